"""One input is read, within bounds of time and memory; what must not happen is named."""

import contextlib
import io
import resource
import signal
import traceback
from collections.abc import Iterator
from contextlib import contextmanager

from evolution.answers import BAD_INPUT
from tests.fuzz.inputs import Reader
from tests.fuzz.places import Place

# No input may keep its reader busy for longer [s of CPU] ...
LONGEST = 5
# ... or make it ask for so much more memory than the process had at first [bytes].
MEMORY = 2**30


class HangError(BaseException):
    """An input takes too long; nothing but the fuzzer catches this."""


@contextmanager
def bounded() -> Iterator[None]:
    """While open, CPU time and memory are limited."""

    def stop(number, frame):
        raise HangError

    with open("/proc/self/statm") as file:
        size = int(file.read().split()[0]) * resource.getpagesize()
    before = resource.getrlimit(resource.RLIMIT_AS)
    handler = signal.signal(signal.SIGVTALRM, stop)
    resource.setrlimit(resource.RLIMIT_AS, (size + MEMORY, before[1]))
    signal.setitimer(signal.ITIMER_VIRTUAL, LONGEST)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        resource.setrlimit(resource.RLIMIT_AS, before)
        signal.signal(signal.SIGVTALRM, handler)


def fault_of(read: Reader, place: Place) -> tuple[int, str]:
    """The exit code, and what is wrong with how an input was answered; nothing if all is well."""
    before, output, errors = place.contents(), io.StringIO(), io.StringIO()
    try:
        with bounded(), contextlib.redirect_stdout(output), contextlib.redirect_stderr(errors):
            code = read()
    except SystemExit as end:  # after help
        code = end.code if isinstance(end.code, int) else 1
    except HangError:
        return -1, f"it takes longer than {LONGEST} s"
    except BaseException:
        return -1, traceback.format_exc()
    return code, _fault(code, output.getvalue(), errors.getvalue()) or _left_behind(code, before, place)


def _fault(code: int, output: str, errors: str) -> str:
    """What is wrong with exit code and words."""
    if code not in (0, BAD_INPUT):
        return f"exit code {code}: {errors}"
    if "Traceback" in output + errors:
        return f"a traceback: {errors}"
    if "memory does not suffice" in errors:
        return "it asks for more memory than it may"
    if code == BAD_INPUT and not (errors.startswith("wordarm: ") and errors.count("\n") == 1):
        return f"not one sentence: {errors!r}"
    if code == BAD_INPUT and "\x1b" in errors:
        return "it passes on what steers a terminal"
    return ""


def _left_behind(code: int, before: dict, place: Place) -> str:
    """What is wrong with the files afterwards: bad input writes nothing, and no input is executed."""
    if place.trap.exists():
        return "it was executed"
    after = place.contents()
    if code == BAD_INPUT and after != before:
        return f"it was refused, but wrote {sorted(set(after.items()) ^ set(before.items()))[:3]}"
    if escaped := [each for each in after if "escape" in each]:
        return f"it wrote outside its folder: {escaped}"
    return ""
