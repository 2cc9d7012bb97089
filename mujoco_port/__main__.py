"""`python -m mujoco_port ...` is `wordarm port ...`."""

import sys

from evolution.cli import main

if __name__ == "__main__":
    sys.exit(main(["port", *sys.argv[1:]]))
