"""One trial in plain Python, straight from the specification: the definition of the world.

Slow and simple; the compiled kernel is tested against it. Only the controller shares more than words
with the kernel, the decoding of its genes, its `sigmoid` and the order of its sums: a recurrent network
can be chaotic, and would blow up a difference in the last bit to another behaviour.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import cache
from math import asin, copysign, degrees, hypot, sqrt
from typing import Final, Literal, NamedTuple

from numpy.typing import ArrayLike

from arm2d import constants as c
from arm2d.arithmetic import sigmoid
from arm2d.geometry import (
    Point,
    bearing_of,
    distance_from_end,
    from_s2,
    offset_from_end,
    offset_of,
    s2_pose,
    to_s2,
    turned,
)
from arm2d.instructions import ActionWord, Instruction
from arm2d.network.controller import decode
from arm2d.readings import Readings
from arm2d.tasks.hearing import bits_heard
from arm2d.tasks.task import Task

# Inputs summed group by group: touch; camera sectors 1, 2, 3; bend; words.
TOUCH, SECTORS, BEND, WORDS = range(2), (range(2, 5), range(5, 8), range(8, 11)), range(11, 12), range(12, 18)
# Whose words sound as in the paper: all of its, for INDICATE and IGNORE share a code there.
PAPERS: Final = Task()
# How much of a step has been made at the end of each sub-step.
SUB_STEPS: Final = tuple(k / c.SUB_STEPS for k in range(1, c.SUB_STEPS + 1))
RIGHT: Final = "right"
LEFT: Final = "left"

Side = Literal["right", "left"] | None


class Score(NamedTuple):
    """Outcome of one trial (section VI)."""

    f1: float
    f2: float
    f3: float
    success: bool
    steps: int


def run_trial(
    genotype: ArrayLike,
    instruction: Instruction,
    alpha: float,
    discs: Iterable[Iterable[float]],
    readings: Readings,
    changes: tuple[Instruction, Instruction, int] | None = None,
    task: Task = PAPERS,
) -> Score:
    """Carry out one trial (spec section 8) with a genotype, [84] or of a network of another size.

    S1 starts at `alpha` [deg], the blue, green and red disc at three (x, y) [cm]. A transition test's
    `changes` are (instruction heard first, instruction heard later, delay); scored is `instruction`. The task
    tells how words are said.
    """
    think = controller(genotype, readings)
    return carry_out(think, instruction, alpha, discs, readings, changes, task=task)


def carry_out(
    think: Callable[[Sequence[float]], tuple[float, float]],
    instruction: Instruction,
    alpha: float,
    discs: Iterable[Iterable[float]],
    readings: Readings,
    changes: tuple[Instruction, Instruction, int] | None = None,
    *,
    beta: float = c.BETA_MAX,
    most_steps: int = c.MAX_STEPS,
    task: Task = PAPERS,
) -> Score:
    """The same for whatever turns 18 inputs into the turns of S1 and S2; S2 starts at `beta` [deg]."""
    r, target = readings, instruction.object
    # Python's own numbers: the same bits as NumPy's in half the time.
    alpha, placed = float(alpha), [(float(x), float(y)) for x, y in discs]
    sides: list[Side] = [None, None, None]
    heard, later, delay = changes or (instruction, instruction, 0)
    countdown, run, best, stretch = None, 0.0, 0.0, 0.0
    full = goal(instruction.action, r)
    first_offset = offset = offset_of(alpha, placed[target])
    for step in range(1, most_steps + 1):
        turns = think(sense(alpha, beta, placed, sides, bits_heard(heard, task, step - 1), r))
        new_alpha, new_beta = turned(alpha, beta, turns)
        placed, sides = touch(alpha, beta, new_alpha, new_beta, placed, sides, r.object_radius)
        moved, alpha, beta = new_alpha - alpha, new_alpha, new_beta
        offset = offset_of(alpha, placed[target])
        in_view = sees(alpha, placed[target], r)
        if in_view:
            stretch = max(stretch, 1.0 - beta / c.BETA_MAX)
            countdown = delay + 1 if countdown is None else countdown
        if countdown is not None:
            countdown -= 1
            heard = later if countdown == 0 else heard
        collided = any(side for disc, side in enumerate(sides) if disc != target)
        if is_good(instruction.action, offset, in_view, sides[target], moved, r):
            run += moved if instruction.action is ActionWord.MOVE else 1.0
        elif r.run_counting == "uninterrupted":
            run = 0.0
        best = max(best, abs(run))
        if best >= full - c.THRESHOLD_TOLERANCE or collided:
            break
    return score(instruction.action, first_offset, offset, in_view, collided, best, beta, stretch, step, r)


def controller(genotype: ArrayLike, readings: Readings) -> Callable[[Sequence[float]], tuple[float, float]]:
    """The CTRNN as a function from 18 inputs to the turns of S1 and S2 (eq. 1 to 3)."""
    net = decode(genotype, readings)
    weights = net.sensory_weights, net.recurrent_weights, net.motor_weights
    sensory, recurrent, motor = (each[0].tolist() for each in weights)
    tau, bias = net.decay_constants[0].tolist(), net.inter_biases[0].tolist()
    input_bias, motor_bias, gain = float(net.input_bias[0]), float(net.motor_bias[0]), float(net.gain[0])
    inter, motors, size = range(len(tau)), range(c.N_MOTORS), readings.turn_size
    y = [0.0] * len(tau)
    z = [sigmoid(y[k] + bias[k]) for k in inter]

    @cache  # most inputs are 0 or 1
    def sensory_neuron(value: float) -> float:
        return sigmoid(gain * value + input_bias)  # eq. 1

    def drive(s: Sequence[float], j: int) -> float:
        touch, bend, words = (_dot(sensory, s, j, group) for group in (TOUCH, BEND, WORDS))
        right, middle, left = (_dot(sensory, s, j, sector) for sector in SECTORS)
        return words + touch + (right + middle + left) + bend

    @cache  # what is sensed is often what was sensed before
    def drives(inputs: tuple[float, ...]) -> list[float]:
        s = [sensory_neuron(value) for value in inputs]
        return [drive(s, j) for j in inter]

    def think(inputs: Sequence[float]) -> tuple[float, float]:
        driven = drives(tuple(inputs))
        for j in inter:
            y[j] += c.DT / tau[j] * (driven[j] + _dot(recurrent, z, j, inter) - y[j])  # eq. 2
        z[:] = [sigmoid(y[k] + bias[k]) for k in inter]
        f = [sigmoid(_dot(motor, z, m, inter) + motor_bias) for m in motors]  # eq. 3
        return _turn(f[0], f[1], size), _turn(f[2], f[3], size)

    return think


def _dot(
    weights: Sequence[Sequence[float]], values: Sequence[float], j: int, indices: Iterable[int]
) -> float:
    """Sum of weights[i][j] values[i] in this order; `sum` would round differently from Python 3.12 on."""
    total = 0.0
    for i in indices:
        total += weights[i][j] * values[i]
    return total


def _turn(go: float, way: float, size: float) -> float:
    """Size H(go - 0.5) sgn(0.5 - way)."""
    return 0.0 if go <= 0.5 or way == 0.5 else copysign(size, 0.5 - way)


def sense(
    alpha: float,
    beta: float,
    discs: Sequence[Point],
    sides: Sequence[Side],
    heard: Instruction | Sequence[int],
    r: Readings,
) -> list[float]:
    """I1 to I18 (spec section 4); heard is an instruction, said as in the paper, or what I13 to I18 are."""
    sectors = [[False] * 3 for _ in range(3)]
    for disc, centre in enumerate(discs):
        low, high = _seen_interval(alpha, centre, r)
        inner, outer = c.MIDDLE_SECTOR_HALF_WIDTH, c.VIEW_HALF_WIDTH
        sectors[0][disc] = low < -inner and high >= -outer
        sectors[1][disc] = low <= inner and high >= -inner
        sectors[2][disc] = low <= outer and high > inner
    blind = c.VIEW_HALF_WIDTH if r.bound_vision == "near" else 0.0
    if alpha <= c.ALPHA_MIN + blind:
        sectors[0] = [True] * 3
    if alpha >= c.ALPHA_MAX - blind:
        sectors[2] = [True] * 3
    touch = [RIGHT in sides, LEFT in sides]
    words = bits_heard(heard, PAPERS, 0) if isinstance(heard, Instruction) else heard
    return [*map(float, touch + sum(sectors, [])), beta / c.BETA_MAX, *map(float, words)]  # noqa: RUF017


def _seen_interval(alpha: float, centre: Point, r: Readings) -> tuple[float, float]:
    """From where to where the camera sees a disc, relative to its direction [deg]."""
    from_end = r.camera_origin == "end"
    offset = offset_from_end(alpha, centre) if from_end else bearing_of(centre) - alpha
    if r.object_vision == "centre":
        return offset, offset
    distance = distance_from_end(alpha, centre) if from_end else hypot(*centre)
    if distance <= r.object_radius:
        return -180.0, 180.0
    half = degrees(asin(r.object_radius / distance))
    return offset - half, offset + half


def sees(alpha: float, centre: Point, r: Readings) -> bool:
    """Whether a disc is in view: its centre lies in the camera's field."""
    offset = abs(offset_from_end(alpha, centre)) if r.camera_origin == "end" else offset_of(alpha, centre)
    return offset <= c.VIEW_HALF_WIDTH


