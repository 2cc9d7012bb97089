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


def longest_trial() -> TrialRecord:
    """Of an evolved agent's trials the longest that moves an object, so that much is drawn."""
    with np.load(EVOLVED, allow_pickle=False) as stored:
        genotype = stored["genotypes"][15]
    asked = [each for each in Condition.WITH_INDICATE.instructions if each.action is not ActionWord.INDICATE]
    trials = draw_trials(asked, 3, Readings(), np.random.default_rng(2))
    records = [record_trial(genotype, trials[t]) for t in range(len(trials))]
    assert {each.instruction.object for each in records} == set(ObjectWord)
    return max(records, key=lambda each: each.steps)


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
    from mujoco_port.film.kinematic import FRAMES_PER_STEP
    from mujoco_port.film.stage import Stage
    from mujoco_port.film.take import kinematic_take
    from mujoco_port.film.video import HEIGHT_PX, PER_SECOND, ROBOT_WIDTH_PX, Side, frames, write_take

    robot = get_robot(sys.argv[1] if len(sys.argv) > 1 else "icub")
    record = longest_trial()
    take = kinematic_take(record, robot, FRAMES_PER_STEP)
    side, n = Side(take, robot), len(take.steps)
    table = Table(title=f"a frame of {robot.title}, {os.environ['MUJOCO_GL']}, milliseconds")
    for column in ("stage", "processor", "clock"):
        table.add_column(column, justify="left" if column == "stage" else "right")

    def row(name: str, figures: tuple[float, float]) -> None:
        table.add_row(name, *(f"{each:.1f}" for each in figures))

    def show(stage: Stage, k: int) -> None:
        k = k * n // N_FRAMES
        stage.pose(take.angles[k], take.objects[k])
        stage.highlight(take.touched[k])

    for width in (ROBOT_WIDTH_PX, 1280):
        with Stage(robot, width, HEIGHT_PX) as stage:
            row(f"pose, {width} x {HEIGHT_PX}", measure(lambda k, stage=stage: show(stage, k)))
            row("  and draw, with shadows", measure(lambda k, s=stage: (show(s, k), s.picture())))
            row(
                "  the same without the backdrop",
                measure(lambda k, s=stage: (show(s, k), s.picture_at_once())),
            )
    row("2D world and captions", measure(lambda k: side.frame(take.steps[k * n // N_FRAMES])))
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
