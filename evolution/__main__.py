"""`python -m evolution` is `wordarm`."""

import sys

from evolution.answers import answer


def main() -> int:
    """Load the command line and run it, both as `answer` does: Ctrl-C may come at any moment."""

    def load_and_run() -> int:
        from evolution.cli import main as command_line

        return command_line()

    return answer(load_and_run)


if __name__ == "__main__":
    sys.exit(main())
