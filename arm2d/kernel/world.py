"""What the readings fix for every trial, as numbers and tables the compiled kernel can read."""

from __future__ import annotations

from functools import lru_cache
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from arm2d import constants as c
from arm2d.arithmetic import sin_cos
from arm2d.compiling import compiled
from arm2d.instructions import ACTION_CODES, OBJECT_CODES, ActionWord, ObjectWord
from arm2d.readings import Readings

# Values of beta are told apart by their whole tenths of a degree.
BETA_KEYS_PER_DEGREE: Final = 10.0
N_BETA_KEYS: Final = 901

# [7, 3]: three object words, then four action words.
WORD_CODES = np.array(
    [*(OBJECT_CODES[each] for each in ObjectWord), *(ACTION_CODES[each] for each in ActionWord)]
)


class World(NamedTuple):
    """The world of one record of readings; numbers only, which Numba hands on at no cost.

    Attributes:
        turn: Turn of a joint per step [deg].
        radius: Of the discs [cm].
        white_right: The camera's right sector is white while alpha is at most this [deg].
        white_left: Its left sector is white while alpha is at least this [deg].
        any_part: Whether any part of a disc is seen, or only its centre.
        from_end: Whether the camera sits at the end of S1, not at J1.
        target_cone: Largest distance from the target that is on target [deg].
        indicate_cone: The same for INDICATE's good steps [deg].
        move_angle: How far a full MOVE pushes [deg].
        ignore_stops: Whether 100 good steps end an IGNORE trial.
        keep: What a bad step leaves of the run: 0, or 1 if good steps need not be consecutive.
        whole_penalty: Whether P1 scales all of F1.
        best_stretch: Whether F3 is taken at its best step.
        strict_success: Whether success needs F3 > 0.99 too.
        quarter_sine: Sine and
        quarter_cosine: cosine of a sub-step of a full turn.
        hit_gap_squared: A disc whose gap squared is below this is hit [cm^2].
        touch_gap_squared: One whose gap squared is at most this, and not hit, is touched.
        side_reach: How far to S1's right, or beyond S2's tip to its left, a disc's centre may be and
            still meet S2 in one step [deg].
    """

    turn: float
    radius: float
    white_right: float
    white_left: float
    any_part: bool
    from_end: bool
    target_cone: float
    indicate_cone: float
    move_angle: float
    ignore_stops: bool
    keep: float
    whole_penalty: bool
    best_stretch: bool
    strict_success: bool
    quarter_sine: float
    quarter_cosine: float
    hit_gap_squared: float
    touch_gap_squared: float
    side_reach: float


@lru_cache(maxsize=64)
def world_of(readings: Readings) -> World:
    """The world that these readings describe."""
    near = readings.bound_vision == "near"
    sine, cosine = sin_cos(readings.turn_size / c.SUB_STEPS)
    radius = readings.object_radius
    # S2 is nowhere nearer to J1 than J2 is.
    closest_centre = c.S1_LENGTH - radius
    # A disc covers its bearing +- asin(rho / distance), at most 1.1 rho / distance here; one turn of S1
    # and, since S2's tip goes to the left by at most a third of its own, a third of a turn besides.
    side_reach = np.degrees(1.1 * radius / closest_centre) + 1.4 * readings.turn_size
    return World(
        turn=readings.turn_size,
        radius=readings.object_radius,
        white_right=c.ALPHA_MIN + (c.VIEW_HALF_WIDTH if near else 0.0),
        white_left=c.ALPHA_MAX - (c.VIEW_HALF_WIDTH if near else 0.0),
        any_part=readings.object_vision == "any_part",
        from_end=readings.camera_origin == "end",
        target_cone=readings.target_cone,
        indicate_cone=readings.indicate_cone,
        move_angle=readings.move_angle,
        ignore_stops=readings.ignore_stops == "early",
        keep=1.0 if readings.run_counting == "cumulative" else 0.0,
        whole_penalty=readings.collision_penalty == "whole",
        best_stretch=readings.f3_time == "best",
        strict_success=readings.success == "f1_f2_f3",
        quarter_sine=sine,
        quarter_cosine=cosine,
        hit_gap_squared=(radius - c.PENETRATION_TOLERANCE) ** 2,
        touch_gap_squared=(radius + c.TOUCH_TOLERANCE) ** 2,
        side_reach=float(side_reach),
    )


class WorldTables(NamedTuple):
    """The arrays that go with a `World`.

    Attributes:
        betas: [B], every value that beta can take in a trial [deg].
        beta_sines: [N_BETA_KEYS, 2], their sines and cosines, each at its key.
        codes: [7, 3], the words' codes: three objects, then four actions.
    """

    betas: NDArray[np.float64]
    beta_sines: NDArray[np.float64]
    codes: NDArray[np.int64]


@lru_cache(maxsize=64)
def tables_of(readings: Readings) -> WorldTables:
    """The tables of the world that these readings describe."""
    betas, sines = _reachable_betas(readings.turn_size), np.zeros((N_BETA_KEYS, 2))
    for beta in betas:
        sines[int(beta_key(beta))] = sin_cos(beta)
    return WorldTables(betas, sines, WORD_CODES)


def _reachable_betas(turn: float) -> NDArray[np.float64]:
    """All values that beta can take from 90 degrees on [deg], [B]."""
    values = [c.BETA_MAX]
    for value in values:  # grows while it is walked
        for successor in (max(c.BETA_MIN, value - turn), min(c.BETA_MAX, value + turn)):
            if successor not in values:
                values.append(successor)
    keys = {int(beta_key(value)) for value in values}
    assert len(keys) == len(values), "two values of beta share a key"  # noqa: S101 - our own mistake
    return np.array(values)


@compiled(allocates=False)
def beta_key(beta: float) -> np.uint64:
    """Where tables hold a value of beta [deg]: its whole tenths of a degree."""
    return np.uint64(beta * BETA_KEYS_PER_DEGREE + 0.5)
