"""The same trials in JAX, compiled by XLA for one core: a peer that the kernel is measured against.

The plain readings and float64. All trials of all genotypes are arrays [P, T] that advance together in one
`while_loop`, masks doing the rest, until every trial has ended. Needs jax (`pip install jax`), which
nothing else in the project does. Divisions, exponentials and arc tangents are XLA's own: a chaotic
trial may end otherwise than the kernel's, and the benchmark says how many do.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import jax  # pyright: ignore[reportMissingImports]
import jax.numpy as jnp  # pyright: ignore[reportMissingImports]
import numpy as np
from numpy.typing import NDArray

from arm2d import ActionWord, Readings, Trials, TrialScores, decode
from arm2d import constants as c
from arm2d.running import WORD_CODES
from benchmarks.jax_contact import LEFT, NONE, RIGHT, bearing_of, touch

jax.config.update("jax_enable_x64", True)  # float64, as the kernel

MOVE, TOUCH, INDICATE, IGNORE = map(int, ActionWord)


class Inputs(NamedTuple):
    """What does not change in a trial: networks [P, ...], instructions and starts [T, ...]."""

    sensory: Any  # [P, 18, 3]
    recurrent: Any  # [P, 3, 3]
    motor: Any  # [P, 3, 4]
    rate: Any  # [P, 1, 3], time step over decay constant
    input_bias: Any  # [P, 1, 1]
    inter_bias: Any  # [P, 1, 3]
    motor_bias: Any  # [P, 1, 1]
    gain: Any  # [P, 1, 1]
    words: Any  # [T, 6]
    action: Any  # [T]
    target: Any  # [T]
    alpha: Any  # [T]
    discs: Any  # [T, 3, 2]


class State(NamedTuple):
    """What changes, [P, T, ...]."""

    alpha: Any
    beta: Any
    discs: Any  # [P, T, 3, 2]
    sides: Any  # [P, T, 3]
    y: Any  # [P, T, 3]
    run: Any
    best: Any
    steps: Any
    collided: Any
    active: Any


def prepare(genotypes: NDArray, trials: Trials, readings: Readings) -> Callable[[], TrialScores]:
    """A function that runs every trial with every genotype; compiled by its first call."""
    nets = decode(genotypes, readings)
    inputs = Inputs(
        nets.sensory_weights,
        nets.recurrent_weights,
        nets.motor_weights,
        c.DT / nets.decay_constants[:, np.newaxis],
        nets.input_bias[:, np.newaxis, np.newaxis],
        nets.inter_biases[:, np.newaxis],
        nets.motor_bias[:, np.newaxis, np.newaxis],
        nets.gain[:, np.newaxis, np.newaxis],
        np.concatenate([WORD_CODES[trials.objects], WORD_CODES[3 + trials.actions]], axis=1),
        trials.actions,
        trials.objects,
        trials.alpha,
        trials.discs,
    )
    run = jax.jit(partial(_run, readings=readings))

    def run_trials() -> TrialScores:
        return TrialScores(*(np.asarray(each) for each in run(inputs)))

    return run_trials


def _run(inputs: Inputs, readings: Readings) -> tuple:
    """From the start of all trials to their scores."""
    shape = (len(inputs.gain), len(inputs.alpha))
    start = State(
        alpha=jnp.broadcast_to(inputs.alpha, shape),
        beta=jnp.full(shape, c.BETA_MAX),
        discs=jnp.broadcast_to(inputs.discs, (*shape, 3, 2)),
        sides=jnp.zeros((*shape, 3), jnp.int8),
        y=jnp.zeros((*shape, c.N_INTER)),
        run=jnp.zeros(shape),
        best=jnp.zeros(shape),
        steps=jnp.zeros(shape, jnp.int64),
        collided=jnp.zeros(shape, bool),
        active=jnp.ones(shape, bool),
    )
    end = jax.lax.while_loop(
        lambda state: state.active.any(), partial(_step, inputs=inputs, readings=readings), start
    )
    return _scores(inputs, _offset(inputs, start), end, readings)


def _step(state: State, inputs: Inputs, readings: Readings) -> State:
    """One control step of all trials that have not ended (spec section 7)."""
    active = state.active
    y = jnp.where(active[..., None], _think(inputs, _sense(inputs, state), state.y), state.y)
    turn1, turn2 = _turns(inputs, y, readings.turn_size)
    alpha = jnp.where(active, jnp.clip(state.alpha + turn1, c.ALPHA_MIN, c.ALPHA_MAX), state.alpha)
    beta = jnp.where(active, jnp.clip(state.beta + turn2, c.BETA_MIN, c.BETA_MAX), state.beta)
    discs, sides = touch(state, alpha, beta, readings.object_radius)
    after = state._replace(alpha=alpha, beta=beta, discs=discs, sides=sides, y=y)
    is_target = jnp.arange(3) == inputs.target[:, None]  # [T, 3]
    collided = state.collided | active & ((sides != NONE) & ~is_target).any(-1)
    turned, side = alpha - state.alpha, jnp.where(is_target, sides, 0).sum(-1)
    good = _good(inputs.action, _offset(inputs, after), side, turned, readings)
    longer = state.run + jnp.where(inputs.action == MOVE, turned, 1.0)
    run = jnp.where(active, jnp.where(good, longer, 0.0), state.run)
    best, steps = jnp.maximum(state.best, jnp.abs(run)), state.steps + active
    goal = jnp.where(inputs.action == MOVE, readings.move_angle, c.GOOD_STEPS_FOR_SUCCESS)
    goes_on = ~collided & (best < goal - c.THRESHOLD_TOLERANCE) & (steps < c.MAX_STEPS)
    return after._replace(run=run, best=best, steps=steps, collided=collided, active=active & goes_on)


def _sigmoid(x):
    return 1.0 / (1.0 + jnp.exp(-x))


def _sense(inputs: Inputs, state: State):
    """I1 to I18, [P, T, 18]."""
    offset = bearing_of(state.discs) - state.alpha[..., None]
    inner, outer = c.MIDDLE_SECTOR_HALF_WIDTH, c.VIEW_HALF_WIDTH
    at_right, at_left = (
        (state.alpha <= c.ALPHA_MIN)[..., None],
        (state.alpha >= c.ALPHA_MAX)[..., None],
    )
    touched = jnp.stack([(state.sides == RIGHT).any(-1), (state.sides == LEFT).any(-1)], -1)
    seen = [
        (offset >= -outer) & (offset < -inner) | at_right,
        jnp.abs(offset) <= inner,
        (offset > inner) & (offset <= outer) | at_left,
    ]
    words = jnp.broadcast_to(inputs.words, (*state.alpha.shape, 6))
    return jnp.concatenate([touched, *seen, state.beta[..., None] / c.BETA_MAX, words], -1)


def _think(inputs: Inputs, values, y):
    """One Euler step of eq. 2."""
    s = _sigmoid(inputs.gain * values + inputs.input_bias)
    z = _sigmoid(y + inputs.inter_bias)
    return y + inputs.rate * (s @ inputs.sensory + z @ inputs.recurrent - y)


def _turns(inputs: Inputs, y, size):
    """The turns of eq. 3."""
    x = _sigmoid(y + inputs.inter_bias) @ inputs.motor + inputs.motor_bias
    return size * (x[..., 0] > 0) * -jnp.sign(x[..., 1]), size * (x[..., 2] > 0) * -jnp.sign(x[..., 3])


def _offset(inputs: Inputs, state: State):
    """Smaller angle between S1 and the target's bearing [deg], [P, T]."""
    chosen = inputs.target[:, None] == jnp.arange(3)
    away = jnp.abs(jnp.where(chosen, bearing_of(state.discs), 0.0).sum(-1) - state.alpha)
    return jnp.minimum(away, 360.0 - away)


