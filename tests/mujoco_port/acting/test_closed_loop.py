"""Closed loop: what the robot senses, and that agents live in it."""

from types import SimpleNamespace

import numpy as np
import pytest

from arm2d import Instruction, Networks, Readings, Trials, draw_trials, encode, record_trial
from arm2d.geometry import camera_offsets
from arm2d.readings import PLAIN
from arm2d.reference import sense
from evolution.runs.sources import find_agent
from mujoco_port.acting.camera import CameraEyes
from mujoco_port.acting.closed_loop import ClosedLoop, felt
from mujoco_port.acting.contacts import LEFT_SIDE, RIGHT_SIDE
from mujoco_port.acting.eyes import geometric_eyes
from mujoco_port.acting.lab import Lab
from mujoco_port.film.physical_port import start_of
from mujoco_port.reach.workspace import beta_of, hand_headings, hand_targets, on_table

READINGS = Readings()


@pytest.fixture
def standing(lab, champion_records):
    """The robot at the start of a trial, hand high or away from the objects."""
    record = champion_records[0]
    plane, alpha, beta = lab.body.robot.plane, np.array(60.0), np.array(90.0)
    angles = lab.kinematics.settle(hand_targets(plane, alpha, beta), float(hand_headings(plane, alpha, beta)))
    lab.body.start(angles, on_table(plane, record.discs[0]))
    return lab.body, record.discs[0]


def bearing(place):
    return np.degrees(np.arctan2(place[1], place[0]))


def test_beta_follows_from_where_the_hand_is(robot):
    for alpha in (-30.0, 60.0, 210.0):
        for beta in (0.0, 2.9, 40.0, 90.0):
            hand = hand_targets(robot.plane, np.array(alpha), np.array(beta))
            assert beta_of(robot.plane, hand) == pytest.approx(beta, abs=1e-5)


def test_eyes_look_along_s1(lab, evolved_agent):
    """In every control step at the angle that the agent had ordered by then."""
    trial = draw_trials([Instruction.parse("indicate green")], 1, READINGS, np.random.default_rng(2))[0]
    eyes, looked = geometric_eyes(lab.body), []

    def look(alpha):
        looked.append(alpha)
        return eyes(alpha)

    record, _ = lab.closed_loop(evolved_agent, trial, READINGS, look)
    np.testing.assert_array_equal(looked, record.orders[:-1, 0])
    assert np.ptp(looked) > 5.0


def test_touch_is_felt_on_the_side_where_it_was_within_the_last_moments():
    contact = np.zeros((10, 3), np.uint8)
    contact[2, 0], contact[7, 2] = RIGHT_SIDE, LEFT_SIDE
    assert felt(contact) == ["right", None, "left"]
    assert felt(contact[:0]) == [None, None, None]


