"""What a camera at the end of S1 (J2) sees: the reading `camera_origin` end (spec section 4).

A point in view from J2 is in view from J1 too, where it lies nearer to S1's direction. Few discs are,
and only of those the bearing from J2 is worked out.
"""

from math import sqrt

from arm2d.arithmetic import bearing, sin_cos
from arm2d.compiling import compiled
from arm2d.constants import N_OBJECTS, S1_LENGTH, VIEW_HALF_WIDTH
from arm2d.kernel.controller import sector_bits, white_bits
from arm2d.kernel.lanes import (
    ALPHA,
    BEARING,
    CAMERA,
    DISTANCE,
    HIGH,
    LOW,
    N_LANES,
    NEAR,
    SEEN,
    TRIAL,
    TURN,
    Floats,
    Integers,
)
from arm2d.kernel.world import World


@compiled(allocates=False)
def look_from_end(s: Floats, n: Integers, lanes: int, objects: Integers, world: World) -> None:
    """After a step, set camera bits and SEEN of each lane where S1 turned or a disc may have moved."""
    for i in range(lanes):
        if s[TURN + i] != 0.0 or n[NEAR + i] != 0:
            look_in_lane(s, n, i, objects[n[TRIAL + i]], world)


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
