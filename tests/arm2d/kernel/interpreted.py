"""Kernel and reference side by side in the plain interpreter; run by test_interpreted.py, which says why."""

from dataclasses import replace

import numba
import numpy as np
import pytest

from arm2d import Condition, LabelChanges, Trials, VectorWorld, draw_trials, record_trial
from arm2d.readings import PLAIN
from tests.arm2d.kernel.test_kernel import disagreements

READINGS = [
    {},
    {"object_vision": "any_part", "object_radius": 10.0, "bound_vision": "near", "start_areas": "bounds"},
    {"turn": "radians", "run_counting": "cumulative", "f3_time": "best", "success": "f1_f2_f3"},
    {"ignore_stops": "never", "indicate_angle": "wide", "collision_penalty": "whole"},
    {"camera_origin": "end"},
    {"camera_origin": "end", "object_vision": "any_part", "object_radius": 11.8},
]


def with_changes(trials, rng):
    """Trials in which both words change some steps after the target is first seen."""
    n = len(trials)
    changes = LabelChanges(
        rng.integers(0, 3, n), trials.objects, trials.actions, rng.integers(0, 3, n), rng.integers(0, 10, n)
    )
    return Trials(trials.actions, trials.objects, trials.alpha, trials.discs, changes)


def test_nothing_is_compiled_here():
    assert numba.config.DISABLE_JIT


@pytest.mark.parametrize("alternative", READINGS, ids=str)
def test_kernel_and_reference_agree(alternative, evolved_plain):
    readings = PLAIN.with_values(alternative)
    rng = np.random.default_rng([12, READINGS.index(alternative)])
    instructions = {each: None for condition in Condition for each in condition.instructions}
    trials = draw_trials(list(instructions), 2, readings, rng)
    assert len(trials) == 48  # more than there are lanes
    for each in (trials, with_changes(trials[:24], rng)):
        assert not list(disagreements(evolved_plain[rng.choice(len(evolved_plain), 1)], each, readings))


def test_discs_far_beyond_the_tables_are_nowhere_near(evolved_plain):
    """Where the compiled kernel would read what lies behind a table, this one says so."""
    trials = draw_trials(["touch red"], 1, PLAIN, np.random.default_rng(4))
    far = replace(trials, discs=trials.discs * 20.0)  # 20 to 30 m
    assert not list(disagreements(evolved_plain[:1], far, PLAIN))


@pytest.mark.parametrize("camera", ["J1", "end"])
def test_a_world_that_is_stepped_ends_as_the_kernel_does(camera, evolved_plain):
    """Two blocks of lanes, the second of them not full."""
    readings = replace(PLAIN, camera_origin=camera)
    trials = draw_trials(Condition.WITH_INDICATE.instructions, 2, readings, np.random.default_rng(3))
    records = [record_trial(evolved_plain[t % 60], trials[t], readings) for t in range(len(trials))]
    world = VectorWorld(trials, readings)
    for k in range(max(record.steps for record in records)):
        turns = np.zeros((len(trials), 2), int)
        for t, record in enumerate(records):
            if k < record.steps:
                assert np.array_equal(world.inputs[t], record.inputs[k]), (t, k)
                turns[t] = np.sign(record.turns[k])
        world.step(turns)
    for name in ("f1", "f2", "f3", "success", "steps"):
        asked = [getattr(record.scores, name)[0, 0] for record in records]
        assert np.array_equal(getattr(world.scores(), name)[0], asked), name
