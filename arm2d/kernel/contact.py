"""Discs against S2 (spec section 3), lane by lane: few lanes are near a disc at any step.

A disc is followed in S1's frame (x along S1, J1 at the origin), in which S2 turns about (100, 0).
"""

from math import sqrt
from typing import Final

import numpy as np

from arm2d.arithmetic import bearing, sin_cos
from arm2d.compiling import compiled
from arm2d.constants import (
    BETA_MAX,
    N_OBJECTS,
    S1_LENGTH,
    S2_LENGTH,
    SUB_STEPS,
    TOUCH_TOLERANCE,
)
from arm2d.kernel.camera_at_end import set_edges
from arm2d.kernel.lanes import (
    ALPHA,
    BEARING,
    BEND,
    BETA,
    COLLIDED,
    DISTANCE,
    HIGH,
    LEFT,
    LIMIT,
    LOW,
    N_LANES,
    NEAR,
    NONE,
    RIGHT,
    SIDE,
    TARGET,
    TARGET_SIDE,
    TOUCH,
    TRIAL,
    TURN,
    Floats,
    Integers,
)
from arm2d.kernel.world import World, beta_key

# In radians, and 0.3 % more.
LITTLE_MORE_THAN_A_DEGREE: Final = 0.0175


def _largest_beta_that_reaches(distance: float) -> float:
    """The beta [deg] at which S2's tip is so far from J1 [cm]; 90 if it always is, -90 if never."""
    cosine = (distance**2 - S1_LENGTH**2 - S2_LENGTH**2) / (2.0 * S1_LENGTH * S2_LENGTH)
    if cosine > 1.0:
        return -BETA_MAX
    return BETA_MAX if cosine <= 0.0 else bearing(cosine, sqrt(1.0 - cosine * cosine)) + 1e-3


# By whole centimetres, which round the distance down: a lane may be looked at in vain, never missed.
LARGEST_BETA = np.array([_largest_beta_that_reaches(float(distance)) for distance in range(1000)])
LAST_CENTIMETRE = len(LARGEST_BETA) - 1


@compiled(allocates=False)
def touch_discs(
    s: Floats, n: Integers, lanes: int, world: World, beta_sines: Floats, objects: Integers
) -> None:
    """Resolve the discs of the lanes marked in NEAR; the others' cannot have changed."""
    for i in range(lanes):
        if n[NEAR + i] == 0:
            continue
        target = objects[n[TRIAL + i]]
        touch, collided = 0, 0
        # Seen along S1, S2's tip lies beta / 3 to the left at the most.
        left_of = (s[BETA + i] - s[BEND + i]) / 3.0 + world.side_reach
        for disc in range(N_OBJECTS):
            at = disc * N_LANES + i
            if -world.side_reach < s[BEARING + at] - s[ALPHA + i] < left_of:
                _resolve(s, n, i, at, world, beta_sines)
            else:
                n[SIDE + at] = NONE
            touch |= n[SIDE + at]
            if disc != target and n[SIDE + at] != NONE:
                collided = 1
        n[TOUCH + i] = touch
        n[COLLIDED + i] = collided
        n[TARGET_SIDE + i] = n[SIDE + target * N_LANES + i]
        s[TARGET + i] = s[BEARING + target * N_LANES + i]


