"""The planar world as light on the table top: S1 and S2, the camera's field, start areas, chords.

A pixel that shows the table is a place of the planar world; what shines there is computed, not drawn, and so
lies where the robot's hand has to be, to the pixel, below whatever stands or moves above it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d import Readings
from arm2d import constants as c
from arm2d.compiling import compiled
from arm2d.drawing import CAMERA_RANGE, OBJECT_COLOURS, arm_points
from arm2d.geometry import camera_position
from arm2d.records import brief

# Half widths [cm].
S1_HALF, S2_HALF, LINE_HALF = 2.1, 1.5, 0.6
JOINT_RADIUS: Final = 4.2
GLOW_CM: Final = 7.0  # how far the arm's light is scattered
GLOW_ENDS: Final = 30.0  # from where on nothing of it is left
SOFT_CM: Final = 0.8  # width of the edge of a line of light
FAINTEST: Final = 0.004  # a weaker light changes no pixel
RING_CM: Final = 4.0  # and that of a ring around what is touched
RING: Final = 1.12  # its radius, of the object's
ARM_COLOUR: Final = (1.00, 0.98, 0.92)
CAMERA_COLOUR: Final = (0.98, 0.84, 0.34)
GROUND_COLOUR: Final = (0.72, 0.80, 0.90)
# How strong: the field's middle and side sectors, three things that are always there, the arm's halo.
MIDDLE, SIDES, GROUND, START, CHORD, HALO = 0.42, 0.22, 0.20, 0.75, 0.65, 0.26


@dataclass(frozen=True)
class Ground:
    """What never moves of the planar world, as the pixels of a view show it.

    Attributes:
        places: [H, W, 2] in [cm], which place of the planar world a pixel shows; NaN beside the table.
        distance: [H, W] in [m], how far ahead of the camera that place is.
        light: [H, W, 4], colour and strength of start areas and chords.
    """

    places: NDArray[np.float32]
    distance: NDArray[np.float32]
    light: NDArray[np.float32]

    __repr__ = brief


def ground(places: NDArray[np.float32], distance: NDArray[np.float32], readings: Readings) -> Ground:
    """Draw what never moves: where J2 can be and starts, and the chord each disc starts on."""
    x, y = places[..., 0], places[..., 1]
    radius, bearing = np.hypot(x, y), np.degrees(np.arctan2(y, x))
    bearing = np.where(bearing < -90.0, bearing + 360.0, bearing)
    light = np.zeros((*x.shape, 4), np.float32)
    on_arc = _stroke(np.abs(radius - c.S1_LENGTH), LINE_HALF, places)
    inside = (bearing >= c.ALPHA_MIN) & (bearing <= c.ALPHA_MAX)
    _add(light, GROUND_COLOUR, GROUND * on_arc * inside)
    wide = _stroke(np.abs(radius - c.S1_LENGTH), 3 * LINE_HALF, places)
    for low, high in readings.start_intervals:
        _add(light, GROUND_COLOUR, START * wide * ((bearing >= low) & (bearing <= high)))
    half = readings.sector_half_width
    for centre, colour in zip(readings.sector_centres, OBJECT_COLOURS.values(), strict=True):
        ends = np.radians([centre - half, centre + half])
        a, b = c.CHORD_END_DISTANCE * np.stack([np.cos(ends), np.sin(ends)], axis=-1)
        near = _stroke(_from_segment(x, y, a, b), 1.6 * LINE_HALF, places)
        _add(light, _lighter(colour), CHORD * near)
    return Ground(places, distance, np.nan_to_num(light))


@compiled
def shine(
    picture: NDArray[np.uint8],
    distance: NDArray[np.float32],
    places: NDArray[np.float32],
    table: NDArray[np.float32],
    light: NDArray[np.float32],
    arm: NDArray[np.float64],
    eye: NDArray[np.float64],
    rings: NDArray[np.float64],
    slack: float,
) -> None:
    """Let the planar world shine on the table, in a picture [H, W, 3].

    Args:
        picture: Rows from above; changed.
        distance: [H, W] in [m], of what is drawn.
        places: [H, W, 2] and
        table: [H, W] and
        light: [H, W, 4], as in `Ground`.
        arm: [3, 2] in [cm], J1, J2 and the end of S2.
        eye: [4]: where the camera is [cm], cosine and sine of its direction.
        rings: [N, 3] in [cm], centre and inner radius of a ring of light.
        slack: [m], how far from the table top something may be that is the table top.
    """
    inner = np.cos(np.radians(c.MIDDLE_SECTOR_HALF_WIDTH))
    outer = np.cos(np.radians(c.VIEW_HALF_WIDTH))
    for row in range(picture.shape[0]):
        for column in range(picture.shape[1]):
            x, y = places[row, column, 0], places[row, column, 1]
            if not (x > -400.0 and np.abs(distance[row, column] - table[row, column]) < slack):
                continue
            field = _field(x - eye[0], y - eye[1], eye[2], eye[3], inner, outer)
            bright, halo, strength = _bright(x, y, arm), _ring(x, y, rings), light[row, column, 3]
            if field + bright + halo + strength < FAINTEST:
                continue
            for channel in range(3):
                value = picture[row, column, channel] / 255.0
                value += strength * (light[row, column, channel] - value)
                value += field * (CAMERA_COLOUR[channel] - value)
                value += bright * (ARM_COLOUR[channel] - value)
                value += halo * (CAMERA_COLOUR[channel] - value)
                picture[row, column, channel] = np.uint8(255.0 * value + 0.5)


@compiled
def _field(dx: float, dy: float, cosine: float, sine: float, inner: float, outer: float) -> float:
    """The light of the camera's field at a place (dx, dy) from it: brightest in the middle."""
    along, away2 = dx * cosine + dy * sine, dx * dx + dy * dy
    if along <= 0.0 or away2 > CAMERA_RANGE * CAMERA_RANGE or along * along <= outer * outer * away2:
        return 0.0
    away = np.sqrt(away2)
    strength = MIDDLE if along > inner * away else SIDES
    return strength * (1.0 - 0.55 * away / CAMERA_RANGE) * min(1.0, (CAMERA_RANGE - away) / 20.0)


