"""How exactly and how fast the hand follows, beside mink and pin-pink on the same paths.

python -m benchmarks.ik [ROBOT] [--tune]

The paths are one walk over all of the workspace and the trials of an evolved agent. All solvers walk each of
them in the same run, in turn; times are processor times, which other work on the machine troubles little.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table

from arm2d import Condition, Readings, draw_trials, record_trial
from benchmarks.ik_solvers import LIBRARIES, TRIED, TUNED, Ours, Solver, installed, library, settled
from models.robots import Robot, get_robot
from mujoco_port.reach.kinematics import ArmKinematics
from mujoco_port.reach.workspace import hand_headings, hand_targets

EVOLVED = Path(__file__).parents[1] / "tests" / "evolved.npz"
COLUMNS = ("path", "solver", "steps", "us median", "p99", "error [m] median", "p99", "largest", "jump [rad]")
Walk = tuple[NDArray[np.float64], NDArray[np.float64]]  # alpha and beta in [deg]


def workspace_walk() -> Walk:
    """(alpha, beta) over all of the workspace, back and forth, no step wider than a turn [deg]."""
    alpha, beta = np.linspace(-30, 210, 84), np.linspace(0, 90, 33)
    columns = [beta[:: -1 if k % 2 else 1] for k in range(len(alpha))]
    return np.repeat(alpha, len(beta)), np.concatenate(columns)


def trial_walks() -> list[Walk]:
    """(alpha, beta) of an evolved agent's trials of all nine instructions [deg]."""
    with np.load(EVOLVED, allow_pickle=False) as stored:
        genotype = stored["genotypes"][15]
    trials = draw_trials(Condition.WITH_INDICATE.instructions, 2, Readings(), np.random.default_rng(1))
    records = [record_trial(genotype, trials[t]) for t in range(len(trials))]
    return [(record.alpha, record.beta) for record in records]


@dataclass
class Figures:
    """What was measured of one solver: [us] and [m] of every step, and the largest step of a joint [rad]."""

    times: list[float] = field(default_factory=list)
    errors: list[float] = field(default_factory=list)
    jump: float = 0.0

    def cells(self) -> tuple[str, ...]:
        """As they stand in the table."""
        middle, late = np.percentile(self.times, [50, 99])
        near, far = np.percentile(self.errors, [50, 99])
        errors = (f"{each:.0e}" for each in (near, far, max(self.errors)))
        return f"{len(self.times):,}", f"{middle:.0f}", f"{late:.0f}", *errors, f"{self.jump:.3f}"


def walk(solver: Solver, kinematics: ArmKinematics, path: Walk, figures: Figures) -> None:
    """Let a solver follow a path, and add what it did to its figures."""
    plane = kinematics.robot.plane
    targets, headings = hand_targets(plane, *path), hand_headings(plane, *path)
    rest = np.clip(kinematics.rest, kinematics.lower, kinematics.upper)
    angles = settled(solver, rest, targets[0], headings[0])
    for target, heading in zip(targets[1:], headings[1:], strict=True):
        start = time.thread_time()
        posture = solver.step(angles, target, heading)
        figures.times.append(1e6 * (time.thread_time() - start))
        figures.errors.append(float(np.linalg.norm(kinematics.forward(posture).position - target)))
        figures.jump = max(figures.jump, float(np.abs(posture - angles).max()))
        angles = posture


def compare(
    solvers: Sequence[Solver], kinematics: ArmKinematics, paths: Sequence[Walk]
) -> list[tuple[str, Figures]]:
    """All solvers on all paths, in turn."""
    measured = [(solver.name, Figures()) for solver in solvers]
    for path in paths:
        for solver, (_, figures) in zip(solvers, measured, strict=True):
            walk(solver, kinematics, path, figures)
    return measured


def tune(robot: Robot) -> None:
    """Print what every setting of mink and pin-pink does on a few trials."""
    kinematics, paths = ArmKinematics(robot), trial_walks()[::6]
    table = Table(*COLUMNS[1:], title="settings; on every sixth trial")
    for name in installed():
        for settings in TRIED:
            ((_, figures),) = compare([library(name, robot, settings)], kinematics, paths)
            table.add_row(f"{name}: {settings}", *figures.cells())
    Console(width=140).print(table)


def main(arguments: Sequence[str]) -> None:
    """Print a table."""
    names = [each for each in arguments if not each.startswith("-")]
    robot = get_robot(names[0] if names else "icub")
    if "--tune" in arguments:
        tune(robot)
        return
    kinematics = ArmKinematics(robot)
    solvers: list[Solver] = [Ours(robot, with_heading=False), Ours(robot, with_heading=True)]
    solvers += [library(name, robot, TUNED[name]) for name in installed()]
    alpha, beta = workspace_walk()
    compare(solvers, kinematics, [(alpha[:50], beta[:50])])  # compiled and warm
    table = Table(*COLUMNS, title=f"inverse kinematics of {robot.title}")
    for title, paths in (("all of the workspace", [workspace_walk()]), ("trials", trial_walks())):
        for name, figures in compare(solvers, kinematics, paths):
            table.add_row(title, name, *figures.cells())
    Console(width=120).print(table)
    print("\n".join(remark(name) for name in LIBRARIES))


def remark(name: str) -> str:
    """The settings of another solver, or how to get it."""
    if name in installed():
        return f"{name}: position only; {TUNED[name]}"
    return f"{name}: not compared with, as it is not installed; run: pip install 'wordarm[benchmark]'"


if __name__ == "__main__":
    main(sys.argv[1:])
