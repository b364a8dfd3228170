"""A wheelset with soft primary suspension on straight track, released off-centre.

    railpatch wheelset -o run.mcap

The wheelset is a Pinocchio model, its contacts are railpatch's force element. The run log and its
report are those of the roller rig.
"""
