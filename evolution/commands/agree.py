"""`wordarm agree`: how often the robot, with motors and free objects, does what the 2D arm does."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from tyro.conf import Positional, arg

if TYPE_CHECKING:
    from mujoco_port.acting.agreement import Candidate


@dataclass(frozen=True)
class Agree:
    """Let the robot carry out many trials of agents by itself, judge them in 3D, and count."""

    sources: Annotated[Positional[tuple[str, ...]], arg(metavar="AGENT...")]
    """Run folders, genotype files or names of shipped champions; the best of each is meant."""

    loops: tuple[Literal["open", "delayed", "geometric", "camera"], ...] = ("open",)
    """open: the robot follows the 2D arm. delayed: the same, with an agent that is answered a step late, as
    in closed loop. geometric, camera: the agent's inputs come from the robot."""

    starts: int = 20
    """Fresh starts of each instruction in each start area."""

    seed: int = 0
    """The starts follow from it."""

    robot: str = "icub"
    """Which humanoid; an unknown name lists those there are."""

    processes: int | None = None
    """How many trials at once; by default one for each core."""

    output: Path = Path("agreement.csv")
    """One row for each trial; a file that is not complete is continued."""

    def run(self) -> int:
        """Carry out what the file does not hold yet, and print the counts."""
        if not self.sources:
            raise ValueError("no agent is named; give run folders, genotype files or shipped champions")
        for name, number in (("starts", self.starts), ("processes", self.processes)):
            if number is not None and number < 1:
                raise ValueError(f"--{name} {number} makes no trials; give at least 1")
        from rich.console import Console
        from rich.progress import track

        from models.robots import get_robot
        from mujoco_port.acting.agreement import jobs, outcomes
        from mujoco_port.acting.tally import tables
        from mujoco_port.film.gl import choose_back_end

        get_robot(self.robot)
        if "camera" in self.loops:
            choose_back_end()
        listed = jobs([candidate(name) for name in self.sources], self.loops, self.starts, self.seed)
        processes = self.processes or len(os.sched_getaffinity(0))
        console = Console()
        counted = list(
            track(
                outcomes(listed, self.robot, self.output, processes),
                "trials on the robot",
                total=len(listed),
                console=Console(stderr=True),
            )
        )
        for table in tables(counted):
            console.print(table)
        print(self.output)
        return 0


def candidate(name: str) -> Candidate:
    """Whom to try, by what the user calls it."""
    from evolution.runs.sources import find_agent
    from mujoco_port.acting.agreement import Candidate

    agent = find_agent(name)
    home = "" if agent.folder is None else f"{agent.condition}/{agent.folder.path.name}/"
    return Candidate(home + agent.name, agent.genotype, agent.condition.instructions, agent.readings)
