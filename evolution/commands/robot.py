"""`wordarm live`, `agree` and `workspace`: a robot in a web page, in many trials, and on all of its table."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
from tyro.conf import Positional, arg

from arm2d import Readings
from evolution.commands.agent import AgentCommand

if TYPE_CHECKING:
    from models.robots import Robot
    from mujoco_port.acting.agreement import Candidate

NOT_CERTIFIED = 1  # exit code


@dataclass(frozen=True, kw_only=True)
class Live(AgentCommand):
    """Let the humanoid act in a web page in real time: words are chosen and changed, objects moved there."""

    start_area: Literal["right", "left"] = "right"
    """Where S1 starts."""

    trial_seed: int = 0
    """Start angle and object positions follow from it."""

    robot: str = "icub"
    """Which humanoid; an unknown name lists those there are."""

    closed_loop: Literal["geometric", "camera"] | None = None
    """The agent's inputs come from the acting robot: objects seen where they are, or by a rendered camera."""

    host: str = "127.0.0.1"
    """Where to listen. Anything but this machine's own address asks for the token in the printed address."""

    port: int = 8080
    """Of the page; 0 for any that is free."""

    def run(self) -> int:
        """Serve the page until Ctrl-C."""
        from arm2d import Trials, draw_trials
        from arm2d.tasks.task import papers_condition
        from arm2d.trials import area_index
        from evolution.search.randomness import Purpose, generator
        from mujoco_port.live.actor import Actor
        from mujoco_port.live.live import show_live

        source = self.find_agent()
        instructions = papers_condition(source.condition, "the live page").instructions

        def draw(area: str, seed: int) -> Trials:  # as `wordarm port` does
            trials = draw_trials([instructions[0]], 1, source.readings, generator(seed, Purpose.RECORDING))
            return trials[area_index(area)]

        show_live(
            Actor(source.name, source.genotype, source.readings, instructions),
            draw,
            lambda address: print(f"open {address} in a browser; Ctrl-C ends", flush=True),
            robot=self.robot,
            closed_loop=self.closed_loop,
            area=self.start_area,
            seed=self.trial_seed,
            host=self.host,
            port=self.port,
        )
        return 0


@dataclass(frozen=True)
class Agree:
    """Let the robot carry out many trials of agents by itself, judge them in 3D, and count."""

    sources: Annotated[Positional[tuple[str, ...]], arg(metavar="AGENT...", help_behavior_hint="(required)")]
    """Run folders, genotype files or names of shipped champions; the best of each is meant."""

    loops: Annotated[
        tuple[Literal["open", "delayed", "geometric", "camera"], ...], arg(metavar="LOOP...")
    ] = ("open",)
    """open: the robot follows the 2D arm. delayed: the same, with an agent that is answered a step late, as
    in closed loop. geometric, camera: the agent's inputs come from the robot."""

    starts: int = 20
    """Fresh starts of each instruction in each start area."""

    seed: int = 0
    """The starts follow from it."""

    robot: str = "icub"
    """Which humanoid; an unknown name lists those there are."""

    head: Literal["turns", "held"] = "turns"
    """turns: neck and eyes follow S1. held: they keep still."""

    processes: int | None = None
    """How many trials at once; by default one for each core."""

    output: Path = Path("agreement.csv")
    """One row for each trial; a file that is not complete is continued."""

    def run(self) -> int:
        """Carry out what the file does not hold yet, and print the counts."""
        if not self.sources:
            raise ValueError("no agent is named; give run folders, genotype files or shipped champions")
        if not self.loops or len(set(self.loops)) < len(self.loops):
            raise ValueError(f"--loops {' '.join(self.loops)}: give one or more, each of them once")
        numbers = {"starts": (self.starts, 1), "processes": (self.processes, 1), "seed": (self.seed, 0)}
        for name, (number, least) in numbers.items():
            if number is not None and number < least:
                raise ValueError(f"--{name} {number} must be at least {least}")
        from mujoco_port.film.gl import choose_back_end, without_drawing

        if "camera" not in self.loops:
            with without_drawing():
                return self._count()
        choose_back_end()
        return self._count()

    def _count(self) -> int:
        from rich.console import Console
        from rich.progress import track

        from models.robots import get_robot
        from mujoco_port.acting.agreement import jobs, outcomes
        from mujoco_port.acting.tally import tables

        get_robot(self.robot)
        listed = jobs(candidates(self.sources), self.loops, self.starts, self.seed)
        processes = self.processes or len(os.sched_getaffinity(0))
        console = Console()
        counted = list(
            track(
                outcomes(listed, self.robot, self.output, processes, self.head),
                "trials on the robot",
                total=len(listed),
                console=Console(stderr=True),
            )
        )
        for table in tables(counted):
            console.print(table)
        print(self.output)
        return 0


