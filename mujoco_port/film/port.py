"""Putting a trial on the robot: the hand follows S2's end, the objects follow the discs.

mujoco_port.port_trial(record, "touch-red.mp4")
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from arm2d import TrialRecord
from arm2d.films import find_encoder, write_png
from models.robots import get_robot
from mujoco_port.film.gl import choose_back_end, drawing
from mujoco_port.film.quality import QualityName, quality_named

N_GALLERY: Final = 9


def port_trial(
    record: TrialRecord,
    output: Path | str,
    *,
    robot: str = "icub",
    genotype: ArrayLike | None = None,
    quality: QualityName = "normal",
) -> Path:
    """Play a recorded trial kinematically on a robot and write it as an MP4.

    The hand follows the end of S2 by inverse kinematics, the objects follow the discs of the 2D world.

    Args:
        record: The trial.
        output: The video; its folder has to be there.
        robot: Name of a record in `models.robots`.
        genotype: [G], of the agent: then its neurons are shown, else what they brought about.
        quality: "draft", "normal" or "high".

    Returns:
        The path of the video.

    Raises:
        ValueError: If there is no such quality.
        UnknownRobotError: If no robot has this name.
        NoRenderingError: If nothing on this machine can draw without a screen.
        OutOfReachError: If the robot cannot follow.
        OSError: If the file cannot be written.
    """
    path, chosen, fine = film_path(output), get_robot(robot), quality_named(quality)
    with drawing():
        from mujoco_port.film.kinematic import FRAMES_PER_STEP
        from mujoco_port.film.take import kinematic_take
        from mujoco_port.film.video import write_take

        write_take(kinematic_take(record, chosen, FRAMES_PER_STEP, genotype), chosen, path, fine)
    return path


def port_gallery(
    records: Sequence[TrialRecord],
    title: str,
    output: Path | str,
    *,
    robot: str = "icub",
    quality: QualityName = "normal",
    rates: ArrayLike | None = None,
) -> tuple[Path, Path]:
    """Play nine recorded trials side by side and write them as an MP4, and its last picture as a PNG.

    Args:
        records: Nine trials, row by row.
        title: What stands above them.
        output: The video; its folder has to be there, and the picture will lie beside it.
        robot: Name of a record in `models.robots`.
        quality: Of the video; the picture is of high quality.
        rates: [9], how often each instruction is carried out on the plane, from 0 to 1, such as
            `Agent.evaluate().success[0]`: one trial shows how, not how often.

    Returns:
        The paths of the video and of the picture.

    Raises:
        ValueError: If there are not nine records, or rates. All other errors as `port_trial`.
    """
    known = check_gallery(records, rates)
    path, chosen, fine = film_path(output), get_robot(robot), quality_named(quality)
    with drawing():
        from mujoco_port.film.gallery import write_gallery
        from mujoco_port.film.kinematic import FRAMES_PER_STEP
        from mujoco_port.film.take import kinematic_take

        takes = [kinematic_take(record, chosen, FRAMES_PER_STEP) for record in records]
        return path, write_gallery(takes, chosen, title, path, fine, known)


def check_gallery(records: Sequence[TrialRecord], rates: ArrayLike | None) -> NDArray[np.float64] | None:
    """The rates [9], if known; all but nine trials of one world, and nine shares, are a ValueError."""
    if len(records) != N_GALLERY:
        raise ValueError(f"a gallery has {N_GALLERY} trials, not {len(records)}; give one per instruction")
    if len({record.readings for record in records}) > 1:
        raise ValueError("the trials of a gallery are from different worlds; give those of one")
    if rates is None:
        return None
    known = np.asarray(rates, np.float64)
    if known.shape != (N_GALLERY,) or not ((known >= 0.0) & (known <= 1.0)).all():
        raise ValueError(f"rates {known} are not {N_GALLERY} shares from 0 to 1; give one per instruction")
    return known


def port_picture(
    record: TrialRecord,
    step: int,
    output: Path | str,
    *,
    robot: str = "icub",
    genotype: ArrayLike | None = None,
    quality: QualityName = "high",
) -> Path:
    """Write one moment of a trial on a robot as a PNG; arguments and errors as `port_trial`."""
    path, chosen, fine = writable(Path(output), ".png"), get_robot(robot), quality_named(quality)
    with drawing():
        from mujoco_port.film.video import frame_at

        return write_png(frame_at(record, chosen, step, fine, genotype), path)


def film_path(output: Path | str) -> Path:
    """The path, if a film can be encoded and written there: told before a minute of drawing."""
    path = writable(Path(output), ".mp4")
    find_encoder()
    return path


def check_films() -> None:
    """Refuse, before a folder is made, if no film can be drawn or encoded here.

    Raises:
        OSError: With the next move.
    """
    find_encoder()
    choose_back_end()


def writable(path: Path, suffix: str) -> Path:
    """The path, if a file of this kind can be written there: told before a minute of drawing."""
    if path.suffix.lower() != suffix:
        raise ValueError(f"{path} does not end in {suffix}; choose such a name")
    if path.is_dir():
        raise OSError(f"{path} is a folder; choose another name")
    if not path.parent.is_dir() or not os.access(path.parent, os.W_OK):
        raise OSError(f"{path} cannot be written: its folder is missing or read-only; choose another")
    return path
