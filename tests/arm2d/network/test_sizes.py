"""Networks of other sizes than the paper's: the same rules, compiled for each number of inter-neurons."""

import re
from dataclasses import fields
from functools import cache

import numpy as np
import pytest

from arm2d import Condition, check_genotypes, decode, draw_trials, encode, record_trial, run_trials
from arm2d.network.genes import SIZES, genes_of
from arm2d.readings import PLAIN
from arm2d.reference import run_trial
from arm2d.tasks.task import Task
from evolution.search.algorithm import breed, choose_parents, initial_genotypes, mean_in_order
from evolution.search.settings import Settings

# Each costs some seconds of compiling; the last thinks neuron after neuron.
SIZES_TRIED = [1, 5, 16]
WORLDS = [
    {},
    {"camera_origin": "end", "object_vision": "any_part"},
    {"tau_exponent_max": 0.0, "bias_ranges": "negative", "object_radius": 10.0},
    {"turn": "radians", "run_counting": "cumulative", "f3_time": "best", "success": "f1_f2_f3"},
]


@cache
def a_little_evolved(n_inter):
    """Genotypes [100, G] after forty generations: of these some touch objects."""
    settings, readings, rng = Settings(inter_neurons=n_inter), PLAIN, np.random.default_rng(n_inter)
    genotypes = initial_genotypes(settings, rng)
    for _ in range(40):
        trials = draw_trials(Condition.WITH_INDICATE.experienced, 1, readings, rng)
        fitness = mean_in_order(run_trials(genotypes, trials, readings).fitness)
        parents = choose_parents(fitness, settings, readings, rng)
        genotypes = breed(genotypes, parents, settings, readings, rng)
    return genotypes


def embedded(genotype, n_inter, rng):
    """A network [84] within a larger one [G], whose further neurons weigh nothing."""
    small, large = genes_of(3), genes_of(n_inter)
    inside = rng.random(large.count)
    weights = inside[large.sensory].reshape(18, n_inter)
    weights[:, :3] = genotype[small.sensory].reshape(18, 3)
    weights = inside[large.recurrent].reshape(n_inter, n_inter)
    weights[3:], weights[:3, :3] = 0.5, genotype[small.recurrent].reshape(3, 3)
    weights = inside[large.motor].reshape(n_inter, 4)
    weights[3:], weights[:3] = 0.5, genotype[small.motor].reshape(3, 4)
    for kind in ("tau", "inter_bias"):
        inside[getattr(large, kind)][:3] = genotype[getattr(small, kind)]
    for kind in ("input_bias", "motor_bias", "gain"):
        inside[getattr(large, kind)] = genotype[getattr(small, kind)]
    return inside


def test_three_inter_neurons_have_84_genes_and_every_size_has_another_number():
    assert [genes_of(n).count for n in (1, 2, 3, 16)] == [28, 55, 84, 643]
    assert {n * n + 24 * n + 3: n for n in range(1, 17)} == SIZES


@pytest.mark.parametrize("n_inter", [1, 2, 16])
def test_each_gene_moves_exactly_one_parameter_of_such_a_network(n_inter):
    count = genes_of(n_inter).count
    moved = np.full((count, count), 0.5)
    np.fill_diagonal(moved, 0.75)
    before, after = decode(np.full(count, 0.5), PLAIN), decode(moved, PLAIN)
    changes = [
        (getattr(after, each.name) != getattr(before, each.name)).reshape(count, -1).sum(axis=1)
        for each in fields(before)
    ]
    np.testing.assert_array_equal(sum(changes), 1)
    assert before.motor_weights.shape == (1, n_inter, 4)


@pytest.mark.parametrize("n_inter", SIZES_TRIED)
def test_encoding_such_a_decoded_genotype_gives_it_back(n_inter):
    genotypes = np.random.default_rng(2).random((20, genes_of(n_inter).count))
    np.testing.assert_allclose(encode(decode(genotypes, PLAIN), PLAIN), genotypes, atol=1e-14)


