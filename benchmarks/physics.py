"""The robot's motors in trials of an agent: tracking, effort, time; without objects in the way, and with.

python -m benchmarks.physics [--still] [AGENT]

With --still the robot's head is held.
"""

from __future__ import annotations

import sys
import time

import numpy as np
from rich.console import Console
from rich.table import Table

from arm2d import Trials, draw_trials
from evolution.runs.sources import Agent, find_agent
from models.robots import get_robot
from mujoco_port.acting.exertion import Exertion, exertion, head_exertion, tracking_errors
from mujoco_port.acting.eyes import geometric_eyes
from mujoco_port.acting.lab import Lab, instruction_of
from mujoco_port.acting.open_loop import OpenLoop, planar_angles
from mujoco_port.acting.rollout import PhysicalRecord, carry_out

OUT_OF_THE_WAY_M = np.array([[0.40, 0.38], [-0.50, 0.38], [-0.62, 0.38]])  # corners of the table


def without_objects(lab: Lab, agent: Agent, trial: Trials) -> PhysicalRecord:
    """All 250 steps of a trial, the objects being where the hand does not come."""
    instruction = instruction_of(trial)
    angles = planar_angles(agent.genotype, instruction, float(trial.alpha[0]), trial.discs[0], agent.readings)
    places = OUT_OF_THE_WAY_M / lab.body.robot.plane.scale
    return carry_out(
        lab.body,
        lab.kinematics,
        OpenLoop(angles),
        geometric_eyes(lab.body),
        instruction,
        places,
        lambda _: False,
    )


def main() -> None:
    """Print a table."""
    still = "--still" in sys.argv[1:]
    names = [each for each in sys.argv[1:] if each != "--still"] or ["best-generaliser"]
    agent, robot = find_agent(names[0], generation=None, rank=0, condition=None), get_robot("icub")
    readings = agent.readings
    lab = Lab(robot.with_head_held if still else robot, readings)
    robot = lab.body.robot
    trials = draw_trials(agent.condition.instructions, 1, readings, np.random.default_rng(3))
    without_objects(lab, agent, trials[0])  # compiled and warm

    table = Table(title=f"{robot.title}, {len(trials)} trials: nine instructions, both start areas")
    for heading in ("", "error [mm] median", "p99", "max", "deepest contact [mm]", "CPU [s] for 25 s"):
        table.add_column(heading, justify="right" if heading else "left")
    efforts: list[Exertion] = []
    head_efforts: list[Exertion] = []
    for name in ("without objects", "with objects"):
        records, began = [], time.process_time()
        for t in range(len(trials)):
            alone = name == "without objects"
            records.append(
                without_objects(lab, agent, trials[t])
                if alone
                else lab.open_loop(agent.genotype, trials[t], readings)[0]
            )
        spent = (time.process_time() - began) / sum(record.steps for record in records) * 250
        errors = 1e3 * np.concatenate([tracking_errors(record, lab.kinematics) for record in records])
        depth = 1e3 * max(record.depth.max() for record in records)
        middle, high = np.percentile(errors, [50, 99])
        cells = (f"{middle:.4f}", f"{high:.3f}", f"{errors.max():.3f}", f"{depth:.2f}", f"{spent:.2f}")
        table.add_row(name, *cells)
        efforts += [exertion(record, lab.kinematics, robot.limits) for record in records if robot.limits]
        head_efforts += [head_exertion(record, lab.body) for record in records]
    Console().print(table)
    _print_effort(robot.joints, efforts)
    if robot.head_joints:
        _print_effort(robot.head_joints, head_efforts)


def _print_effort(joints: tuple[str, ...], efforts: list[Exertion]) -> None:
    """Print the largest part used of every joint's limits."""
    table = Table(title="largest part of the limits that was used")
    for heading in ("joint", "position", "velocity", "torque"):
        table.add_column(heading, justify="left" if heading == "joint" else "right")
    largest = efforts[0]
    for effort in efforts[1:]:
        largest = largest.with_(effort)
    for j, joint in enumerate(joints):
        parts = (largest.position[j], largest.velocity[j], largest.torque[j])
        table.add_row(joint, *(f"{100 * part:.0f} %" for part in parts))
    Console().print(table)


if __name__ == "__main__":
    main()
