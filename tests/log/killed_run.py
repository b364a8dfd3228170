"""A run to be killed: writes positions quickly, then computes for long. Started by test_killed.py.

Prints each position's index once it was written.
"""

import sys
import time
from pathlib import Path

import synthetic

if __name__ == "__main__":
    path, positions = Path(sys.argv[1]), int(sys.argv[2])
    log = synthetic.open_log(path)
    for index in range(positions):
        synthetic.write_position(log, index)
        print(index, flush=True)
        time.sleep(0.02)
    time.sleep(600)
