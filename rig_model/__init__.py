"""Replay of the NRC roller rig: its machine as scenes, the force balance, and the run log.

    railpatch rig -o run.mcap

The rig holds a wheelset on two rollers, turns it about the vertical axis and records the forces.
The replay finds at each position the height, the roll angle and the pitch rate at which the forces
balance (report DOT/FRA/ORD-24/18, section 6).
"""
