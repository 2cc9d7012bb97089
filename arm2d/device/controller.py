"""Sense, think and turn (spec sections 4 and 5): `arm2d.kernel.controller` for one trial."""

import warp as wp

from arm2d.device import numbers as c
from arm2d.device.arithmetic import sigmoid
from arm2d.device.drives import BEND_ROW, CAMERA_ROW, WORD_ROW, three
from arm2d.device.lanes import Lane
from arm2d.device.world import Tables, World, key_of_beta

RECURRENT = wp.int32(c.GENES.recurrent.start)
MOTOR = wp.int32(c.GENES.motor.start)
TAU = wp.int32(c.GENES.tau.start)
INTER_BIAS = wp.int32(c.GENES.inter_bias.start)
MOTOR_BIAS = wp.int32(c.GENES.motor_bias)


@wp.struct
class Network:
    """Parameters of one network as `think` and `turn_joints` take them.

    Attributes:
        from_0: What the first inter-neuron's output adds to the three, and
        from_1: the second's and
        from_2: the third's.
        rate: dt / tau.
        bias: Of the inter-neurons.
        motor_0: What the first adds to the four motor neurons, and
        motor_1: the second and
        motor_2: the third.
        motor_bias: Of all four.
    """

    from_0: wp.vec3d
    from_1: wp.vec3d
    from_2: wp.vec3d
    rate: wp.vec3d
    bias: wp.vec3d
    motor_0: wp.vec4d
    motor_1: wp.vec4d
    motor_2: wp.vec4d
    motor_bias: wp.float64


@wp.func
def network_of(genes: wp.array2d[wp.float64], p: wp.int32) -> Network:
    """The parameters of network p."""
    network = Network()
    network.from_0 = three(genes, p, RECURRENT)
    network.from_1 = three(genes, p, RECURRENT + 3)
    network.from_2 = three(genes, p, RECURRENT + 6)
    tau = three(genes, p, TAU)
    network.rate = wp.vec3d(c.DT / tau[0], c.DT / tau[1], c.DT / tau[2])
    network.bias = three(genes, p, INTER_BIAS)
    network.motor_0 = four(genes, p, MOTOR)
    network.motor_1 = four(genes, p, MOTOR + 4)
    network.motor_2 = four(genes, p, MOTOR + 8)
    network.motor_bias = genes[p, MOTOR_BIAS]
    return network


@wp.func
def four(genes: wp.array2d[wp.float64], p: wp.int32, first: wp.int32) -> wp.vec4d:
    """Four parameters in a row."""
    return wp.vec4d(genes[p, first], genes[p, first + 1], genes[p, first + 2], genes[p, first + 3])


@wp.func
def sense_camera(lane: Lane, world: World) -> Lane:
    """Set the nine camera bits."""
    blue = sector_bits(lane.low[0] - lane.alpha, lane.high[0] - lane.alpha)
    green = sector_bits(lane.low[1] - lane.alpha, lane.high[1] - lane.alpha)
    red = sector_bits(lane.low[2] - lane.alpha, lane.high[2] - lane.alpha)
    lane.camera = white_bits(lane.alpha, world) | blue | (green << 1) | (red << 2)
    return lane


@wp.func
def white_bits(alpha: wp.float64, world: World) -> wp.int32:
    """All bits of the sectors that are white."""
    bits = wp.int32(0)
    if alpha <= world.white_right:
        bits = bits | 7
    if alpha >= world.white_left:
        bits = bits | 448
    return bits


@wp.func
def sector_bits(low: wp.float64, high: wp.float64) -> wp.int32:
    """Bits 0, 3 and 6: the sectors that meet [low, high], bearings relative to the camera [deg]."""
    bits = wp.int32(0)
    if low < -c.MIDDLE and high >= -c.VIEW:
        bits = bits | 1
    if low <= c.MIDDLE and high >= -c.MIDDLE:
        bits = bits | 8
    if low <= c.VIEW and high > c.MIDDLE:
        bits = bits | 64
    return bits


@wp.func
def hear(lane: Lane, drives: wp.array2d[wp.vec3d], p: wp.int32, action: wp.int32, target: wp.int32) -> Lane:
    """Let an instruction be heard from now on."""
    lane.words = drives[p, WORD_ROW + 3 * action + target]
    return lane


@wp.func
def think(
    lane: Lane,
    network: Network,
    drives: wp.array2d[wp.vec3d],
    p: wp.int32,
    world: World,
    tables: Tables,
) -> Lane:
    """Advance the inter-neurons by one Euler step (eq. 1 and 2)."""
    code = lane.camera
    camera = (
        drives[p, CAMERA_ROW + (code & 7)]
        + drives[p, CAMERA_ROW + 8 + ((code >> 3) & 7)]
        + drives[p, CAMERA_ROW + 16 + (code >> 6)]
    )
    number = tables.beta_numbers[world.row, key_of_beta(lane.beta)]
    drive = lane.words + drives[p, lane.touch] + camera + drives[p, BEND_ROW + number]
    recurrent = network.from_0 * lane.z[0] + network.from_1 * lane.z[1] + network.from_2 * lane.z[2]
    change = drive + recurrent - lane.y
    lane.y = lane.y + wp.cw_mul(network.rate, change)
    lane.z = outputs(lane.y + network.bias)
    return lane


@wp.func
def outputs(x: wp.vec3d) -> wp.vec3d:
    """Sigmoids of the three inter-neurons."""
    return wp.vec3d(sigmoid(x[0]), sigmoid(x[1]), sigmoid(x[2]))


@wp.func
def turn_joints(lane: Lane, network: Network, world: World) -> Lane:
    """Turn the joints as the motor neurons say (eq. 3), and note whether S2 may meet a disc on its way."""
    motor = network.motor_0 * lane.z[0] + network.motor_1 * lane.z[1] + network.motor_2 * lane.z[2]
    bias = network.motor_bias
    alpha = turned(lane.alpha, motor[0] + bias, motor[1] + bias, world.turn, c.ALPHA_MIN, c.ALPHA_MAX)
    beta = turned(lane.beta, motor[2] + bias, motor[3] + bias, world.turn, c.BETA_MIN, c.BETA_MAX)
    lane.turn = alpha - lane.alpha
    lane.bend = beta - lane.beta
    lane.near = 0
    if lane.beta < lane.limit and (lane.turn != c.ZERO or lane.bend != c.ZERO or lane.step == 0):
        lane.near = 1
    lane.alpha = alpha
    lane.beta = beta
    return lane


@wp.func
def turned(
    angle: wp.float64, go: wp.float64, way: wp.float64, size: wp.float64, low: wp.float64, high: wp.float64
) -> wp.float64:
    """Give the angle [deg] after a turn, cut off at the joint's bounds."""
    after = angle
    if go > c.ZERO and way < c.ZERO:
        after = angle + size
    if go > c.ZERO and way > c.ZERO:
        after = angle - size
    if not after > low:
        after = low
    if not after < high:
        after = high
    return after
