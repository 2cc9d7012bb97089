"""How large a network is, for the compiled kernel: known when it is compiled, anew for each size.

A tuple's length is part of its type. `Inter` is a tuple as long as the network has inter-neurons; where its
length stands in a loop, Numba compiles the kernel for each length, and LLVM unrolls the loop. Lengths and
places are unsigned: of a place that could be negative Numba would ask whether it counts from an array's end,
which keeps LLVM from vectors.
"""

from typing import NamedTuple

import numpy as np

from arm2d.compiling import compiled
from arm2d.constants import N_INPUTS, N_MOTORS
from arm2d.kernel.lanes import NEURON

# As many zeros as the network has inter-neurons.
Inter = tuple[float, ...]


class Places(NamedTuple):
    """Where the parameters of a network stand: the first place of each kind, in the order of the genes."""

    recurrent: np.uint64
    motor: np.uint64
    tau: np.uint64
    input_bias: np.uint64
    inter_bias: np.uint64
    motor_bias: np.uint64
    gain: np.uint64


@compiled(allocates=False)
def places_of(inter: Inter) -> Places:
    """Where the parameters of a network stand (spec section 6)."""
    n = len(inter)
    recurrent = N_INPUTS * n
    motor = recurrent + n * n
    tau = motor + N_MOTORS * n
    input_bias = tau + n
    return Places(
        np.uint64(recurrent),
        np.uint64(motor),
        np.uint64(tau),
        np.uint64(input_bias),
        np.uint64(input_bias + 1),
        np.uint64(input_bias + 1 + n),
        np.uint64(input_bias + 2 + n),
    )


@compiled(allocates=False)
def row_of(inter: Inter) -> np.uint64:
    """Length of a row of drives: one for each inter-neuron, then zeros up to a multiple of four."""
    return np.uint64((len(inter) + 3) // 4 * 4)


@compiled(allocates=False)
def of_neuron(field: int, j: np.uint64) -> np.uint64:
    """Where a field of inter-neuron j begins."""
    return np.uint64(field) + np.uint64(NEURON) * j
