"""The robot's motors: the motion between control steps, feed-forward torques, tracking, limits."""

import dataclasses
from types import SimpleNamespace

import mujoco
import numpy as np
import pytest

from models.physics import NoPhysicsError, build_physics_model
from mujoco_port.acting.control import UnstableError
from mujoco_port.acting.exertion import Exertion, exertion, head_exertion, tracking_errors
from mujoco_port.acting.eyes import geometric_eyes
from mujoco_port.acting.open_loop import planar_angles
from mujoco_port.acting.rollout import carry_out
from mujoco_port.acting.trajectory import motion_between

N = 50  # physics steps in a control step


@pytest.fixture(scope="module")
def knots():
    """Joint targets [K, J] that start, turn back, stop and run on."""
    steps = np.random.default_rng(5).choice([-0.05, 0.0, 0.05], size=(40, 3))
    return np.cumsum(steps, axis=0)


def test_motion_ends_on_its_target_and_goes_on_from_where_the_last_one_ended(knots):
    first, second = motion_between(knots[0:4], N), motion_between(knots[1:5], N)
    np.testing.assert_allclose(first.angles[-1], knots[2], atol=1e-12)
    np.testing.assert_allclose(second.angles[-1], knots[3], atol=1e-12)
    start = second.angles[0] - first.angles[-1]
    # Over 2 ms the speed changes by at most 0.002 s times 60 rad/s^2: 0.05 rad from rest to rest in 0.1 s.
    assert np.abs(start - 0.002 * first.velocities[-1]).max() < 0.5 * 60 * 0.002**2


def test_motion_never_leaves_the_interval_between_two_targets(knots):
    for k in range(len(knots) - 3):
        angles = motion_between(knots[k : k + 4], N).angles
        low, high = np.minimum(knots[k + 1], knots[k + 2]), np.maximum(knots[k + 1], knots[k + 2])
        assert (angles >= low - 1e-12).all()
        assert (angles <= high + 1e-12).all()


def test_joint_that_is_told_to_stop_arrives_at_rest():
    motion = motion_between(np.array([[0.0], [0.1], [0.2], [0.2]]), N)
    assert motion.velocities[-1, 0] == pytest.approx(0.0, abs=1e-9)


def test_velocity_and_acceleration_are_the_derivatives_of_the_motion(knots):
    motion = motion_between(knots[3:7], 5000)
    step = 0.1 / 5000
    np.testing.assert_allclose(
        np.gradient(motion.angles, step, axis=0)[1:-1], motion.velocities[1:-1], atol=1e-4
    )
    np.testing.assert_allclose(
        np.gradient(motion.velocities, step, axis=0)[1:-1], motion.accelerations[1:-1], atol=1e-2
    )


def test_feed_forward_is_what_mujocos_own_inverse_dynamics_asks_for(lab, knots):
    """The set point of a motor pulls a joint that is on its way with exactly the torque the motion needs."""
    body = lab.body
    joints = [body.model.joint(f"robot/{name}") for name in (*body.robot.joints, *body.robot.head_joints)]
    middle = np.array([joint.range.mean() for joint in joints])
    turns = np.tile(knots[:4], (1, 6))[:, : len(middle)]
    motion = motion_between(middle + turns, N)
    points = body.set_points(motion)
    angles, speeds = [joint.qposadr[0] for joint in joints], [joint.dofadr[0] for joint in joints]
    data = mujoco.MjData(body.model)
    stiffness, damping = body.model.actuator_gainprm[:, 0], -body.model.actuator_biasprm[:, 2]
    for n in (0, 17, 49):
        data.qpos[angles], data.qvel[speeds] = motion.angles[n], motion.velocities[n]
        data.qacc[speeds] = motion.accelerations[n]
        mujoco.mj_inverse(body.model, data)
        pull = stiffness * (points[n] - motion.angles[n]) - damping * motion.velocities[n]
        np.testing.assert_allclose(pull, data.qfrc_inverse[speeds], atol=1e-8)


