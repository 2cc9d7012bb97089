"""A trajectory of one's own in place of an agent's: what the planar world makes of it, as a recorded trial.

    alpha, beta = angles_to(points)                      where S2's end is to be, in [cm]
    record = drive("move red", alpha, beta)              drawn, filmed and ported like any other trial

Axes: K steps of 0.1 s, so K + 1 states; 3 objects (blue, green, red).
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from arm2d import Instruction, Readings, TrialRecord, TrialScores
from arm2d import constants as c
from arm2d.geometry import Point
from arm2d.reference import LEFT, RIGHT, Side, carry_out, sense, touch
from mujoco_port.reach.workspace import BEARING_CUT

BENT_REACH = float(np.hypot(c.S1_LENGTH, c.S2_LENGTH))  # [cm], from J1 to S2's end with beta at 90
STRAIGHT_REACH = c.S1_LENGTH + c.S2_LENGTH


def drive(
    instruction: Instruction | str,
    alpha: ArrayLike,
    beta: ArrayLike,
    discs: ArrayLike | None = None,
    readings: Readings | None = None,
) -> TrialRecord:
    """Let the planar arm follow angles of your own, and judge it as an agent that carries out an instruction.

    Args:
        instruction: What it is judged by; text such as "move red" will do.
        alpha: [K + 1], angle of S1 in [deg] at the start and after every step of 0.1 s, in [-30, 210].
        beta: [K + 1], angle of S2 in [deg], in [0, 90].
        discs: [3, 2] in [cm], centres of the blue, green and red disc; by default amid their sectors.
        readings: The world; the default readings if none are given.

    Returns:
        The trial. `inputs` are what an agent would sense; `states` are NaN, for there is no network. It is
        scored where it would end by the rules, after 250 steps at the latest; the motion goes on.

    Raises:
        ValueError: If the angles are not numbers in their ranges, or there are fewer than two of them.
    """
    asked = Instruction.parse(instruction) if isinstance(instruction, str) else instruction
    readings = readings or Readings()
    alphas, betas = _angles("alpha", alpha, c.ALPHA_MIN, c.ALPHA_MAX), _angles("beta", beta, 0.0, c.BETA_MAX)
    if len(alphas) != len(betas) or len(alphas) < 2:
        raise ValueError(
            f"there are {len(alphas)} angles alpha and {len(betas)} beta; give the same number, at least two"
        )
    placed = _places(discs, readings)
    centres, contact, inputs = _touched(asked, alphas, betas, placed, readings)
    turns = np.diff(np.stack([alphas, betas], axis=-1), axis=0)
    following = iter(turns.tolist())
    score = carry_out(
        lambda sensed: tuple(next(following)),
        asked,
        alphas[0],
        placed,
        readings,
        beta=betas[0],
        most_steps=min(len(turns), c.MAX_STEPS),
    )
    return TrialRecord(
        instruction=asked,
        readings=readings,
        alpha=alphas,
        beta=betas,
        discs=centres,
        contact=contact,
        inputs=inputs,
        states=np.full((len(turns), c.N_INTER), np.nan),
        turns=turns,
        scores=TrialScores(*(np.array([[value]]) for value in score)),
    )


def angles_to(points: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The angles (alpha, beta) [K + 1] in [deg] at which S2 ends in points [K + 1, 2] in [cm].

    x points to the agent's right and y ahead, J1 is the origin. On a robot's table, a point in [m] is
    `robot.plane.scale` times as many [cm].

    Raises:
        ValueError: If a point is no number or out of reach: between 111.8 (S2 fully bent) and 150 cm from J1.
    """
    ends = np.asarray(points, dtype=np.float64)
    if ends.ndim != 2 or ends.shape[1] != 2 or not np.isfinite(ends).all():
        raise ValueError(f"points must be numbers [K + 1, 2] in cm, not {ends.dtype} {ends.shape}")
    reach = np.hypot(*ends.T)
    if (outside := np.flatnonzero((reach < BENT_REACH - 1e-9) | (reach > STRAIGHT_REACH + 1e-9))).size:
        k = outside[0]
        raise ValueError(
            f"point {k} is {reach[k]:.1f} cm from J1; S2 ends between {BENT_REACH:.1f} and "
            f"{STRAIGHT_REACH:g} cm from it"
        )
    cosine = (reach**2 - BENT_REACH**2) / (2 * c.S1_LENGTH * c.S2_LENGTH)
    beta = np.arccos(np.clip(cosine, 0.0, 1.0))
    ahead = np.arctan2(c.S2_LENGTH * np.sin(beta), c.S1_LENGTH + c.S2_LENGTH * np.cos(beta))
    bearing = np.arctan2(ends[:, 1], ends[:, 0])
    bearing = np.where(bearing < BEARING_CUT, bearing + 2 * np.pi, bearing)
    alpha = np.degrees(bearing - ahead)
    if (outside := np.flatnonzero((alpha < c.ALPHA_MIN - 1e-9) | (alpha > c.ALPHA_MAX + 1e-9))).size:
        k = outside[0]
        raise ValueError(
            f"point {k} asks S1 to turn to {alpha[k]:.1f} degrees; it turns from {c.ALPHA_MIN:g} to "
            f"{c.ALPHA_MAX:g}"
        )
    return np.clip(alpha, c.ALPHA_MIN, c.ALPHA_MAX), np.degrees(beta)


def _angles(name: str, values: ArrayLike, low: float, high: float) -> NDArray[np.float64]:
    """Angles [K + 1] in [deg], all within [low, high]."""
    array = np.array(values, dtype=np.float64)
    if array.ndim != 1 or not np.all((array >= low) & (array <= high)):  # False for NaN
        raise ValueError(f"{name} must be a row of numbers in [{low:g}, {high:g}] degrees")
    return array


def _places(discs: ArrayLike | None, readings: Readings) -> list[Point]:
    """The discs' centres in [cm]; without, the middles of their sectors' chords."""
    if discs is None:
        distance = c.CHORD_END_DISTANCE * np.cos(np.radians(readings.sector_half_width))
        bearings = np.radians(readings.sector_centres)
        discs = distance * np.stack([np.cos(bearings), np.sin(bearings)], axis=-1)
    places = np.asarray(discs, dtype=np.float64)
    if places.shape != (c.N_OBJECTS, 2) or not np.isfinite(places).all():
        raise ValueError(f"discs must be the centres [3, 2] in cm of blue, green and red, not {places.shape}")
    return [(x, y) for x, y in places.tolist()]


def _touched(
    asked: Instruction,
    alphas: NDArray[np.float64],
    betas: NDArray[np.float64],
    places: Sequence[Point],
    readings: Readings,
) -> tuple[NDArray[np.float64], NDArray[np.int8], NDArray[np.float64]]:
    """Centres [K + 1, 3, 2] and contacts [K + 1, 3] of the discs, and what an agent would sense [K, 18]."""
    sides: list[Side] = [None, None, None]
    centres, contact, inputs = [list(places)], [sides], []
    angles = list(zip(alphas.tolist(), betas.tolist(), strict=True))
    for before, after in pairwise(angles):
        inputs.append(sense(*before, places, sides, asked, readings))
        places, sides = touch(*before, *after, places, sides, readings.object_radius)
        centres.append(places)
        contact.append(sides)
    codes = {None: 0, RIGHT: 1, LEFT: 2}
    return (
        np.array(centres),
        np.array([[codes[side] for side in row] for row in contact], np.int8),
        np.array(inputs),
    )
