"""Where a robot is to stand and what its arm is to prefer: a search for the constants of its record.

wordarm workspace --search --scale 0.0019

The search varies the place of the robot's root, the rest posture with its weights, and the weights of
heading and roll. It starts from the record as it stands and lowers the cost of `wishes.py`. The
method is CMA-ES; the same seed gives the same record.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from models.robots import Robot
from mujoco_port.reach.kinematics import ArmKinematics
from mujoco_port.reach.wishes import Cost, Wishes

# How far a coordinate of the search leads when it changes by one.
PLACE_UNIT: Final = 0.03  # [m], of the root
REST_UNIT: Final = 0.15  # of a joint's range
WEIGHT_UNIT: Final = 1.0  # of a weight's natural logarithm
FIRST_SPREAD: Final = 0.1  # of the search, in these units


def varied(robot: Robot, kinematics: ArmKinematics, change: NDArray[np.float64]) -> Robot:
    """Give the record that a point of the search stands for; the origin is the record itself."""
    n = len(robot.joints)
    place, rest, weights, wishes = np.split(change, [3, 3 + n, 3 + 2 * n])
    span = kinematics.upper - kinematics.lower
    posture = robot.posture
    return replace(
        robot,
        base_position=tuple((np.array(robot.base_position) + PLACE_UNIT * place).tolist()),
        posture=replace(
            posture,
            rest=tuple(
                np.clip(posture.rest + REST_UNIT * span * rest, kinematics.lower, kinematics.upper).tolist()
            ),
            weights=tuple((np.array(posture.weights) * np.exp(WEIGHT_UNIT * weights)).tolist()),
            heading_weight=float(posture.heading_weight * np.exp(WEIGHT_UNIT * wishes[0])),
            level_weight=float(posture.level_weight * np.exp(WEIGHT_UNIT * wishes[1])),
        ),
    )


def search(robot: Robot, *, evaluations: int, seed: int, tell: Callable[[int, Cost, Robot], None]) -> Robot:
    """Lower a record's cost and give the best record seen, unrounded.

    Args:
        robot: Where the search starts.
        evaluations: Records to try; the search ends with the population in which they are used up.
        seed: The same seed gives the same record.
        tell: Called after every population: how many records were tried, the least cost, the best record.

    Raises:
        ValueError: If `evaluations` or `seed` is negative.
    """
    from cmaes import CMA

    if evaluations < 0 or seed < 0:
        raise ValueError(f"{evaluations} evaluations with seed {seed} are none; give numbers from 0 on")
    kinematics, wishes = ArmKinematics(robot), Wishes(robot)
    n_coordinates = 3 + 2 * len(robot.joints) + 2
    optimizer = CMA(mean=np.zeros(n_coordinates), sigma=FIRST_SPREAD, seed=seed)
    best = robot
    least = wishes.cost(robot)
    tell(0, least, best)
    done = 0
    while done < evaluations:
        told = []
        for _ in range(optimizer.population_size):
            change = optimizer.ask()
            candidate = varied(robot, kinematics, change)
            cost = wishes.cost(candidate)
            told.append((change, cost.total))
            if cost.total < least.total:
                best, least = candidate, cost
        done += len(told)
        optimizer.tell(told)
        tell(done, least, best)
    return best


def search_with_progress(robot: Robot, *, evaluations: int, seed: int) -> Robot:
    """Search as `search` does, with a bar on stderr; Ctrl-C ends it with the best record so far."""
    found = [robot]
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    console = Console(stderr=True)
    with Progress(*columns, console=console) as progress:
        task = progress.add_task(robot.name, total=evaluations)

        def tell(done: int, cost: Cost, best: Robot) -> None:
            if best is not found[-1] and not console.is_terminal:  # a log gets lines in place of a bar
                console.print(f"{robot.name}: cost {cost.total:.4f} after {done} of {evaluations} records")
            found.append(best)
            progress.update(task, completed=done, description=f"{robot.name}, cost {cost.total:.4f}")

        try:
            return search(robot, evaluations=evaluations, seed=seed, tell=tell)
        except KeyboardInterrupt:
            return found[-1]


def written(robot: Robot) -> str:
    """Give the lines of a robot's record that the search finds, as they stand in `models.robots`."""
    posture = robot.posture
    return "\n".join(
        (
            f"    base_position=({', '.join(f'{x:.4f}' for x in robot.base_position)}),",
            f"        rest=({', '.join(f'{x:.3f}' for x in posture.rest)}),",
            f"        weights=({', '.join(f'{x:.3g}' for x in posture.weights)}),",
            f"        heading_weight={posture.heading_weight:.3g},",
            f"        level_weight={posture.level_weight:.3g},",
        )
    )
