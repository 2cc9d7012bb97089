"""The command line: `wordarm <command>`.

What a user got wrong is answered by one sentence on stderr and exit code 2.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from typing import Annotated, Final

import tyro
from tyro.conf import subcommand

from arm2d import Readings
from evolution.answers import answer
from evolution.commands.agree import Agree
from evolution.commands.analyse import Analyse
from evolution.commands.behaviour import BehaviourCommand
from evolution.commands.classes import Classes
from evolution.commands.compare import Compare
from evolution.commands.doctor import Doctor
from evolution.commands.evaluate import Evaluate
from evolution.commands.evolve import Evolve, UncheckedReadings
from evolution.commands.experiment import ExperimentCommand
from evolution.commands.gallery import Gallery
from evolution.commands.lineage import LineageCommand
from evolution.commands.measure import Measure
from evolution.commands.play import Play
from evolution.commands.plot import Plot
from evolution.commands.port import Port
from evolution.commands.postevaluate import PostEvaluate
from evolution.commands.repair import Repair
from evolution.commands.report import Report
from evolution.commands.reproduce import Reproduce
from evolution.commands.ship import Ship
from evolution.commands.status import Status
from evolution.commands.study import StudyCommand
from evolution.commands.torture import TortureCommand
from evolution.commands.verify import Verify
from evolution.commands.workspace import Workspace

DESCRIPTION: Final = "An arm that obeys two-word instructions: evolve its controllers, test them, show them."

Command = (
    Evolve
    | Agree
    | Evaluate
    | ExperimentCommand
    | BehaviourCommand
    | Classes
    | Compare
    | Doctor
    | Gallery
    | LineageCommand
    | Measure
    | Play
    | Plot
    | Port
    | PostEvaluate
    | Repair
    | Report
    | Reproduce
    | Ship
    | Status
    | StudyCommand
    | TortureCommand
    | Verify
    | Workspace
    | Analyse
)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command and return its exit code: 0, 2 for bad input, 130 after Ctrl-C."""
    # A run is one thread; idle threads of linear algebra would only cost memory.
    for library in ("OPENBLAS", "OMP", "MKL"):
        os.environ.setdefault(f"{library}_NUM_THREADS", "1")
    return answer(lambda: parse(sys.argv[1:] if arguments is None else arguments).run())


def parse(arguments: Sequence[str]) -> Command:
    """The command that the arguments ask for; the option parser exits with code 2 where it finds none.

    Raises:
        ValueError: If an argument holds a control character, which the parser would pass on to the terminal.
    """
    for number, argument in enumerate(arguments, 1):
        if any(each < " " or each == "\x7f" for each in argument):
            raise ValueError(f"argument {number} is {argument!r}; leave out what cannot be printed")
    command = _parse(arguments, UncheckedReadings())
    if isinstance(command, Evolve | Reproduce) and command.preset != "default":
        # Now that the preset is known, its readings become the defaults of those that were not set.
        command = _parse(arguments, UncheckedReadings(**vars(Readings.preset(command.preset))))
    return command


def _parse(arguments: Sequence[str], readings: UncheckedReadings) -> Command:
    """Parse, with the default readings as given."""
    commands = (
        Annotated[Evolve, subcommand("evolve", default=Evolve(readings=readings))]
        | Annotated[Agree, subcommand("agree")]
        | Annotated[BehaviourCommand, subcommand("behaviour")]
        | Annotated[Classes, subcommand("classes")]
        | Annotated[Compare, subcommand("compare")]
        | Annotated[Doctor, subcommand("doctor")]
        | Annotated[Evaluate, subcommand("evaluate")]
        | Annotated[ExperimentCommand, subcommand("experiment")]
        | Annotated[Gallery, subcommand("gallery")]
        | Annotated[LineageCommand, subcommand("lineage")]
        | Annotated[Measure, subcommand("measure")]
        | Annotated[Play, subcommand("play")]
        | Annotated[Plot, subcommand("plot")]
        | Annotated[Port, subcommand("port")]
        | Annotated[PostEvaluate, subcommand("postevaluate")]
        | Annotated[Repair, subcommand("repair")]
        | Annotated[Report, subcommand("report")]
        | Annotated[Reproduce, subcommand("reproduce", default=Reproduce(readings=readings))]
        | Annotated[Ship, subcommand("ship")]
        | Annotated[Status, subcommand("status")]
        | Annotated[StudyCommand, subcommand("study")]
        | Annotated[TortureCommand, subcommand("torture")]
        | Annotated[Verify, subcommand("verify")]
        | Annotated[Workspace, subcommand("workspace")]
        | Annotated[Analyse, subcommand("analyse")]
    )
    return tyro.cli(commands, prog="wordarm", description=DESCRIPTION, args=arguments)  # pyright: ignore
