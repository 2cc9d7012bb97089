"""The orders of the open loop are the 2D world's own."""

from itertools import islice

import numpy as np
import pytest

from arm2d import Instruction, Readings, draw_trials
from mujoco_port.acting.open_loop import OpenLoop, planar_angles


def test_orders_are_those_of_the_recorded_trial_and_go_on_after_it(evolved_agent, champion_records):
    for record in champion_records:
        ordered = planar_angles(
            evolved_agent, record.instruction, record.alpha[0], record.discs[0], record.readings
        )
        orders = [*OpenLoop(ordered).first(), *islice(ordered, record.steps)]
        recorded = np.stack([record.alpha, record.beta], axis=-1)
        np.testing.assert_allclose(orders[:-1], recorded, atol=1e-9)


def test_delayed_agent_stands_still_for_so_many_steps_and_then_does_what_it_would_have_done(evolved_agent):
    """Nothing is in view at first, and nothing touched: the same inputs, the same turns, later."""
    trials = draw_trials([Instruction.parse("indicate red")], 1, Readings(), np.random.default_rng(2))
    start = trials.alpha[0], trials.discs[0], Readings()
    prompt, late = (
        list(islice(planar_angles(evolved_agent, Instruction.parse("indicate red"), *start, delay), 15))
        for delay in (0, 2)
    )
    assert late[:3] == [prompt[0]] * 3
    np.testing.assert_allclose(late[2:], prompt[:13], atol=1e-9)


@pytest.mark.parametrize(
    ("world", "told"),
    [
        (
            {"object_radius": 11.8},
            r"those of this trial have 11.8 cm and begin at 135\.9; make a lab for its",
        ),
        ({"sector_half_width": 5.0}, r"begin at 14\d\.4; make a lab for its world: Lab\(robot, readings\)"),
    ],
)
def test_a_table_laid_for_another_world_is_refused(lab, evolved_agent, world, told):
    readings = Readings().with_values(world)
    trial = draw_trials([Instruction.parse("touch red")], 1, readings, np.random.default_rng(2))[0]
    with pytest.raises(ValueError, match=told):
        lab.open_loop(evolved_agent, trial, readings)
