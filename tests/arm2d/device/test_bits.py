"""The device's kernel, run on the processor, against the compiled one: the same bits in every world."""

import re
from dataclasses import fields, replace

import numpy as np
import pytest
import warp as wp

from arm2d import Condition, LabelChanges, Trials, draw_trials, run_trials
from arm2d.device import loop
from arm2d.device.groups import Group
from arm2d.readings import PLAIN
from evolution.search.algorithm import mean_in_order
from tests.arm2d.kernel.test_kernel import ALTERNATIVES, SEEN_FROM_THE_END, genotypes_of

WORLDS = [*ALTERNATIVES, *({"camera_origin": "end", **each} for each in SEEN_FROM_THE_END)]
TRIALS = 2000
BOTH_CAMERAS = pytest.mark.parametrize("camera_origin", ["J1", "end"])


def assert_same_bits(one, other):
    for each in fields(one):
        np.testing.assert_array_equal(getattr(one, each.name), getattr(other, each.name), each.name)


def test_two_thousand_trials_of_all_readings_end_with_the_kernels_bits(laboratory, evolved_plain):
    n = 0
    for number, world in enumerate(WORLDS):
        readings, rng = PLAIN.with_values(world), np.random.default_rng([13, number])
        for condition in Condition:
            trials = draw_trials(condition.instructions, 1, readings, rng)
            genotypes = genotypes_of(evolved_plain, -(-TRIALS // (2 * len(WORLDS) * len(trials))), rng)
            expected = run_trials(genotypes, trials, readings)
            assert_same_bits(laboratory.run_trials(genotypes, trials, readings), expected)
            n += expected.success.size
    assert n >= TRIALS


@BOTH_CAMERAS
def test_words_that_change_in_mid_trial_change_nothing_of_that(laboratory, evolved_plain, camera_origin):
    readings, rng = replace(PLAIN, camera_origin=camera_origin), np.random.default_rng(8)
    drawn = draw_trials(Condition.WITH_INDICATE.instructions, 4, readings, rng)
    n = len(drawn)
    changes = LabelChanges(
        rng.integers(0, 3, n), drawn.objects, drawn.actions, rng.integers(0, 3, n), rng.integers(0, 10, n)
    )
    trials = Trials(drawn.actions, drawn.objects, drawn.alpha, drawn.discs, changes)
    genotypes = genotypes_of(evolved_plain, 12, rng)
    assert_same_bits(
        laboratory.run_trials(genotypes, trials, readings), run_trials(genotypes, trials, readings)
    )


@BOTH_CAMERAS
def test_discs_that_start_at_or_in_s2_change_nothing_of_that(laboratory, evolved_plain, camera_origin):
    readings, rng = replace(PLAIN, camera_origin=camera_origin), np.random.default_rng(10)
    drawn = draw_trials(Condition.WITH_INDICATE.instructions, 2, readings, rng)
    angles = np.radians(rng.uniform(50, 150, (len(drawn), 3)))
    distances = rng.uniform(100, 120, (len(drawn), 3, 1))
    discs = distances * np.stack([np.cos(angles), np.sin(angles)], -1)
    trials, genotypes = (
        Trials(drawn.actions, drawn.objects, drawn.alpha, discs),
        genotypes_of(evolved_plain, 12, rng),
    )
    assert_same_bits(
        laboratory.run_trials(genotypes, trials, readings), run_trials(genotypes, trials, readings)
    )


def test_groups_of_one_batch_live_in_worlds_of_their_own(laboratory, evolved_plain):
    rng, groups = np.random.default_rng(3), []
    for world in ({"turn": "radians"}, {}, {"camera_origin": "end"}, {"object_radius": 10.0}, {}):
        readings = PLAIN.with_values(world)
        trials = draw_trials(Condition.WITH_IGNORE.experienced, 1, readings, rng)
        groups.append(Group(genotypes_of(evolved_plain, 4, rng), trials, readings))
    expected = [run_trials(*group[:3]) for group in groups]
    np.testing.assert_array_equal(
        laboratory.fitness(groups), [mean_in_order(scores.fitness) for scores in expected]
    )
    np.testing.assert_array_equal(laboratory.success(groups), [scores.success for scores in expected])


def test_each_genotype_of_a_group_may_have_trials_of_its_own(laboratory, evolved_plain):
    rng, groups, expected = np.random.default_rng(4), [], []
    for world in ({}, {"turn": "radians"}):
        readings = PLAIN.with_values(world)
        instructions, genotypes = Condition.WITH_IGNORE.experienced, genotypes_of(evolved_plain, 3, rng)
        seed = int(rng.integers(1000))
        one_by_one = np.random.default_rng(seed)
        own = [draw_trials(instructions, 2, readings, one_by_one) for _ in genotypes]
        together = draw_trials(instructions * 3, 2, readings, np.random.default_rng(seed))
        groups.append(Group(genotypes, together, readings, each_own=True))
        expected.append([run_trials(*each, readings) for each in zip(genotypes, own, strict=True)])
    fitness = [[mean_in_order(scores.fitness[0]) for scores in group] for group in expected]
    success = [[scores.success[0] for scores in group] for group in expected]
    np.testing.assert_array_equal(laboratory.fitness(groups), fitness)
    np.testing.assert_array_equal(laboratory.success(groups), success)


def test_trials_that_cannot_be_shared_out_are_refused(laboratory, evolved_plain):
    trials = draw_trials("touch red", 2, PLAIN, np.random.default_rng(1))
    with pytest.raises(ValueError, match="3 genotypes cannot have as many trials of their own each of 4"):
        laboratory.fitness([Group(evolved_plain[:3], trials, PLAIN, each_own=True)])


def test_groups_may_have_more_genotypes_or_fewer_but_not_other_numbers_of_trials(laboratory, evolved_plain):
    rng, readings = np.random.default_rng(1), PLAIN
    one, two = (draw_trials("touch red", n, readings, rng) for n in (1, 2))
    groups = [Group(evolved_plain[10 : 10 + n], one, readings) for n in (2, 3)]
    groups.append(Group(evolved_plain[15:17], two, readings, each_own=True))
    both, three, own = laboratory.success(groups)
    np.testing.assert_array_equal(both, run_trials(*groups[0][:3]).success)
    np.testing.assert_array_equal(three, run_trials(*groups[1][:3]).success)
    expected = run_trials(evolved_plain[15:17], two, readings).success
    np.testing.assert_array_equal(own, [expected[0, :2], expected[1, 2:]])
    with pytest.raises(ValueError, match="carry out as many trials each; these are 2 and 4"):
        laboratory.fitness([groups[0], Group(evolved_plain[:1], two, readings)])


def instructions_for_cuda(module, folder):
    """The kinds of arithmetic in what is compiled for a GPU of 2022, which takes none."""
    (path,) = wp.compile_aot_module(module, arch=90, module_dir=folder, use_ptx=True)
    text = path.read_bytes().decode("utf-8", "replace")
    return set(re.findall(r"^\s+((?:add|sub|mul|div|sqrt|rcp|fma|mad)\.\S*f(?:32|64))", text, re.M))


@pytest.mark.parametrize(
    ("fuse", "expected"), [(False, {"mul.rn.f64", "add.rn.f64"}), (True, {"fma.rn.f64"})]
)
def test_products_and_sums_share_a_rounding_only_where_that_is_asked_for(fuse, expected, tmp_path):
    @wp.kernel(module="unique", module_options={"fuse_fp": fuse}, enable_backward=False)
    def product_and_sum(values: wp.array[wp.float64], result: wp.array[wp.float64]):
        result[0] = values[0] * values[1] + values[2]

    assert instructions_for_cuda(product_and_sum.module, tmp_path) == expected


@pytest.mark.slow
def test_what_is_compiled_for_cuda_rounds_every_operation_as_ieee_754_says(laboratory, tmp_path):
    expected = {"add.rn.f64", "sub.rn.f64", "mul.rn.f64", "div.rn.f64", "sqrt.rn.f64"}
    assert instructions_for_cuda(loop, tmp_path) == expected
