"""The command `wordarm`, and `python -m wordarm`: found whatever else is called `evolution` or `models`."""

import sys
from pathlib import Path


def main() -> int:
    """Run a command and return its exit code."""
    home = str(Path(__file__).resolve().parent)
    sys.path.insert(0, home)
    try:
        from evolution.__main__ import main as command
    finally:
        sys.path.remove(home)
    return command()


if __name__ == "__main__":
    sys.exit(main())
