"""From genes to the parameters of the controller, and back (section V; spec section 6).

The controller is a CTRNN of 18 sensory neurons, N inter-neurons (the paper: three) and 4 motor neurons. Axes:
P genotypes of G genes each (three: 84), which tell N by their number.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from arm2d.arithmetic import exp
from arm2d.compiling import compiled
from arm2d.constants import MOST_INTER, N_INPUTS, N_INTER, N_MOTORS
from arm2d.network.genes import SIZES, Genes, counted, genes_of, told
from arm2d.readings import Readings
from arm2d.records import alike

# What a gene of 0 and of 1 stands for.
SENSORY_WEIGHT_RANGE = (-8.0, 8.0)
INNER_WEIGHT_RANGE = (-10.0, 10.0)
TAU_EXPONENT_MIN = -1.0
INPUT_BIAS_RANGES = {"symmetric": (-4.0, 4.0), "negative": (-4.0, -2.0)}
INNER_BIAS_RANGE = (-5.0, 5.0)
GAIN_RANGE = (1.0, 13.0)

LN_10 = 2.302585092994046


@dataclass(frozen=True)
class Networks:
    """The phenotypes of P genotypes.

    Attributes:
        sensory_weights: [P, 18, N], `[p, i, j]` leads from sensory neuron i to inter-neuron j.
        recurrent_weights: [P, N, N], `[p, k, j]` leads from inter-neuron k to inter-neuron j.
        motor_weights: [P, N, 4], `[p, j, m]` leads from inter-neuron j to motor neuron m.
        decay_constants: [P, N], tau of the inter-neurons in [s].
        input_bias: [P], beta_I, shared by the sensory neurons.
        inter_biases: [P, N].
        motor_bias: [P], beta_O, shared by the motor neurons.
        gain: [P], g.
    """

    sensory_weights: NDArray[np.float64]
    recurrent_weights: NDArray[np.float64]
    motor_weights: NDArray[np.float64]
    decay_constants: NDArray[np.float64]
    input_bias: NDArray[np.float64]
    inter_biases: NDArray[np.float64]
    motor_bias: NDArray[np.float64]
    gain: NDArray[np.float64]

    __eq__ = alike

    def __repr__(self) -> str:
        return f"<Networks of {len(self.gain)} genotype{'s' * (len(self.gain) != 1)}>"


def check_genotypes(genotypes: ArrayLike, n_inter: int | None = None) -> NDArray[np.float64]:
    """The genotypes as a contiguous array [P, G]; a single one [G] is a batch of one.

    Args:
        genotypes: [P, G] or [G]; G is 84 for the paper's network of three inter-neurons.
        n_inter: How many inter-neurons the networks should have; by default 1 to 16, as the genes tell.

    Raises:
        ValueError: If the shape is another, or a gene is not a number in [0, 1].
    """
    array = np.ascontiguousarray(genotypes, dtype=np.float64)
    if array.ndim == 1:
        array = array[np.newaxis]
    found = SIZES.get(array.shape[1]) if array.ndim == 2 else None
    if found is None or n_inter not in (None, found):
        raise ValueError(_other_size(np.shape(genotypes), found, n_inter))
    valid = (array >= 0.0) & (array <= 1.0)  # False for NaN
    if not valid.all():
        genotype, gene = np.argwhere(~valid)[0]
        raise ValueError(
            f"gene {gene} of genotype {genotype} is {array[genotype, gene]:g}; genes lie in [0, 1]"
        )
    return array


def _other_size(shape: tuple[int, ...], found: int | None, n_inter: int | None) -> str:
    """Why genotypes of this shape are refused."""
    right = n_inter or N_INTER
    needs = f"needs [P, {genes_of(right).count}]: {told(right)}"
    if n_inter is None:
        least, most = genes_of(1).count, genes_of(MOST_INTER).count
        others = f"1 to {MOST_INTER} inter-neurons take {least} to {most} genes"
        return f"genotypes have shape {shape}, this controller {needs}; {others}"
    have = f", of {counted(found)}" if found else ""
    return f"genotypes have shape {shape}{have}; a controller of {counted(right)} {needs}"


def decode(genotypes: ArrayLike, readings: Readings) -> Networks:
    """The parameters that the genotypes [P, G] stand for, under these readings.

    Raises:
        ValueError: As `check_genotypes`.
    """
    flat = decode_flat(genotypes, readings)
    n, inter = len(flat), n_inter_of(flat)
    genes = genes_of(inter)
    return Networks(
        sensory_weights=flat[:, genes.sensory].reshape(n, N_INPUTS, inter),
        recurrent_weights=flat[:, genes.recurrent].reshape(n, inter, inter),
        motor_weights=flat[:, genes.motor].reshape(n, inter, N_MOTORS),
        decay_constants=flat[:, genes.tau],
        input_bias=flat[:, genes.input_bias],
        inter_biases=flat[:, genes.inter_bias],
        motor_bias=flat[:, genes.motor_bias],
        gain=flat[:, genes.gain],
    )


def decode_flat(genotypes: ArrayLike, readings: Readings) -> NDArray[np.float64]:
    """The same parameters in the order of their genes, [P, G]."""
    checked = check_genotypes(genotypes)
    genes = genes_of(n_inter_of(checked))
    low, high = _ranges(genes, readings)
    flat = low + (high - low) * checked
    _raise_ten_to(flat[:, genes.tau])
    return flat


def encode(networks: Networks, readings: Readings) -> NDArray[np.float64]:
    """The genotypes [P, G] that decode to these networks, up to rounding.

    Raises:
        ValueError: If a parameter lies outside its gene's range.
    """
    n, inter = networks.decay_constants.shape
    low, high = _ranges(genes_of(inter), readings)
    flat = np.concatenate(
        [
            networks.sensory_weights.reshape(n, N_INPUTS * inter),
            networks.recurrent_weights.reshape(n, inter * inter),
            networks.motor_weights.reshape(n, inter * N_MOTORS),
            np.log10(networks.decay_constants),
            networks.input_bias[:, np.newaxis],
            networks.inter_biases,
            networks.motor_bias[:, np.newaxis],
            networks.gain[:, np.newaxis],
        ],
        axis=1,
    )
    genes = (flat - low) / (high - low)
    # Rounding may carry a gene past its bound by a few ulp; anything further is the caller's mistake.
    clipped = np.clip(genes, 0.0, 1.0)
    return check_genotypes(np.where(np.abs(genes - clipped) < 1e-12, clipped, genes))


def n_inter_of(checked: NDArray[np.float64]) -> int:
    """How many inter-neurons the networks of checked genotypes [P, G] have."""
    return SIZES[checked.shape[1]]


def _ranges(genes: Genes, readings: Readings) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """What a gene of 0 and of 1 stands for, [G] each; for tau the exponent of 10."""
    ranges = np.empty((genes.count, 2))
    ranges[genes.sensory] = SENSORY_WEIGHT_RANGE
    ranges[genes.recurrent] = INNER_WEIGHT_RANGE
    ranges[genes.motor] = INNER_WEIGHT_RANGE
    ranges[genes.tau] = TAU_EXPONENT_MIN, readings.tau_exponent_max
    ranges[genes.input_bias] = INPUT_BIAS_RANGES[readings.bias_ranges]
    ranges[genes.inter_bias] = INNER_BIAS_RANGE
    ranges[genes.motor_bias] = INNER_BIAS_RANGE
    ranges[genes.gain] = GAIN_RANGE
    return ranges[:, 0], ranges[:, 1]


@compiled
def _raise_ten_to(exponents: NDArray[np.float64]) -> None:
    """Replace each x in [P, N] by 10**x, with the same bits on every machine."""
    for p in range(exponents.shape[0]):
        for j in range(exponents.shape[1]):
            exponents[p, j] = exp(LN_10 * exponents[p, j])
