"""Discs against S2 (spec section 3): `arm2d.kernel.contact` for one trial."""

import warp as wp

from arm2d.device import numbers as c
from arm2d.device.arithmetic import bearing, sin_cos
from arm2d.device.lanes import Lane, pick, put, set_side, side_of
from arm2d.device.world import Tables, World, key_of_beta
from arm2d.kernel.contact import LARGEST_BETA, LITTLE_MORE_THAN_A_DEGREE

DEGREE = wp.float64(LITTLE_MORE_THAN_A_DEGREE)
THREE = wp.float64(3.0)
LAST_CENTIMETRE = wp.int32(len(LARGEST_BETA) - 1)


@wp.func
def touch_discs(lane: Lane, world: World, tables: Tables) -> Lane:
    """Resolve the discs of a trial that is marked in `near`."""
    lane.touch = 0
    lane.collided = 0
    # Seen along S1, S2's tip lies beta / 3 to the left at the most.
    left_of = (lane.beta - lane.bend) / THREE + world.side_reach
    disc = wp.int32(0)
    while disc < 3:  # not `for`: three copies of what follows would be slower to fetch than one
        beside = pick(lane.bearing, disc) - lane.alpha
        if -world.side_reach < beside and beside < left_of:
            lane = resolve(lane, disc, world, tables)
        else:
            lane = set_side(lane, disc, c.NONE)
        side = side_of(lane, disc)
        lane.touch = lane.touch | side
        if disc != lane.target and side != c.NONE:
            lane.collided = 1
        disc = disc + 1
    return lane


@wp.func
def resolve(lane: Lane, disc: wp.int32, world: World, tables: Tables) -> Lane:
    """Move one disc with or out of S2's way through the sub-steps of this step's motion."""
    sine, cosine = sin_cos(pick(lane.bearing, disc) - (lane.alpha - lane.turn))
    distance = pick(lane.distance, disc)
    x = distance * cosine
    y = distance * sine
    before = tables.beta_sines[world.row, tables.beta_numbers[world.row, key_of_beta(lane.beta - lane.bend)]]
    sin_beta = before[0]
    cos_beta = before[1]
    side = side_of(lane, disc)
    moved = wp.int32(0)
    u0, v0 = to_s2(x, y, sin_beta, cos_beta)
    beyond = beyond_s2(u0)
    # No gap shrinks by more than the arcs that the disc and S2's points run through in S1's frame.
    motion = distance * wp.abs(lane.turn) + c.S2_LENGTH * wp.abs(lane.bend)
    reach = world.radius + c.TWICE_TOUCH_TOLERANCE + DEGREE * motion
    if side == c.NONE and beyond * beyond + v0 * v0 > reach * reach:
        return lane
    # In S1's frame a resting disc turns the other way.
    sine, cosine = sub_step(-lane.turn, world)
    sin_bend, cos_bend = sub_step(lane.bend, world)
    k = wp.int32(0)
    while k < c.SUB_STEPS:
        k = k + 1
        next_sine = sin_beta * cos_bend + cos_beta * sin_bend
        cos_beta = cos_beta * cos_bend - sin_beta * sin_bend
        sin_beta = next_sine
        next_x = x * cosine - y * sine
        y = x * sine + y * cosine
        x = next_x
        u, v = to_s2(x, y, sin_beta, cos_beta)
        beyond = beyond_s2(u)
        gap_squared = beyond * beyond + v * v
        if gap_squared < world.hit_gap_squared:
            if side != c.NONE:
                u = u0
                v = v0
            else:
                v = wp.sqrt(world.radius * world.radius - beyond * beyond)
                side = c.LEFT
                if v0 < c.ZERO:
                    side = c.RIGHT
                    v = -v
            x = c.S1_LENGTH + u * cos_beta - v * sin_beta
            y = u * sin_beta + v * cos_beta
            moved = 1
        elif gap_squared <= world.touch_gap_squared:
            side = c.LEFT
            if v < c.ZERO:
                side = c.RIGHT
        else:
            side = c.NONE
        u0 = u
        v0 = v
    lane = set_side(lane, disc, side)
    if moved != 0:
        lane = place_disc(lane, disc, lane.alpha + bearing(x, y), wp.sqrt(x * x + y * y), world)
        lane = set_limit(lane, world, tables)
    return lane


@wp.func
def place_disc(
    lane: Lane, disc: wp.int32, bearing_deg: wp.float64, distance: wp.float64, world: World
) -> Lane:
    """Put a disc at a bearing [deg] and a distance [cm] from J1."""
    half = wp.float64(0.0)
    if world.any_part != 0:
        half = bearing(wp.sqrt(distance * distance - world.radius * world.radius), world.radius)
    lane.bearing = put(lane.bearing, disc, bearing_deg)
    lane.distance = put(lane.distance, disc, distance)
    lane.low = put(lane.low, disc, bearing_deg - half)
    lane.high = put(lane.high, disc, bearing_deg + half)
    return lane


@wp.func
def set_limit(lane: Lane, world: World, tables: Tables) -> Lane:
    """Work out from which beta on S2 may meet a disc within a step."""
    nearest = wp.min(wp.min(lane.distance[0], lane.distance[1]), lane.distance[2])
    whole = wp.min(wp.int32(nearest - world.radius), LAST_CENTIMETRE)
    lane.limit = tables.largest_betas[whole] + world.turn
    return lane


@wp.func
def sub_step(turn: wp.float64, world: World):
    """(sine, cosine) of one sub-step of a joint's turn [deg]; a turn is full unless a bound cut it."""
    if turn == c.ZERO:
        return c.ZERO, c.ONE
    if turn == world.turn:
        return world.quarter_sine, world.quarter_cosine
    if turn == -world.turn:
        return -world.quarter_sine, world.quarter_cosine
    sine, cosine = sin_cos(turn / c.SUB_STEPS_FLOAT)
    return sine, cosine


@wp.func
def to_s2(x: wp.float64, y: wp.float64, sin_beta: wp.float64, cos_beta: wp.float64):
    """(u, v) along and to the left of S2, of the point (x, y) in S1's frame."""
    from_j2 = x - c.S1_LENGTH
    return from_j2 * cos_beta + y * sin_beta, y * cos_beta - from_j2 * sin_beta


@wp.func
def beyond_s2(u: wp.float64) -> wp.float64:
    """How far u lies beyond either end of S2 [cm]."""
    if u < c.ZERO:
        return -u
    if u > c.S2_LENGTH:
        return u - c.S2_LENGTH
    return c.ZERO
