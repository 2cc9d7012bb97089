"""Records print as one short line, can be compared, and instructions may be given as text."""

import inspect
import pkgutil
from dataclasses import fields, is_dataclass, replace
from importlib import import_module

import numpy as np
import pytest

import arm2d
import evolution
from arm2d import Condition, Instruction, LabelChanges, Readings, Trials, decode, draw_trials, run_trials
from arm2d.records import alike, brief
from tests.arm2d.controllers import steady_controller

READINGS = Readings()
WORDS = Condition.WITH_INDICATE.instructions


def trials(instructions=WORDS, seed=1):
    return draw_trials(instructions, 2, READINGS, np.random.default_rng(seed))


def test_trials_say_how_many_they_are_and_of_how_many_instructions():
    assert repr(trials()) == "<Trials: 36 of 9 instructions>"
    assert repr(trials()[0]) == "<Trials: 1 of 1 instruction>"


def test_trials_whose_words_change_say_so():
    two = np.zeros(2, int)
    changes = LabelChanges(two, two, two, two, two)
    changing = Trials([0, 1], [0, 1], [60.0, 60.0], trials()[:2].discs, changes)
    assert repr(changing) == "<Trials: 2 of 2 instructions, words change>"
    assert repr(changes) == (
        "LabelChanges(first_actions=[2], first_objects=[2], later_actions=[2], later_objects=[2], delays=[2])"
    )


def test_scores_say_what_share_was_carried_out():
    scores = run_trials(steady_controller(0, 0), trials())
    share = 100 * scores.success.mean()
    assert repr(scores) == f"<TrialScores: 1 x 36 trials, {share:.0f} % carried out>"


def test_a_recorded_trial_says_what_was_asked_and_what_became_of_it(evolved_agent):
    from arm2d import record_trial

    for trial in (trials()[t] for t in range(0, 36, 4)):
        record = record_trial(evolved_agent, trial)
        outcome = "carried out" if record.success else "not carried out"
        shown = f"<TrialRecord: {record.instruction}, {outcome} in {record.steps / 10:.1f} s>"
        assert repr(record) == shown


def test_readings_show_only_what_is_not_the_default_and_read_back():
    assert repr(Readings()) == "Readings()"
    other = Readings(object_radius=3.0, start_areas="bounds")
    assert repr(other) == "Readings(object_radius=3.0, start_areas='bounds')"
    assert eval(repr(other), {"Readings": Readings}) == other


def test_an_instruction_reads_back():
    for instruction in WORDS:
        assert eval(repr(instruction), {"Instruction": Instruction}) == instruction


def test_networks_say_how_many_they_are(evolved):
    assert repr(decode(evolved, READINGS)) == "<Networks of 60 genotypes>"


def test_no_record_takes_more_than_a_line(evolved):
    scored = run_trials(evolved, trials(), READINGS)
    for record in (trials(), scored, decode(evolved, READINGS), READINGS, WORDS[0]):
        assert "\n" not in repr(record)
        assert len(repr(record)) < 110


def test_a_long_value_is_cut():
    from dataclasses import dataclass

    @dataclass(frozen=True)
    class Example:
        values: tuple[int, ...]
        array: np.ndarray

        __repr__ = brief

    shown = repr(Example(tuple(range(100)), np.zeros((3, 4))))
    assert shown.startswith("Example(values=(0, 1, 2, ")
    assert shown.endswith(" ..., array=[3, 4])")
    assert len(shown) < 90


def test_instructions_may_be_text_and_give_the_same_trials():
    by_text, by_record = trials([str(each) for each in WORDS]), trials()
    for name in ("actions", "objects", "alpha", "discs"):
        np.testing.assert_array_equal(getattr(by_text, name), getattr(by_record, name))


@pytest.mark.parametrize("one", ["touch green", Instruction.parse("touch green")])
def test_a_single_instruction_needs_no_list(one):
    assert [str(each) for each in trials(one).instructions] == ["TOUCH Green"] * 4


def test_text_that_is_no_instruction_is_named():
    with pytest.raises(ValueError, match="unknown object word 'yellow'; this world knows blue, green, red"):
        trials(["touch yellow"])


def records_of_arrays():
    """Every dataclass of the planar world and the evolution that has an array among its fields."""
    for package in (arm2d, evolution):
        for found in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            if found.name.endswith("__main__"):
                continue
            module = import_module(found.name)
            for kind in vars(module).values():
                own = inspect.isclass(kind) and kind.__module__ == module.__name__
                if own and is_dataclass(kind) and any("NDArray" in str(each.type) for each in fields(kind)):
                    yield kind


def test_every_record_of_arrays_can_be_compared():
    """What Python writes for a dataclass fails: "the truth value of an array is ambiguous"."""
    found = list(records_of_arrays())
    assert len(found) > 30
    assert [kind.__name__ for kind in found if kind.__eq__ not in (alike, object.__eq__)] == []


def test_trials_and_what_comes_of_them_are_equal_if_all_numbers_are():
    readings, genotype = arm2d.Readings(), np.random.default_rng(2).random(84)
    one, other = (
        arm2d.draw_trials(["touch red", "move blue"], 2, readings, np.random.default_rng(1)) for _ in range(2)
    )
    assert one == other
    assert one != one[:3]
    assert one != replace(one, alpha=one.alpha + 1e-9)
    assert arm2d.run_trials(genotype, one) == arm2d.run_trials(genotype, other)
    assert arm2d.record_trial(genotype, one[0]) == arm2d.record_trial(genotype, other[0])
    assert arm2d.record_trial(genotype, one[0]) != arm2d.record_trial(genotype, one[1])
    assert arm2d.decode(genotype, readings) == arm2d.decode(genotype, readings)