@pytest.mark.parametrize(("ago_ms", "is_felt"), [(2, True), (14, True), (20, True), (22, False)])
def test_touch_is_felt_for_twenty_milliseconds(standing, ago_ms, is_felt):
    """An agent whose S1 turns left while its right touch sensor is on, 200 ms after its start."""
    body, discs = standing
    pilot = ClosedLoop(turns_by([0]), Instruction.parse("touch red"), 60.0, READINGS, body)
    contact = np.zeros((100, 3), np.uint8)
    contact[-ago_ms // 2, 2] = RIGHT_SIDE
    alphas = [pilot.first()[1][0]]
    alphas += [pilot.after(SimpleNamespace(contact=contact), discs)[0] for _ in range(10)]
    assert (np.diff(alphas) > 0.0).any() == is_felt


def test_geometric_eyes_see_objects_where_the_2d_world_has_them(standing):
    body, discs = standing
    np.testing.assert_allclose(geometric_eyes(body)(0.0).by_camera, discs, atol=1e-9)


def test_camera_sees_the_same_bearings_as_geometry_and_nothing_outside_its_field(standing):
    """A camera in J1."""
    body, discs = standing
    with CameraEyes(body, PLAIN) as eyes:
        for target, disc in enumerate(discs):
            true = bearing(disc)
            for offset in (-14.0, -5.0, 0.0, 9.0, 14.0):
                seen = eyes(true + offset).by_camera
                # A pixel in the middle of the picture is 0.18 degrees wide.
                assert bearing(seen[target]) == pytest.approx(true, abs=0.2)
                hidden = [k for k in range(3) if abs(bearing(discs[k]) - true - offset) > 60.0]
                assert all(seen[k][1] < -100.0 for k in hidden)


def test_camera_at_the_end_of_s1_sees_bearings_from_there_and_the_robot_still_looks_from_j1(standing):
    body, discs = standing
    end = Readings(camera_origin="end")
    with CameraEyes(body, end) as eyes, CameraEyes(body, PLAIN) as others:
        for target, disc in enumerate(discs):
            for offset in (-9.0, -3.0, 0.0, 1.0, 5.0):
                alpha = bearing(disc) + offset
                sight = eyes(alpha)
                true = camera_offsets(np.array(alpha), disc, end)
                # In the middle of the picture a pixel is 0.18 degrees wide.
                assert camera_offsets(np.array(alpha), sight.by_camera[target], end) == pytest.approx(
                    true, abs=0.2
                )
                np.testing.assert_array_equal(sight.from_j1, others(alpha).from_j1)


def test_what_the_camera_at_the_end_of_s1_does_not_see_is_in_no_sector(standing):
    body, discs = standing
    end, heard = Readings(camera_origin="end"), Instruction.parse("touch red")
    with CameraEyes(body, end) as eyes:
        for alpha in range(-29, 210):
            true = sense(alpha, 90.0, [tuple(disc) for disc in discs], [None] * 3, heard, end)
            seen = sense(alpha, 90.0, eyes(alpha).by_camera.tolist(), [None] * 3, heard, end)
            edges = np.abs(np.abs(camera_offsets(np.array(float(alpha)), discs, end)) - [[5.0], [15.0]]).min()
            assert seen == true or edges < 0.3


def test_agent_in_the_robot_senses_what_its_camera_at_the_end_of_s1_sees(lab, champion_records):
    """With S1 8 degrees beside an object, a camera in J1 sees it, and one at the end of S1 does not."""
    discs = champion_records[0].discs[0]
    start = np.array([bearing(discs[2]) - 8.0])
    trial = Trials(np.array([1]), np.array([2]), start, discs[np.newaxis])
    genotype = turns_when_it_sees_red()
    with CameraEyes(lab.body, Readings(camera_origin="end")) as eyes:
        for origin, sights, turns in (("J1", [None], True), ("end", [None, eyes], False)):
            for sight in sights:
                physical, _ = lab.closed_loop(genotype, trial, Readings(camera_origin=origin), sight)
                assert (np.ptp(physical.orders[:40, 0]) > 0.0) == turns


def test_agents_order_takes_effect_one_control_step_after_what_it_answers_to(lab, evolved_agent):
    """In the 2D world the second state answers to the first inputs; here the third does."""
    record = _trial("indicate red", evolved_agent)
    physical, _ = lab.closed_loop(evolved_agent, start_of(record), READINGS)
    np.testing.assert_array_equal(physical.orders[0], physical.orders[1])
    k = 15  # nothing has been seen yet: the same inputs, the same turns
    np.testing.assert_allclose(physical.orders[1 : k + 2, 0], record.alpha[: k + 1], atol=1e-9)


def test_shipped_agent_touches_red_in_the_robots_body_with_either_kind_of_eyes(robot):
    champion = find_agent("with-ignore")
    lab = Lab(robot, champion.readings)
    record = _trial("touch red", champion.genotype, champion.readings)
    assert record.success
    with CameraEyes(lab.body, champion.readings) as eyes:
        for sight in (None, eyes):
            physical, verdict = lab.closed_loop(champion.genotype, start_of(record), champion.readings, sight)
            assert verdict.success
            assert abs(physical.steps - record.steps) < 10


def test_same_trial_is_repeated_to_the_last_bit(lab, evolved_agent):
    record = _trial("move red", evolved_agent)
    first, second = (lab.closed_loop(evolved_agent, start_of(record), READINGS)[0] for _ in range(2))
    np.testing.assert_array_equal(first.objects, second.objects)
    np.testing.assert_array_equal(first.contact, second.contact)


def turns_when_it_sees_red():
    """A genotype [84] whose S1 turns left as long as a red sensor of the camera is on, and S2 never."""
    return turns_by([4, 7, 10])


def turns_by(sensors):
    """The same for any sensors, by their indices."""
    sensory, motor = np.zeros((1, 18, 3)), np.zeros((1, 3, 4))
    sensory[0, sensors, 0] = 8.0
    motor[0, 0, 0] = 10.0
    networks = Networks(
        sensory_weights=sensory,
        recurrent_weights=np.zeros((1, 3, 3)),
        motor_weights=motor,
        decay_constants=np.full((1, 3), 0.1),
        input_bias=np.full(1, -4.0),
        inter_biases=np.full((1, 3), -5.0),
        motor_bias=np.full(1, -5.0),
        gain=np.full(1, 13.0),
    )
    return encode(networks, READINGS)[0]


def _trial(words, genotype, readings=READINGS):
    trials = draw_trials([Instruction.parse(words)], 1, readings, np.random.default_rng(2))
    return record_trial(genotype, trials[0], readings)
