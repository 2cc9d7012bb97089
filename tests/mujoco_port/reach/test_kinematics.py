"""Inverse kinematics: how exactly the hand follows, and that Pinocchio and MuJoCo mean the same robot."""

import re
from dataclasses import replace

import mujoco
import numpy as np
import pytest
from scipy.optimize import least_squares

from models.build import HAND_SITE, ROBOT_PREFIX, build_model
from models.robots import ICUB, ROBOTS, get_robot
from mujoco_port.film.kinematic import roll_out
from mujoco_port.reach.kinematics import MAX_TURN, ArmKinematics, OutOfReachError
from mujoco_port.reach.workspace import hand_headings, hand_targets


# Every robot there is has to pass.
@pytest.fixture(scope="module", params=ROBOTS)
def robot(request):
    return get_robot(request.param)


@pytest.fixture(scope="module")
def kinematics(robot):
    return ArmKinematics(robot)


LARGEST_ERROR_M = 1e-6
LARGEST_JUMP_RAD = 0.15
TURN_DEG = 2.9


def assert_followed(kinematics, targets, angles):
    """Position error, joint limits and jumps of a path are within what is promised."""
    reached = np.array([kinematics.forward(each).position for each in angles])
    assert np.linalg.norm(reached - targets, axis=1).max() <= LARGEST_ERROR_M
    assert (angles >= kinematics.lower).all()
    assert (angles <= kinematics.upper).all()
    assert np.abs(np.diff(angles, axis=0)).max() <= LARGEST_JUMP_RAD


def test_pinocchio_and_mujoco_agree_on_ten_thousand_postures(robot, kinematics):
    model = build_model(robot)
    data = mujoco.MjData(model)
    joints = [model.joint(ROBOT_PREFIX + name).qposadr[0] for name in robot.joints]
    postures = np.random.default_rng(0).uniform(kinematics.lower, kinematics.upper, (10_000, len(joints)))
    worst = 0.0
    for angles in postures:
        data.qpos[joints] = angles
        mujoco.mj_kinematics(model, data)
        hand = data.site(HAND_SITE)
        pose = kinematics.forward(angles)
        worst = max(worst, np.abs(hand.xpos - pose.position).max())
        assert np.abs(hand.xmat.reshape(3, 3) - pose.rotation).max() < 1e-12
    assert worst < 1e-12


def test_a_joint_that_does_not_act_is_held_at_its_angle_by_both(robot):
    """One between root and hand, for on others the hand does not depend."""
    at = robot.joints.index("torso_yaw")
    rest, weights = (np.delete(numbers, at) for numbers in (robot.posture.rest, robot.posture.weights))
    held = replace(
        robot,
        joints=tuple(np.delete(robot.joints, at).tolist()),
        posture=replace(robot.posture, rest=tuple(rest), weights=tuple(weights)),
        fixed={**robot.fixed, "torso_yaw": 0.3},
    )
    model, kinematics = build_model(held), ArmKinematics(held)
    data = mujoco.MjData(model)
    data.qpos[[model.joint(ROBOT_PREFIX + name).qposadr[0] for name in held.joints]] = rest
    mujoco.mj_kinematics(model, data)
    np.testing.assert_allclose(kinematics.forward(rest).position, data.site(HAND_SITE).xpos, atol=1e-12)
    whole = ArmKinematics(robot).forward(np.insert(rest, at, 0.3))
    np.testing.assert_allclose(kinematics.forward(rest).rotation, whole.rotation, atol=1e-12)
    np.testing.assert_allclose(kinematics.forward(rest).position, whole.position, atol=1e-12)


def test_joint_limits_are_those_of_the_mujoco_model(robot, kinematics):
    model = build_model(robot)
    ranges = np.array([model.joint(ROBOT_PREFIX + name).range for name in robot.joints])
    np.testing.assert_allclose(ranges[:, 0], kinematics.lower, atol=1e-9)
    np.testing.assert_allclose(ranges[:, 1], kinematics.upper, atol=1e-9)


