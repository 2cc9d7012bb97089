"""What the readings fix for every trial, as numbers and tables the compiled kernel can read."""

from __future__ import annotations

from functools import lru_cache
from math import sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from arm2d import constants as c
from arm2d.arithmetic import sin_cos
from arm2d.readings import Readings

# Beta lives on this lattice [deg]: a turn and its reverse cancel exactly.
BETA_DIGITS = 9


class World(NamedTuple):
    """The world of one record of readings.

    B grid points of beta; directions D = 0 (unbend), 1 (stay), 2 (bend).

    Attributes:
        turn: Turn of a joint per step [deg].
        radius: Of the discs [cm].
        white_right: The camera's right sector is white while alpha is at most this [deg].
        white_left: Its left sector is white while alpha is at least this [deg].
        any_part: Whether any part of a disc is seen, or only its centre.
        target_cone: Largest distance from the target that is on target [deg].
        indicate_cone: The same for INDICATE's good steps [deg].
        move_angle: How far a full MOVE pushes [deg].
        ignore_stops: Whether 100 good steps end an IGNORE trial.
        keep: What a bad step leaves of the run: 0, or 1 if good steps need not be consecutive.
        whole_penalty: Whether P1 scales all of F1.
        best_stretch: Whether F3 is taken at its best step.
        strict_success: Whether success needs F3 > 0.99 too.
        beta: [B] in [deg].
        next_beta: [B * 3], index after a turn in direction D.
        sub_step_sin_cos: [B, 3, 5, 2], sine and cosine of beta before the turn in direction D and
            after each of its sub-steps.
        reach: [B], how far from J1 a disc's centre may be and still meet S2 in a turn from here [cm].
        side_reach: How far to S1's right, or beyond S2's tip to its left, a disc's centre may be and
            still meet S2 in one step [deg].
        tip_offset: [B], bearing of S2's tip minus alpha, before the turn [deg].
    """

    turn: float
    radius: float
    white_right: float
    white_left: float
    any_part: bool
    target_cone: float
    indicate_cone: float
    move_angle: float
    ignore_stops: bool
    keep: float
    whole_penalty: bool
    best_stretch: bool
    strict_success: bool
    beta: NDArray[np.float64]
    next_beta: NDArray[np.int64]
    sub_step_sin_cos: NDArray[np.float64]
    reach: NDArray[np.float64]
    side_reach: float
    tip_offset: NDArray[np.float64]


@lru_cache(maxsize=64)
def world_of(readings: Readings) -> World:
    """The world that these readings describe."""
    beta, next_beta = _beta_grid(readings.turn_size)
    near = readings.bound_vision == "near"
    tips = np.array([_tip(each) for each in beta])
    closest_centre = c.S1_LENGTH - readings.object_radius
    # asin(rho / distance) <= 1.6 rho / distance for these ratios; one step's turns of both joints besides.
    side_reach = np.degrees(1.6 * readings.object_radius / closest_centre) + 3.0 * readings.turn_size
    unbent = next_beta.reshape(-1, 3)[:, 0]
    return World(
        turn=readings.turn_size,
        radius=readings.object_radius,
        white_right=c.ALPHA_MIN + (c.VIEW_HALF_WIDTH if near else 0.0),
        white_left=c.ALPHA_MAX - (c.VIEW_HALF_WIDTH if near else 0.0),
        any_part=readings.object_vision == "any_part",
        target_cone=readings.target_cone,
        indicate_cone=readings.indicate_cone,
        move_angle=readings.move_angle,
        ignore_stops=readings.ignore_stops == "early",
        keep=1.0 if readings.run_counting == "cumulative" else 0.0,
        whole_penalty=readings.collision_penalty == "whole",
        best_stretch=readings.f3_time == "best",
        strict_success=readings.success == "f1_f2_f3",
        beta=beta,
        next_beta=next_beta,
        sub_step_sin_cos=_sub_steps(beta, next_beta),
        reach=tips[unbent, 0] + readings.object_radius + 1e-3,
        side_reach=float(side_reach),
        tip_offset=tips[:, 1],
    )


def turned_beta(beta: float, turn: float) -> float:
    """Beta [deg] after a turn, clipped to its range and rounded to its lattice."""
    return round(min(c.BETA_MAX, max(c.BETA_MIN, beta + turn)), BETA_DIGITS)


def _beta_grid(turn: float) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """All values that beta can take from 90 degrees on, and where each turn leads."""
    values, successors = [c.BETA_MAX], []
    index = {c.BETA_MAX: 0}
    for value in values:  # grows while it is walked
        for direction in (-1.0, 0.0, 1.0):
            successor = turned_beta(value, direction * turn)
            if successor not in index:
                index[successor] = len(values)
                values.append(successor)
            successors.append(index[successor])
    return np.array(values), np.array(successors)


def _sub_steps(beta: NDArray[np.float64], next_beta: NDArray[np.int64]) -> NDArray[np.float64]:
    """Sine and cosine of beta through each turn; [B, 3, 5, 2]."""
    table = np.empty((len(beta), 3, c.SUB_STEPS + 1, 2))
    for start, (before, successors) in enumerate(zip(beta, next_beta.reshape(-1, 3), strict=True)):
        for direction, after in enumerate(beta[successors]):
            for k in range(c.SUB_STEPS + 1):
                table[start, direction, k] = sin_cos(before + (after - before) * k / c.SUB_STEPS)
    return table


def _tip(beta: float) -> tuple[float, float]:
    """Distance [cm] of S2's tip from J1 and its bearing minus alpha [deg]."""
    sine, cosine = sin_cos(beta)
    along, across = c.S1_LENGTH + c.S2_LENGTH * cosine, c.S2_LENGTH * sine
    return sqrt(along * along + across * across), float(np.degrees(np.arctan2(across, along)))
