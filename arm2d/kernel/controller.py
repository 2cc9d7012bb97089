"""Sense, think and turn, for all lanes at once (spec sections 4 and 5)."""

from typing import NamedTuple

import numpy as np

from arm2d.arithmetic import sigmoid
from arm2d.compiling import compiled
from arm2d.constants import (
    ALPHA_MAX,
    ALPHA_MIN,
    BETA_MAX,
    BETA_MIN,
    DT,
    MIDDLE_SECTOR_HALF_WIDTH,
    N_INPUTS,
    N_MOTORS,
    VIEW_HALF_WIDTH,
)
from arm2d.kernel.lanes import (
    ALPHA,
    BEND,
    BETA,
    CAMERA,
    DRIVE,
    HIGH,
    LIMIT,
    LOW,
    N_LANES,
    NEAR,
    STEP,
    SUM,
    TOUCH,
    TURN,
    Floats,
    Integers,
    Y,
    Z,
)
from arm2d.kernel.network import Inter, Places, of_neuron, places_of, row_of, unsigned
from arm2d.kernel.world import beta_key

# Places of the inputs in spec section 4, from 0.
FIRST_CAMERA_INPUT = 2
BEND_INPUT = 11
OBJECT_WORD_INPUTS = 12
ACTION_WORD_INPUTS = 15

N_CAMERA_CODES = 512
# Up to so many inter-neurons, thinking lane after lane is faster (measured).
MOST_AT_ONCE = 8


class Drives(NamedTuple):
    """What each state of the inputs drives in a network's inter-neurons; rows of the length R of `row_of`.

    Attributes:
        touch: [4, R] by the code of I1, I2.
        camera: [512, R] by the code of I3..I11.
        bend: [N_BETA_KEYS, R] by the key of beta.
        words: [5, 4, R] by action and object; the last of each is none.
    """

    touch: Floats
    camera: Floats
    bend: Floats
    words: Floats


@compiled
def tabulate_drives(network: Floats, betas: Floats, codes: Integers, drives: Drives, inter: Inter) -> None:
    """Fill in what each state of each kind of input adds to the inter-neurons.

    Args:
        network: Its parameters in the order of the genes.
        betas: [B], the values of beta [deg].
        codes: [7, 3], the words' codes: three objects, then four actions.
        drives: `Drives` of this network.
        inter: As many zeros as it has inter-neurons.
    """
    count = len(inter)
    at: Places = places_of(inter)
    bias, gain = network[at.input_bias], network[at.gain]
    off, on = sigmoid(bias), sigmoid(gain + bias)
    weights = network[: N_INPUTS * count].reshape(N_INPUTS, count)
    for j in range(count):
        for code in range(4):
            drives.touch[code, j] = _sum_of_bits(weights, 0, 2, code, off, on, j)
        _tabulate_camera(weights, off, on, j, drives.camera)
        _tabulate_words(weights, off, on, j, codes, drives.words)
    for beta in betas:
        output = sigmoid(gain * (beta / BETA_MAX) + bias)
        for j in range(count):
            drives.bend[beta_key(beta), j] = weights[BEND_INPUT, j] * output


@compiled
def _tabulate_camera(weights: Floats, off: float, on: float, j: int, camera: Floats) -> None:
    """Fill in what each of the 512 codes of the three sectors drives in inter-neuron j."""
    sectors = np.empty((3, 8))
    for sector in range(3):
        for code in range(8):
            sectors[sector, code] = _sum_of_bits(
                weights, FIRST_CAMERA_INPUT + 3 * sector, 3, code, off, on, j
            )
    for left in range(8):
        for middle in range(8):
            for right in range(8):
                drive = sectors[0, right] + sectors[1, middle] + sectors[2, left]
                camera[64 * left + 8 * middle + right, j] = drive