@pytest.mark.parametrize("world", WORLDS, ids=str)
@pytest.mark.parametrize("n_inter", SIZES_TRIED)
def test_kernel_and_reference_agree_for_every_size(n_inter, world):
    readings, rng = PLAIN.with_values(world), np.random.default_rng(n_inter)
    touching = 0
    for condition in Condition:
        trials = draw_trials(condition.instructions, 1, readings, rng)
        genotypes = a_little_evolved(n_inter)[[0, 7, 99]]
        scores = run_trials(genotypes, trials, readings)
        for p, genotype in enumerate(genotypes):
            for t, instruction in enumerate(trials.instructions):
                plain = run_trial(genotype, instruction, trials.alpha[t], trials.discs[t], readings)
                fast = [getattr(scores, name)[p, t] for name in plain._fields]
                np.testing.assert_allclose(fast[:3], plain[:3], rtol=0, atol=1e-9)
                assert fast[3:] == list(plain[3:])
                touching += plain.steps < 250
    assert touching > 10  # they ended by a touch, or by success


@pytest.mark.parametrize("n_inter", [5, 16])
def test_neurons_that_nobody_listens_to_do_not_change_a_bit(n_inter, evolved_plain):
    rng = np.random.default_rng(n_inter)
    trials = draw_trials(Condition.WITH_INDICATE.instructions, 4, PLAIN, rng)
    larger = np.array([embedded(genotype, n_inter, rng) for genotype in evolved_plain[:20]])
    found, expected = (run_trials(each, trials, PLAIN) for each in (larger, evolved_plain[:20]))
    assert expected.success.mean() > 0.5
    for each in fields(expected):
        np.testing.assert_array_equal(getattr(found, each.name), getattr(expected, each.name))


@pytest.mark.parametrize("n_inter", SIZES_TRIED)
def test_a_recording_holds_the_states_of_all_inter_neurons(n_inter):
    genotypes = a_little_evolved(n_inter)
    trials = draw_trials(["touch red"], 1, PLAIN, np.random.default_rng(1))
    record = record_trial(genotypes[0], trials[0], PLAIN)
    scores = run_trials(genotypes[0], trials, PLAIN)
    assert record.states.shape == (record.steps, n_inter)
    assert (record.steps, record.fitness) == (scores.steps[0, 0], scores.fitness[0, 0])
    nets, y = decode(genotypes[0], PLAIN), np.zeros(n_inter)
    for inputs, states in zip(record.inputs, record.states, strict=True):
        s = 1 / (1 + np.exp(-(nets.gain[0] * inputs + nets.input_bias[0])))
        z = 1 / (1 + np.exp(-(y + nets.inter_biases[0])))
        total = s @ nets.sensory_weights[0] + z @ nets.recurrent_weights[0]
        np.testing.assert_allclose(states, y + 0.1 / nets.decay_constants[0] * (total - y), atol=1e-9)
        y = states


def test_words_in_sequence_are_heard_by_all_inter_neurons():
    task, rng = Task(words="action-first", word_steps=5), np.random.default_rng(3)
    trials = draw_trials(task.instructions, 1, PLAIN, rng, task)
    genotypes = a_little_evolved(5)[:3]
    scores = run_trials(genotypes, trials, PLAIN, threads=2)
    for p, genotype in enumerate(genotypes):
        for t, instruction in enumerate(trials.instructions):
            plain = run_trial(genotype, instruction, trials.alpha[t], trials.discs[t], PLAIN, task=task)
            assert (scores.success[p, t], scores.steps[p, t]) == (plain.success, plain.steps)


@pytest.mark.parametrize(
    ("shape", "asked", "sentence"),
    [
        (
            (83,),
            None,
            "genotypes have shape (83,), this controller needs [P, 84]: 75 weights, 3 decay constants, "
            "5 biases and 1 gain each; 1 to 16 inter-neurons take 28 to 643 genes",
        ),
        (
            (2, 84),
            5,
            "genotypes have shape (2, 84), of three inter-neurons; a controller of five inter-neurons needs "
            "[P, 148]: 135 weights, 5 decay constants, 7 biases and 1 gain each",
        ),
        (
            (148,),
            1,
            "genotypes have shape (148,), of five inter-neurons; a controller of one inter-neuron needs "
            "[P, 28]: 23 weights, 1 decay constant, 3 biases and 1 gain each",
        ),
        (
            (2, 85),
            3,
            "genotypes have shape (2, 85); a controller of three inter-neurons needs [P, 84]: 75 weights",
        ),
    ],
)
def test_genotypes_of_another_size_are_refused_with_what_was_found_and_what_is_right(shape, asked, sentence):
    with pytest.raises(ValueError, match=re.escape(sentence)):
        check_genotypes(np.full(shape, 0.5), asked)
