"""What a camera at the end of S1 (J2) sees: `arm2d.kernel.camera_at_end` for one trial."""

import warp as wp

from arm2d.device import numbers as c
from arm2d.device.arithmetic import bearing, sin_cos
from arm2d.device.controller import sector_bits, white_bits
from arm2d.device.lanes import Lane, pick
from arm2d.device.world import World


@wp.func
def look_from_end(lane: Lane, world: World) -> Lane:
    """Set the nine camera bits for the next step, and whether the target's centre is in view."""
    bits = white_bits(lane.alpha, world)
    seen = wp.int32(0)
    disc = wp.int32(0)
    while disc < 3:
        low_of, high_of = pick(lane.low, disc) - lane.alpha, pick(lane.high, disc) - lane.alpha
        if not (low_of > c.VIEW or high_of < -c.VIEW):
            offset, squared = from_end(pick(lane.bearing, disc) - lane.alpha, pick(lane.distance, disc))
            low, high = seen_interval(offset, squared, world)
            bits = bits | (sector_bits(low, high) << disc)
            if disc == lane.target and offset >= -c.VIEW and offset <= c.VIEW:
                seen = 1
        disc = disc + 1
    lane.camera = bits
    lane.seen = seen
    return lane


@wp.func
def seen_interval(offset: wp.float64, squared: wp.float64, world: World):
    """From where to where a disc is seen, relative to S1 [deg], by its centre's `from_end`."""
    if world.any_part == 0:
        return offset, offset
    beyond = squared - world.radius * world.radius
    if beyond <= c.ZERO:
        return -c.HALF_TURN, c.HALF_TURN
    half = bearing(wp.sqrt(beyond), world.radius)
    return offset - half, offset + half


@wp.func
def from_end(from_j1: wp.float64, distance: wp.float64):
    """A point's bearing from J2 relative to S1 [deg] and its squared distance from J2 [cm^2]."""
    sine, cosine = sin_cos(from_j1)
    x = distance * cosine - c.S1_LENGTH
    y = distance * sine
    offset = bearing(x, y)
    squared = x * x + y * y
    if offset <= c.HALF_TURN:
        return offset, squared
    return offset - c.WHOLE_TURN, squared