def touch(
    alpha0: float,
    beta0: float,
    alpha1: float,
    beta1: float,
    discs: Sequence[Point],
    sides: Sequence[Side],
    radius: float,
) -> tuple[list[Point], list[Side]]:
    """Carry, push or leave every disc while the arm moves in four sub-steps (spec section 3)."""
    discs, sides = list(discs), list(sides)
    moved, bent = alpha1 - alpha0, beta1 - beta0
    hitting, touching = radius - c.PENETRATION_TOLERANCE, radius + c.TOUCH_TOLERANCE
    pose = s2_pose(alpha0, beta0)
    for part in SUB_STEPS:
        last = pose
        if moved or bent:
            pose = s2_pose(alpha0 + moved * part, beta0 + bent * part)
        for disc, centre in enumerate(discs):
            u, v = to_s2(pose, centre)
            beyond = 0.0 if 0.0 <= u <= c.S2_LENGTH else max(-u, u - c.S2_LENGTH)
            gap = hypot(beyond, v)
            if gap > touching:
                sides[disc] = None
            elif gap >= hitting:
                sides[disc] = RIGHT if v < 0.0 else LEFT
            elif sides[disc]:
                discs[disc] = from_s2(pose, *to_s2(last, centre))
            else:
                _, v0 = to_s2(last, centre)
                sides[disc] = RIGHT if v0 < 0.0 else LEFT
                v = sqrt(radius * radius - beyond * beyond)
                discs[disc] = from_s2(pose, u, -v if v0 < 0.0 else v)
    return discs, sides


