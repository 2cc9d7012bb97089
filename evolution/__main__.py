"""`python -m evolution` is `wordarm`, which begins here: Ctrl-C is answered before anything is imported."""

import sys


def main() -> int:
    """Run a command and return its exit code."""
    try:
        from mujoco_port.neighbours import come_first

        come_first()
        from evolution.cli import main as command_line

        return command_line()
    except KeyboardInterrupt:
        sys.stderr.write("wordarm: stopped by Ctrl-C\n")
        return 130


if __name__ == "__main__":
    sys.exit(main())
