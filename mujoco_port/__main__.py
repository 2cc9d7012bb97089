"""`python -m mujoco_port ...` is `wordarm port ...`."""

import sys

from evolution.__main__ import main

if __name__ == "__main__":
    sys.argv.insert(1, "port")
    sys.exit(main())
