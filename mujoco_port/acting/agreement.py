"""How often the robot does what the 2D arm does: many trials, judged in both worlds.

Every trial is one row of a file, written as soon as it is known; a file that is not complete is continued.
"""

from __future__ import annotations

import csv
import hashlib
import multiprocessing
import os
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import astuple, dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Final, Literal

import numpy as np
from numpy.typing import NDArray

from arm2d import Instruction, Readings, Trials, draw_trials, run_trials
from arm2d.cache import sources_digest
from arm2d.files import handle_to_append, lock_file, read_file
from arm2d.records import brief
from arm2d.trials import START_AREAS
from models.robots import PlaneMap, Robot, get_robot

if TYPE_CHECKING:
    from mujoco_port.acting.lab import Lab
    from mujoco_port.acting.rollout import Eyes

Loop = Literal["open", "delayed", "geometric", "camera"]
Head = Literal["turns", "held"]
MARK: Final = "# "
LARGEST: Final = 256 * 2**20  # [bytes], a million trials
# Whose code decides what becomes of a trial in either world.
PACKAGES: Final = ("arm2d", "models", "mujoco_port")
SAFE_PATH: Final = "PYTHONSAFEPATH"


@dataclass(frozen=True)
class Candidate:
    """Whom to try.

    Attributes:
        name: What its rows are called.
        genotype: [G].
        instructions: The nine of its condition.
        readings: Its world.
    """

    name: str
    genotype: NDArray[np.float64]
    instructions: tuple[Instruction, ...]
    readings: Readings

    __repr__ = brief


@dataclass(frozen=True)
class Outcome:
    """One trial in both worlds; a row of the file.

    Attributes:
        agent: Its name.
        loop: Whether and how the agent's inputs came from the robot.
        instruction: In words.
        area: Where S1 started.
        start: Number of the start, from 0.
        planar: Whether the 2D arm succeeded, 0 or 1.
        physical: Whether the robot did.
        progress: [s], or [deg] for MOVE, of what was asked.
        reason: In words, why not.
    """

    agent: str
    loop: str
    instruction: str
    area: str
    start: int
    planar: int
    physical: int
    progress: float
    reason: str


@dataclass(frozen=True)
class Job:
    """One trial to carry out."""

    agent: Candidate
    loop: Loop
    trial: Trials
    area: str
    start: int

    @property
    def name(self) -> tuple[str, str, str, str, int]:
        """What tells it from all others, as the file has it."""
        return self.agent.name, self.loop, str(self.trial.instructions[0]), self.area, self.start


def jobs(agents: Sequence[Candidate], loops: Sequence[Loop], n_starts: int, seed: int) -> list[Job]:
    """All instructions from `n_starts` fresh starts in each area, the same for every agent and loop."""
    listed = []
    for agent in agents:
        rng = np.random.default_rng(seed)
        trials = draw_trials(agent.instructions, n_starts, agent.readings, rng)
        for loop in loops:
            for t in range(len(trials)):
                area, start = divmod(t % (2 * n_starts), n_starts)
                listed.append(Job(agent, loop, trials[t], START_AREAS[area], start))
    return listed


def outcomes(
    listed: Sequence[Job], robot: str, path: Path, processes: int, head: Head = "turns"
) -> Iterator[Outcome]:
    """Carry out the jobs that a file does not hold yet, and write them to it; all outcomes, in order.

    Args:
        listed: The jobs.
        robot: Name of a record in `models.robots`.
        path: The file.
        processes: How many trials at once.
        head: Whether neck and eyes follow S1.

    Raises:
        ValueError: If the file holds outcomes of other trials, or of another version of the robot.
        OSError: If the file cannot be written, or a process was killed.
    """
    mark = MARK + fingerprint(listed, robot, head)
    if path.exists() and len(known := _read(path, mark, listed)) == len(listed):
        yield from known
        return
    with os.fdopen(handle_to_append(path), "a", encoding="utf-8", newline="") as file:
        _hold(file.fileno(), path)
        known = _read(path, mark, listed)
        yield from known
        left = listed[len(known) :]
        writer = csv.writer(file, lineterminator="\n")
        if not known and file.tell() == 0:
            file.write(mark + "\n")
            writer.writerow(field.name for field in fields(Outcome))
        # Spawned, not forked: a forked child would share the parent's state of drawing and linear algebra.
        context = multiprocessing.get_context("spawn")
        pool = ProcessPoolExecutor(processes, context, initializer=_move_in, initargs=(robot, head))
        with _current_folder_is_no_library(), pool:
            try:
                for outcome in pool.map(carry_out_job, left):
                    writer.writerow(astuple(outcome))
                    file.flush()
                    yield outcome
            except BrokenProcessPool:
                raise OSError(
                    f"a process that carried out trials was killed; {path} keeps what is done, "
                    "go on with the same command"
                ) from None
            finally:
                pool.shutdown(wait=False, cancel_futures=True)