def _good(action, offset, side, turned, readings: Readings):
    """Whether the step counts for F2 (spec section 8)."""
    near, seen = offset < readings.target_cone, offset <= c.VIEW_HALF_WIDTH
    pushes, free = near & (side == RIGHT), side == NONE
    good = jnp.where(action == MOVE, pushes, pushes & (turned == 0.0))
    return jnp.where(action == INDICATE, near & free, jnp.where(action == IGNORE, ~seen & free, good))


def _scores(inputs: Inputs, first, end: State, readings: Readings) -> tuple:
    """(f1, f2, f3, success, steps) at the end of the trials (spec section 8)."""
    offset, action = _offset(inputs, end), inputs.action
    seen, on_target = offset <= c.VIEW_HALF_WIDTH, offset < readings.target_cone
    penalty = jnp.where(end.collided, c.COLLISION_FACTOR, 1.0)
    nearer = jnp.where(first > 0.0, (first - offset) / jnp.where(first > 0.0, first, 1.0), 0.0)
    f1 = jnp.maximum(jnp.maximum(0.0, nearer * penalty), 1.0 * on_target)
    f1 = jnp.where(action == IGNORE, 1.0 * ~seen, f1)
    full = jnp.where(action == MOVE, readings.move_angle, c.GOOD_STEPS_FOR_SUCCESS)
    share = jnp.where(end.best >= full - c.THRESHOLD_TOLERANCE, 1.0, end.best / full)
    f2 = jnp.where(f1 == 1.0, share, 0.0)
    stretches = ((action == TOUCH) | (action == MOVE)) & seen
    f3 = jnp.where(stretches, 1.0 - end.beta / c.BETA_MAX, 0.0)
    return f1, f2, f3, (f1 == 1.0) & (f2 == 1.0), end.steps
