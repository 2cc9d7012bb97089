"""What the skin feels, and how the hand pushes."""

from dataclasses import replace

import numpy as np
import pytest

from arm2d import Instruction, Readings, draw_trials, record_trial
from models.physics import SKIN
from mujoco_port.acting.contacts import LEFT_SIDE, OBJECT, RIGHT_SIDE, ContactSensors
from mujoco_port.acting.exertion import tracking_errors
from mujoco_port.acting.lab import Lab
from mujoco_port.acting.open_loop import OpenLoop
from mujoco_port.film.physical_port import start_of
from mujoco_port.reach.workspace import for_world, hand_headings, hand_targets

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


def test_skin_is_felt_by_what_hardly_touches_it_and_pushes_it_nowhere(lab, reached):
    """Within half a millimetre; a robot's arm swings by a tenth when it stops."""
    distance = float(np.hypot(*lab.kinematics.forward(reached).position[:2])) - 0.005
    gaps, untouched = [], 0
    for bearing in np.arange(ALPHA - 20.0, ALPHA, 0.01):
        lab.body.start(reached, places(lab, bearing, distance))
        touched, depth = ContactSensors(lab.body).read()
        if depth:
            break
        if touched[1]:
            contacts = lab.body.data.contact
            pair = (contacts.geom == lab.body.model.geom("green").id).any(axis=1) & (contacts.exclude == 1)
            gaps.extend(contacts.dist[pair])
            assert lab.body.data.nefc == untouched  # nothing pushes it that did not before
        else:
            untouched = lab.body.data.nefc
    assert gaps
    assert 0.4e-3 < max(gaps) <= SKIN
    assert min(gaps) > 0.0


@pytest.mark.parametrize("pressed", [0.5e-3, 2e-3])
def test_hand_that_is_pressed_in_by_a_depth_reads_this_depth(lab, reached, pressed):
    """The object is moved against the skin's normal, from where it hardly touches."""
    skin, distance = ContactSensors(lab.body), float(np.hypot(*lab.kinematics.forward(reached).position[:2]))
    for bearing in np.arange(ALPHA - 20.0, ALPHA, 0.01):
        standing = places(lab, bearing, distance - 0.005)
        lab.body.start(reached, standing)
        touched, depth = skin.read()
        if depth:
            break
    assert touched[1]
    assert depth < 0.1e-3
    contacts = lab.body.data.contact
    green = (contacts.geom == lab.body.model.geom("green").id).any(axis=1)
    # Of the table, normals are upright.
    (normal,) = (frame[:3] for frame in contacts.frame[green] if abs(frame[2]) < 0.9)
    towards = normal[:2] * np.sign(normal[:2] @ (lab.body.hand[:2] - standing[1]))
    standing[1] += pressed * towards / np.linalg.norm(towards)
    lab.body.start(reached, standing)
    assert skin.read()[1] == pytest.approx(depth + pressed, rel=0.05)
    standing[1] -= 0.01 * towards
    lab.body.start(reached, standing)
    assert skin.read()[1] == 0.0


def pushed_inwards_and_outwards(robot, readings):
    """How far [m] from its distance an object comes in and goes out while pushed by 60 degrees."""
    lab, sweep = Lab(robot, readings), [ALPHA + 10.0, *np.arange(ALPHA + 10.0, 45.0, -2.9)]
    discs = np.array([[220.0, 215.0], [-39.0, 145.0], [-260.0, 100.0]])
    orders = OpenLoop(iter([(alpha, 0.0) for alpha in sweep]))
    record, _ = lab.carry_out(orders, Instruction.parse("move green"), discs, readings, to_the_end=True)
    x, y = record.objects[:, 1, :2].T
    bearing = np.degrees(np.arctan2(y, x))
    assert bearing[0] - bearing[-1] > 55.0
    away = np.hypot(x, y) - np.hypot(x[0], y[0])
    return away.min(), away.max()


@pytest.mark.parametrize("radius", [5.0, 8.0])
def test_pushed_object_stays_with_the_hand(robot, radius):
    """One of 17 mm ends 12 mm further out; of a hand along its bearing it would be 16, to its left 19."""
    readings = Readings(object_radius=radius)
    inwards, outwards = pushed_inwards_and_outwards(robot, readings)
    assert inwards > -1e-3
    assert outwards < 0.82 * for_world(robot, readings).plane.object_radius


def test_pushed_object_does_not_roll_along_a_hand_that_is_not_square_to_its_way(robot):
    """With fingers 24 degrees to the right it came in by 2 mm; without resistance to rolling by 14."""
    askew = replace(robot, plane=replace(robot.plane, heading_lead=np.radians(24.0)))
    inwards, outwards = pushed_inwards_and_outwards(askew, Readings(object_radius=5.0))
    assert inwards > -5e-3
    assert outwards < 5e-3


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
