"""How exactly and how fast the hand follows: all of the workspace, and trials of an evolved agent.

python -m benchmarks.ik
"""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table

from arm2d import Condition, Readings, draw_trials, record_trial
from models.robots import get_robot
from mujoco_port.kinematics import ArmKinematics
from mujoco_port.workspace import hand_headings, hand_targets

EVOLVED = Path(__file__).parents[1] / "tests" / "evolved.npz"


def workspace_walk() -> tuple[NDArray, NDArray]:
    """(alpha, beta) over all of the workspace, back and forth, no step wider than a turn [deg]."""
    alpha, beta = np.linspace(-30, 210, 84), np.linspace(0, 90, 33)
    columns = [beta[:: -1 if k % 2 else 1] for k in range(len(alpha))]
    return np.repeat(alpha, len(beta)), np.concatenate(columns)


def trial_walks() -> list[tuple[NDArray, NDArray]]:
    """(alpha, beta) of an evolved agent's trials of all nine instructions [deg]."""
    with np.load(EVOLVED, allow_pickle=False) as stored:
        genotype = stored["genotypes"][15]
    trials = draw_trials(Condition.WITH_INDICATE.instructions, 5, Readings(), np.random.default_rng(1))
    records = [record_trial(genotype, trials[t]) for t in range(len(trials))]
    return [(record.alpha, record.beta) for record in records]


def measure(
    kinematics: ArmKinematics, walks: list[tuple[NDArray, NDArray]]
) -> tuple[NDArray, NDArray, float]:
    """(microseconds per step, position errors in [m], largest joint jump in [rad])."""
    plane, times, errors, jump = kinematics.robot.plane, [], [], 0.0
    for alpha, beta in walks:
        targets, headings = hand_targets(plane, alpha, beta), hand_headings(plane, alpha, beta)
        angles = kinematics.settle(targets[0], headings[0])
        for target, heading in zip(targets[1:], headings[1:], strict=True):
            start = time.perf_counter()
            posture = kinematics.step(angles, target, heading)
            times.append(1e6 * (time.perf_counter() - start))
            errors.append(np.linalg.norm(kinematics.forward(posture).position - target))
            jump = max(jump, float(np.abs(posture - angles).max()))
            angles = posture
    return np.array(times), np.array(errors), jump


def main() -> None:
    """Print a table."""
    kinematics = ArmKinematics(get_robot("icub"))
    measure(kinematics, [workspace_walk()])  # compiled and warm
    table = Table(title="inverse kinematics of the iCub, position with heading")
    for heading in (
        "path",
        "steps",
        "time [us] median",
        "p99",
        "error [m] median",
        "p99",
        "max",
        "jump [rad]",
    ):
        table.add_column(heading, justify="left" if heading == "path" else "right")
    for name, walks in (("whole workspace", [workspace_walk()]), ("trials", trial_walks())):
        times, errors, jump = measure(kinematics, walks)
        fast, slow = np.percentile(times, [50, 99])
        middle, high = np.percentile(errors, [50, 99])
        cells = (
            f"{fast:.0f}",
            f"{slow:.0f}",
            f"{middle:.0e}",
            f"{high:.0e}",
            f"{errors.max():.0e}",
            f"{jump:.3f}",
        )
        table.add_row(name, f"{len(times):,}", *cells)
    Console().print(table)


if __name__ == "__main__":
    main()
