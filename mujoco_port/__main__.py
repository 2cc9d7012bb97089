"""`python -m mujoco_port ...` is `wordarm port ...`."""

import sys

from mujoco_port.neighbours import come_first

if __name__ == "__main__":
    come_first()
    from evolution.__main__ import main

    sys.argv.insert(1, "port")
    sys.exit(main())
