"""What a camera at the end of S1 (J2) sees: the reading `camera_origin` end (spec section 4).

A sector's edge, seen from J2, is a bearing from J1 that depends on the disc's distance alone: it is worked
out when a disc is placed, and a step compares. Only where a comparison is too close to trust, where a disc is
close to J2, or where any part of a disc counts, the bearing from J2 is worked out; a point in view from J2 is
in view from J1 too, where it lies nearer to S1's direction.
"""

from math import sqrt
from typing import Final

from arm2d.arithmetic import bearing, sin_cos
from arm2d.compiling import compiled
from arm2d.constants import MIDDLE_SECTOR_HALF_WIDTH, N_OBJECTS, S1_LENGTH, VIEW_HALF_WIDTH
from arm2d.kernel.controller import sector_bits, white_bits
from arm2d.kernel.lanes import (
    ALPHA,
    BEARING,
    CAMERA,
    DISTANCE,
    EDGE,
    EDGES_FOR,
    HIGH,
    LOW,
    MIDDLE_EDGE,
    N_LANES,
    NEAR,
    SEEN,
    TARGET_BITS,
    TRIAL,
    TURN,
    UNCLEAR,
    Floats,
    Integers,
)
from arm2d.kernel.world import World

# Where sectors end, as sines.
SINE_OF_VIEW: Final = sin_cos(VIEW_HALF_WIDTH)[0]
SINE_OF_MIDDLE: Final = sin_cos(MIDDLE_SECTOR_HALF_WIDTH)[0]
# Nearer to an edge than this [deg], or nearer to J1 than this [cm], the bearing from J2 itself decides:
# rounding is a thousand times smaller.
TOO_CLOSE_TO_AN_EDGE: Final = 1e-6
TOO_CLOSE_TO_J2: Final = S1_LENGTH + 1.0
# Edges hold for distances that differ by less [cm]: S1 alone pushes a disc around J1, but for rounding.
SAME_DISTANCE: Final = 1e-9


@compiled(allocates=False)
def look_from_end(s: Floats, n: Integers, lanes: int, width: int, objects: Integers, world: World) -> None:
    """After a step, set camera bits and SEEN of each lane.

    Args:
        s: The lanes' floats and
        n: integers.
        lanes: How many lanes are in use, and
        width: as many, to whole blocks.
        objects: [T], the object of each trial.
        world: Its `World`.
    """
    if world.any_part:
        for i in range(lanes):
            if s[TURN + i] != 0.0 or n[NEAR + i] != 0:
                look_in_lane(s, n, i, objects[n[TRIAL + i]], world)
    elif _look_at_centres(s, n, width, world.white_right, world.white_left) > 0:
        for i in range(lanes):
            if n[UNCLEAR + i] != 0:
                look_in_lane(s, n, i, objects[n[TRIAL + i]], world)


@compiled(allocates=False)
def set_edges(s: Floats, at: int, distance: float) -> None:
    """Set how far from S1's direction, seen from J1 [deg], view and middle sector end for a disc.

    In the triangle of J1, J2 and the disc, the angle at the disc follows from that at J2 by the law of sines.

    Args:
        s: The lanes' floats.
        at: The disc's lane and colour, as in `place_disc`.
        distance: Of the disc from J1 [cm].
    """
    if distance >= TOO_CLOSE_TO_J2 and abs(distance - s[EDGES_FOR + at]) > SAME_DISTANCE:
        s[EDGES_FOR + at] = distance
        s[EDGE + at] = VIEW_HALF_WIDTH - _arc_sine(SINE_OF_VIEW * S1_LENGTH / distance)
        s[MIDDLE_EDGE + at] = MIDDLE_SECTOR_HALF_WIDTH - _arc_sine(SINE_OF_MIDDLE * S1_LENGTH / distance)


@compiled(allocates=False)
def _arc_sine(sine: float) -> float:
    """Arc sine of a number in [0, 1) [deg]."""
    return bearing(sqrt(1.0 - sine * sine), sine)


@compiled(allocates=False)
def _look_at_centres(s: Floats, n: Integers, width: int, right: float, left: float) -> int:
    """Set camera bits and SEEN by the edges; in how many lanes that is unclear, marked in UNCLEAR."""
    n_unclear = 0
    for i in range(width):
        alpha = s[ALPHA + i]
        bits, unclear = 0, 0
        for disc in range(N_OBJECTS):
            at = disc * N_LANES + i
            from_s1 = s[BEARING + at] - alpha
            away = from_s1 if from_s1 >= 0.0 else -from_s1
            sector = 0o100 if from_s1 >= 0.0 else 0o001
            sector = 0o010 if away < s[MIDDLE_EDGE + at] else sector
            bits |= (sector if away < s[EDGE + at] else 0) << disc
            unclear |= 1 if s[DISTANCE + at] < TOO_CLOSE_TO_J2 else 0
            unclear |= _too_close(away - s[EDGE + at]) | _too_close(away - s[MIDDLE_EDGE + at])
        n[SEEN + i] = 1 if (bits & n[TARGET_BITS + i]) != 0 else 0
        n[CAMERA + i] = bits | white_bits(alpha, right, left)
        n[UNCLEAR + i] = unclear
        n_unclear += unclear
    return n_unclear


@compiled(allocates=False)
def _too_close(difference: float) -> int:
    """1 where a difference [deg] is too small to trust its sign."""
    size = difference if difference >= 0.0 else -difference
    return 1 if size < TOO_CLOSE_TO_AN_EDGE else 0


@compiled(allocates=False)
def look_in_lane(s: Floats, n: Integers, i: int, target: int, world: World) -> None:
    """Set the nine camera bits of lane i for its next step, and whether the target's centre is in view."""
    alpha = s[ALPHA + i]
    bits, seen = white_bits(alpha, world.white_right, world.white_left), 0
    for disc in range(N_OBJECTS):
        at = disc * N_LANES + i
        if s[LOW + at] - alpha > VIEW_HALF_WIDTH or s[HIGH + at] - alpha < -VIEW_HALF_WIDTH:
            continue
        offset, squared = _from_end(s[BEARING + at] - alpha, s[DISTANCE + at])
        low, high = _seen_interval(offset, squared, world)
        bits |= sector_bits(low, high) << disc
        if disc == target and -VIEW_HALF_WIDTH <= offset <= VIEW_HALF_WIDTH:
            seen = 1
    n[CAMERA + i] = bits
    n[SEEN + i] = seen


@compiled(allocates=False)
def _seen_interval(offset: float, squared: float, world: World) -> tuple[float, float]:
    """From where to where a disc is seen, relative to S1 [deg], by its centre's `_from_end`."""
    if not world.any_part:
        return offset, offset
    beyond = squared - world.radius * world.radius
    if beyond <= 0.0:
        return -180.0, 180.0
    half = bearing(sqrt(beyond), world.radius)
    return offset - half, offset + half


@compiled(allocates=False)
def _from_end(from_j1: float, distance: float) -> tuple[float, float]:
    """A point's bearing from J2 relative to S1 [deg] and its squared distance from J2 [cm^2].

    Args:
        from_j1: Its bearing from J1 relative to S1 [deg].
        distance: Its distance from J1 [cm].
    """
    sine, cosine = sin_cos(from_j1)
    x, y = distance * cosine - S1_LENGTH, distance * sine
    offset = bearing(x, y)
    return offset if offset <= 180.0 else offset - 360.0, x * x + y * y
