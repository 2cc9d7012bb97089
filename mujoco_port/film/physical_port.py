"""Putting a trial on an acting robot: motors, free objects, contacts, verdicts.

verdict = mujoco_port.port_physical_trial(record, genotype, "touch-red.mp4")
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from arm2d import TrialRecord, Trials
from models.robots import get_robot
from mujoco_port.film.gl import choose_back_end, drawing, refuse_other_renderer
from mujoco_port.film.port import check_gallery, film_path
from mujoco_port.film.quality import QualityName, quality_named

if TYPE_CHECKING:
    from mujoco_port.acting.lab import Lab
    from mujoco_port.acting.rollout import PhysicalRecord
    from mujoco_port.acting.verdict import Verdict

ClosedLoopName = Literal["geometric", "camera"]


def port_physical_trial(
    record: TrialRecord,
    genotype: NDArray[np.float64] | None = None,
    output: Path | str | None = None,
    *,
    robot: str = "icub",
    closed_loop: ClosedLoopName | None = None,
    quality: QualityName = "normal",
) -> Verdict:
    """Let a robot with motors carry out a trial among free objects, judge it, and write it as an MP4.

    Args:
        record: The trial in the 2D world, with its start.
        genotype: [G], of the agent; None if there is none: the robot follows the record to its end.
        output: The video; None if none is wanted.
        robot: Name of a record in `models.robots`.
        closed_loop: Where the agent's inputs come from: None, the 2D world; "geometric", the robot's skin and
            hand, and the objects' true places; "camera", a rendered picture in place of these.
        quality: Of the video.

    Returns:
        What became of the instruction on the robot.

    Raises:
        ValueError: If an agent is missing whose loop is to be closed.
        NoPhysicsError: If the robot's record says too little for it to act.
        UnknownRobotError, NoRenderingError, OutOfReachError, OSError: As `port_trial`.
    """
    if genotype is None and closed_loop is not None:
        raise ValueError(f"a loop that is closed ({closed_loop}) needs an agent; give its genotype")
    path = None if output is None else film_path(output)
    chosen, fine = get_robot(robot), quality_named(quality)
    with drawing() if path is not None or closed_loop == "camera" else nullcontext():
        from mujoco_port.acting.lab import Lab

        physical, verdict = _carry_out(Lab(chosen, record.readings), record, genotype, closed_loop)
        if path is not None:
            from mujoco_port.film.take import physical_take
            from mujoco_port.film.video import write_take

            write_take(physical_take(record, physical, verdict, genotype), chosen, path, fine)
    return verdict


def port_physical_gallery(
    records: Sequence[TrialRecord],
    genotype: NDArray[np.float64],
    title: str,
    output: Path | str,
    *,
    robot: str = "icub",
    closed_loop: ClosedLoopName | None = None,
    quality: QualityName = "normal",
    rates: ArrayLike | None = None,
) -> tuple[tuple[Path, Path], list[Verdict]]:
    """Let a robot with motors carry out nine trials, and write them side by side as `port_gallery` does.

    Args:
        records: Nine trials in the 2D world, row by row.
        genotype: [G], of the agent.
        title: What stands above them; how many the robot has carried out is added.
        output: The video; its folder has to be there, and the picture will lie beside it.
        robot: Name of a record in `models.robots`.
        closed_loop: As `port_physical_trial`.
        quality: Of the video; the picture is of high quality.
        rates: As `port_gallery`.

    Returns:
        The paths of the video and of the picture, and what became of each instruction.

    Raises:
        ValueError: If there are not nine records, or rates. All other errors as `port_physical_trial`.
    """
    known = check_gallery(records, rates)
    path, chosen, fine = film_path(output), get_robot(robot), quality_named(quality)
    with drawing():
        from rich.progress import track

        from mujoco_port.acting.lab import Lab
        from mujoco_port.film.gallery import write_gallery
        from mujoco_port.film.take import physical_take

        lab, takes, verdicts = Lab(chosen, records[0].readings), [], []
        for record in track(records, "trials on the robot"):
            physical, verdict = _carry_out(lab, record, genotype, closed_loop)
            takes.append(physical_take(record, physical, verdict, genotype))
            verdicts.append(verdict)
        title += f"; the robot carries out {sum(verdict.success for verdict in verdicts)} of those shown"
        return (path, write_gallery(takes, chosen, title, path, fine, known)), verdicts


def _carry_out(
    lab: Lab, record: TrialRecord, genotype: NDArray[np.float64] | None, closed_loop: ClosedLoopName | None
) -> tuple[PhysicalRecord, Verdict]:
    """One trial on the robot, with the agent's inputs from where they are wanted."""
    if genotype is None:
        return lab.follow(record)
    trial = start_of(record)
    if closed_loop is None:
        return lab.open_loop(genotype, trial, record.readings)
    if closed_loop == "geometric":
        return lab.closed_loop(genotype, trial, record.readings)
    refuse_other_renderer()
    from mujoco_port.acting.camera import CameraEyes

    with CameraEyes(lab.body, record.readings) as eyes:
        return lab.closed_loop(genotype, trial, record.readings, eyes)


def check_acts(robot: str) -> None:
    """Refuse a robot that cannot act, before a folder is made; raises as `port_physical_trial`."""
    chosen = get_robot(robot)
    choose_back_end()
    from models.physics import limits_of_acting

    limits_of_acting(chosen)


def start_of(record: TrialRecord) -> Trials:
    """The trial that a record is one of, as a batch of one."""
    asked = record.instruction
    return Trials(
        actions=np.array([asked.action]),
        objects=np.array([asked.object]),
        alpha=record.alpha[:1],
        discs=record.discs[:1],
        task=record.task,
    )
