"""What each state of the inputs drives in a network's inter-neurons, tabulated before its trials.

As `arm2d.kernel.controller.Drives`, but for the camera, whose three sectors are added up step by step: tables
of many networks must stay small. The rows:

    0..3      touch, by the code of I1, I2
    4..27     camera, sector by sector, by the sector's three bits
    28..39    words, by action and object
    40..      bend, by the number of beta
"""

import warp as wp

from arm2d.device import numbers as c
from arm2d.device.arithmetic import sigmoid
from arm2d.kernel import controller as plain

FIRST_CAMERA_INPUT = wp.int32(plain.FIRST_CAMERA_INPUT)
BEND_INPUT = wp.int32(plain.BEND_INPUT)
OBJECT_WORD_INPUTS = wp.int32(plain.OBJECT_WORD_INPUTS)
ACTION_WORD_INPUTS = wp.int32(plain.ACTION_WORD_INPUTS)
INPUT_BIAS = wp.int32(c.GENES.input_bias)
GAIN = wp.int32(c.GENES.gain)
CAMERA_ROW = wp.int32(4)
WORD_ROW = wp.int32(28)
BEND_ROW = wp.int32(40)


@wp.func
def tabulated_drive(
    genes: wp.array2d[wp.float64],
    p: wp.int32,
    row: wp.int32,
    betas: wp.array2d[wp.float64],
    world: wp.int32,
    codes: wp.array2d[wp.int32],
) -> wp.vec3d:
    """What one row of the table of network p holds."""
    bias = genes[p, INPUT_BIAS]
    gain = genes[p, GAIN]
    off = sigmoid(bias)
    on = sigmoid(gain + bias)
    total = wp.vec3d()
    if row < CAMERA_ROW:
        for i in range(2):
            total = total + weighted(genes, p, i, (row >> i) & 1, off, on)
    elif row < WORD_ROW:
        sector = (row - CAMERA_ROW) // 8
        code = (row - CAMERA_ROW) % 8
        for i in range(3):
            total = total + weighted(genes, p, FIRST_CAMERA_INPUT + 3 * sector + i, (code >> i) & 1, off, on)
    elif row < BEND_ROW:
        action = (row - WORD_ROW) // 3
        target = (row - WORD_ROW) % 3
        for i in range(3):
            total = total + weighted(genes, p, OBJECT_WORD_INPUTS + i, codes[target, i], off, on)
        for i in range(3):
            total = total + weighted(genes, p, ACTION_WORD_INPUTS + i, codes[3 + action, i], off, on)
    else:
        output = sigmoid(gain * (betas[world, row - BEND_ROW] / c.BETA_MAX) + bias)
        total = three(genes, p, 3 * BEND_INPUT) * output
    return total


@wp.func
def weighted(
    genes: wp.array2d[wp.float64],
    p: wp.int32,
    i: wp.int32,
    bit: wp.int32,
    off: wp.float64,
    on: wp.float64,
) -> wp.vec3d:
    """What input i drives when it is on, or off."""
    output = off
    if bit != 0:
        output = on
    return three(genes, p, 3 * i) * output


@wp.func
def three(genes: wp.array2d[wp.float64], p: wp.int32, first: wp.int32) -> wp.vec3d:
    """Three parameters in a row."""
    return wp.vec3d(genes[p, first], genes[p, first + 1], genes[p, first + 2])
