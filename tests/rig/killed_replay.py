"""A replay to be killed, started by test_replay.py: prints the index of each position."""

import sys

from rig_model.run import replay
from rig_model.scene import load_rig_scene

if __name__ == "__main__":
    scene = load_rig_scene(sys.argv[1], {"rate": 200.0})
    replay(scene, sys.argv[2], lambda balance: print(balance.position.index, flush=True))
