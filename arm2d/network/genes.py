"""Which genes stand for which parameter, in a network of any size (spec section 6).

N inter-neurons have 18 N + N N + 4 N weights, N decay constants and N biases; the sensory neurons share a
bias and a gain, the motor neurons a bias. Three make 84. The number of genes tells how many inter-neurons
there are.
"""

from __future__ import annotations

from functools import cache
from typing import Final, NamedTuple

from arm2d.constants import MOST_INTER, N_INPUTS, N_MOTORS


class Genes(NamedTuple):
    """Where each parameter stands among the genes of a network.

    Attributes:
        sensory: Weights from sensory neurons to inter-neurons,
        recurrent: from inter-neurons to inter-neurons,
        motor: from inter-neurons to motor neurons.
        tau: Decay constants of the inter-neurons.
        input_bias: Bias of the sensory neurons,
        inter_bias: of each inter-neuron,
        motor_bias: of the motor neurons.
        gain: Of the sensory neurons.
        count: How many genes there are.
    """

    sensory: slice
    recurrent: slice
    motor: slice
    tau: slice
    input_bias: int
    inter_bias: slice
    motor_bias: int
    gain: int
    count: int


@cache
def genes_of(n_inter: int) -> Genes:
    """The genes of a network of so many inter-neurons."""
    recurrent = N_INPUTS * n_inter
    motor = recurrent + n_inter * n_inter
    tau = motor + n_inter * N_MOTORS
    input_bias = tau + n_inter
    motor_bias = input_bias + 1 + n_inter
    return Genes(
        sensory=slice(0, recurrent),
        recurrent=slice(recurrent, motor),
        motor=slice(motor, tau),
        tau=slice(tau, input_bias),
        input_bias=input_bias,
        inter_bias=slice(input_bias + 1, motor_bias),
        motor_bias=motor_bias,
        gain=motor_bias + 1,
        count=motor_bias + 2,
    )


# How many inter-neurons a network has, by the number of its genes.
SIZES: Final = {genes_of(n).count: n for n in range(1, MOST_INTER + 1)}


NUMBERS: Final = (
    "one", "two", "three", "four", "five", "six", "seven", "eight",
    "nine", "ten", "eleven", "twelve", "thirteen", "fourteen", "fifteen", "sixteen",
)  # fmt: skip


def counted(n_inter: int) -> str:
    """So many inter-neurons in words, such as "three inter-neurons"."""
    return f"{NUMBERS[n_inter - 1]} inter-neuron{'s' * (n_inter != 1)}"


def told(n_inter: int) -> str:
    """What a network of so many inter-neurons is made of, for people."""
    weights = genes_of(n_inter).tau.start
    return (
        f"{weights} weights, {n_inter} decay constant{'s' * (n_inter != 1)}, "
        f"{n_inter + 2} biases and 1 gain each"
    )
