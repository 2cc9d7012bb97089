"""The world that is stepped from outside: the kernel's bits, and clear words for impossible turns."""

import runpy
from dataclasses import fields, replace
from importlib import import_module
from pathlib import Path
from textwrap import dedent

import numpy as np
import pytest

from arm2d import (
    INPUT_NAMES,
    Condition,
    Instruction,
    LabelChanges,
    Readings,
    TrialRecord,
    Trials,
    VectorWorld,
    World,
    draw_trials,
    record_trial,
    run_trials,
)
from arm2d.readings import PLAIN
from tests.arm2d.kernel.test_kernel import ALTERNATIVES, genotypes_of

EXAMPLE = Path(__file__).parents[3] / "docs" / "examples" / "by_hand.py"
TRIALS_PER_ALTERNATIVE = -(-2_000 // len(ALTERNATIVES))
INSTRUCTIONS = [*Condition.WITH_INDICATE.instructions, *Condition.WITH_IGNORE.instructions[6:]]


def drawn(n, readings, seed):
    """n trials of all twelve instructions, mixed."""
    rng = np.random.default_rng(seed)
    trials = draw_trials(INSTRUCTIONS, -(-n // (2 * len(INSTRUCTIONS))), readings, rng)
    return trials[rng.permutation(len(trials))[:n]]


@pytest.mark.parametrize("alternative", ALTERNATIVES, ids=str)
def test_driven_by_a_networks_decisions_it_ends_with_the_kernels_bits(alternative, evolved_plain):
    """All trials of an alternative side by side, each with the decisions of a genotype of its own."""
    readings = replace(PLAIN, **alternative)
    n = TRIALS_PER_ALTERNATIVE
    trials = drawn(n, readings, 5)
    genotypes = genotypes_of(evolved_plain, n, np.random.default_rng(6))
    records = [record_trial(genotypes[t], trials[t], readings) for t in range(n)]
    world = VectorWorld(trials, readings)
    for k in range(max(record.steps for record in records)):
        turns = np.zeros((n, 2), int)
        for t, record in enumerate(records):
            if k < record.steps:
                assert np.array_equal(world.inputs[t], record.inputs[k]), (t, k)
                turns[t] = np.sign(record.turns[k])
        assert np.array_equal(world.ended, [k >= record.steps for record in records])
        world.step(turns)
    assert world.ended.all()
    arm, discs, sides = world.positions()
    assert np.array_equal(arm, [(record.alpha[-1], record.beta[-1]) for record in records])
    assert np.array_equal(sides, [record.contact[-1] for record in records])
    assert np.allclose(discs, [record.discs[-1] for record in records], rtol=0, atol=1e-12)
    for name in ("f1", "f2", "f3", "success", "steps"):
        asked = [getattr(record.scores, name)[0, 0] for record in records]
        assert np.array_equal(getattr(world.scores(), name)[0], asked), name


def test_a_record_of_the_stepped_world_is_the_kernels_record(evolved_agent):
    readings = PLAIN
    for t in range(12):
        trial = drawn(12, readings, 8)[t]
        record = record_trial(evolved_agent, trial, readings)
        world = World(readings)
        world.reset(record.instruction, start=trial)
        for turns in record.turns:
            world.step(np.sign(turns))
        stepped = world.record()
        for field in fields(TrialRecord):
            if field.name not in ("states", "scores"):
                assert np.array_equal(getattr(stepped, field.name), getattr(record, field.name)), field.name
        assert stepped.fitness == record.fitness
        assert not stepped.states.any()


def test_what_is_stepped_after_the_end_changes_nothing():
    readings = PLAIN
    world = VectorWorld(drawn(40, readings, 1), readings)
    rng = np.random.default_rng(2)
    for _ in range(250):
        world.step(rng.integers(-1, 2, (40, 2)))
    before, places = world.scores(), world.positions()
    for _ in range(30):
        world.step(rng.integers(-1, 2, (40, 2)))
    for name in ("f1", "f2", "f3", "success", "steps"):
        assert np.array_equal(getattr(before, name), getattr(world.scores(), name))
    assert all(np.array_equal(a, b) for a, b in zip(places, world.positions(), strict=True))


def test_a_restarted_trial_is_as_good_as_new_and_leaves_the_others_alone():
    readings = PLAIN
    first, second = drawn(40, readings, 1), drawn(40, readings, 2)
    rng = np.random.default_rng(3)
    early, late = rng.integers(-1, 2, (30, 40, 2)), rng.integers(-1, 2, (30, 40, 2))
    which = rng.random(40) < 0.5

    def after(trials, *phases):
        world = VectorWorld(trials, readings)
        for turns in np.concatenate(phases):
            world.step(turns)
        return world

    world = after(first, early)
    world.restart(np.flatnonzero(which), second[np.flatnonzero(which)])
    for turns in late:
        world.step(turns)
    fresh, undisturbed = after(second, late), after(first, early, late)
    for got, new, old in zip(
        (*world.positions(), world.inputs), (*fresh.positions(), fresh.inputs),
        (*undisturbed.positions(), undisturbed.inputs), strict=True,
    ):  # fmt: skip
        assert np.array_equal(got[which], new[which])
        assert np.array_equal(got[~which], old[~which])


def test_other_words_are_heard_and_the_first_are_scored():
    world = World()
    before = world.reset("touch green", seed=3)
    world.hear("move red")
    assert before[12:].tolist() == [1, 0, 1, 1, 0, 1]
    assert world.inputs[12:].tolist() == [0, 1, 1, 0, 1, 1]
    world.step((1, 0))
    assert world.inputs[12:].tolist() == [0, 1, 1, 0, 1, 1]
    assert world.record().instruction == Instruction.parse("touch green")


def test_every_input_has_a_name_with_its_unit():
    assert len(INPUT_NAMES) == len(set(INPUT_NAMES)) == 18
    assert all(name.endswith("]") for name in INPUT_NAMES)
    world = World()
    inputs = world.reset("move blue", seed=1)
    assert dict(zip(INPUT_NAMES, inputs, strict=True))["bend [beta / 90 degrees]"] == 1.0


@pytest.mark.parametrize("readings", [Readings(), PLAIN], ids=["default", "plain"])
def test_the_example_obeys_all_nine_instructions_and_ignores(readings):
    by_hand = runpy.run_path(str(EXAMPLE))["ByHand"]
    world = World(readings)
    done = 0
    for instruction in INSTRUCTIONS:
        for seed in range(20):
            inputs, controller = world.reset(instruction, seed=seed), by_hand(instruction)
            while not world.ended:
                inputs = world.step(controller(inputs))
            done += world.score().success[0, 0]
    assert done == 20 * len(INSTRUCTIONS)


@pytest.mark.parametrize(
    "turns", [(2, 0), (0.5, 0), (float("nan"), 0), (0,), (0, 0, 0), "up", None, [[0, 0]]]
)
def test_a_controller_that_returns_something_else_is_told_what_would_be_right(turns):
    world = World()
    world.reset("touch red", seed=1)
    with pytest.raises(ValueError, match="-1, 0 or 1"):
        world.step(turns)


@pytest.mark.parametrize("turns", [1, (1,), [[0, 0]], None])
def test_turns_that_are_no_pair_are_shown(turns):
    world = World()
    world.reset("touch red", seed=1)
    with pytest.raises(
        ValueError, match="turns must be a pair, S1's and S2's, each -1, 0 or 1; this is "
    ) as no:
        world.step(turns)
    assert str(no.value).endswith(repr(turns))
    with pytest.raises(ValueError, match="turns must be 1 pair, S1's"):
        VectorWorld(drawn(1, PLAIN, 1)).step((0, 0))


@pytest.mark.parametrize("wrong", [5, None, [None] * 3, [["touch", "red"]] * 3])
def test_words_that_are_no_instruction_are_named(wrong):
    with pytest.raises(ValueError, match="is no instruction; give text such as 'touch green'"):
        World().reset(wrong)
    with pytest.raises(ValueError, match="is no instruction; give text such as 'touch green'"):
        VectorWorld(drawn(3, PLAIN, 1)).hear(wrong)


def test_words_for_each_trial_come_in_any_sequence():
    for asked in (["touch green", Instruction.parse("move red")], ("touch green", "move red")):
        worlds = VectorWorld(drawn(2, PLAIN, 1))
        worlds.hear(asked)
        assert worlds.inputs[:, 12:].tolist() == [[1, 0, 1, 1, 0, 1], [0, 1, 1, 0, 1, 1]]
    with pytest.raises(ValueError, match="2 trials hear one instruction or one each, not 1"):
        worlds.hear(["touch green"])


@pytest.mark.parametrize("which", [[0.7], [1.0], 0.7, [True], "1", [None]])
def test_a_restart_takes_whole_numbers_only(which):
    worlds = VectorWorld(drawn(2, PLAIN, 1))
    with pytest.raises(ValueError, match="a restart takes whole numbers of trials, such as"):
        worlds.restart(which, drawn(1, PLAIN, 2))
    worlds.restart([], drawn(2, PLAIN, 2)[:0])


def test_worlds_show_themselves_on_one_line():
    world = World()
    assert repr(world) == "<World: no trial yet>"
    world.reset("ignore green", seed=1)
    for _ in range(12):
        world.step((0, 0))
    assert repr(world) == "<World: IGNORE Green, step 12>"
    while not world.ended:
        world.step((0, 0))
    assert repr(world) == "<World: IGNORE Green, step 100, over>"
    assert repr(VectorWorld(drawn(36, PLAIN, 1))) == "<VectorWorld: 36 trials, 0 over>"


@pytest.mark.parametrize("world", [World, lambda readings: VectorWorld(drawn(1, PLAIN, 1), readings)])
def test_readings_of_another_kind_are_refused_when_a_world_is_made(world):
    with pytest.raises(ValueError, match="readings = 'plain' must be a record"):
        world("plain")


@pytest.mark.parametrize("module", ["world", "vector_world"])
def test_the_loop_in_a_modules_first_words_is_python(module):
    text = import_module(f"arm2d.worlds.{module}").__doc__
    compile(dedent(text.split("\n", 2)[2]), module, "exec")


def test_a_world_without_a_trial_or_after_its_end_says_so():
    world = World()
    with pytest.raises(ValueError, match="call reset"):
        world.step((0, 0))
    world.reset("indicate red", seed=1)
    assert world.record().steps == 0
    while not world.ended:
        world.step((0, 0))
    with pytest.raises(ValueError, match="another one with reset"):
        world.step((0, 0))
    with pytest.raises(ValueError, match="either a seed or a start"):
        world.reset("indicate red", seed=1, start=drawn(1, PLAIN, 1))


def test_trials_that_change_their_words_by_themselves_are_refused():
    trials = drawn(2, PLAIN, 1)
    changes = LabelChanges(trials.actions, trials.objects, trials.actions, trials.objects, np.array([1, 2]))
    changing = Trials(trials.actions, trials.objects, trials.alpha, trials.discs, changes)
    with pytest.raises(ValueError, match="use hear"):
        VectorWorld(changing)


def test_trials_of_one_genotype_side_by_side_are_those_of_the_kernel(evolved_agent):
    """More trials than one block of lanes holds, and not a whole number of blocks."""
    readings, n = PLAIN, 77
    trials = drawn(n, readings, 9)
    scores = run_trials(evolved_agent, trials, readings)
    world = VectorWorld(trials, readings)
    records = [record_trial(evolved_agent, trials[t], readings) for t in range(n)]
    for k in range(250):
        turns = [np.sign(record.turns[k]) if k < record.steps else (0, 0) for record in records]
        world.step(turns)
    assert np.array_equal(world.scores().fitness, scores.fitness)
