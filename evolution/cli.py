"""The command line: `wordarm COMMAND`.

A command is named once, in GROUPS; its module is imported when it is asked for. What a user got wrong is
answered by one sentence on stderr and exit code 2.
"""

from __future__ import annotations

import os
import re
import sys
import warnings
from collections.abc import Sequence
from typing import Final, NamedTuple, Protocol

from evolution.answers import BAD_INPUT, SENTENCE_PREFIX, answer


class Entry(NamedTuple):
    """A command: where its record is, and what it is for."""

    place: str
    line: str


# In the order of the story.
GROUPS: Final = {
    "evolve": {
        "evolve": Entry("evolve:Evolve", "one run from random genotypes, or the rest of it"),
        "experiment": Entry("experiment:ExperimentCommand", "any grid of readings, settings and seeds"),
        "reproduce": Entry("reproduce:Reproduce", "the whole paper, from random genotypes to its report"),
        "status": Entry("experiment:Status", "how far runs have come, from another terminal"),
        "study": Entry("study:StudyCommand", "which reading comes nearest to the paper; what lies beyond it"),
    },
    "look": {
        "evaluate": Entry("agent:Evaluate", "an agent on all nine instructions; a run's fitness"),
        "behaviour": Entry("behaviour:BehaviourCommand", "how an agent, or classes of agents, do it"),
        "lineage": Entry("lineage:LineageCommand", "an agent's ancestors, and when each skill came"),
    },
    "paper": {
        "postevaluate": Entry("analyse:PostEvaluate", "the paper's tests, for every finished run"),
        "analyse": Entry("analyse:Analyse", "its tables and figures; several experiments compared"),
        "report": Entry("analyse:Report", "one page with everything an experiment shows"),
    },
    "robot": {
        "port": Entry("port:Port", "a trial, or all nine, on the iCub, as a video"),
        "live": Entry("robot:Live", "the iCub acts in a web page, and listens to you"),
        "agree": Entry("robot:Agree", "how often the robot does what the planar arm does"),
        "workspace": Entry("robot:Workspace", "whether a robot reaches everywhere, and hits nothing"),
    },
    "keep": {
        "verify": Entry("verify:Verify", "a run computed again and compared; an archive checked"),
        "doctor": Entry("machine:Doctor", "what this machine lacks; what its file system keeps"),
    },
}
COMMANDS: Final = {name: entry for group in GROUPS.values() for name, entry in group.items()}
# What became of commands that there were.
MOVED: Final = {
    "classes": "behaviour EXPERIMENT",
    "compare": "analyse EXPERIMENT EXPERIMENT",
    "gallery": "port AGENT all",
    "plot": "evaluate RUN",
    "repair": "verify RUN --repair",
    "ship": "analyse EXPERIMENT --ship FOLDER",
    "archive": "analyse EXPERIMENT --archive FILE.tar.gz",
    "torture": "doctor --torture FOLDER",
}

USAGE: Final = """\
usage: wordarm COMMAND [OPTIONS]

An arm that obeys two-word instructions: evolve its controllers, test them,
show them on a humanoid.
"""
ENDING: Final = """
Options of a command: wordarm COMMAND --help. Version: wordarm --version"""


class Command(Protocol):
    """What the options of a command are read into."""

    def run(self) -> int:
        """Do it; the exit code."""
        ...


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command and return its exit code: 0, 2 for bad input, 130 after Ctrl-C, 141 for a closed pipe."""
    return answer(lambda: _main(sys.argv[1:] if arguments is None else arguments))


def _main(arguments: Sequence[str]) -> int:
    warnings.formatwarning = _one_line
    if os.path.expanduser("~") == "~":  # a user without a home, of which arm2d.cache tells
        import logging

        logging.getLogger("matplotlib").setLevel(logging.ERROR)
    # A run is one thread; idle threads of linear algebra would only cost memory.
    for library in ("OPENBLAS", "OMP", "MKL"):
        os.environ.setdefault(f"{library}_NUM_THREADS", "1")
    # A notebook's back end may not exist here, a number be 0: nothing is shown, no kernel has threads.
    os.environ.update(MPLBACKEND="agg", NUMBA_NUM_THREADS="1")
    # A terminal of no columns would be shown none; NumPy does not load with a date that is no number.
    for name in ("COLUMNS", "SOURCE_DATE_EPOCH"):
        if not re.fullmatch("[1-9][0-9]*", os.environ.get(name, "1")):
            del os.environ[name]
    if not arguments:
        print(overview(), file=sys.stderr)
        return BAD_INPUT
    if arguments[0] in ("-h", "--help"):
        print(overview())
        return 0
    if arguments[0] == "--version":
        from evolution.runs.meta import revision, versions

        print(f"wordarm {versions()['wordarm']}, revision {revision()}")
        return 0
    _check_current_folder()
    return parse(arguments).run()


def _check_current_folder() -> None:
    """Refuse a current folder that was removed: libraries would stumble over it without a name."""
    try:
        os.getcwd()
    except OSError as error:
        raise OSError(f"the current folder cannot be used ({error.strerror}); go to another: cd ~") from None


def _one_line(message: Warning | str, *_: object, **__: object) -> str:
    """How a warning is shown: to a user, its place in our sources says nothing."""
    return f"{SENTENCE_PREFIX}{message}\n"


def overview() -> str:
    """What `wordarm --help` says."""
    width = max(map(len, COMMANDS)) + 2
    groups = [
        "\n".join([name, *(f"  {command:{width}}{entry.line}" for command, entry in group.items())])
        for name, group in GROUPS.items()
    ]
    return "\n".join([USAGE, "\n\n".join(groups), ENDING])


def parse(arguments: Sequence[str]) -> Command:
    """The command that the arguments ask for.

    Raises:
        ValueError: If there is no such command, option or value, with the nearest there is.
        SystemExit: With code 0, after the help of a command was printed.
    """
    # The parser would pass control characters on to the terminal.
    for number, argument in enumerate(arguments, 1):
        if any(character < " " or character == "\x7f" for character in argument):
            raise ValueError(f"argument {number} is {argument!r}; leave out what cannot be printed")
    name, *options = arguments
    kind, prog = _record(name), f"wordarm {name}"
    from evolution.parsing import read_command

    command = read_command(kind, options, prog)
    # Now that a preset is known, its readings become the defaults of those that were not set.
    default = command.preset_default() if hasattr(command, "preset_default") else None
    return command if default is None else read_command(kind, options, prog, default)


def _record(name: str) -> type:
    """The record of a command.

    Raises:
        ValueError: If there is none of that name.
    """
    from importlib import import_module

    entry = COMMANDS.get(name)
    if entry is None:
        raise ValueError(_no_command(name))
    module, record = entry.place.split(":")
    return getattr(import_module(f"evolution.commands.{module}"), record)


def _no_command(name: str) -> str:
    """What is said instead of a command that does not exist."""
    if name.startswith("-"):
        return f"{name} stands where a command should; see: wordarm --help"
    from difflib import get_close_matches

    close = get_close_matches(name.lower(), [*COMMANDS, *MOVED], n=1)
    if not close:
        return f"there is no command {name!r}; see: wordarm --help"
    return f"there is no command {name!r}; the nearest is: wordarm {MOVED.get(close[0], close[0])}"
