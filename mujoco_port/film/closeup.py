"""Contacts from near: when a second camera looks down on them, where, and how its picture is laid in."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from arm2d.drawing import FLOOR, INK
from arm2d.records import brief
from mujoco_port.film.panel import blank, pixels

if TYPE_CHECKING:
    from mujoco_port.film.take import Take

INSET_PX: Final = 264  # a square, in a picture of 720 lines
MARGIN_PX, FRAME_PX = 14, 3
LABEL_PX: Final = 20
# The camera is there so long before a contact and so long after it; shorter pauses are none [s].
BEFORE_S, AFTER_S, FADE_S = 0.9, 0.7, 0.2
NARROWEST_M, ROOM_M = 0.17, 0.09  # what is seen across, at least; and beside what is pushed


@dataclass(frozen=True)
class CloseUp:
    """One contact, from near.

    Attributes:
        first: The first and
        last: the last of a take's moments that are seen.
        centre: [2] in [m], what is looked at on the table.
        width: [m], what is seen across.
        fade: Moments in which the picture appears, and vanishes.
        ends: Whether it vanishes before the film ends.
    """

    first: int
    last: int
    centre: NDArray[np.float64]
    width: float
    fade: float
    ends: bool

    __repr__ = brief

    def strength(self, moment: int) -> float:
        """How clearly the picture is there, from 0 to 1."""
        left = (self.last - moment + 1) / self.fade if self.ends else 1.0
        return float(np.clip(min((moment - self.first + 1) / self.fade, left), 0.0, 1.0))


def close_ups(take: Take) -> list[CloseUp]:
    """The contacts of a take that are to be seen from near, none at the same time as another."""
    touching = np.flatnonzero(take.touched.any(axis=1))
    if not len(touching):
        return []
    before, after = round(BEFORE_S / take.moment_s), round(AFTER_S / take.moment_s)
    gaps = np.flatnonzero(np.diff(touching) > before + after)
    starts, ends = touching[[0, *(gaps + 1)]], touching[[*gaps, -1]]
    return [
        _close_up(take, int(start), int(end), before, after) for start, end in zip(starts, ends, strict=True)
    ]


def _close_up(take: Take, start: int, end: int, before: int, after: int) -> CloseUp:
    """The view of what is touched from one moment to another."""
    touched = take.touched[start : end + 1]
    paths = take.objects[start : end + 1, :, :2][touched]  # [N, 2]
    low, high = paths.min(axis=0), paths.max(axis=0)
    width = max(NARROWEST_M, float((high - low).max()) + ROOM_M)
    last = min(end + after, len(take.steps) - 1)
    ends = end + after < len(take.steps) - 1
    fade = max(1.0, FADE_S / take.moment_s)
    return CloseUp(max(0, start - before), last, (low + high) / 2, width, fade, ends)


def laid_in(picture: NDArray[np.uint8], inset: NDArray[np.uint8], strength: float) -> None:
    """Lay a square picture with a frame and a label into the upper left corner of another; changes it."""
    size = len(inset)
    framed = np.full((size + LABEL_PX + FRAME_PX, size + 2 * FRAME_PX, 3), _rgb(INK), np.uint8)
    framed[FRAME_PX : FRAME_PX + size, FRAME_PX : FRAME_PX + size] = inset
    framed[FRAME_PX + size :, FRAME_PX:-FRAME_PX] = _label(size)
    height, width, _ = framed.shape
    place = picture[MARGIN_PX : MARGIN_PX + height, MARGIN_PX : MARGIN_PX + width]
    place[:] = (strength * framed + (1.0 - strength) * place + 0.5).astype(np.uint8)


@cache
def _label(width_px: int) -> NDArray[np.uint8]:
    """What the inset is."""
    figure = blank(width_px, LABEL_PX, INK)
    figure.text(0.03, 0.54, "contact, from above", va="center", fontsize=8.5, color=FLOOR)
    return pixels(figure)


def _rgb(colour: str) -> list[int]:
    return list(bytes.fromhex(colour[1:]))
