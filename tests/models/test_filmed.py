"""The robot of a film: eyes that turn, hands that are mirror images, a palm where the robot has one."""

import dataclasses

import mujoco
import numpy as np
import pytest

from models.build import ROBOT_PREFIX, build_model
from models.filmed import PALM, film_spec, finger_joint, hand_name
from models.robots import ROBOTS
from models.shapes import ICUB_SHAPES


@pytest.fixture(scope="module", params=ROBOTS)
def filmed(request):
    robot = ROBOTS[request.param]
    return robot, film_spec(robot).compile()


def pose(model, **angles):
    """What a model looks like with some joints turned [rad]."""
    data = mujoco.MjData(model)
    for name, angle in angles.items():
        data.qpos[model.joint(ROBOT_PREFIX + name).qposadr[0]] = angle
    mujoco.mj_kinematics(model, data)
    return data


def test_whatever_moves_acts_or_is_neck_eye_or_finger(filmed):
    robot, model = filmed
    presence = robot.presence
    eyes = {name for eye in presence.eyes for name in eye.joints}
    fingers = {
        finger_joint(link, finger, phalanx)
        for link in presence.hands
        for finger in presence.fingers
        for phalanx in range(3)
    }
    shown = {ROBOT_PREFIX + name for name in {*robot.joints, *presence.neck, *eyes, *fingers}}
    assert {model.joint(k).name for k in range(model.njnt)} - {"blue", "green", "red"} == shown


def test_an_eye_pans_to_the_left_and_tilts_down_about_its_own_centre(filmed):
    robot, model = filmed
    for eye in robot.presence.eyes:
        pan, tilt = eye.joints
        straight, panned, tilted = (pose(model, **each) for each in ({}, {pan: 0.2}, {tilt: 0.2}))
        head = straight.body(ROBOT_PREFIX + eye.link)
        to_head = head.xmat.reshape(3, 3).T
        ways = [
            to_head @ data.body(ROBOT_PREFIX + eye.name).xmat.reshape(3, 3) @ eye.ahead
            for data in (straight, panned, tilted)
        ]
        up = np.cross(eye.ahead, eye.left)
        np.testing.assert_allclose(ways[0], eye.ahead, atol=1e-9)
        np.testing.assert_allclose([ways[1] @ eye.left, ways[1] @ up], [np.sin(0.2), 0.0], atol=1e-9)
        np.testing.assert_allclose([ways[2] @ eye.left, ways[2] @ up], [0.0, -np.sin(0.2)], atol=1e-9)
        for data in (straight, panned, tilted):
            centre = to_head @ (data.body(ROBOT_PREFIX + eye.name).xpos - head.xpos)
            np.testing.assert_allclose(centre, eye.centre, atol=1e-9)


def shown_on(model, link):
    """Sizes [S, 3] and places [S, 3] of the shapes on a hand and its fingers, by the body's name."""
    found = {}
    for geom in range(model.ngeom):
        body = model.body(model.geom_bodyid[geom]).name.removeprefix(ROBOT_PREFIX)
        if body.startswith(hand_name(link)):
            part = body.removeprefix(hand_name(link))
            found.setdefault(part, []).append([*model.geom_size[geom], *model.geom_pos[geom]])
    return {part: np.array(rows) for part, rows in found.items()}


def test_hands_are_mirror_images(filmed):
    """A left hand's z leaves its back: there all z have the other sign."""
    robot, model = filmed
    right, left = (shown_on(model, link) for link in robot.presence.hands)
    assert len(right) == 1 + 5 * 3  # a palm, and three phalanges of five fingers
    assert left.keys() == right.keys()
    for part, rows in right.items():
        np.testing.assert_allclose(left[part], rows * [1, 1, 1, 1, 1, -1], atol=1e-12)


def test_a_finger_that_bends_leaves_the_back_of_its_hand(filmed):
    robot, model = filmed
    finger = robot.presence.fingers[1]
    for link, palm in zip(robot.presence.hands, (1.0, -1.0), strict=True):
        hand, tip = hand_name(link), finger_joint(link, finger, 2)
        heights = []
        for bend in (0.0, 0.5):
            data = pose(model, **{finger_joint(link, finger, 0): bend})
            frame = data.body(ROBOT_PREFIX + hand)
            place = data.body(ROBOT_PREFIX + tip).xpos - frame.xpos
            heights.append(palm * (frame.xmat.reshape(3, 3)[:, 2] @ place))
        reach = finger.lengths[0] + finger.lengths[1]
        assert heights[1] - heights[0] == pytest.approx(reach * np.sin(0.5))


def test_the_palm_is_thick_where_it_meets_objects():
    """Centres in the box of `models.shapes`, no gap between them, and nothing far beyond the box."""
    box = next(each for each in ICUB_SHAPES if each.name == "palm")
    low, high = np.subtract(box.start, box.end), np.add(box.start, box.end)
    for centre, size in PALM[:3]:
        assert (low < centre).all()
        assert (centre < high).all()
        assert (np.subtract(centre, size) > low - 0.025).all()
        assert (np.add(centre, size) < high + 0.025).all()
    (first, thick), *others = PALM
    for centre, size in others:
        assert (np.subtract(centre, first) ** 2 / np.add(thick, size) ** 2).sum() < 1.0


def test_a_robot_without_presence_is_filmed_as_it_is(filmed):
    robot, _ = filmed
    plain = dataclasses.replace(robot, presence=None)
    assert film_spec(plain).compile().njnt == build_model(robot).njnt
