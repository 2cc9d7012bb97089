"""What a command answers: exit codes, and one sentence for what a user got wrong."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from typing import Final

BAD_INPUT: Final = 2
INTERRUPTED: Final = 130
BROKEN_PIPE: Final = 141
# How the one sentence of an error begins.
SENTENCE_PREFIX: Final = "wordarm: "
LONGEST_SENTENCE: Final = 1000


def answer(run: Callable[[], int]) -> int:
    """The exit code of what a command does; what is wrong with its input is printed in one sentence."""
    try:
        return _run_and_print(run)
    except BrokenPipeError:
        return _nobody_reads()
    except SystemExit as end:
        # Rich ends the program by itself, with 1, when nobody reads what it prints.
        if isinstance(end.__context__, BrokenPipeError):
            return _nobody_reads()
        raise
    except (ValueError, OSError) as error:
        print(f"{SENTENCE_PREFIX}{_sentence(error)}", file=sys.stderr)
        return BAD_INPUT
    except MemoryError:
        print(f"{SENTENCE_PREFIX}the memory does not suffice; ask for less at once", file=sys.stderr)
        return BAD_INPUT
    except KeyboardInterrupt:
        return INTERRUPTED


def _run_and_print(run: Callable[[], int]) -> int:
    """Run, and see to it that all that was said is written."""
    try:
        return run()
    finally:
        if sys.stdout:
            sys.stdout.flush()


def _nobody_reads() -> int:
    """Whoever read our output has seen enough; Python must not complain of it when it ends."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return BROKEN_PIPE


def _sentence(error: ValueError | OSError) -> str:
    """What an error says, on one line, with the file a system call failed on."""
    text = str(error)
    if isinstance(error, OSError) and error.filename:
        text = f"{error.filename}: {error.strerror}"
    # Whatever a file or a flag holds must neither steer the terminal nor fill it.
    line = "".join(each if each.isprintable() else "?" for each in " ".join(text.split()))
    return line if len(line) <= LONGEST_SENTENCE else f"{line[:LONGEST_SENTENCE]} ..."
