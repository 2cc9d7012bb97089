"""Criteria step by step, and F1 to F3 at the end of a trial (spec section 8)."""

import numpy as np

from arm2d.compiling import compiled
from arm2d.constants import (
    BETA_MAX,
    COLLISION_FACTOR,
    GOOD_STEPS_FOR_SUCCESS,
    MAX_STEPS,
    STRAIGHT,
    THRESHOLD_TOLERANCE,
    VIEW_HALF_WIDTH,
)
from arm2d.instructions import ActionWord
from arm2d.kernel.lanes import (
    ALPHA,
    BEST,
    BETA,
    COLLIDED,
    CONE,
    COUNT,
    CRITERION,
    DONE,
    FIRST_OFFSET,
    GOAL,
    NONE,
    PUSH,
    RIGHT,
    RUN,
    SEEN,
    STEP,
    STRETCH,
    TARGET,
    TARGET_SIDE,
    TURN,
    Floats,
    Integers,
)
from arm2d.kernel.world import World

MOVE, TOUCH = int(ActionWord.MOVE), int(ActionWord.TOUCH)
INDICATE, IGNORE = int(ActionWord.INDICATE), int(ActionWord.IGNORE)


def is_good(action: ActionWord, near: bool, in_view: bool, touches: bool, right: bool, still: bool) -> bool:
    """Whether a step is good, given S1 near the target, the target seen, touching, on the right, S1 still."""
    if action is ActionWord.INDICATE:
        return near and not touches
    if action is ActionWord.TOUCH:
        return near and right and still
    if action is ActionWord.IGNORE:
        return not in_view and not touches
    return near and right


def _truth_table(action: ActionWord) -> int:
    """`is_good` of all 32 situations, as bits; a situation's number has `near` lowest."""
    situations = [[bool(number >> bit & 1) for bit in range(5)] for number in range(32)]
    return sum(is_good(action, *flags) << number for number, flags in enumerate(situations))


# [4], by action word.
CRITERIA = np.array([_truth_table(action) for action in ActionWord])


@compiled(allocates=False)
def set_criterion(s: Floats, n: Integers, i: int, action: int, world: World) -> None:
    """Tell lane i what a good step is, and which run of them ends the trial."""
    n[CRITERION + i] = CRITERIA[action]
    s[CONE + i] = world.indicate_cone if action == INDICATE else world.target_cone
    s[COUNT + i] = 0.0 if action == MOVE else 1.0
    s[PUSH + i] = 1.0 if action == MOVE else 0.0
    s[GOAL + i] = world.move_angle - THRESHOLD_TOLERANCE if action == MOVE else 1.0 * GOOD_STEPS_FOR_SUCCESS
    if action == IGNORE and not world.ignore_stops:
        s[GOAL + i] = 2.0 * MAX_STEPS


@compiled(allocates=False)
def score_step(s: Floats, n: Integers, lanes: int, keep: float, from_end: bool) -> int:
    """Judge the step just made in each lane; returns how many trials it ended."""
    ended = 0
    for i in range(lanes):
        offset = s[TARGET + i] - s[ALPHA + i]
        away = offset if offset >= 0.0 else -offset
        away = away if away <= 180.0 else 360.0 - away
        side = n[TARGET_SIDE + i]
        situation = 1 if away < s[CONE + i] else 0
        in_view = 1 if away <= VIEW_HALF_WIDTH else 0
        situation |= 2 * (n[SEEN + i] if from_end else in_view)
        situation |= 4 if side != NONE else 0
        situation |= 8 if side == RIGHT else 0
        situation |= 16 if s[TURN + i] == 0.0 else 0
        good = (n[CRITERION + i] >> situation) & 1
        run = s[RUN + i]
        longer = run + (s[COUNT + i] + s[PUSH + i] * s[TURN + i])
        run = longer if good != 0 else run * keep
        size = run if run >= 0.0 else -run
        best = s[BEST + i]
        best = size if size > best else best
        s[RUN + i] = run
        s[BEST + i] = best
        step = n[STEP + i] + 1
        n[STEP + i] = step
        done = 1 if best >= s[GOAL + i] else 0
        done |= n[COLLIDED + i]
        done |= 1 if step >= MAX_STEPS else 0
        n[DONE + i] = done
        ended += done
    return ended


@compiled(allocates=False)
def remember_stretch(s: Floats, n: Integers, lanes: int, world: World) -> None:
    """Keep the largest 1 - beta / 90 with the target in view; needed by one reading only."""
    for i in range(lanes):
        if target_in_view(s, n, i, world):
            s[STRETCH + i] = max(s[STRETCH + i], 1.0 - s[BETA + i] / BETA_MAX)


@compiled(allocates=False)
def offset_from_target(s: Floats, i: int) -> float:
    """Smaller angle between S1 and the bearing of the target, d [deg]."""
    away = abs(s[TARGET + i] - s[ALPHA + i])
    return away if away <= 180.0 else 360.0 - away


@compiled(allocates=False)
def target_in_view(s: Floats, n: Integers, i: int, world: World) -> bool:
    """Whether the target's centre lies in the camera's field."""
    if world.from_end:
        return n[SEEN + i] == 1
    return offset_from_target(s, i) <= VIEW_HALF_WIDTH


@compiled(allocates=False)
def final_scores(
    s: Floats, n: Integers, i: int, world: World, action: int
) -> tuple[float, float, float, bool]:
    """(F1, F2, F3, success) of the ended trial in lane i."""
    d, first = offset_from_target(s, i), s[FIRST_OFFSET + i]
    in_view = target_in_view(s, n, i, world)
    if action == IGNORE:
        f1 = 0.0 if in_view else 1.0
    else:
        penalty = COLLISION_FACTOR if n[COLLIDED + i] else 1.0
        ratio = (first - d) / first if first > 0.0 else 0.0
        on_target = 1.0 if d < world.target_cone else 0.0
        f1 = max(0.0, ratio * penalty, on_target)
        if world.whole_penalty:
            f1 = penalty * max(0.0, ratio, on_target)
    full = world.move_angle if action == MOVE else 1.0 * GOOD_STEPS_FOR_SUCCESS
    share = 1.0 if s[BEST + i] >= full - THRESHOLD_TOLERANCE else s[BEST + i] / full
    f2 = share if f1 == 1.0 else 0.0
    f3 = 0.0
    if action in (TOUCH, MOVE):
        if world.best_stretch:
            f3 = s[STRETCH + i]
        elif in_view:
            f3 = 1.0 - s[BETA + i] / BETA_MAX
    success = f1 == 1.0 and f2 == 1.0
    if world.strict_success and action in (TOUCH, MOVE):
        success = success and f3 > STRAIGHT
    return f1, f2, f3, success
