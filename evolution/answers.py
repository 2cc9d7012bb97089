"""What a command answers: exit codes, and one sentence for what a user got wrong."""

from __future__ import annotations

import os
import select
import sys
from collections.abc import Callable
from io import TextIOWrapper
from typing import Final, TextIO

from evolution.unloadable import unloadable

BAD_INPUT: Final = 2
# A process whose device no longer answers: another one can go on with it, or find that it is not there.
DEVICE_LOST: Final = 3
INTERRUPTED: Final = 130
BROKEN_PIPE: Final = 141
# How the one sentence of an error begins.
SENTENCE_PREFIX: Final = "wordarm: "
LONGEST_SENTENCE: Final = 1000


class OutputClosedError(BrokenPipeError):
    """Whoever read the output has seen enough."""


def answer(run: Callable[[], int]) -> int:
    """The exit code of what a command does; what is wrong with its input is printed in one sentence."""
    _open_closed_streams()
    if isinstance(sys.stdout, TextIOWrapper):
        # What the output cannot encode is no reason to fail.
        sys.stdout.reconfigure(errors="replace")
    try:
        return _written_out(run)
    except Exception as error:
        if isinstance(error, BrokenPipeError) and _is_closed(error):
            _say("nobody reads the output any more, so the command ended; repeat it to go on")
            _give_up(sys.stdout)
            return BROKEN_PIPE
        told = unloadable(error) or _told(error)
        if told is None:  # a mistake of ours
            raise
        _say(_on_one_line(told))
        _give_up_unwritten()
        return BAD_INPUT
    except KeyboardInterrupt:
        _say("stopped by Ctrl-C")
        return INTERRUPTED


def _open_closed_streams() -> None:
    """Let what is printed to a stream that the caller closed (`>&-`) go nowhere.

    Else the next file that is opened would get its number, and whatever prints would write into that file.
    """
    while (number := os.open(os.devnull, os.O_RDWR)) <= 2:
        os.set_inheritable(number, True)
    os.close(number)
    if sys.stdout is None:
        sys.stdout = os.fdopen(1, "w", closefd=False)
    if sys.stderr is None:
        sys.stderr = os.fdopen(2, "w", closefd=False)


def _written_out(run: Callable[[], int]) -> int:
    """Run, and meet whatever is wrong with the output now rather than when Python ends."""
    try:
        code = run()
    except SystemExit as end:
        if isinstance(end.__context__, BrokenPipeError):  # what rich makes of it
            raise OutputClosedError from None
        _flush()
        raise
    _flush()
    return code


def _flush() -> None:
    """Write out what was printed."""
    try:
        if sys.stdout is not None:
            sys.stdout.flush()
    except BrokenPipeError:
        raise
    except OSError as error:
        raise OSError(f"the output cannot be written ({error.strerror}); send it elsewhere") from None


def _is_closed(error: BrokenPipeError) -> bool:
    """Whether it is our output that nobody reads, rather than a program that we write to and that died."""
    if isinstance(error, OutputClosedError):
        return True
    watch = select.poll()
    watch.register(sys.stdout.fileno(), 0)
    return any(events & (select.POLLERR | select.POLLHUP) for _, events in watch.poll(0))


def _say(sentence: str) -> None:
    """Print a sentence, if there is anybody to read it."""
    try:
        print(f"{SENTENCE_PREFIX}{sentence}", file=sys.stderr, flush=True)
    except OSError:
        _give_up(sys.stderr)


def _give_up_unwritten() -> None:
    """Give an output up that takes no more, such as a file on a full disk: Python would try once more."""
    try:
        _flush()
    except OSError:
        _give_up(sys.stdout)


def _give_up(stream: TextIO) -> None:
    """Let what is still to be written to a stream go nowhere."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def _told(error: Exception) -> str | None:
    """What an error says, with the file a system call failed on; None if it was not raised for a user."""
    if isinstance(error, MemoryError):
        return "the memory does not suffice; ask for less at once"
    if isinstance(error, OSError) and error.filename:
        return f"{error.filename}: {error.strerror}"
    return str(error) if isinstance(error, ValueError | OSError) else None


def _on_one_line(text: str) -> str:
    """A text of which nothing steers the terminal or fills it, whatever a file or a flag holds."""
    line = "".join(each if each.isprintable() else "?" for each in " ".join(text.split()))
    if len(line) <= LONGEST_SENTENCE:
        return line
    # What is found stands first, the reason last.
    return f"{line[: LONGEST_SENTENCE // 2]} ... {line[-LONGEST_SENTENCE // 2 :]}"
