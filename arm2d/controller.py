"""From genes to the parameters of the controller, and back (section V; spec section 6).

The controller is a CTRNN of 18 sensory neurons, 3 inter-neurons and 4 motor neurons. Axes:
P genotypes, 84 genes each.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from arm2d.arithmetic import exp
from arm2d.compiling import compiled
from arm2d.constants import N_GENES, N_INPUTS, N_INTER, N_MOTORS
from arm2d.readings import Readings

# Where each parameter stands among the genes.
SENSORY_GENES = slice(0, 54)
RECURRENT_GENES = slice(54, 63)
MOTOR_GENES = slice(63, 75)
TAU_GENES = slice(75, 78)
INPUT_BIAS_GENE = 78
INTER_BIAS_GENES = slice(79, 82)
MOTOR_BIAS_GENE = 82
GAIN_GENE = 83

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
        sensory_weights: [P, 18, 3], `[p, i, j]` leads from sensory neuron i to inter-neuron j.
        recurrent_weights: [P, 3, 3], `[p, k, j]` leads from inter-neuron k to inter-neuron j.
        motor_weights: [P, 3, 4], `[p, j, m]` leads from inter-neuron j to motor neuron m.
        decay_constants: [P, 3], tau of the inter-neurons in [s].
        input_bias: [P], beta_I, shared by the sensory neurons.
        inter_biases: [P, 3].
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

    def __repr__(self) -> str:
        return f"<Networks of {len(self.gain)} genotype{'s' * (len(self.gain) != 1)}>"


def check_genotypes(genotypes: ArrayLike) -> NDArray[np.float64]:
    """The genotypes as a contiguous array [P, 84]; a single one [84] is a batch of one.

    Raises:
        ValueError: If the shape is another, or a gene is not a number in [0, 1].
    """
    array = np.ascontiguousarray(genotypes, dtype=np.float64)
    if array.ndim == 1:
        array = array[np.newaxis]
    if array.ndim != 2 or array.shape[1] != N_GENES:
        raise ValueError(
            f"genotypes have shape {np.shape(genotypes)}, this controller needs [P, {N_GENES}]: "
            "75 weights, 3 decay constants, 5 biases and 1 gain each"
        )
    valid = (array >= 0.0) & (array <= 1.0)  # False for NaN
    if not valid.all():
        genotype, gene = np.argwhere(~valid)[0]
        raise ValueError(
            f"gene {gene} of genotype {genotype} is {array[genotype, gene]:g}; genes lie in [0, 1]"
        )
    return array


def decode(genotypes: ArrayLike, readings: Readings) -> Networks:
    """The parameters that the genotypes [P, 84] stand for, under these readings.

    Raises:
        ValueError: As `check_genotypes`.
    """
    flat = decode_flat(genotypes, readings)
    n = len(flat)
    return Networks(
        sensory_weights=flat[:, SENSORY_GENES].reshape(n, N_INPUTS, N_INTER),
        recurrent_weights=flat[:, RECURRENT_GENES].reshape(n, N_INTER, N_INTER),
        motor_weights=flat[:, MOTOR_GENES].reshape(n, N_INTER, N_MOTORS),
        decay_constants=flat[:, TAU_GENES],
        input_bias=flat[:, INPUT_BIAS_GENE],
        inter_biases=flat[:, INTER_BIAS_GENES],
        motor_bias=flat[:, MOTOR_BIAS_GENE],
        gain=flat[:, GAIN_GENE],
    )


def decode_flat(genotypes: ArrayLike, readings: Readings) -> NDArray[np.float64]:
    """The same parameters in the order of their genes, [P, 84]."""
    low, high = _ranges(readings)
    flat = low + (high - low) * check_genotypes(genotypes)
    _raise_ten_to(flat[:, TAU_GENES])
    return flat


def encode(networks: Networks, readings: Readings) -> NDArray[np.float64]:
    """The genotypes [P, 84] that decode to these networks, up to rounding.

    Raises:
        ValueError: If a parameter lies outside its gene's range.
    """
    low, high = _ranges(readings)
    flat = np.concatenate(
        [
            networks.sensory_weights.reshape(-1, N_INPUTS * N_INTER),
            networks.recurrent_weights.reshape(-1, N_INTER * N_INTER),
            networks.motor_weights.reshape(-1, N_INTER * N_MOTORS),
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


def _ranges(readings: Readings) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """What a gene of 0 and of 1 stands for, [84] each; for tau the exponent of 10."""
    ranges = np.empty((N_GENES, 2))
    ranges[SENSORY_GENES] = SENSORY_WEIGHT_RANGE
    ranges[RECURRENT_GENES] = INNER_WEIGHT_RANGE
    ranges[MOTOR_GENES] = INNER_WEIGHT_RANGE
    ranges[TAU_GENES] = TAU_EXPONENT_MIN, readings.tau_exponent_max
    ranges[INPUT_BIAS_GENE] = INPUT_BIAS_RANGES[readings.bias_ranges]
    ranges[INTER_BIAS_GENES] = INNER_BIAS_RANGE
    ranges[MOTOR_BIAS_GENE] = INNER_BIAS_RANGE
    ranges[GAIN_GENE] = GAIN_RANGE
    return ranges[:, 0], ranges[:, 1]


@compiled
def _raise_ten_to(exponents: NDArray[np.float64]) -> None:
    """Replace each x in [P, 3] by 10**x, with the same bits on every machine."""
    for p in range(exponents.shape[0]):
        for j in range(exponents.shape[1]):
            exponents[p, j] = exp(LN_10 * exponents[p, j])