def test_champions_trials_of_all_nine_instructions_are_followed_to_a_micrometre(
    robot, kinematics, champion_records
):
    assert len({record.instruction for record in champion_records}) == 9
    for record in champion_records:
        rollout = roll_out(record, robot, frames_per_step=1)
        assert len(rollout.angles) == record.steps + 1
        assert_followed(kinematics, rollout.targets, rollout.angles)


def test_whole_workspace_is_reached_to_a_micrometre(robot, kinematics):
    """A grid of all alpha and beta no wider than a turn, walked back and forth."""
    alpha, beta = np.linspace(-30, 210, 84), np.linspace(0, 90, 33)
    assert max(np.diff(alpha).max(), np.diff(beta).max()) <= TURN_DEG
    columns = [beta[:: -1 if k % 2 else 1] for k in range(len(alpha))]
    walk = np.repeat(alpha, len(beta)), np.concatenate(columns)
    targets = hand_targets(robot.plane, *walk)
    angles = kinematics.follow(targets, hand_headings(robot.plane, *walk))
    assert_followed(kinematics, targets, angles)


def test_hand_keeps_its_roll_and_points_outwards(robot, kinematics, champion_records):
    for record in champion_records[::4]:
        rollout = roll_out(record, robot, frames_per_step=1)
        wanted = hand_headings(robot.plane, record.alpha, record.beta)
        for angles, heading in zip(rollout.angles, wanted, strict=True):
            hand = kinematics.forward(angles)
            assert kinematics.roll_error(hand) < np.radians(20)  # soft: a wish, not a promise
            assert kinematics.heading_error(hand, heading) < np.radians(45)


def test_tilt_lets_a_hand_that_lies_on_its_back_turn_over(robot, kinematics):
    """The sine of the tilt is as small on the back as on the palm; its angle must lessen all the same."""
    rng = np.random.default_rng(4)
    found = 0
    while found < 20:
        angles = rng.uniform(kinematics.lower, kinematics.upper)
        before = kinematics.forward(angles)
        if kinematics.roll_error(before) < np.radians(150):
            continue
        found += 1
        direction = before.rotation[:2, 0]
        after = kinematics.step(angles, before.position, float(np.arctan2(direction[1], direction[0])))
        assert kinematics.roll_error(kinematics.forward(after)) < kinematics.roll_error(before)


def test_same_targets_give_the_same_postures(robot, champion_records):
    first, second = (roll_out(champion_records[0], robot) for _ in range(2))
    np.testing.assert_array_equal(first.angles, second.angles)


def test_no_joint_turns_far_where_the_arm_meets_its_limits(robot, kinematics):
    """At the left bound five joints are near a limit at once; torso_yaw once turned by 0.157 rad there."""
    alpha = np.array([*np.arange(152.3, 207.5, 2.9), 210.0, 210.0, 210.0, 207.1])
    beta = np.array([90.0] * 8 + [90.0 - 2.9 * k for k in range(1, len(alpha) - 7)])
    targets, headings = hand_targets(robot.plane, alpha, beta), hand_headings(robot.plane, alpha, beta)
    angles = kinematics.follow(targets, headings)
    assert_followed(kinematics, targets, angles)
    assert np.abs(np.diff(angles, axis=0)).max() <= MAX_TURN + 1e-12


def test_trial_can_start_at_every_bound_of_the_workspace(robot, kinematics):
    for alpha in (-30.0, 0.0, 90.0, 180.0, 210.0):
        for beta in np.linspace(0.0, 90.0, 31):
            target = hand_targets(robot.plane, alpha, beta)
            angles = kinematics.settle(target, float(hand_headings(robot.plane, alpha, beta)))
            assert np.linalg.norm(kinematics.forward(angles).position - target) <= LARGEST_ERROR_M


