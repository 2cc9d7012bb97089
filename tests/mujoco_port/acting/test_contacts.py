"""What the skin feels, and how the hand pushes."""

import numpy as np
import pytest

from arm2d import Instruction, Readings, draw_trials, record_trial
from mujoco_port.acting.contacts import LEFT_SIDE, OBJECT, RIGHT_SIDE, ContactSensors
from mujoco_port.acting.exertion import tracking_errors
from mujoco_port.film.physical_port import start_of
from mujoco_port.reach.workspace import hand_headings, hand_targets

ALPHA = 120.0  # where the straight arm of these tests points


@pytest.fixture
def reached(lab):
    """The robot's joints with a straight arm."""
    plane, alpha, beta = lab.body.robot.plane, np.array(ALPHA), np.array(0.0)
    return lab.kinematics.settle(hand_targets(plane, alpha, beta), float(hand_headings(plane, alpha, beta)))


def places(lab, bearing, distance):
    """The green object at a bearing [deg] and distance [m], the others out of the way."""
    green = distance * np.array([np.cos(np.radians(bearing)), np.sin(np.radians(bearing))])
    return np.array([[0.40, 0.38], green, [-0.62, 0.38]])


def feel(lab, reached, bearing):
    """The bits of the green object when the hand stands still beside it."""
    distance = float(np.linalg.norm(lab.kinematics.forward(reached).position[:2])) - 0.005
    lab.body.start(reached, places(lab, bearing, distance))
    return ContactSensors(lab.body).read()[0]


@pytest.mark.parametrize(("direction", "side"), [(-1.0, RIGHT_SIDE), (1.0, LEFT_SIDE)])
def test_object_that_comes_from_one_side_is_felt_by_that_side_first(lab, reached, direction, side):
    """The right one is the little finger's."""
    felt = [feel(lab, reached, ALPHA + direction * off)[1] for off in np.arange(30.0, 0.0, -0.25)]
    assert felt[0] == 0  # too far away
    assert next(bits for bits in felt if bits) == side


def test_objects_that_touch_each_other_are_told(lab, reached):
    side_by_side = np.array([[0.30, 0.38], [0.339, 0.38], [-0.62, 0.38]])
    radius = lab.body.model.geom("blue").size[0]
    side_by_side[1, 0] = side_by_side[0, 0] + 2 * radius - 1e-4
    lab.body.start(reached, side_by_side)
    assert ContactSensors(lab.body).read()[0].tolist() == [OBJECT, OBJECT, 0]


def test_objects_that_nobody_touches_stay_where_they_are(lab, evolved_agent):
    record = _trial("indicate red", evolved_agent)
    physical, _ = lab.open_loop(evolved_agent, start_of(record), record.readings)
    untouched = ~physical.contact.any(axis=0)
    assert untouched.any()
    drift = np.abs(physical.objects - physical.objects[0])[:, untouched]
    assert drift.max() < 2e-4  # they sink in by a tenth of a millimetre under their own weight
    assert physical.upright[:, untouched].min() > 1 - 1e-6


def test_pushed_object_goes_where_the_2d_disc_goes(lab, evolved_agent):
    record = _trial("move red", evolved_agent)
    assert record.success
    physical, verdict = lab.open_loop(evolved_agent, start_of(record), record.readings)
    assert verdict.success
    x, y = physical.objects[-1, 2, :2]
    disc = record.discs[-1, 2]
    assert np.degrees(np.arctan2(y, x)) == pytest.approx(np.degrees(np.arctan2(disc[1], disc[0])), abs=4.0)
    assert tracking_errors(physical, lab.kinematics).max() <= 8e-3
    assert physical.depth.max() < 3e-3  # no hand inside an object


def _trial(words, genotype):
    trials = draw_trials([Instruction.parse(words)], 1, Readings(), np.random.default_rng(2))
    return record_trial(genotype, trials[0])