@compiled(allocates=False)
def _tabulate_words(weights: Floats, off: float, on: float, j: int, codes: Integers, words: Floats) -> None:
    """Fill in what each instruction drives in inter-neuron j, object word first; no word is silence."""
    for action in range(5):
        for object_ in range(4):
            total = 0.0
            for i in range(3):
                heard = object_ < 3 and codes[object_, i] != 0
                total += weights[OBJECT_WORD_INPUTS + i, j] * (on if heard else off)
            for i in range(3):
                heard = action < 4 and codes[3 + action, i] != 0
                total += weights[ACTION_WORD_INPUTS + i, j] * (on if heard else off)
            words[action, object_, j] = total


@compiled(allocates=False)
def _sum_of_bits(weights: Floats, first: int, count: int, code: int, off: float, on: float, j: int) -> float:
    """Drive on inter-neuron j of `count` inputs from `first` on, whose values are the bits of `code`."""
    total = 0.0
    for i in range(count):
        total += weights[first + i, j] * (on if (code >> i) & 1 else off)
    return total


@compiled(allocates=False)
def sense_camera(s: Floats, n: Integers, lanes: int, right: float, left: float) -> None:
    """Set the nine camera bits of each lane; alpha at or beyond `right` or `left` [deg] sees white."""
    for i in range(lanes):
        alpha = s[ALPHA + i]
        blue = sector_bits(s[LOW + i] - alpha, s[HIGH + i] - alpha)
        green = sector_bits(s[LOW + N_LANES + i] - alpha, s[HIGH + N_LANES + i] - alpha)
        red = sector_bits(s[LOW + 2 * N_LANES + i] - alpha, s[HIGH + 2 * N_LANES + i] - alpha)
        n[CAMERA + i] = white_bits(alpha, right, left) | blue | green << 1 | red << 2


@compiled(allocates=False)
def white_bits(alpha: float, right: float, left: float) -> int:
    """All bits of the sectors that are white; alpha at or beyond `right` or `left` [deg] sees white."""
    return (0o007 if alpha <= right else 0) | (0o700 if alpha >= left else 0)


@compiled(allocates=False)
def sector_bits(low: float, high: float) -> int:
    """Bits 0, 3 and 6: the sectors that meet [low, high], bearings relative to the camera [deg]."""
    first = (low < -MIDDLE_SECTOR_HALF_WIDTH) & (high >= -VIEW_HALF_WIDTH)
    middle = (low <= MIDDLE_SECTOR_HALF_WIDTH) & (high >= -MIDDLE_SECTOR_HALF_WIDTH)
    last = (low <= VIEW_HALF_WIDTH) & (high > MIDDLE_SECTOR_HALF_WIDTH)
    return (0o001 if first else 0) | (0o010 if middle else 0) | (0o100 if last else 0)


@compiled(allocates=False)
def gather_drives(
    s: Floats, n: Integers, d: Floats, lanes: int, touch: Floats, camera: Floats, bend: Floats, inter: Inter
) -> None:
    """Add up what words, touch, camera and bend drive (eq. 1 and the first sum of eq. 2).

    Rows of the tables are read and added as vectors.
    """
    for i in range(unsigned(lanes)):
        t, code = unsigned(n[unsigned(TOUCH) + i]), unsigned(n[unsigned(CAMERA) + i])
        b, row = beta_key(s[unsigned(BETA) + i]), row_of(inter) * i
        for j in range(unsigned(len(inter))):
            s[of_neuron(DRIVE, j) + i] = d[row + j] + touch[t, j] + camera[code, j] + bend[b, j]


@compiled(allocates=False)
def think(s: Floats, lanes: int, network: Floats, inter: Inter) -> None:
    """Advance the inter-neurons by one Euler step (eq. 2), all of them from the old outputs."""
    if len(inter) <= MOST_AT_ONCE:
        _think_at_once(s, lanes, network, inter)
    else:
        _think_in_turn(s, lanes, network, inter)