@compiled(allocates=False)
def _resolve(s: Floats, n: Integers, i: int, at: int, world: World, beta_sines: Floats) -> None:
    """Move one disc with or out of S2's way through the sub-steps of this step's motion.

    Gaps are compared by their squares.
    """
    sine, cosine = sin_cos(s[BEARING + at] - (s[ALPHA + i] - s[TURN + i]))
    x, y = s[DISTANCE + at] * cosine, s[DISTANCE + at] * sine
    key = beta_key(s[BETA + i] - s[BEND + i])
    sin_beta, cos_beta = beta_sines[key, 0], beta_sines[key, 1]
    side, moved = n[SIDE + at], False
    u0, v0 = _to_s2(x, y, sin_beta, cos_beta)
    beyond = _beyond(u0)
    # No gap shrinks by more than the arcs that the disc and S2's points run through in S1's frame.
    motion = s[DISTANCE + at] * abs(s[TURN + i]) + S2_LENGTH * abs(s[BEND + i])
    reach = world.radius + 2.0 * TOUCH_TOLERANCE + LITTLE_MORE_THAN_A_DEGREE * motion
    if side == NONE and beyond * beyond + v0 * v0 > reach * reach:
        return
    # In S1's frame a resting disc turns the other way.
    sine, cosine = _sub_step(-s[TURN + i], world)
    sin_bend, cos_bend = _sub_step(s[BEND + i], world)
    for _ in range(SUB_STEPS):
        sin_beta, cos_beta = (
            sin_beta * cos_bend + cos_beta * sin_bend,
            cos_beta * cos_bend - sin_beta * sin_bend,
        )
        x, y = x * cosine - y * sine, x * sine + y * cosine
        u, v = _to_s2(x, y, sin_beta, cos_beta)
        beyond = _beyond(u)
        gap_squared = beyond * beyond + v * v
        if gap_squared < world.hit_gap_squared:
            if side != NONE:
                u, v = u0, v0
            else:
                side = RIGHT if v0 < 0.0 else LEFT
                v = sqrt(world.radius * world.radius - beyond * beyond)
                v = -v if side == RIGHT else v
            x = S1_LENGTH + u * cos_beta - v * sin_beta
            y = u * sin_beta + v * cos_beta
            moved = True
        elif gap_squared <= world.touch_gap_squared:
            side = RIGHT if v < 0.0 else LEFT
        else:
            side = NONE
        u0, v0 = u, v
    n[SIDE + at] = side
    if moved:
        place_disc(s, at, s[ALPHA + i] + bearing(x, y), sqrt(x * x + y * y), world)
        set_limit(s, i, world)


@compiled(allocates=False)
def place_disc(s: Floats, at: int, bearing_deg: float, distance: float, world: World) -> None:
    """Put a disc, the one of lane and colour `at`, at a bearing [deg] and a distance [cm] from J1."""
    s[BEARING + at] = bearing_deg
    s[DISTANCE + at] = distance
    half = (
        bearing(sqrt(distance * distance - world.radius * world.radius), world.radius)
        if world.any_part
        else 0.0
    )
    s[LOW + at] = bearing_deg - half
    s[HIGH + at] = bearing_deg + half
    if world.from_end:
        set_edges(s, at, distance)


@compiled(allocates=False)
def set_limit(s: Floats, i: int, world: World) -> None:
    """Work out from which beta on S2 may meet a disc of lane i within a step."""
    nearest = min(s[DISTANCE + i], s[DISTANCE + N_LANES + i], s[DISTANCE + 2 * N_LANES + i])
    s[LIMIT + i] = LARGEST_BETA[min(int(nearest - world.radius), LAST_CENTIMETRE)] + world.turn


@compiled(allocates=False)
def _sub_step(turn: float, world: World) -> tuple[float, float]:
    """(sine, cosine) of one sub-step of a joint's turn [deg]; a turn is full unless a bound cut it."""
    if turn == 0.0:
        return 0.0, 1.0
    if turn == world.turn:
        return world.quarter_sine, world.quarter_cosine
    if turn == -world.turn:
        return -world.quarter_sine, world.quarter_cosine
    return sin_cos(turn / SUB_STEPS)


@compiled(allocates=False)
def _to_s2(x: float, y: float, sin_beta: float, cos_beta: float) -> tuple[float, float]:
    """(u, v) along and to the left of S2, of the point (x, y) in S1's frame."""
    x -= S1_LENGTH
    return x * cos_beta + y * sin_beta, y * cos_beta - x * sin_beta


@compiled(allocates=False)
def _beyond(u: float) -> float:
    """How far u lies beyond either end of S2 [cm]."""
    if u < 0.0:
        return -u
    return u - S2_LENGTH if u > S2_LENGTH else 0.0
