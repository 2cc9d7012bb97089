"""Discs against S2 (spec section 3), lane by lane: few lanes are near a disc at any step.

A disc is followed in S1's frame (x along S1, J1 at the origin), in which S2 turns about (100, 0).
"""

from math import sqrt

from numba import njit

from arm2d.arithmetic import bearing, sin_cos
from arm2d.constants import PENETRATION_TOLERANCE, S1_LENGTH, S2_LENGTH, SUB_STEPS, TOUCH_TOLERANCE
from arm2d.kernel.lanes import (
    ALPHA,
    BEARING,
    BETA,
    COLLIDED,
    DISTANCE,
    HIGH,
    LEFT,
    LOW,
    N_LANES,
    NEAREST,
    NEXT_BETA,
    NONE,
    RIGHT,
    SIDE,
    TARGET,
    TARGET_SIDE,
    TOUCH,
    TRIAL,
    TURN,
)


@njit(cache=True, error_model="numpy")
def move_and_touch(s, n, lanes, world, objects):
    """Bend S2 and resolve every disc it may meet; a motionless arm changes nothing."""
    for i in range(lanes):
        before = n[BETA + i]
        direction = n[NEXT_BETA + i]
        after = world.next_beta[3 * before + direction]
        n[BETA + i] = after
        if s[NEAREST + i] < world.reach[before] and (after != before or s[TURN + i] != 0.0):
            _touch(s, n, i, before, direction, world, objects)


@njit(cache=True, error_model="numpy")
def _touch(s, n, i, before, direction, world, objects):
    """Resolve the discs of lane i, whose S2 turned from grid point `before` in `direction`."""
    target = objects[n[TRIAL + i]]
    right_of, left_of = -world.side_reach, world.tip_offset[before] + world.side_reach
    touch, collided = 0, 0
    for disc in range(3):
        at = disc * N_LANES + i
        offset = s[BEARING + at] - s[ALPHA + i]
        near = right_of < offset < left_of and s[DISTANCE + at] < world.reach[before]
        if near:
            _resolve(s, n, i, at, world.sub_step_sin_cos[before, direction], world)
        else:
            n[SIDE + at] = NONE
        touch |= n[SIDE + at]
        if disc != target and n[SIDE + at] != NONE:
            collided = 1
    n[TOUCH + i] = touch
    n[COLLIDED + i] = collided
    n[TARGET_SIDE + i] = n[SIDE + target * N_LANES + i]
    s[TARGET + i] = s[BEARING + target * N_LANES + i]


@njit(cache=True, error_model="numpy")
def _resolve(s, n, i, at, sin_cos_beta, world):
    """Move one disc with or out of S2's way through the sub-steps of this step's motion."""
    radius = world.radius
    before = s[ALPHA + i] - s[TURN + i]
    sine, cosine = sin_cos(s[BEARING + at] - before)
    x, y = s[DISTANCE + at] * cosine, s[DISTANCE + at] * sine
    # In S1's frame a resting disc turns the other way.
    sine, cosine = sin_cos(-s[TURN + i] / SUB_STEPS)
    side, moved = n[SIDE + at], False
    u0, v0 = _to_s2(x, y, sin_cos_beta[0, 0], sin_cos_beta[0, 1])
    for k in range(1, SUB_STEPS + 1):
        sin_beta, cos_beta = sin_cos_beta[k, 0], sin_cos_beta[k, 1]
        x, y = x * cosine - y * sine, x * sine + y * cosine
        u, v = _to_s2(x, y, sin_beta, cos_beta)
        beyond = _beyond(u)
        gap = sqrt(beyond * beyond + v * v)
        if gap < radius - PENETRATION_TOLERANCE:
            if side != NONE:
                u, v = u0, v0
            else:
                side = RIGHT if v0 < 0.0 else LEFT
                v = sqrt(radius * radius - beyond * beyond)
                v = -v if side == RIGHT else v
            x = S1_LENGTH + u * cos_beta - v * sin_beta
            y = u * sin_beta + v * cos_beta
            moved = True
        elif gap <= radius + TOUCH_TOLERANCE:
            side = RIGHT if v < 0.0 else LEFT
        else:
            side = NONE
        u0, v0 = u, v
    n[SIDE + at] = side
    if moved:
        place_disc(s, at, i, s[ALPHA + i] + bearing(x, y), sqrt(x * x + y * y), world)


@njit(cache=True, error_model="numpy")
def place_disc(s, at, i, bearing_deg, distance, world):
    """Put a disc at a bearing [deg] and distance [cm] from J1; `at` is its lane and disc, i its lane."""
    s[BEARING + at] = bearing_deg
    s[DISTANCE + at] = distance
    half = (
        bearing(sqrt(distance * distance - world.radius * world.radius), world.radius)
        if world.any_part
        else 0.0
    )
    s[LOW + at] = bearing_deg - half
    s[HIGH + at] = bearing_deg + half
    nearest = min(s[DISTANCE + i], s[DISTANCE + N_LANES + i])
    s[NEAREST + i] = min(nearest, s[DISTANCE + 2 * N_LANES + i])


@njit(cache=True, error_model="numpy")
def _to_s2(x, y, sin_beta, cos_beta):
    """(u, v) along and to the left of S2, of the point (x, y) in S1's frame."""
    x -= S1_LENGTH
    return x * cos_beta + y * sin_beta, y * cos_beta - x * sin_beta


@njit(cache=True, error_model="numpy")
def _beyond(u):
    """How far u lies beyond either end of S2 [cm]."""
    if u < 0.0:
        return -u
    return u - S2_LENGTH if u > S2_LENGTH else 0.0