def test_a_settled_posture_stays_where_it_is(robot, kinematics):
    for alpha, beta in ((-30.0, 90.0), (90.0, 45.0), (150.0, 0.0), (210.0, 90.0)):
        target, heading = (
            hand_targets(robot.plane, alpha, beta),
            float(hand_headings(robot.plane, alpha, beta)),
        )
        settled = kinematics.settle(target, heading)
        np.testing.assert_allclose(kinematics.step(settled, target, heading), settled, atol=1.01e-7)


def test_the_search_for_the_nearest_place_ends_at_once_where_the_hand_is_there(kinematics):
    posture = np.random.default_rng(3).uniform(kinematics.lower, kinematics.upper)
    found, distance = kinematics._descend(posture, kinematics.forward(posture).position)
    np.testing.assert_allclose(found, posture, atol=1e-9)
    assert distance < 1e-9


def test_far_target_is_reached_in_one_step_if_need_be(robot, kinematics):
    alpha, beta = np.array([0.0, 180.0]), np.array([90.0, 0.0])
    targets = hand_targets(robot.plane, alpha, beta)
    angles = kinematics.follow(targets, hand_headings(robot.plane, alpha, beta))
    assert np.linalg.norm(kinematics.forward(angles[1]).position - targets[1]) <= LARGEST_ERROR_M


def test_distance_out_of_reach_is_that_from_the_nearest_place(kinematics):
    """Held against bounded least squares from 25 random postures."""
    target, rng = np.array([0.0, 0.5, 0.05]), np.random.default_rng(0)
    nearest = min(
        np.linalg.norm(
            least_squares(
                lambda angles: kinematics.forward(angles).position - target,
                rng.uniform(kinematics.lower, kinematics.upper),
                bounds=(kinematics.lower, kinematics.upper),
            ).fun
        )
        for _ in range(25)
    )
    with pytest.raises(OutOfReachError) as caught:
        kinematics.settle(target, np.pi / 2)
    assert caught.value.distance == pytest.approx(nearest, abs=1e-4)


def test_target_out_of_reach_says_by_how_much(kinematics):
    with pytest.raises(
        OutOfReachError, match=r"target \(0.000, 3.000, 0.050\) m lies 2\.\d+ m beyond the reach"
    ):
        kinematics.settle(np.array([0.0, 3.0, 0.05]), 0.0)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_what_is_not_a_number_is_refused_wherever_it_stands(kinematics, robot, bad):
    target, heading = hand_targets(robot.plane, 90.0, 45.0), float(hand_headings(robot.plane, 90.0, 45.0))
    posture = kinematics.settle(target, heading)
    nowhere, broken = target.copy(), posture.copy()
    nowhere[1] = broken[2] = bad
    with pytest.raises(ValueError, match=r"heading .* rad holds what is not a finite number"):
        kinematics.settle(target, bad)
    with pytest.raises(ValueError, match=r"heading .* rad holds what is not a finite number"):
        kinematics.step(posture, target, bad)
    with pytest.raises(ValueError, match=r"target \[.*\] m holds what is not a finite number"):
        kinematics.settle(nowhere, heading)
    with pytest.raises(ValueError, match=r"posture \[.*\] rad holds what is not a finite number"):
        kinematics.step(broken, target, heading)
    with pytest.raises(ValueError, match=r"heading .* rad holds what is not a finite number"):
        kinematics.follow(np.array([target, target]), np.array([heading, bad]))


@pytest.mark.parametrize(
    ("changed", "sentence"),
    [
        ({"joints": ("torso_pich", *ICUB.joints[1:])}, "has no joint 'torso_pich'; near to it: torso_pitch"),
        ({"hand_frame": "r_hand_dh_fram"}, "has no frame 'r_hand_dh_fram'; near to it: r_hand_dh_frame"),
        ({"fixed": {"nek_pitch": 0.1}}, "has no joint 'nek_pitch'; near to it: neck_pitch"),
    ],
)
def test_a_record_that_its_description_contradicts_is_refused(changed, sentence):
    with pytest.raises(ValueError, match=re.escape(sentence)):
        ArmKinematics(replace(ICUB, **changed))
