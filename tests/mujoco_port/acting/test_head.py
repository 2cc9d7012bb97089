"""Neck and eyes as motors turn them: within limits and speeds, along S1, and in no way of the hand."""

import mujoco
import numpy as np
import pytest

from arm2d.constants import DT
from models.build import ROBOT_PREFIX
from mujoco_port.acting.exertion import head_exertion, tracking_errors
from mujoco_port.acting.eyes import geometric_eyes
from mujoco_port.acting.lab import Lab
from mujoco_port.acting.open_loop import OpenLoop, planar_angles
from mujoco_port.acting.rollout import _gaze_of, carry_out
from mujoco_port.film.physical_port import start_of
from mujoco_port.reach.gaze import looked_at

AWAY = np.array([[0.40, 0.38], [-0.50, 0.38], [-0.62, 0.38]])  # [m], corners of the table
# Times as far from its path, at most, as with a head that is held; docs/physics.md has what was measured.
FURTHER = 1.1


@pytest.fixture(scope="module")
def still(robot):
    """The same robot with a head that is held."""
    return Lab(robot.with_head_held)


@pytest.fixture(scope="module")
def searching(champion_records):
    """The trials in which S1 turns most, most of all first."""
    return sorted(champion_records, key=lambda each: -np.abs(np.diff(each.alpha)).sum())


def swept(lab, genotype, planar):
    """A whole trial with the objects out of the way."""
    orders = planar_angles(genotype, planar.instruction, planar.alpha[0], planar.discs[0], planar.readings)
    places = AWAY / lab.body.robot.plane.scale
    eyes = geometric_eyes(lab.body)
    return carry_out(
        lab.body, lab.kinematics, OpenLoop(orders), eyes, planar.instruction, places, lambda _: False
    )


def test_a_turning_head_does_not_take_the_hand_off_its_path(lab, still, searching, evolved_agent):
    for planar in searching[:2]:
        moving, held = (swept(each, evolved_agent, planar) for each in (lab, still))
        assert np.abs(np.diff(moving.head[:, :3], axis=0)).sum() > 0.5  # [rad], it does turn
        errors, before = (tracking_errors(each, lab.kinematics) for each in (moving, held))
        for share in (50.0, 99.0, 100.0):
            assert np.percentile(errors, share) < FURTHER * np.percentile(before, share) + 1e-7


def test_neck_and_eyes_keep_their_limits_speeds_and_torques(lab, searching, evolved_agent):
    used = head_exertion(swept(lab, evolved_agent, searching[0]), lab.body)
    assert used.position.max() < 1.001  # the stops are a little soft
    assert used.velocity.max() < 1.0
    assert used.torque.max() < 0.5


def test_a_head_in_a_hurry_takes_two_thirds_of_its_largest_speeds(lab):
    gaze, presence = _gaze_of(lab.body), lab.body.robot.presence
    before = np.array(gaze.follow(lab.kinematics.rest, 0.0, None))
    steps = [before]
    for _ in range(3):
        steps.append(np.array(gaze.follow(lab.kinematics.rest, 180.0, DT)))
    fastest = np.abs(np.diff(steps, axis=0)).max(axis=0) / DT  # [rad/s]
    neck = len(presence.neck)
    assert fastest[:neck].max() == pytest.approx(2 / 3 * presence.neck_speed)
    assert fastest[neck:].max() <= 2 / 3 * presence.eye_speed + 1e-9


def test_an_acting_robot_looks_where_s1_points(lab, searching, evolved_agent):
    """Both eyes within 6 degrees in most moments, as in films of set angles."""
    record = swept(lab, evolved_agent, searching[0])
    rows = np.arange(0, len(record.alpha), 50)
    off = [eyes_off(lab, record.angles[row], record.head[row], record.alpha[row]) for row in rows]
    assert np.median(off) < 6.0


@pytest.mark.parametrize("alpha", [60.0, 90.0, 120.0])
def test_eyes_that_have_time_look_straight_at_the_place(lab, alpha):
    rest = lab.kinematics.rest
    head = _gaze_of(lab.body).follow(rest, alpha, None)
    assert eyes_off(lab, rest, head, alpha) == pytest.approx([0.0, 0.0], abs=0.05)


def eyes_off(lab, angles, head, alpha):
    """How far each eye looks past the place along S1 [deg], in a posture of arm and head."""
    robot, model = lab.body.robot, lab.body.model
    data, (place,) = mujoco.MjData(model), looked_at(robot, np.array([alpha]))
    joints = [model.joint(ROBOT_PREFIX + name).qposadr[0] for name in (*robot.joints, *robot.head_joints)]
    data.qpos[joints] = *angles, *head
    mujoco.mj_kinematics(model, data)
    off = []
    for eye in robot.presence.eyes:
        body = data.body(ROBOT_PREFIX + eye.name)
        way = (place - body.xpos) / np.linalg.norm(place - body.xpos)
        cosine = way @ body.xmat.reshape(3, 3) @ np.array(eye.ahead)
        off.append(np.degrees(np.arccos(min(1.0, cosine))))
    return off


def test_verdicts_are_those_of_a_head_that_is_held(lab, still, champion_records, evolved_agent):
    for planar in champion_records[::6]:
        trial = start_of(planar)
        one, other = (each.open_loop(evolved_agent, trial, planar.readings)[1] for each in (lab, still))
        assert (one.success, one.certain) == (other.success, other.certain)
        assert one.progress == pytest.approx(other.progress, abs=1.0)


def test_the_inverse_kinematics_knows_nothing_of_the_head(lab, still, searching):
    for turned in (np.zeros(7), np.array([0.3, 0.2, 0.8, 0.5, 0.5, 0.5, 0.5])):
        lab.body.start(lab.kinematics.rest, AWAY, turned)
        still.body.start(lab.kinematics.rest, AWAY)
        np.testing.assert_array_equal(lab.body.hand, still.body.hand)
        assert lab.kinematics.forward(lab.kinematics.rest).position == pytest.approx(lab.body.hand, abs=1e-12)
