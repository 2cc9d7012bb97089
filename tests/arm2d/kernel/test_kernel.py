"""The compiled kernel against the plain reference, and its promises: same bits, no influence."""

from dataclasses import fields, replace

import numpy as np
import pytest

from arm2d import (
    ActionWord,
    Condition,
    Instruction,
    LabelChanges,
    ObjectWord,
    Readings,
    Trials,
    draw_trials,
    record_trial,
    run_trials,
)
from arm2d.readings import PLAIN, choices
from arm2d.reference import run_trial

# Every alternative of the ledger that changes a trial, one at a time.
OF_EVOLUTION_ONLY = {"parent_scaling", "ties", "starts_shared"}
ALTERNATIVES = [
    {},
    *(
        {name: word}
        for name, words in choices().items()
        for word in words[1:]
        if name not in OF_EVOLUTION_ONLY
    ),
    *({"object_radius": radius} for radius in (3.0, 8.0, 10.0, 11.8)),
    *({"sector_half_width": width} for width in (5.0, 8.0)),
    {"sector_centres": (45.0, 90.0, 135.0), "sector_half_width": 3.0},
    *({"tau_exponent_max": exponent} for exponent in (1.0, 0.0)),
    {"object_vision": "any_part", "object_radius": 10.0, "bound_vision": "near", "start_areas": "bounds"},
    {"turn": "radians", "run_counting": "cumulative", "f3_time": "best", "success": "f1_f2_f3"},
]
# A camera at the end of S1 has code of its own in the kernel. The default readings are one of these worlds.
SEEN_FROM_THE_END = [
    {},
    {each.name: getattr(Readings(), each.name) for each in fields(Readings)},
    {"object_vision": "any_part"},
    {"object_vision": "any_part", "object_radius": 11.8},
    {"f3_time": "best", "bound_vision": "near", "object_radius": 10.0, "start_areas": "bounds"},
]
TRIALS_PER_ALTERNATIVE = -(-5_000 // len(ALTERNATIVES))


def genotypes_of(evolved_plain, n, rng):
    """A quarter random, the rest evolved_plain genotypes, [n, 84]: what is random seldom touches anything."""
    random = rng.random((-(-n // 4), 84))
    return np.concatenate([random, evolved_plain[rng.choice(len(evolved_plain), n - len(random))]])


def disagreements(genotypes, trials, readings):
    """Trials in which kernel and reference differ, as readable lines."""
    scores = run_trials(genotypes, trials, readings)
    for p, genotype in enumerate(genotypes):
        for t, instruction in enumerate(trials.instructions):
            plain = run_trial(
                genotype, instruction, trials.alpha[t], trials.discs[t], readings, changes_of(trials, t)
            )
            fast = [getattr(scores, name)[p, t] for name in plain._fields]
            near = np.allclose(fast[:3], plain[:3], rtol=0, atol=1e-9)
            if not (near and fast[3:] == list(plain[3:])):
                yield f"{instruction} of genotype {p}: {plain} became {fast}"


def changes_of(trials, t):
    """The label change of trial t as the reference takes it."""
    if trials.changes is None:
        return None
    each = trials.changes
    first = Instruction(ActionWord(each.first_actions[t]), ObjectWord(each.first_objects[t]))
    later = Instruction(ActionWord(each.later_actions[t]), ObjectWord(each.later_objects[t]))
    return first, later, int(each.delays[t])


@pytest.mark.slow
@pytest.mark.parametrize("alternative", ALTERNATIVES, ids=str)
def test_kernel_and_reference_agree_on_thousands_of_trials_of_all_readings(alternative, evolved_plain):
    readings = PLAIN.with_values(alternative)
    rng = np.random.default_rng([7, ALTERNATIVES.index(alternative)])
    for condition in Condition:
        trials = draw_trials(condition.instructions, 1, readings, rng)
        genotypes = genotypes_of(evolved_plain, -(-TRIALS_PER_ALTERNATIVE // (2 * len(trials))), rng)
        assert not list(disagreements(genotypes, trials, readings))


def test_readings_of_the_search_change_no_trial(evolved_plain):
    trials = draw_trials(Condition.WITH_INDICATE.instructions, 2, PLAIN, np.random.default_rng(2))
    scores = run_trials(evolved_plain[:10], trials, PLAIN)
    for name in OF_EVOLUTION_ONLY:
        for word in choices()[name][1:]:
            other = run_trials(evolved_plain[:10], trials, PLAIN.with_values({name: word}))
            assert np.array_equal(other.fitness, scores.fitness), (name, word)


@pytest.mark.slow
@pytest.mark.parametrize("alternative", SEEN_FROM_THE_END)
def test_kernel_and_reference_agree_on_hundreds_of_trials_seen_from_the_end_of_s1(alternative, evolved_plain):
    readings = replace(PLAIN, camera_origin="end").with_values(alternative)
    rng = np.random.default_rng([11, SEEN_FROM_THE_END.index(alternative)])
    for condition in Condition:
        trials = draw_trials(condition.instructions, 2, readings, rng)
        assert len(trials) == 36
        assert not list(disagreements(genotypes_of(evolved_plain, 8, rng), trials, readings))


@pytest.mark.parametrize("readings", [PLAIN, replace(PLAIN, camera_origin="end")], ids=["J1", "end"])
def test_kernel_and_reference_agree_where_words_change_in_mid_trial(readings, evolved_plain):
    rng = np.random.default_rng(8)
    drawn = draw_trials(Condition.WITH_INDICATE.instructions, 4, readings, rng)
    n = len(drawn)
    changes = LabelChanges(
        rng.integers(0, 3, n), drawn.objects, drawn.actions, rng.integers(0, 3, n), rng.integers(0, 10, n)
    )
    trials = Trials(drawn.actions, drawn.objects, drawn.alpha, drawn.discs, changes)
    genotypes = genotypes_of(evolved_plain, 8, rng)
    assert not list(disagreements(genotypes, trials, readings))
    unchanged = run_trials(genotypes, drawn, readings)
    assert not np.array_equal(run_trials(genotypes, trials, readings).fitness, unchanged.fitness)


@pytest.mark.parametrize("readings", [PLAIN, replace(PLAIN, camera_origin="end")], ids=["J1", "end"])
def test_kernel_and_reference_agree_where_discs_start_at_or_in_s2(readings, evolved_plain):
    rng = np.random.default_rng(10)
    drawn = draw_trials(Condition.WITH_INDICATE.instructions, 2, readings, rng)
    angles, distances = rng.uniform(50, 150, (2, len(drawn), 3))
    distances = 100.0 + 0.2 * (distances - 50)
    discs = distances[..., np.newaxis] * np.stack(
        [np.cos(np.radians(angles)), np.sin(np.radians(angles))], -1
    )
    trials = Trials(drawn.actions, drawn.objects, drawn.alpha, discs)
    assert not list(disagreements(genotypes_of(evolved_plain, 12, rng), trials, readings))


@pytest.fixture(scope="module")
def population(evolved_plain):
    rng = np.random.default_rng(9)
    return genotypes_of(evolved_plain, 30, rng), draw_trials(
        Condition.WITH_INDICATE.instructions, 5, PLAIN, rng
    )


def assert_same_scores(one, other):
    for each in fields(one):
        np.testing.assert_array_equal(getattr(one, each.name), getattr(other, each.name))


@pytest.mark.parametrize("threads", [2, 3, 64])
def test_number_of_threads_does_not_change_a_bit(population, threads):
    assert_same_scores(run_trials(*population), run_trials(*population, threads=threads))


def test_genotypes_and_trials_do_not_influence_one_another(population):
    genotypes, trials = population
    together = run_trials(genotypes, trials)
    for p, t in ((0, 0), (3, 40), (29, 89)):
        alone = run_trials(genotypes[p], trials[t])
        assert alone.fitness[0, 0] == together.fitness[p, t]
        assert alone.steps[0, 0] == together.steps[p, t]


def test_order_of_trials_does_not_matter(population):
    genotypes, trials = population
    order = np.random.default_rng(0).permutation(len(trials))
    shuffled = run_trials(genotypes, trials[order])
    np.testing.assert_array_equal(shuffled.fitness, run_trials(genotypes, trials).fitness[:, order])


def test_recording_a_trial_gives_the_scores_of_running_it(population):
    genotypes, trials = population
    scores = run_trials(genotypes, trials)
    for p, t in ((0, 0), (20, 33), (29, 89)):
        record = record_trial(genotypes[p], trials[t])
        assert record.fitness == scores.fitness[p, t]
        assert record.steps == scores.steps[p, t] == len(record.alpha) - 1


def test_discs_are_never_left_inside_s2_and_move_only_where_s2_passes(population):
    genotypes, trials = population
    n_moves = n_grazed = 0
    for p in range(0, 30, 2):
        for t in range(0, len(trials), 9):
            record = record_trial(genotypes[p], trials[t])
            assert gaps(record).min() >= 5.0 - 1e-6
            moved = (np.diff(record.discs, axis=0) != 0).any(axis=-1)
            # No point of S2 moves farther than 11 cm in a step: 2.9 degrees of 160 cm and of 50 cm.
            assert gaps(record)[moved].max(initial=0.0) < 5.0 + 11.0
            touched = (record.contact[:-1] != 0) | (record.contact[1:] != 0)
            n_moves, n_grazed = n_moves + moved.sum(), n_grazed + (moved & ~touched).sum()
    # S2's tip may push a disc aside and lose it within one step, but seldom does.
    assert n_moves > 100
    assert n_grazed < 0.05 * n_moves


def gaps(record):
    """Distance of every disc's centre from S2 in every state after the start [cm], [K, 3]."""
    a, h = np.radians(record.alpha), np.radians(record.alpha + record.beta)
    joint = 100.0 * np.stack([np.cos(a), np.sin(a)], axis=-1)
    along = np.stack([np.cos(h), np.sin(h)], axis=-1)
    rest = record.discs - joint[:, np.newaxis]
    u = np.clip(np.einsum("kox,kx->ko", rest, along), 0.0, 50.0)
    return np.linalg.norm(rest - u[..., np.newaxis] * along[:, np.newaxis], axis=-1)[1:]


def test_asking_for_no_thread_is_refused(population):
    with pytest.raises(ValueError, match="asked for 0 threads"):
        run_trials(*population, threads=0)


def test_recording_more_than_one_trial_is_refused(population):
    genotypes, trials = population
    with pytest.raises(ValueError, match="a recording takes one genotype and one trial, not 1 and 90"):
        record_trial(genotypes[0], trials)


@pytest.mark.parametrize("threads", [1, 2])
def test_genotypes_with_trials_of_their_own_score_as_one_by_one(evolved_plain, threads):
    readings, rng = PLAIN, np.random.default_rng(12)
    genotypes, instructions = genotypes_of(evolved_plain, 3, rng), Condition.WITH_IGNORE.instructions
    together = draw_trials(instructions * 3, 1, readings, np.random.default_rng(6))
    one_by_one = np.random.default_rng(6)
    found = run_trials(genotypes, together, readings, each_own=True, threads=threads)
    for p, genotype in enumerate(genotypes):
        alone = run_trials(genotype, draw_trials(instructions, 1, readings, one_by_one), readings)
        for name, values in vars(alone).items():
            np.testing.assert_array_equal(getattr(found, name)[p : p + 1], values, name)


def test_trials_that_cannot_be_shared_out_among_genotypes_are_refused(evolved_plain):
    trials = draw_trials("touch red", 2, PLAIN, np.random.default_rng(1))
    with pytest.raises(ValueError, match="3 genotypes cannot have as many trials of their own each of 4"):
        run_trials(evolved_plain[:3], trials, PLAIN, each_own=True)
