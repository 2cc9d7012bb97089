"""What a frame of the robot's video costs, stage by stage, in processor time and on the clock.

python -m benchmarks.video [ROBOT]
"""

from __future__ import annotations

import os
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from arm2d import ActionWord, Condition, ObjectWord, Readings, TrialRecord, draw_trials, record_trial
from models.robots import get_robot
from mujoco_port.film.gl import choose_back_end

EVOLVED = Path(__file__).parents[1] / "tests" / "evolved.npz"
N_FRAMES = 60
NEAR = np.array([0.0, 0.27]), 0.2  # [m], what the camera from above looks at, and how much of it


def longest_trial() -> tuple[TrialRecord, np.ndarray]:
    """Of an evolved agent's trials the longest that moves an object, so that much is drawn; and the agent."""
    with np.load(EVOLVED, allow_pickle=False) as stored:
        genotype = stored["genotypes"][15]
    asked = [each for each in Condition.WITH_INDICATE.instructions if each.action is not ActionWord.INDICATE]
    trials = draw_trials(asked, 3, Readings(), np.random.default_rng(2))
    records = [record_trial(genotype, trials[t]) for t in range(len(trials))]
    assert {each.instruction.object for each in records} == set(ObjectWord)
    return max(records, key=lambda each: each.steps), genotype


def measure(call: Callable[[int], object], n: int = N_FRAMES) -> tuple[float, float]:
    """Milliseconds of processor (all threads of this process) and of clock for each of `n` calls."""
    call(0)
    cpu, clock = time.process_time(), time.perf_counter()
    for k in range(n):
        call(k)
    return 1e3 * (time.process_time() - cpu) / n, 1e3 * (time.perf_counter() - clock) / n


def children_ms(n: int, since: os.times_result) -> float:
    """Milliseconds of processor that ended child processes took for each of `n` frames."""
    now = os.times()
    spent = now.children_user + now.children_system - since.children_user - since.children_system
    return 1e3 * spent / n


def main() -> None:
    """Print a table."""
    choose_back_end()
    from arm2d.films import write_mp4
    from mujoco_port.film.gaze import Bearing
    from mujoco_port.film.kinematic import FRAMES_PER_STEP
    from mujoco_port.film.quality import QUALITIES
    from mujoco_port.film.stage import Stage
    from mujoco_port.film.take import kinematic_take
    from mujoco_port.film.video import (
        HEIGHT_PX,
        INSET_PX,
        PER_SECOND,
        ROBOT_WIDTH_PX,
        frames,
        panel_of,
        write_take,
    )

    robot = get_robot(sys.argv[1] if len(sys.argv) > 1 else "icub")
    record, genotype = longest_trial()
    take = kinematic_take(record, robot, FRAMES_PER_STEP, genotype)
    panel, n = panel_of(take, robot), len(take.steps)
    table = Table(title=f"a frame of {robot.title}, {os.environ['MUJOCO_GL']}, milliseconds")
    for column in ("stage", "processor", "clock"):
        table.add_column(column, justify="left" if column == "stage" else "right")

    def row(name: str, figures: tuple[float, float]) -> None:
        table.add_row(name, *(f"{each:.1f}" for each in figures))

    def show(stage: Stage, k: int) -> None:
        k = k * n // N_FRAMES
        stage.pose(take.angles[k], take.objects[k], bearing, k)
        stage.highlight(take.touched[k])
        stage.shine(*take.planar[k])

    def turn(stage: Stage) -> Bearing:
        return stage.bearing(take)

    for name, quality in QUALITIES.items():
        calls = N_FRAMES if quality.oversampling == 1 else N_FRAMES // 10
        with Stage(robot, ROBOT_WIDTH_PX, HEIGHT_PX, quality, take.record.readings) as stage:
            bearing = turn(stage)
            row(f"robot, {name}", measure(lambda k, s=stage: (show(s, k), s.picture()), calls))
            row(
                "  a contact from above",
                measure(lambda k, s=stage: (show(s, k), s.close_up(*NEAR, INSET_PX)), calls),
            )
    with Stage(robot, ROBOT_WIDTH_PX, HEIGHT_PX, readings=take.record.readings) as stage:
        cpu, clock = measure(lambda _: turn(stage), 1)
        row("neck, eyes and fingers", (cpu / n, clock / n))
    row("the agent's mind", measure(lambda k: panel.frame(take.steps[k]), n - 1))
    pictures = [picture for _, picture in zip(range(N_FRAMES), frames(take, robot), strict=False)]
    with tempfile.TemporaryDirectory() as folder:
        path, before, clock = Path(folder) / "trial.mp4", os.times(), time.perf_counter()
        write_mp4(pictures, path, PER_SECOND)
        clock = 1e3 * (time.perf_counter() - clock) / N_FRAMES
        row("encode (a process of its own)", (children_ms(N_FRAMES, before), clock))
        before, cpu, clock = os.times(), time.process_time(), time.perf_counter()
        write_take(take, robot, path)
        clock, cpu = time.perf_counter() - clock, time.process_time() - cpu
        cpu += 1e-3 * children_ms(1, before)
    Console().print(table)
    length = f"{record.instruction}, {record.steps / 10:.1f} s, {n} frames"
    print(f"{length}: {cpu:.1f} s of processor, {clock:.1f} s on the clock")


if __name__ == "__main__":
    main()
