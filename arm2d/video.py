"""Videos of the planar world: a recorded trial to an MP4, or to frames for a larger picture."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Final

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from arm2d.constants import DT
from arm2d.drawing import FLOOR, Scene, look
from arm2d.films import write_mp4
from arm2d.trials import TrialRecord

FRAMES_PER_STEP: Final = 3  # positions are interpolated in between
DPI: Final = 100
HOLD_S: Final = 1.0  # the last state stays for so long


class Panel:
    """RGB frames of a trial, such as the panel beside the robot: `Panel(record, 480, 360).frame(12.5)`.

    Args:
        record: The trial.
        width_px: Width and
        height_px: height of a frame.
        caption: Whether the instruction is written into it.
        note: A line under the instruction.
        outcome: Whether it says in the end how it went, by default with the caption.
    """

    def __init__(
        self,
        record: TrialRecord,
        width_px: int,
        height_px: int,
        *,
        caption: bool = True,
        note: str = "",
        outcome: bool | None = None,
    ) -> None:
        with look():
            figure = Figure(figsize=(width_px / DPI, height_px / DPI), dpi=DPI, facecolor=FLOOR)
            self._canvas = FigureCanvasAgg(figure)
            self._axes = figure.add_axes((0, 0, 1, 1))
            self._scene = Scene(self._axes, record, caption=caption, note=note, outcome=outcome)
            for artist in self._scene.moving:
                artist.set_animated(True)
            self._canvas.draw()
        self._background = self._canvas.copy_from_bbox(figure.bbox)

    def frame(self, step: float) -> NDArray[np.uint8]:
        """The picture after `step` steps, [height, width, 3]; fractions lie between two states.

        Raises:
            ValueError: If the record has no such step.
        """
        self._scene.show(step)
        self._canvas.restore_region(self._background)
        for artist in self._scene.moving:
            self._axes.draw_artist(artist)
        return np.asarray(self._canvas.buffer_rgba())[..., :3].copy()


def frames(
    record: TrialRecord, width_px: int = 960, height_px: int = 720, *, note: str = ""
) -> Iterator[NDArray[np.uint8]]:
    """All frames of a trial's video, [height, width, 3] each; the last one stays for `HOLD_S`."""
    panel = Panel(record, width_px, height_px, note=note)
    for k in range(record.steps * FRAMES_PER_STEP):
        yield panel.frame(k / FRAMES_PER_STEP)
    last = panel.frame(record.steps)
    for _ in range(1 + round(HOLD_S / DT * FRAMES_PER_STEP)):
        yield last


def render_video(record: TrialRecord, path: Path | str, *, note: str = "") -> Path:
    """Write a trial as an MP4 in real time, at 30 frames per second.

    Args:
        record: The trial.
        path: The file, ending in .mp4; its folder has to be there.
        note: A line under the instruction, such as the agent's run and the trial's seed.

    Returns:
        The path.

    Raises:
        ValueError: If the path does not end in .mp4.
        OSError: If nothing here can write films, or the file cannot be written: an old one is then kept.
    """
    path = Path(path)
    if path.suffix.lower() != ".mp4":
        raise ValueError(
            f"{path} does not end in .mp4, the one kind of video written here; choose such a name"
        )
    return write_mp4(frames(record, note=note), path, round(FRAMES_PER_STEP / DT))