@compiled(allocates=False)
def _think_at_once(s: Floats, lanes: int, network: Floats, inter: Inter) -> None:
    """Lane after lane, so that the compiler keeps all weights at hand."""
    count = unsigned(len(inter))
    at: Places = places_of(inter)
    for i in range(unsigned(lanes)):
        for j in range(count):
            total = network[at.recurrent + j] * s[unsigned(Z) + i]
            for k in range(unsigned(1), count):
                total += network[at.recurrent + count * k + j] * s[of_neuron(Z, k) + i]
            y = s[of_neuron(Y, j) + i]
            s[of_neuron(Y, j) + i] = y + DT / network[at.tau + j] * (s[of_neuron(DRIVE, j) + i] + total - y)
        for j in range(count):
            state: int = of_neuron(Y, j)
            s[of_neuron(Z, j) + i] = sigmoid(s[state + i] + network[at.inter_bias + j])


@compiled(allocates=False)
def _think_in_turn(s: Floats, lanes: int, network: Floats, inter: Inter) -> None:
    """The same neuron after neuron, for so many that a lane's loop would no longer become vectors."""
    count = unsigned(len(inter))
    at: Places = places_of(inter)
    for j in range(count):
        rate = DT / network[at.tau + j]
        for i in range(unsigned(lanes)):
            total = network[at.recurrent + j] * s[unsigned(Z) + i]
            for k in range(unsigned(1), count):
                total += network[at.recurrent + count * k + j] * s[of_neuron(Z, k) + i]
            s[unsigned(SUM) + i] = total
        for i in range(unsigned(lanes)):
            y = s[of_neuron(Y, j) + i]
            s[of_neuron(Y, j) + i] = y + rate * (s[of_neuron(DRIVE, j) + i] + s[unsigned(SUM) + i] - y)
    for j in range(count):
        bias = network[at.inter_bias + j]
        state: int = of_neuron(Y, j)
        for i in range(unsigned(lanes)):
            s[of_neuron(Z, j) + i] = sigmoid(s[state + i] + bias)


@compiled(allocates=False)
def turn(s: Floats, n: Integers, lanes: int, network: Floats, turn_size: float, inter: Inter) -> int:
    """Turn the joints as the motor neurons say (eq. 3).

    Only signs matter: f > 0.5 where the neuron's input is positive.

    Returns:
        In how many lanes S2 may meet a disc on its way; they are marked in NEAR.
    """
    at: Places = places_of(inter)
    motor, bias = at.motor, network[at.motor_bias]
    near = 0
    for i in range(unsigned(lanes)):
        z = s[unsigned(Z) + i]
        go1, way1 = network[motor] * z, network[motor + unsigned(1)] * z
        go2, way2 = network[motor + unsigned(2)] * z, network[motor + unsigned(3)] * z
        for j in range(unsigned(1), unsigned(len(inter))):
            z, of_j = s[of_neuron(Z, j) + i], motor + unsigned(N_MOTORS) * j
            go1 += network[of_j] * z
            way1 += network[of_j + unsigned(1)] * z
            go2 += network[of_j + unsigned(2)] * z
            way2 += network[of_j + unsigned(3)] * z
        alpha, beta = s[unsigned(ALPHA) + i], s[unsigned(BETA) + i]
        new_alpha = _turned(alpha, go1 + bias, way1 + bias, turn_size, ALPHA_MIN, ALPHA_MAX)
        new_beta = _turned(beta, go2 + bias, way2 + bias, turn_size, BETA_MIN, BETA_MAX)
        turned, bent = new_alpha - alpha, new_beta - beta
        s[unsigned(ALPHA) + i], s[unsigned(TURN) + i] = new_alpha, turned
        s[unsigned(BETA) + i], s[unsigned(BEND) + i] = new_beta, bent
        moved = (turned != 0.0) | (bent != 0.0) | (n[unsigned(STEP) + i] == 0)
        may_meet = 1 if (beta < s[unsigned(LIMIT) + i]) & moved else 0
        n[unsigned(NEAR) + i] = may_meet
        near += may_meet
    return near


@compiled(allocates=False)
def _turned(angle: float, go: float, way: float, size: float, low: float, high: float) -> float:
    """Give the angle [deg] after a turn, cut off at the joint's bounds; without a branch, for vectors."""
    turn = size if way < 0.0 else 0.0
    turn = -size if way > 0.0 else turn
    turn = turn if go > 0.0 else 0.0
    after = angle + turn
    after = after if after > low else low
    return after if after < high else high
