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
    SEEN,
    TRIAL,
    Floats,
    Integers,
)
from arm2d.kernel.world import World


@compiled(allocates=False)
def sense_camera_at_end(s: Floats, n: Integers, lanes: int, world: World) -> None:
    """Set the nine camera bits of each lane, as `sense_camera` does for a camera at J1."""
    for i in range(lanes):
        alpha = s[ALPHA + i]
        bits = white_bits(alpha, world.white_right, world.white_left)
        for disc in range(N_OBJECTS):
            at = disc * N_LANES + i
            if s[LOW + at] - alpha <= VIEW_HALF_WIDTH and s[HIGH + at] - alpha >= -VIEW_HALF_WIDTH:
                low, high = _seen_interval(s[BEARING + at] - alpha, s[DISTANCE + at], world)
                bits |= sector_bits(low, high) << disc
        n[CAMERA + i] = bits


@compiled(allocates=False)
def see_targets(s: Floats, n: Integers, lanes: int, objects: Integers) -> None:
    """Note in which lanes the target's centre is in view."""
    for i in range(lanes):
        at = objects[n[TRIAL + i]] * N_LANES + i
        from_j1 = s[BEARING + at] - s[ALPHA + i]
        seen = False
        if -VIEW_HALF_WIDTH <= from_j1 <= VIEW_HALF_WIDTH:
            offset, _ = _from_end(from_j1, s[DISTANCE + at])
            seen = -VIEW_HALF_WIDTH <= offset <= VIEW_HALF_WIDTH
        n[SEEN + i] = 1 if seen else 0


@compiled(allocates=False)
def _seen_interval(from_j1: float, distance: float, world: World) -> tuple[float, float]:
    """From where to where a disc is seen, relative to S1 [deg]; its centre is given as seen from J1."""
    offset, squared = _from_end(from_j1, distance)
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
