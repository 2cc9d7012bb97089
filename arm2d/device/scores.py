"""Criteria step by step, and F1 to F3 at the end (spec section 8): `arm2d.kernel.scores` for one trial."""

import warp as wp

from arm2d.device import numbers as c
from arm2d.device.lanes import Lane, pick, side_of
from arm2d.device.world import Tables, World


@wp.func
def set_criterion(lane: Lane, world: World, tables: Tables) -> Lane:
    """Tell what a good step is, and which run of them ends the trial."""
    lane.criterion = tables.criteria[lane.action]
    lane.cone = world.target_cone
    lane.count = c.ONE
    lane.push = c.ZERO
    lane.goal = c.GOOD_STEPS
    if lane.action == c.INDICATE:
        lane.cone = world.indicate_cone
    if lane.action == c.MOVE:
        lane.count = c.ZERO
        lane.push = c.ONE
        lane.goal = world.move_angle - c.THRESHOLD_TOLERANCE
    if lane.action == c.IGNORE and world.ignore_stops == 0:
        lane.goal = c.NEVER
    return lane


@wp.func
def score_step(lane: Lane, world: World) -> Lane:
    """Judge the step just made."""
    away = offset_from_target(lane)
    side = side_of(lane, lane.target)
    situation = wp.int32(0)
    if away < lane.cone:
        situation = situation | 1
    if target_in_view(lane, world):
        situation = situation | 2
    if side != c.NONE:
        situation = situation | 4
    if side == c.RIGHT:
        situation = situation | 8
    if lane.turn == c.ZERO:
        situation = situation | 16
    if ((lane.criterion >> situation) & 1) != 0:
        lane.run = lane.run + (lane.count + lane.push * lane.turn)
    else:
        lane.run = lane.run * world.keep
    size = wp.abs(lane.run)
    if size > lane.best:
        lane.best = size
    lane.step = lane.step + 1
    if lane.best >= lane.goal or lane.collided != 0 or lane.step >= c.MAX_STEPS:
        lane.done = 1
    return lane


@wp.func
def remember_stretch(lane: Lane, world: World) -> Lane:
    """Keep the largest 1 - beta / 90 with the target in view; needed by one reading only."""
    if target_in_view(lane, world):
        stretch = c.ONE - lane.beta / c.BETA_MAX
        if stretch > lane.stretch:
            lane.stretch = stretch
    return lane


@wp.func
def offset_from_target(lane: Lane) -> wp.float64:
    """Smaller angle between S1 and the bearing of the target, d [deg]."""
    away = wp.abs(pick(lane.bearing, lane.target) - lane.alpha)
    if away <= c.HALF_TURN:
        return away
    return c.WHOLE_TURN - away


@wp.func
def target_in_view(lane: Lane, world: World) -> wp.bool:
    """Whether the target's centre lies in the camera's field."""
    if world.from_end != 0:
        return lane.seen == 1
    return offset_from_target(lane) <= c.VIEW


@wp.func
def final_f1(lane: Lane, world: World) -> wp.float64:
    """F1 of the ended trial."""
    if lane.action == c.IGNORE:
        if target_in_view(lane, world):
            return c.ZERO
        return c.ONE
    d = offset_from_target(lane)
    penalty = wp.float64(1.0)
    if lane.collided != 0:
        penalty = c.COLLISION_FACTOR
    ratio = wp.float64(0.0)
    if lane.first_offset > c.ZERO:
        ratio = (lane.first_offset - d) / lane.first_offset
    on_target = wp.float64(0.0)
    if d < world.target_cone:
        on_target = c.ONE
    if world.whole_penalty != 0:
        return penalty * larger(larger(c.ZERO, ratio), on_target)
    return larger(larger(c.ZERO, ratio * penalty), on_target)


@wp.func
def final_f2(lane: Lane, f1: wp.float64, world: World) -> wp.float64:
    """F2 of the ended trial."""
    if f1 != c.ONE:
        return c.ZERO
    full = c.GOOD_STEPS
    if lane.action == c.MOVE:
        full = world.move_angle
    if lane.best >= full - c.THRESHOLD_TOLERANCE:
        return c.ONE
    return lane.best / full


@wp.func
def final_f3(lane: Lane, world: World) -> wp.float64:
    """F3 of the ended trial."""
    if lane.action != c.TOUCH and lane.action != c.MOVE:
        return c.ZERO
    if world.best_stretch != 0:
        return lane.stretch
    if target_in_view(lane, world):
        return c.ONE - lane.beta / c.BETA_MAX
    return c.ZERO


@wp.func
def final_success(lane: Lane, f1: wp.float64, f2: wp.float64, f3: wp.float64, world: World) -> wp.bool:
    """Whether the instruction was carried out."""
    success = f1 == c.ONE and f2 == c.ONE
    if world.strict_success != 0 and (lane.action == c.TOUCH or lane.action == c.MOVE):
        return success and f3 > c.ENOUGH_STRETCH
    return success


@wp.func
def larger(a: wp.float64, b: wp.float64) -> wp.float64:
    """The larger of two numbers; the first if they are equal."""
    if b > a:
        return b
    return a
