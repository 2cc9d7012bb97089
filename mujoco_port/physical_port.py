"""Putting a trial on an acting robot: the public face of the physics for one trial.

from mujoco_port.physical_port import port_physical_trial
verdict = port_physical_trial(record, genotype, "touch-red.mp4")
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from arm2d import TrialRecord, Trials
from models.robots import get_robot
from mujoco_port.gl import choose_back_end
from mujoco_port.port import writable

if TYPE_CHECKING:
    from mujoco_port.verdict import Verdict

ClosedLoopName = Literal["geometric", "camera"]


def port_physical_trial(
    record: TrialRecord,
    genotype: NDArray[np.float64],
    output: Path | str | None = None,
    *,
    robot: str = "icub",
    closed_loop: ClosedLoopName | None = None,
) -> Verdict:
    """Let a robot with motors carry out a trial among free objects, judge it, and write it as an MP4.

    Args:
        record: The trial in the 2D world, with its start.
        genotype: [84], of the agent.
        output: The video; None if none is wanted.
        robot: Name of a record in `models.robots`.
        closed_loop: Where the agent's inputs come from: None, the 2D world; "geometric", the robot's skin and
            hand, and the objects' true places; "camera", a rendered picture in place of these.

    Returns:
        What became of the instruction on the robot.

    Raises:
        NoPhysicsError: If the robot's record says too little for it to act.
        UnknownRobotError, NoRenderingError, OutOfReachError, OSError: As `port_trial`.
    """
    path = None if output is None else writable(Path(output), ".mp4")
    chosen = get_robot(robot)
    if path is not None or closed_loop == "camera":
        choose_back_end()
    from mujoco_port.physical import Lab

    lab, trial = Lab(chosen), start_of(record)
    if closed_loop is None:
        physical, verdict = lab.open_loop(genotype, trial, record.readings)
    elif closed_loop == "geometric":
        physical, verdict = lab.closed_loop(genotype, trial, record.readings)
    else:
        from mujoco_port.camera import CameraEyes

        with CameraEyes(lab.body) as eyes:
            physical, verdict = lab.closed_loop(genotype, trial, record.readings, eyes)
    if path is not None:
        from mujoco_port.physical_take import physical_take
        from mujoco_port.video import write_take

        write_take(physical_take(record, physical, verdict), chosen, path)
    return verdict


def start_of(record: TrialRecord) -> Trials:
    """The trial that a record is one of, as a batch of one."""
    asked = record.instruction
    return Trials(
        actions=np.array([asked.action]),
        objects=np.array([asked.object]),
        alpha=record.alpha[:1],
        discs=record.discs[:1],
    )
