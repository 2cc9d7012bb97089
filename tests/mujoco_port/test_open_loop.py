"""The orders of the open loop are the 2D world's own."""

from itertools import islice

import numpy as np

from mujoco_port.open_loop import OpenLoop, planar_angles


def test_orders_are_those_of_the_recorded_trial_and_go_on_after_it(evolved_agent, champion_records):
    for record in champion_records:
        ordered = planar_angles(
            evolved_agent, record.instruction, record.alpha[0], record.discs[0], record.readings
        )
        orders = [*OpenLoop(ordered).first(), *islice(ordered, record.steps)]
        recorded = np.stack([record.alpha, record.beta], axis=-1)
        np.testing.assert_allclose(orders[:-1], recorded, atol=1e-9)
