"""How large a network is, for the compiled kernel: known when it is compiled, anew for each size.

A tuple's length is part of its type. `Inter` is a tuple as long as the network has inter-neurons; where its
length stands in a loop, Numba compiles the kernel for each length, and LLVM unrolls the loop. Lengths and
places are `unsigned`: of a place that could be negative Numba would ask whether it counts from an array's
end, which keeps LLVM from vectors.
"""

from typing import NamedTuple

import numpy as np

from arm2d.compiling import compiled
from arm2d.constants import N_INPUTS, N_MOTORS
from arm2d.kernel.lanes import NEURON

# As many zeros as the network has inter-neurons.
Inter = tuple[float, ...]


@compiled(allocates=False)
def unsigned(number: int) -> int:
    """A number that cannot be negative, as one that is known not to be."""
    return np.uint64(number)  # type: ignore[return-value] - a whole number for whoever reads


class Places(NamedTuple):
    """Where the parameters of a network stand: the first place of each kind, in the order of the genes."""

    recurrent: int
    motor: int
    tau: int
    input_bias: int
    inter_bias: int
    motor_bias: int
    gain: int


@compiled(allocates=False)
def places_of(inter: Inter) -> Places:
    """Where the parameters of a network stand (spec section 6)."""
    n = len(inter)
    recurrent = N_INPUTS * n
    motor = recurrent + n * n
    tau = motor + N_MOTORS * n
    input_bias = tau + n
    return Places(
        unsigned(recurrent),
        unsigned(motor),
        unsigned(tau),
        unsigned(input_bias),
        unsigned(input_bias + 1),
        unsigned(input_bias + 1 + n),
        unsigned(input_bias + 2 + n),
    )


@compiled(allocates=False)
def row_of(inter: Inter) -> int:
    """Length of a row of drives: one for each inter-neuron, then zeros up to a multiple of four."""
    return unsigned((len(inter) + 3) // 4 * 4)


@compiled(allocates=False)
def of_neuron(field: int, j: int) -> int:
    """Where a field of inter-neuron j begins."""
    return unsigned(field) + unsigned(NEURON) * j
