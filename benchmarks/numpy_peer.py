"""The same trials in numpy, vectorised over genotypes and trials: the peer the kernel is measured against.

The plain readings only. Two versions share all but one line: `run_trials` computes every quantity of
every trial at every step, masks doing the rest, as array code mostly does; `sparse=True` computes
contact only for the discs that S2 may reach in the step, the best that numpy could be made to do here.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from arm2d import ActionWord, Networks, Readings, Trials, TrialScores, decode
from arm2d import constants as c
from arm2d.running import WORD_CODES

MOVE, TOUCH, INDICATE, IGNORE = map(int, ActionWord)
NONE, RIGHT, LEFT = 0, 1, 2


def run_trials(
    genotypes: NDArray, trials: Trials, readings: Readings, *, sparse: bool = False
) -> TrialScores:
    """Run every trial with every genotype; as `arm2d.run_trials`."""
    nets, shape = decode(genotypes, readings), (len(genotypes), len(trials))
    everywhere = np.broadcast_to
    words = np.concatenate([WORD_CODES[trials.objects], WORD_CODES[3 + trials.actions]], axis=1)  # [T, 6]
    inputs = np.zeros((*shape, c.N_INPUTS))
    inputs[..., 12:] = words
    action, target = everywhere(trials.actions, shape), everywhere(trials.objects, shape)[..., np.newaxis]
    alpha, beta = everywhere(trials.alpha, shape).copy(), np.full(shape, c.BETA_MAX)
    discs = everywhere(trials.discs, (*shape, 3, 2)).copy()
    sides = np.zeros((*shape, 3), int)
    y = np.zeros((*shape, c.N_INTER))
    run, best, steps = np.zeros(shape), np.zeros(shape), np.zeros(shape, int)
    collided, active = np.zeros(shape, bool), np.ones(shape, bool)
    bearings = _bearing(discs)
    first = offset = _offset(alpha, np.take_along_axis(bearings, target, -1)[..., 0])
    for _ in range(c.MAX_STEPS):
        _sense(inputs, alpha, beta, bearings, sides)
        y = np.where(active[..., np.newaxis], _think(nets, inputs, y), y)
        turn1, turn2 = _turns(nets, y, readings.turn_size)
        after1 = np.where(active, np.clip(alpha + turn1, c.ALPHA_MIN, c.ALPHA_MAX), alpha)
        after2 = np.where(active, np.clip(beta + turn2, c.BETA_MIN, c.BETA_MAX), beta)
        _touch(alpha, beta, after1, after2, discs, bearings, sides, readings.object_radius, sparse)
        turned, alpha, beta = after1 - alpha, after1, after2
        offset = _offset(alpha, np.take_along_axis(bearings, target, -1)[..., 0])
        side = np.take_along_axis(sides, target, -1)[..., 0]
        touched = sides != NONE
        np.put_along_axis(touched, target, False, -1)
        collided |= active & touched.any(-1)
        good = _good(action, offset, side, turned, readings)
        run = np.where(active, np.where(good, run + np.where(action == MOVE, turned, 1.0), 0.0), run)
        best = np.maximum(best, np.abs(run))
        steps += active
        goal = np.where(action == MOVE, readings.move_angle, c.GOOD_STEPS_FOR_SUCCESS)
        active &= ~(collided | (best >= goal - c.THRESHOLD_TOLERANCE))
        if not active.any():
            break
    return _scores(action, first, offset, collided, best, beta, steps, readings)


def _sigmoid(x: NDArray) -> NDArray:
    return 1.0 / (1.0 + np.exp(-x))


def _sense(inputs, alpha, beta, bearings, sides) -> None:
    """Set I1 to I12."""
    offset = bearings - alpha[..., np.newaxis]
    inputs[..., 0] = (sides == RIGHT).any(-1)
    inputs[..., 1] = (sides == LEFT).any(-1)
    at_right, at_left = (alpha <= c.ALPHA_MIN)[..., np.newaxis], (alpha >= c.ALPHA_MAX)[..., np.newaxis]
    inner, outer = c.MIDDLE_SECTOR_HALF_WIDTH, c.VIEW_HALF_WIDTH
    inputs[..., 2:5] = ((offset >= -outer) & (offset < -inner)) | at_right
    inputs[..., 5:8] = np.abs(offset) <= inner
    inputs[..., 8:11] = ((offset > inner) & (offset <= outer)) | at_left
    inputs[..., 11] = beta / c.BETA_MAX


def _think(nets: Networks, inputs, y) -> NDArray:
    """One Euler step of eq. 2."""
    s = _sigmoid(nets.gain[:, np.newaxis, np.newaxis] * inputs + nets.input_bias[:, np.newaxis, np.newaxis])
    z = _sigmoid(y + nets.inter_biases[:, np.newaxis])
    total = s @ nets.sensory_weights + z @ nets.recurrent_weights
    return y + c.DT / nets.decay_constants[:, np.newaxis] * (total - y)


def _turns(nets: Networks, y, size) -> tuple[NDArray, NDArray]:
    """The turns of eq. 3."""
    x = _sigmoid(y + nets.inter_biases[:, np.newaxis]) @ nets.motor_weights
    x += nets.motor_bias[:, np.newaxis, np.newaxis]
    return size * (x[..., 0] > 0) * -np.sign(x[..., 1]), size * (x[..., 2] > 0) * -np.sign(x[..., 3])


def _touch(alpha0, beta0, alpha1, beta1, discs, bearings, sides, radius, sparse) -> None:
    """Resolve contacts (spec section 3) of all discs, or of those that S2 may reach in this step."""
    moved = (alpha1 != alpha0) | (beta1 != beta0)
    near = np.ones(sides.shape, bool)
    if sparse:
        near = _may_meet(moved, alpha1, beta1, discs, bearings, radius)
        sides[moved[..., np.newaxis] & ~near] = NONE
    p, t, o = np.nonzero(near)
    if not len(p):
        return
    a0, b0, a1, b1 = alpha0[p, t], beta0[p, t], alpha1[p, t], beta1[p, t]
    point, side = discs[p, t, o], sides[p, t, o]
    u0, v0 = _to_s2(a0, b0, point)
    for k in range(1, c.SUB_STEPS + 1):
        a, b = a0 + (a1 - a0) * k / c.SUB_STEPS, b0 + (b1 - b0) * k / c.SUB_STEPS
        u, v = _to_s2(a, b, point)
        beyond = np.maximum(0.0, np.maximum(u - c.S2_LENGTH, -u))
        gap = np.hypot(beyond, v)
        hit = gap < radius - c.PENETRATION_TOLERANCE
        carried, met = hit & (side != NONE), hit & (side == NONE)
        tangent = np.sqrt(np.maximum(radius * radius - beyond * beyond, 0.0)) * np.where(v0 < 0.0, -1.0, 1.0)
        u, v = np.where(carried, u0, u), np.where(carried, v0, np.where(met, tangent, v))
        point = np.where(hit[:, np.newaxis], _from_s2(a, b, u, v), point)
        seen = np.where(v < 0.0, RIGHT, LEFT)
        free = np.where(gap <= radius + c.TOUCH_TOLERANCE, seen, NONE)
        side = np.where(carried, side, np.where(met, np.where(v0 < 0.0, RIGHT, LEFT), free))
        u0, v0 = u, v
    discs[p, t, o], sides[p, t, o], bearings[p, t, o] = point, side, _bearing(point)


def _may_meet(moved, alpha, beta, discs, bearings, radius) -> NDArray:
    """Which discs lie where S2 can be within a step of these angles, [P, T, 3]."""
    offset, distance = bearings - alpha[..., np.newaxis], np.hypot(discs[..., 0], discs[..., 1])
    along = c.S1_LENGTH + c.S2_LENGTH * np.cos(np.radians(beta))
    reach = np.hypot(along, c.S2_LENGTH * np.sin(np.radians(beta))) + radius + 3.0
    return moved[..., np.newaxis] & (offset > -15.0) & (offset < 42.0) & (distance < reach[..., np.newaxis])


def _to_s2(alpha, beta, point) -> tuple[NDArray, NDArray]:
    a, h = np.radians(alpha), np.radians(alpha + beta)
    x, y = point[..., 0] - c.S1_LENGTH * np.cos(a), point[..., 1] - c.S1_LENGTH * np.sin(a)
    return x * np.cos(h) + y * np.sin(h), y * np.cos(h) - x * np.sin(h)


def _from_s2(alpha, beta, u, v) -> NDArray:
    a, h = np.radians(alpha), np.radians(alpha + beta)
    x = c.S1_LENGTH * np.cos(a) + u * np.cos(h) - v * np.sin(h)
    return np.stack([x, c.S1_LENGTH * np.sin(a) + u * np.sin(h) + v * np.cos(h)], axis=-1)


def _bearing(points) -> NDArray:
    return (np.degrees(np.arctan2(points[..., 1], points[..., 0])) + 90.0) % 360.0 - 90.0


def _offset(alpha, bearing) -> NDArray:
    away = np.abs(bearing - alpha)
    return np.minimum(away, 360.0 - away)


def _good(action, offset, side, turned, readings: Readings) -> NDArray:
    """Whether the step counts for F2."""
    near, seen = offset < readings.target_cone, offset <= c.VIEW_HALF_WIDTH
    return np.select(
        [action == MOVE, action == TOUCH, action == INDICATE],
        [near & (side == RIGHT), near & (side == RIGHT) & (turned == 0.0), near & (side == NONE)],
        ~seen & (side == NONE),
    )


def _scores(action, first, offset, collided, best, beta, steps, readings: Readings) -> TrialScores:
    seen, near = offset <= c.VIEW_HALF_WIDTH, offset < readings.target_cone
    ratio = (first - offset) / first * np.where(collided, c.COLLISION_FACTOR, 1.0)
    f1 = np.where(action == IGNORE, ~seen, np.maximum(np.maximum(0.0, ratio), near)).astype(float)
    full = np.where(action == MOVE, readings.move_angle, c.GOOD_STEPS_FOR_SUCCESS)
    share = np.where(best >= full - c.THRESHOLD_TOLERANCE, 1.0, best / full)
    f2 = np.where(f1 == 1.0, share, 0.0)
    f3 = np.where(seen & ((action == TOUCH) | (action == MOVE)), 1.0 - beta / c.BETA_MAX, 0.0)
    return TrialScores(f1, f2, f3, (f1 == 1.0) & (f2 == 1.0), steps)