def test_hand_without_objects_in_its_way_is_tracked_and_the_motors_limits_hold(
    lab, evolved_agent, champion_records
):
    """The first four seconds of all nine instructions; benchmarks/physics.py does it for whole trials."""
    errors, away = [], np.array([[0.40, 0.38], [-0.50, 0.38], [-0.62, 0.38]]) / lab.body.robot.plane.scale
    for number, planar in enumerate(champion_records):
        if number % 4 not in (0, 3):
            continue  # nine of eighteen, right and left starts in turn
        orders = planar_angles(
            evolved_agent, planar.instruction, planar.alpha[0], planar.discs[0], planar.readings
        )
        record = carry_out(
            lab.body,
            lab.kinematics,
            _Orders(orders, 40),
            geometric_eyes(lab.body),
            planar.instruction,
            away,
            lambda _: False,
        )
        assert record.steps == 40
        errors.append(tracking_errors(record, lab.kinematics))
        assert not record.contact.any()
        arm, head = (
            exertion(record, lab.kinematics, lab.body.robot.limits),
            head_exertion(record, lab.body),
        )
        for used in (arm, head):
            assert used.velocity.max() < 1.0
            assert used.torque.max() <= 1.0
            assert used.position.max() < 1.001  # the stops are a little soft
    errors = np.concatenate(errors)
    assert np.median(errors) <= 0.05e-3
    assert errors.max() <= 1e-3


class _Orders:
    """The first `n` orders of somebody else."""

    def __init__(self, angles, n):
        self._angles, self._left = angles, n - 1

    def first(self):
        return next(self._angles), next(self._angles)

    def after(self, *_):
        self._left -= 1
        return next(self._angles) if self._left >= 0 else None


def test_exertion_is_told_in_parts_of_the_limits_and_the_larger_of_two_is_kept(kinematics, robot):
    """Joint 0 at the top of its range, joint 1 at the bottom, joint 2 in the middle."""
    limits, middle = robot.limits, (kinematics.lower + kinematics.upper) / 2
    angles = np.tile(middle, (2, 1))
    angles[0, 0], angles[1, 1] = kinematics.upper[0], kinematics.lower[1]
    speeds, torques = np.zeros((2, 10)), np.zeros((2, 10))
    speeds[1, 3], torques[0, 4] = -0.5 * limits.velocity[3], -0.25 * limits.torque[4]
    used = exertion(SimpleNamespace(angles=angles, velocities=speeds, torques=torques), kinematics, limits)
    np.testing.assert_allclose(used.position, [1.0, 1.0, *[0.0] * 8], atol=1e-12)
    np.testing.assert_allclose(used.velocity, [0.0] * 3 + [0.5] + [0.0] * 6)
    np.testing.assert_allclose(used.torque, [0.0] * 4 + [0.25] + [0.0] * 5)
    ones, nothing = np.full(10, 0.75), np.zeros(10)
    for both in (used.with_(Exertion(nothing, ones, nothing)), Exertion(nothing, ones, nothing).with_(used)):
        np.testing.assert_array_equal(both.position, used.position)
        np.testing.assert_array_equal(both.velocity, ones)
        np.testing.assert_array_equal(both.torque, used.torque)


def test_torque_never_exceeds_the_motors_limit(lab):
    body = lab.body
    body.start(lab.kinematics.rest, np.array([[0.40, 0.38], [-0.50, 0.38], [-0.62, 0.38]]))
    largest = np.array([*body.robot.limits.torque, *body.robot.presence.limits.torque])
    for _ in range(5):
        body.advance(np.concatenate([lab.kinematics.rest, body.head]) + 10.0)
        assert (np.abs(body.torques) <= largest).all()
    assert np.abs(body.torques) == pytest.approx(largest)
    body.refuse_unstable()


def test_simulation_that_blows_up_is_told_and_a_new_start_is_a_new_trial(lab, tmp_path, monkeypatch, capfd):
    monkeypatch.chdir(tmp_path)  # where MuJoCo would write a log
    body, away = lab.body, np.array([[0.40, 0.38], [-0.50, 0.38], [-0.62, 0.38]])
    body.start(lab.kinematics.rest, away)
    body.data.qvel[:] = np.nan
    body.advance(np.concatenate([lab.kinematics.rest, np.zeros(7)]))
    with pytest.raises(UnstableError, match="the physics of robot 'icub' became unstable"):
        body.refuse_unstable()
    body.start(lab.kinematics.rest, away)
    body.refuse_unstable()
    assert list(tmp_path.iterdir()) == []
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize(
    ("field", "empty", "missing"), [("limits", None, "motor limits"), ("shapes", (), "contact shapes")]
)
def test_robot_of_which_too_little_is_known_is_refused(robot, field, empty, missing):
    with pytest.raises(
        NoPhysicsError, match=f"the record of robot 'icub' has no {missing}; play the trial without"
    ):
        build_physics_model(dataclasses.replace(robot, **{field: empty}))