def is_good(action: ActionWord, offset: float, in_view: bool, side: Side, turned: float, r: Readings) -> bool:
    """Whether the step counts for F2 (spec section 8)."""
    if action is ActionWord.INDICATE:
        return offset < r.indicate_cone and not side
    if action is ActionWord.TOUCH:
        return offset < r.target_cone and side == RIGHT and turned == 0.0
    if action is ActionWord.MOVE:
        return offset < r.target_cone and side == RIGHT
    return not in_view and not side


def goal(action: ActionWord, r: Readings) -> float:
    """The run of good steps, or of turns [deg], that ends the trial."""
    if action is ActionWord.IGNORE and r.ignore_stops == "never":
        return float("inf")
    return r.move_angle if action is ActionWord.MOVE else float(c.GOOD_STEPS_FOR_SUCCESS)


def score(
    action: ActionWord,
    first_offset: float,
    offset: float,
    in_view: bool,
    collided: bool,
    best: float,
    beta: float,
    stretch: float,
    steps: int,
    r: Readings,
) -> Score:
    """F1 to F3 at the end of the trial."""
    on_target = float(offset < r.target_cone)
    penalty = c.COLLISION_FACTOR if collided else 1.0
    ratio = (first_offset - offset) / first_offset if first_offset > 0.0 else 0.0
    if action is ActionWord.IGNORE:
        f1 = float(not in_view)
    elif r.collision_penalty == "whole":
        f1 = penalty * max(0.0, ratio, on_target)
    else:
        f1 = max(0.0, ratio * penalty, on_target)
    full = r.move_angle if action is ActionWord.MOVE else float(c.GOOD_STEPS_FOR_SUCCESS)
    share = 1.0 if best >= full - c.THRESHOLD_TOLERANCE else best / full
    f2 = share if f1 == 1.0 else 0.0
    stretches = action in (ActionWord.TOUCH, ActionWord.MOVE)
    at_end = 1.0 - beta / c.BETA_MAX if in_view else 0.0
    f3 = 0.0 if not stretches else stretch if r.f3_time == "best" else at_end
    strict = r.success == "f1_f2_f3" and stretches
    return Score(f1, f2, f3, f1 == f2 == 1.0 and (f3 > c.STRAIGHT or not strict), steps)
