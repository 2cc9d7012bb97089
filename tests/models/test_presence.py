"""The numbers of what only a film moves: eyes in a head, fingers on a hand, joints within their limits."""

import mujoco
import numpy as np
import pytest

from models.build import ROBOT_PREFIX, build_model
from models.filmed import film_spec
from models.presence import RELAXED
from models.robots import ROBOTS
from models.shapes import ICUB_SHAPES
from models.spec import read_spec

MM = 1e-3  # [m]
# Fingers whose straight phalanges are a capsule of `models.shapes`; the thumb's begins nearer to the wrist.
OFF_THE_CAPSULE = {"little": 1 * MM, "ring": 1 * MM, "middle": 1 * MM, "index": 1 * MM, "thumb": 15 * MM}
# Held further ahead than the real arm can be: known, and part of every stored result.
HELD_BEYOND = {"l_shoulder_pitch"}


@pytest.fixture(scope="module", params=ROBOTS)
def robot(request):
    return ROBOTS[request.param]


def angle(one, other):
    """Between two vectors [deg]."""
    return np.degrees(np.arccos(np.dot(one, other) / np.linalg.norm(one) / np.linalg.norm(other)))


def test_a_face_and_its_eyes_look_along_unit_vectors_square_to_their_left(robot):
    for each in (robot.presence, *robot.presence.eyes):
        assert np.linalg.norm([each.ahead, each.left], axis=1) == pytest.approx(1.0)
        assert angle(each.ahead, each.left) == pytest.approx(90.0)
        np.testing.assert_array_equal(each.ahead, robot.presence.ahead)


def test_eyes_that_cannot_turn_look_ten_degrees_down_and_to_no_side(robot):
    for eye in robot.presence.eyes:
        up = np.cross(eye.ahead, eye.left)
        assert np.linalg.norm(eye.still) == pytest.approx(1.0, abs=0.001)
        assert angle(eye.still, eye.ahead) == pytest.approx(10.0, abs=0.5)
        assert np.dot(eye.still, up) < 0.0
        assert np.dot(eye.still, eye.left) == 0.0


def test_eyes_are_mirror_images_as_far_apart_as_a_childs(robot):
    left, right = (np.array(eye.centre) for eye in robot.presence.eyes)
    apart = left - right
    assert 0.06 < np.linalg.norm(apart) < 0.07
    np.testing.assert_allclose(apart / np.linalg.norm(apart), robot.presence.left)
    assert np.dot((left + right) / 2, robot.presence.left) == pytest.approx(0.0)


def test_eyes_are_in_the_upper_half_of_the_face(robot):
    """In front of the head's joint and above it, by as much as a head is large."""
    for eye in robot.presence.eyes:
        up = np.cross(eye.ahead, eye.left)
        assert 0.03 < np.dot(eye.centre, eye.ahead) < 0.08
        assert 0.08 < np.dot(eye.centre, up) < 0.12


def distance(point, start, end):
    """Of a point from a line between two others."""
    start, way = np.array(start), np.subtract(end, start)
    share = np.clip(np.dot(point - start, way) / np.dot(way, way), 0.0, 1.0)
    return np.linalg.norm(point - start - share * way)


def test_a_straight_finger_is_the_capsule_that_meets_objects(robot):
    capsules = {each.name.removesuffix("_finger"): each for each in ICUB_SHAPES if each.radius}
    for finger in robot.presence.fingers:
        capsule, within = capsules[finger.name], OFF_THE_CAPSULE[finger.name]
        lengths = np.concatenate([[0.0], np.cumsum(finger.lengths)])
        places = np.array(finger.base) + np.outer(lengths, finger.axes[0])
        for place in places:
            assert distance(place, capsule.start, capsule.end) < within
        assert np.linalg.norm(places[-1] - capsule.end) < within
        assert finger.radius == pytest.approx(capsule.radius, abs=1.2 * MM)


def test_what_a_record_maps_cannot_be_changed(robot):
    for mapping in (robot.fixed, robot.presence.resting, robot.presence.hands):
        with pytest.raises(TypeError, match="does not support item assignment"):
            mapping["l_elbow"] = 0.0


def test_phalanges_get_shorter_towards_the_tip(robot):
    for finger in robot.presence.fingers:
        assert list(finger.lengths) == sorted(finger.lengths, reverse=True)


def test_a_finger_bends_square_to_its_length_and_towards_the_palm(robot):
    """z leaves the palm: so does the tip of a finger that begins to bend, and a thumb crosses the palm."""
    for finger in robot.presence.fingers:
        along, bend = finger.axes
        assert np.linalg.norm(finger.axes, axis=1) == pytest.approx(1.0, abs=0.002)
        assert angle(along, bend) == pytest.approx(90.0, abs=4.0)
        motion = np.cross(bend, along)  # of the tip
        assert motion[1 if finger.name == "thumb" else 2] > 0.2


def test_a_pointing_hand_has_the_index_straight_and_all_others_bent(robot):
    for finger in robot.presence.fingers:
        bends = np.array(finger.pointing)
        assert (bends >= 0.0).all()
        if finger.name == "index":
            assert bends.max() < 0.05
        else:
            assert bends.min() >= 0.5
            assert bends.max() < np.radians(100)


def test_a_resting_hand_is_a_little_bent_in_every_joint(robot):
    for finger in robot.presence.fingers:
        for bend, relaxed in zip(finger.resting, RELAXED, strict=True):
            assert relaxed / 2 < bend <= relaxed


def test_what_does_not_act_is_held_where_the_joint_can_be(robot):
    ranges = {joint.name: joint.range for joint in read_spec(robot).joints}
    for held, beyond in ((robot.fixed, HELD_BEYOND), (robot.presence.resting, set())):
        for name in {*held} - beyond:
            low, high = ranges[name] + np.radians([-1.0, 1.0])  # limits of the older robot are a degree off
            assert low <= held[name] <= high, name


def test_a_head_that_cannot_turn_is_turned_to_the_arm_that_acts(robot):
    """By 15 to 25 degrees to the right of the chest."""
    model = build_model(robot)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    presence = robot.presence
    rotation = data.body(ROBOT_PREFIX + presence.head).xmat.reshape(3, 3)
    ahead, left = rotation @ presence.ahead, rotation @ presence.left
    assert 15.0 < np.degrees(np.arctan2(ahead[0], ahead[1])) < 25.0
    assert left[0] < -0.9


def test_the_resting_hand_hangs_beside_the_robot_below_the_table(robot):
    """In front of the trunk, to its left, out of the workspace."""
    model = film_spec(robot).compile()
    data = mujoco.MjData(model)
    data.qpos[[model.joint(ROBOT_PREFIX + name).qposadr[0] for name in robot.joints]] = robot.posture.rest
    mujoco.mj_kinematics(model, data)
    x, y, z = data.body(ROBOT_PREFIX + "l_hand_shown").xpos
    assert -0.35 < x < -0.2
    assert -0.3 < y < -0.15
    assert -0.15 < z < 0.0
