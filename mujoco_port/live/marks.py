"""What never moves of the planar world, as ribbons on the table: start areas, the end of S1's arc, chords.

What moves of it, arm and camera's field, is light that the page computes pixel by pixel.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d import Readings
from arm2d import constants as c
from arm2d.drawing import OBJECT_COLOURS
from mujoco_port.live.surfaces import Surface

ABOVE_M: Final = 0.0004  # of the table top
GROUND: Final = (0.72, 0.80, 0.90)
# Half widths [cm], and how much of the table is still seen below.
ARC, START, CHORD = (0.6, 0.78), (1.5, 0.4), (1.0, 0.4)
STEP_DEG: Final = 2.0
Colour = tuple[float, float, float]


def marks(readings: Readings, scale: float, table: Colour) -> Iterator[tuple[Colour, Surface]]:
    """Ribbons and their colours.

    Args:
        readings: Of the planar world.
        scale: [m/cm], of its map.
        table: Colour of what they lie on.
    """
    arcs = [(c.ALPHA_MIN, c.ALPHA_MAX, ARC)]
    arcs += [(low, high, START) for low, high in readings.start_intervals]
    for low, high, (half, below) in arcs:
        bearings = np.radians(np.linspace(low, high, 2 + int((high - low) / STEP_DEG)))
        points = c.S1_LENGTH * np.stack([np.cos(bearings), np.sin(bearings)], axis=-1)
        # A start area lies over the arc that it is a part of.
        yield _mixed(GROUND, table, below), ribbon(points, half, scale, ABOVE_M * (1 + (below == START[1])))
    half, below = CHORD
    for centre, colour in zip(readings.sector_centres, OBJECT_COLOURS.values(), strict=True):
        bearings = np.radians([centre - readings.sector_half_width, centre + readings.sector_half_width])
        ends = c.CHORD_END_DISTANCE * np.stack([np.cos(bearings), np.sin(bearings)], axis=-1)
        light = tuple(0.25 + 0.75 * int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5))
        yield _mixed(light, table, below), ribbon(ends, half, scale, ABOVE_M)


def ribbon(points: NDArray[np.float64], half: float, scale: float, height: float) -> Surface:
    """A flat ribbon along points [P, 2] in [cm], `half` as wide to either side, at a height in [m]."""
    along = np.gradient(points, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    left = half * np.stack([-along[:, 1], along[:, 0]], axis=-1)
    flat = scale * np.concatenate([points - left, points + left])
    places = np.column_stack([flat, np.full(len(flat), height)])
    a, n = np.arange(len(points) - 1), len(points)
    triangles = np.concatenate([np.stack([a, a + 1, a + n], -1), np.stack([a + 1, a + n + 1, a + n], -1)])
    return Surface(places, np.tile([0.0, 0.0, 1.0], (len(flat), 1)), triangles)


def _mixed(colour: tuple[float, ...], table: Colour, below: float) -> Colour:
    red, green, blue = (round(one + below * (two - one), 4) for one, two in zip(colour, table, strict=True))
    return red, green, blue