@compiled
def _bright(x: float, y: float, arm: NDArray[np.float64]) -> float:
    """The light of the arm: full on segments and joints, and a glow around them."""
    s1, s2 = _from_segment2(x, y, arm[0], arm[1]), _from_segment2(x, y, arm[1], arm[2])
    if min(s1, s2) > GLOW_ENDS * GLOW_ENDS:
        return 0.0
    joints = min(x * x + y * y, (x - arm[1, 0]) ** 2 + (y - arm[1, 1]) ** 2)
    off = min(np.sqrt(s1) - S1_HALF, np.sqrt(s2) - S2_HALF, np.sqrt(joints) - JOINT_RADIUS)
    return max(min(1.0, max(0.0, 0.5 - off / SOFT_CM)), HALO * np.exp(-max(off, 0.0) / GLOW_CM))


@compiled
def _ring(x: float, y: float, rings: NDArray[np.float64]) -> float:
    """The light around what is touched."""
    strength = 0.0
    for ring in range(rings.shape[0]):
        off = np.sqrt((x - rings[ring, 0]) ** 2 + (y - rings[ring, 1]) ** 2) - rings[ring, 2]
        if 0.0 < off < GLOW_ENDS:
            strength = max(strength, min(1.0, off / SOFT_CM) * np.exp(-off / RING_CM))
    return strength


@compiled
def _from_segment2(x: float, y: float, a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    """The square of how far a point is from a segment."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    part = ((x - a[0]) * dx + (y - a[1]) * dy) / (dx * dx + dy * dy)
    part = min(1.0, max(0.0, part))
    return (x - a[0] - part * dx) ** 2 + (y - a[1] - part * dy) ** 2


def shine_state(
    picture: NDArray[np.uint8],
    distance: NDArray[np.float32],
    lit: Ground,
    alpha: float,
    beta: float,
    rings: NDArray[np.float64],
    readings: Readings,
    slack: float,
) -> None:
    """Let one state of the planar world shine in a picture; angles in [deg], rings as in `shine`."""
    arm = np.stack([np.zeros(2), *arm_points(alpha, beta)])
    angle = np.radians(alpha)
    eye = np.array([*camera_position(alpha, readings), np.cos(angle), np.sin(angle)])
    shine(picture, distance, lit.places, lit.distance, lit.light, arm, eye, rings, slack)


def _from_segment(x: NDArray, y: NDArray, a: NDArray, b: NDArray) -> NDArray:
    """How far points are from a segment, [H, W]."""
    along = b - a
    part = np.clip(((x - a[0]) * along[0] + (y - a[1]) * along[1]) / (along @ along), 0.0, 1.0)
    return np.hypot(x - a[0] - part * along[0], y - a[1] - part * along[1])


def _stroke(off: NDArray, half: float, places: NDArray) -> NDArray:
    """How much of a line's light a pixel gets that is `off` from its middle; its edge is a pixel wide."""
    pixel = np.maximum(np.abs(np.gradient(places[..., 0], axis=1)), 0.05)
    return np.clip(0.5 - (off - half) / pixel, 0.0, 1.0)


def _add(light: NDArray, colour: tuple[float, ...], strength: NDArray) -> None:
    """Lay one light over others."""
    light[..., :3] = np.where(strength[..., None] > light[..., 3:], colour, light[..., :3])
    light[..., 3] = np.fmax(light[..., 3], strength)


def _lighter(colour: str) -> tuple[float, ...]:
    """The colour as light on a dark table."""
    rgb = [int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)]
    return tuple(0.25 + 0.75 * each for each in rgb)