@contextmanager
def _current_folder_is_no_library() -> Iterator[None]:
    """While open, a Python that is started imports nothing from where it is started."""
    before = os.environ.get(SAFE_PATH)
    os.environ[SAFE_PATH] = "1"
    try:
        yield
    finally:
        if before is None:
            del os.environ[SAFE_PATH]
        else:
            os.environ[SAFE_PATH] = before


def fingerprint(listed: Sequence[Job], robot: str, head: Head = "turns") -> str:
    """What determines the outcomes: sources, robot and its head, genotypes and starts."""
    digest = hashlib.sha256(f"{robot} {head} {sources_digest(*PACKAGES)}".encode())
    for job in listed:
        digest.update(f"{job.agent.name} {job.loop} {job.agent.readings.to_mapping()}".encode())
        for array in (
            job.agent.genotype,
            job.trial.alpha,
            job.trial.discs,
            job.trial.actions,
            job.trial.objects,
        ):
            digest.update(np.ascontiguousarray(array).tobytes())
    return digest.hexdigest()[:16]


def _hold(descriptor: int, path: Path) -> None:
    """Keep other commands from writing to the same file; the kernel lets go when it is closed."""
    try:
        lock_file(descriptor)
    except BlockingIOError:
        raise ValueError(
            f"another command writes to {path}; wait until it has ended, or choose another file"
        ) from None


def _read(path: Path, mark: str, listed: Sequence[Job]) -> list[Outcome]:
    """The outcomes of the first of these jobs in a file of ours.

    A last line that was not written to its end is cut off.
    """
    try:
        whole = read_file(path, LARGEST).decode()
    except ValueError as error:
        raise ValueError(f"{path} cannot be read ({error}); choose another file") from None
    if not whole:
        return []
    if not whole.startswith(mark + "\n"):
        raise ValueError(
            f"{path} holds no outcomes of these trials with this version of the robot; choose another file"
        )
    lines = whole[: whole.rfind("\n") + 1]
    if lines != whole:
        os.truncate(path, len(lines.encode()))
    rows = list(csv.reader(lines.splitlines()[2:]))
    try:
        found = [_outcome(row) for row in rows]
    except ValueError as error:
        raise ValueError(f"{path} has a row that is no outcome ({error}); choose another file") from None
    told = [(each.agent, each.loop, each.instruction, each.area, each.start) for each in found]
    if told != [job.name for job in listed[: len(told)]]:
        raise ValueError(f"{path} holds other trials than these, or some of them twice; choose another file")
    return found


def _outcome(row: Sequence[str]) -> Outcome:
    agent, loop, instruction, area, start, planar, physical, progress, reason = row
    return Outcome(
        agent, loop, instruction, area, int(start), int(planar), int(physical), float(progress), reason
    )


_robot: Robot | None = None
_labs: dict[PlaneMap, Lab] = {}  # by how the table is laid
_eyes: dict[tuple[PlaneMap, str], Eyes] = {}  # by that and where the camera sits


def _move_in(robot: str, head: Head = "turns") -> None:
    """Choose the robot of this process."""
    global _robot
    chosen = get_robot(robot)
    _robot = chosen if head == "turns" else chosen.with_head_held
    _labs.clear()
    _eyes.clear()


def lab_for(readings: Readings) -> Lab:
    """The robot of this process at a table for a world; each table is laid once."""
    from mujoco_port.acting.lab import Lab
    from mujoco_port.reach.workspace import for_world

    if _robot is None:
        raise RuntimeError("there is no robot in this process")
    plane = for_world(_robot, readings).plane
    if plane not in _labs:
        _labs[plane] = Lab(_robot, readings)
    return _labs[plane]


def camera_for(lab: Lab, readings: Readings) -> Eyes:
    """The eyes of a lab's robot, opened once for each place of the camera."""
    key = lab.body.robot.plane, readings.camera_origin
    if key not in _eyes:
        from mujoco_port.acting.camera import CameraEyes

        _eyes[key] = CameraEyes(lab.body, readings)
    return _eyes[key]


def carry_out_job(job: Job) -> Outcome:
    """One trial in both worlds, on the robot of this process."""
    agent, readings = job.agent, job.agent.readings
    lab = lab_for(readings)
    scores = run_trials(agent.genotype[np.newaxis], job.trial, readings)
    if job.loop in ("open", "delayed"):
        record, verdict = lab.open_loop(agent.genotype, job.trial, readings, int(job.loop == "delayed"))
    else:
        eyes = camera_for(lab, readings) if job.loop == "camera" else None
        record, verdict = lab.closed_loop(agent.genotype, job.trial, readings, eyes)
    return Outcome(
        agent.name,
        job.loop,
        str(record.instruction),
        job.area,
        job.start,
        int(scores.success[0, 0]),
        int(verdict.success),
        round(verdict.progress, 2),
        "" if verdict.success else verdict.reason,
    )
