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
    N_INTER,
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
    ROW,
    STEP,
    TOUCH,
    TURN,
    Floats,
    Integers,
    Y,
    Z,
)
from arm2d.kernel.world import beta_key

# Places of the inputs in spec section 4, from 0.
FIRST_CAMERA_INPUT = 2
BEND_INPUT = 11
OBJECT_WORD_INPUTS = 12
ACTION_WORD_INPUTS = 15

# Where the parameters of one network stand; the order of the genes (spec section 6).
RECURRENT = 54
MOTOR = 63
TAU = 75
INPUT_BIAS = 78
INTER_BIAS = 79
MOTOR_BIAS = 82
GAIN = 83

N_CAMERA_CODES = 512


class Drives(NamedTuple):
    """What each state of the inputs drives in a network's inter-neurons; rows of three and a 0.

    Attributes:
        touch: [4, ROW] by the code of I1, I2.
        camera: [512, ROW] by the code of I3..I11.
        bend: [N_BETA_KEYS, ROW] by the key of beta.
        words: [5, 4, ROW] by action and object; the last of each is none.
    """

    touch: Floats
    camera: Floats
    bend: Floats
    words: Floats


@compiled
def tabulate_drives(network: Floats, betas: Floats, codes: Integers, drives: Drives) -> None:
    """Fill in what each state of each kind of input adds to the three inter-neurons.

    Args:
        network: [84] parameters in the order of the genes.
        betas: [B], the values of beta [deg].
        codes: [7, 3], the words' codes: three objects, then four actions.
        drives: `Drives` of this network.
    """
    bias, gain = network[INPUT_BIAS], network[GAIN]
    off, on = sigmoid(bias), sigmoid(gain + bias)
    weights = network[: N_INPUTS * N_INTER].reshape(N_INPUTS, N_INTER)
    for j in range(N_INTER):
        for code in range(4):
            drives.touch[code, j] = _sum_of_bits(weights, 0, 2, code, off, on, j)
        for beta in betas:
            output = sigmoid(gain * (beta / BETA_MAX) + bias)
            drives.bend[beta_key(beta), j] = weights[BEND_INPUT, j] * output
        _tabulate_camera(weights, off, on, j, drives.camera)
        _tabulate_words(weights, off, on, j, codes, drives.words)


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
    s: Floats, n: Integers, d: Floats, lanes: int, touch: Floats, camera: Floats, bend: Floats
) -> None:
    """Add up what words, touch, camera and bend drive (eq. 1 and the first sum of eq. 2).

    Rows of the tables are read and added as vectors.
    """
    for i in range(lanes):
        t, code, b = np.uint64(n[TOUCH + i]), np.uint64(n[CAMERA + i]), beta_key(s[BETA + i])
        row = ROW * i
        drive0 = d[row] + touch[t, 0] + camera[code, 0] + bend[b, 0]
        drive1 = d[row + 1] + touch[t, 1] + camera[code, 1] + bend[b, 1]
        drive2 = d[row + 2] + touch[t, 2] + camera[code, 2] + bend[b, 2]
        s[DRIVE + i], s[DRIVE + N_LANES + i], s[DRIVE + 2 * N_LANES + i] = drive0, drive1, drive2


@compiled(allocates=False)
def think(s: Floats, lanes: int, network: Floats) -> None:
    """Advance the inter-neurons by one Euler step (eq. 2)."""
    w00, w01, w02 = network[RECURRENT], network[RECURRENT + 1], network[RECURRENT + 2]
    w10, w11, w12 = network[RECURRENT + 3], network[RECURRENT + 4], network[RECURRENT + 5]
    w20, w21, w22 = network[RECURRENT + 6], network[RECURRENT + 7], network[RECURRENT + 8]
    rate0, rate1, rate2 = DT / network[TAU], DT / network[TAU + 1], DT / network[TAU + 2]
    bias0, bias1, bias2 = network[INTER_BIAS], network[INTER_BIAS + 1], network[INTER_BIAS + 2]
    for i in range(lanes):
        y0, y1, y2 = s[Y + i], s[Y + N_LANES + i], s[Y + 2 * N_LANES + i]
        z0, z1, z2 = s[Z + i], s[Z + N_LANES + i], s[Z + 2 * N_LANES + i]
        total0 = s[DRIVE + i] + (w00 * z0 + w10 * z1 + w20 * z2)
        total1 = s[DRIVE + N_LANES + i] + (w01 * z0 + w11 * z1 + w21 * z2)
        total2 = s[DRIVE + 2 * N_LANES + i] + (w02 * z0 + w12 * z1 + w22 * z2)
        y0 += rate0 * (total0 - y0)
        y1 += rate1 * (total1 - y1)
        y2 += rate2 * (total2 - y2)
        s[Y + i], s[Y + N_LANES + i], s[Y + 2 * N_LANES + i] = y0, y1, y2
        s[Z + i] = sigmoid(y0 + bias0)
        s[Z + N_LANES + i] = sigmoid(y1 + bias1)
        s[Z + 2 * N_LANES + i] = sigmoid(y2 + bias2)


@compiled(allocates=False)
def turn(s: Floats, n: Integers, lanes: int, network: Floats, turn_size: float) -> int:
    """Turn the joints as the motor neurons say (eq. 3).

    Only signs matter: f > 0.5 where the neuron's input is positive.

    Returns:
        In how many lanes S2 may meet a disc on its way; they are marked in NEAR.
    """
    bias = network[MOTOR_BIAS]
    go1_0, way1_0, go2_0, way2_0 = network[MOTOR], network[MOTOR + 1], network[MOTOR + 2], network[MOTOR + 3]
    go1_1, way1_1, go2_1, way2_1 = (
        network[MOTOR + 4],
        network[MOTOR + 5],
        network[MOTOR + 6],
        network[MOTOR + 7],
    )
    go1_2, way1_2, go2_2, way2_2 = (
        network[MOTOR + 8],
        network[MOTOR + 9],
        network[MOTOR + 10],
        network[MOTOR + 11],
    )
    near = 0
    for i in range(lanes):
        z0, z1, z2 = s[Z + i], s[Z + N_LANES + i], s[Z + 2 * N_LANES + i]
        go1 = go1_0 * z0 + go1_1 * z1 + go1_2 * z2 + bias
        way1 = way1_0 * z0 + way1_1 * z1 + way1_2 * z2 + bias
        go2 = go2_0 * z0 + go2_1 * z1 + go2_2 * z2 + bias
        way2 = way2_0 * z0 + way2_1 * z1 + way2_2 * z2 + bias
        alpha, beta = s[ALPHA + i], s[BETA + i]
        new_alpha = _turned(alpha, go1, way1, turn_size, ALPHA_MIN, ALPHA_MAX)
        new_beta = _turned(beta, go2, way2, turn_size, BETA_MIN, BETA_MAX)
        turned, bent = new_alpha - alpha, new_beta - beta
        s[ALPHA + i], s[TURN + i] = new_alpha, turned
        s[BETA + i], s[BEND + i] = new_beta, bent
        moved = (turned != 0.0) | (bent != 0.0) | (n[STEP + i] == 0)
        may_meet = 1 if (beta < s[LIMIT + i]) & moved else 0
        n[NEAR + i] = may_meet
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
