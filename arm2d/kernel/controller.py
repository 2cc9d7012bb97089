"""Sense, think and turn, for all lanes at once (spec sections 4 and 5)."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

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
        words: [4, 3, ROW] by action and object.
    """

    touch: NDArray[np.float64]
    camera: NDArray[np.float64]
    bend: NDArray[np.float64]
    words: NDArray[np.float64]


@compiled
def tabulate_drives(network, betas, codes, drives):
    """Fill in what each state of each kind of input adds to the three inter-neurons.

    Args:
        network: [84] parameters in the order of the genes.
        betas: [B], the values of beta [deg].
        codes: [7, 3], the words' codes: three objects, then four actions.
        drives: `Drives` of this network.
    """
    touch, camera, bend, words = drives
    bias, gain = network[INPUT_BIAS], network[GAIN]
    off, on = sigmoid(bias), sigmoid(gain + bias)
    weights = network[: N_INPUTS * N_INTER].reshape(N_INPUTS, N_INTER)
    sectors = np.empty((3, 8, N_INTER))
    for j in range(N_INTER):
        for code in range(4):
            touch[code, j] = _sum_of_bits(weights, 0, 2, code, off, on, j)
        for sector in range(3):
            for code in range(8):
                first = FIRST_CAMERA_INPUT + 3 * sector
                sectors[sector, code, j] = _sum_of_bits(weights, first, 3, code, off, on, j)
        for beta in betas:
            bend[beta_key(beta), j] = weights[BEND_INPUT, j] * sigmoid(gain * (beta / BETA_MAX) + bias)
        for action in range(4):
            for object_ in range(3):
                total = 0.0
                for i in range(3):
                    total += weights[OBJECT_WORD_INPUTS + i, j] * (on if codes[object_, i] else off)
                for i in range(3):
                    total += weights[ACTION_WORD_INPUTS + i, j] * (on if codes[3 + action, i] else off)
                words[action, object_, j] = total
    for left in range(8):
        for middle in range(8):
            for right in range(8):
                for j in range(N_INTER):
                    camera[64 * left + 8 * middle + right, j] = (
                        sectors[0, right, j] + sectors[1, middle, j] + sectors[2, left, j]
                    )


@compiled(allocates=False)
def _sum_of_bits(weights, first, count, code, off, on, j):
    """Drive on inter-neuron j of `count` inputs from `first` on, whose values are the bits of `code`."""
    total = 0.0
    for i in range(count):
        total += weights[first + i, j] * (on if (code >> i) & 1 else off)
    return total


@compiled(allocates=False)
def sense_camera(s, n, lanes, right, left):
    """Set the nine camera bits of each lane; alpha at or beyond `right` or `left` [deg] sees white."""
    for i in range(lanes):
        alpha = s[ALPHA + i]
        blue = _sector_bits(s[LOW + i] - alpha, s[HIGH + i] - alpha)
        green = _sector_bits(s[LOW + N_LANES + i] - alpha, s[HIGH + N_LANES + i] - alpha)
        red = _sector_bits(s[LOW + 2 * N_LANES + i] - alpha, s[HIGH + 2 * N_LANES + i] - alpha)
        white = (0o007 if alpha <= right else 0) | (0o700 if alpha >= left else 0)
        n[CAMERA + i] = white | blue | green << 1 | red << 2


@compiled(allocates=False)
def _sector_bits(low, high):
    """Bits 0, 3 and 6: the sectors that meet [low, high], bearings relative to the camera [deg]."""
    first = (low < -MIDDLE_SECTOR_HALF_WIDTH) & (high >= -VIEW_HALF_WIDTH)
    middle = (low <= MIDDLE_SECTOR_HALF_WIDTH) & (high >= -MIDDLE_SECTOR_HALF_WIDTH)
    last = (low <= VIEW_HALF_WIDTH) & (high > MIDDLE_SECTOR_HALF_WIDTH)
    return (0o001 if first else 0) | (0o010 if middle else 0) | (0o100 if last else 0)


@compiled(allocates=False)
def gather_drives(s, n, d, lanes, touch, camera, bend):
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
def think(s, lanes, network):
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
def turn(s, n, lanes, network, turn_size):
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
        turn1 = turn_size if way1 < 0.0 else 0.0
        turn1 = -turn_size if way1 > 0.0 else turn1
        turn1 = turn1 if go1 > 0.0 else 0.0
        alpha = s[ALPHA + i]
        after = alpha + turn1
        after = after if after > ALPHA_MIN else ALPHA_MIN
        after = after if after < ALPHA_MAX else ALPHA_MAX
        turned = after - alpha
        s[ALPHA + i] = after
        s[TURN + i] = turned
        turn2 = turn_size if way2 < 0.0 else 0.0
        turn2 = -turn_size if way2 > 0.0 else turn2
        turn2 = turn2 if go2 > 0.0 else 0.0
        beta = s[BETA + i]
        after = beta + turn2
        after = after if after > BETA_MIN else BETA_MIN
        after = after if after < BETA_MAX else BETA_MAX
        bent = after - beta
        s[BETA + i] = after
        s[BEND + i] = bent
        moved = (turned != 0.0) | (bent != 0.0) | (n[STEP + i] == 0)
        may_meet = 1 if (beta < s[LIMIT + i]) & moved else 0
        n[NEAR + i] = may_meet
        near += may_meet
    return near