def candidates(sources: Sequence[str]) -> list[Candidate]:
    """Whom to try; those that would be called alike by what the user calls them.

    Raises:
        ValueError: If one of them is named twice, by whatever name.
    """
    found = [candidate(source) for source in sources]
    for (first, one), (second, other) in combinations(zip(sources, found, strict=True), 2):
        alike = (one.readings, one.instructions) == (other.readings, other.instructions)
        if alike and np.array_equal(one.genotype, other.genotype):
            raise ValueError(f"{first} and {second} are the same agent; name each of them once")
    names = [each.name for each in found]
    return [
        each if names.count(each.name) == 1 else replace(each, name=source)
        for source, each in zip(sources, found, strict=True)
    ]


def candidate(name: str) -> Candidate:
    """Whom to try, by what the user calls it."""
    from arm2d.tasks.task import papers_condition
    from evolution.runs.sources import find_agent
    from mujoco_port.acting.agreement import Candidate

    agent = find_agent(name)
    home = "" if agent.folder is None else f"{agent.condition}/{agent.folder.path.name}/"
    condition = papers_condition(agent.condition, "the agreement of robot and plane")
    return Candidate(home + agent.name, agent.genotype, condition.instructions, agent.readings)


@dataclass(frozen=True, kw_only=True)
class Workspace:
    """Certify that a humanoid reaches all of the workspace and meets neither the table nor itself."""

    robot: str = "icub"
    """Which humanoid; an unknown name lists those there are."""

    output: Path = Path()
    """Folder for `workspace-ROBOT.npz`, `.png` and `.svg`."""

    scale: float | None = None
    """Another scale of the map than the robot's own [m/cm]."""

    step_deg: float = 2.9
    """Widest step of the grid [deg]."""

    search: bool = False
    """Search for the constants of the robot's record instead, from those it has, and print the record."""

    evaluations: int = 3000
    """Records that a search tries."""

    seed: int = 0
    """Of the search: the same seed gives the same record."""

    def run(self) -> int:
        """Certify, or search."""
        from models.robots import get_robot

        robot = get_robot(self.robot)
        self._check_search()
        if self.scale is not None:
            if not self.scale > 0.0:
                raise ValueError(
                    f"a scale of {self.scale:g} m/cm is no map; give a positive one, such as 0.002"
                )
            robot = replace(robot, plane=replace(robot.plane, scale=self.scale))
        from mujoco_port.film.gl import without_drawing
        from mujoco_port.reach.workspace import for_world

        robot = for_world(robot, Readings())
        with without_drawing():
            return self._search(robot) if self.search else self._certify(robot)

    def _check_search(self) -> None:
        """Refuse what a search cannot do, and what is about none."""
        evaluations, seed = self.evaluations, self.seed
        if not self.search and (evaluations, seed) != (Workspace.evaluations, Workspace.seed):
            raise ValueError("--evaluations and --seed are about --search; leave them out, or search")
        for name, number, least in (("evaluations", evaluations, 1), ("seed", seed, 0)):
            if number < least:
                raise ValueError(f"--{name} {number} must be at least {least}")

    def _certify(self, robot: Robot) -> int:
        from evolution.figures.page import save_figure
        from evolution.runs.storage import make_folder, write_arrays
        from mujoco_port.reach.certificate import certify, check_step
        from mujoco_port.reach.certificate_figure import draw_certificate

        check_step(self.step_deg)
        make_folder(self.output)
        certificate = certify(robot, step_deg=self.step_deg)
        stem = self.output / f"workspace-{robot.name}"
        path = stem.with_suffix(".npz")
        write_arrays(path, certificate.arrays())
        figures = save_figure(draw_certificate(certificate, robot), stem)
        print("\n".join(certificate.summary()))
        for fault in certificate.faults():
            print(f"Not certified: {fault}.")
        print(", ".join(str(each) for each in (path, *figures)))
        return NOT_CERTIFIED if certificate.faults() else 0

    def _search(self, robot: Robot) -> int:
        from mujoco_port.reach.search import search_with_progress, written

        best = search_with_progress(robot, evaluations=self.evaluations, seed=self.seed)
        print(written(best))
        return 0
