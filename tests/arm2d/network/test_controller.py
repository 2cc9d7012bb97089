"""Genes and parameters (spec section 6)."""

from dataclasses import fields, replace

import numpy as np
import pytest

from arm2d import Networks, check_genotypes, decode, encode
from arm2d.readings import PLAIN


def test_genes_at_the_bounds_give_the_printed_ranges():
    low, high = (decode(np.full(84, value), PLAIN) for value in (0.0, 1.0))
    for name, bounds in {
        "sensory_weights": (-8, 8),
        "recurrent_weights": (-10, 10),
        "motor_weights": (-10, 10),
        "decay_constants": (0.1, 100),
        "input_bias": (-4, 4),
        "inter_biases": (-5, 5),
        "motor_bias": (-5, 5),
        "gain": (1, 13),
    }.items():
        np.testing.assert_allclose(getattr(low, name), bounds[0], rtol=1e-14)
        np.testing.assert_allclose(getattr(high, name), bounds[1], rtol=1e-14)


def test_each_gene_moves_exactly_one_parameter():
    base = np.full(84, 0.5)
    moved = np.repeat(base[np.newaxis], 84, axis=0)
    np.fill_diagonal(moved, 0.75)
    before, after = decode(base, PLAIN), decode(moved, PLAIN)
    changes = sum(
        (getattr(after, name).reshape(84, -1) != getattr(before, name).reshape(1, -1)).sum(axis=1)
        for name in before.__dataclass_fields__
    )
    np.testing.assert_array_equal(changes, 1)


def test_gene_order_is_sensory_neuron_by_sensory_neuron():
    genotype = np.full(84, 0.5)
    genotype[3 * 7 + 2] = 1.0  # from sensory neuron 7 to inter-neuron 2
    genotype[54 + 3 * 1 + 0] = 1.0  # from inter-neuron 1 to inter-neuron 0
    genotype[63 + 4 * 2 + 3] = 1.0  # from inter-neuron 2 to motor neuron 3
    nets = decode(genotype, PLAIN)
    assert nets.sensory_weights[0, 7, 2] == 8
    assert nets.recurrent_weights[0, 1, 0] == 10
    assert nets.motor_weights[0, 2, 3] == 10


def test_encoding_a_decoded_genotype_gives_it_back():
    genotypes = np.random.default_rng(2).random((50, 84))
    for readings in (PLAIN, replace(PLAIN, tau_exponent_max=0.0, bias_ranges="negative")):
        np.testing.assert_allclose(encode(decode(genotypes, readings), readings), genotypes, atol=1e-14)


def test_readings_of_tau_and_bias_change_their_ranges_only():
    nets = decode(np.ones(84), replace(PLAIN, tau_exponent_max=1.0, bias_ranges="negative"))
    np.testing.assert_allclose(nets.decay_constants, 10, rtol=1e-14)
    np.testing.assert_allclose(nets.input_bias, -2)
    np.testing.assert_allclose(nets.inter_biases, 5)


@pytest.mark.parametrize(
    ("genotypes", "message"),
    [
        (np.zeros(83), r"genotypes have shape \(83,\), this controller needs \[P, 84\]: 75 weights"),
        (np.zeros((2, 3, 84)), r"genotypes have shape \(2, 3, 84\)"),
        (np.full(84, np.nan), r"gene 0 of genotype 0 is nan; genes lie in \[0, 1\]"),
        (np.full((2, 84), 1.5), r"gene 0 of genotype 0 is 1.5; genes lie in \[0, 1\]"),
    ],
)
def test_unsound_genotype_is_refused(genotypes, message):
    with pytest.raises(ValueError, match=message):
        check_genotypes(genotypes)


@pytest.mark.parametrize("name", [each.name for each in fields(Networks)])
@pytest.mark.parametrize("bound", [0.0, 1.0])
def test_parameter_out_of_its_genes_range_is_refused_and_never_clipped(name, bound):
    """A gene 1 % of its range out; what rounding adds at the bound is taken away."""
    at_bound = decode(np.full((1, 84), bound), PLAIN)
    np.testing.assert_array_equal(encode(at_bound, PLAIN), bound)
    low, high = (getattr(decode(np.full((1, 84), gene), PLAIN), name) for gene in (0.0, 1.0))
    out = 1.01 * bound - 0.01 * (1.0 - bound)
    beyond = low * (high / low) ** out if name == "decay_constants" else low + out * (high - low)
    with pytest.raises(ValueError, match=rf"gene \d+ of genotype 0 is {out:g}; genes lie in \[0, 1\]"):
        encode(replace(at_bound, **{name: beyond}), PLAIN)


@pytest.mark.parametrize("gene", [0, 53, 77, 83])
def test_genes_are_taken_up_to_their_bounds_and_not_beyond(gene):
    for value, sound in ((0.0, True), (1.0, True), (-1e-15, False), (np.nextafter(1.0, 2.0), False)):
        genotype = np.full(84, 0.5)
        genotype[gene] = value
        if sound:
            assert check_genotypes(genotype)[0, gene] == value
        else:
            with pytest.raises(ValueError, match=f"gene {gene} of genotype 0"):
                check_genotypes(genotype)
