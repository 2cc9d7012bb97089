"""What moves besides the arm: neck, eyes, fingers, within their limits, and in nobody's way."""

import mujoco
import numpy as np
import pytest

from models.build import ROBOT_PREFIX, build_model
from models.filmed import film_spec
from models.robots import get_robot
from mujoco_port.film.gaze import bearing
from mujoco_port.film.physical_port import start_of
from mujoco_port.film.stage import Stage
from mujoco_port.film.take import kinematic_take, physical_take
from mujoco_port.reach.gaze import Gaze, Head, looked_at
from mujoco_port.reach.kinematics import ArmKinematics
from mujoco_port.reach.workspace import hand_headings, hand_targets

ROBOTS = ["icub", "icub-erd"]
ARMS_APART = 0.02  # [m]


@pytest.fixture(scope="module", params=ROBOTS)
def filmed(request):
    robot = get_robot(request.param)
    return robot, film_spec(robot).compile()


def turned(filmed, record):
    """A take of a trial, and what neck, eyes and fingers do in it."""
    robot, model = filmed
    take = kinematic_take(record, robot, 2.5)
    return take, bearing(model, robot, take.angles, take.planar[:, 0], take.pointing, take.moment_s)


@pytest.fixture(scope="module")
def searching(champion_records):
    return max(champion_records, key=lambda each: np.abs(np.diff(each.alpha)).sum())


def test_neck_and_eyes_keep_their_limits_and_speeds(filmed, searching):
    robot, model = filmed
    take, moved = turned(filmed, searching)
    neck, eyes = moved.angles[:, :3], moved.angles[:, 3:7]
    ranges = np.array([model.joint(ROBOT_PREFIX + name).range for name in robot.presence.neck])
    assert (neck >= ranges[:, 0] - 1e-9).all()
    assert (neck <= ranges[:, 1] + 1e-9).all()
    assert np.abs(eyes).max() <= robot.presence.eye_range
    assert np.abs(np.diff(neck, axis=0)).max() <= robot.presence.neck_speed * take.moment_s + 1e-9
    assert np.abs(np.diff(eyes, axis=0)).max() <= robot.presence.eye_speed * take.moment_s + 1e-9


def test_the_robot_looks_where_s1_points(filmed, searching):
    """Both eyes within 6 degrees of it in most moments: a head that turns by 50 degrees has its limits."""
    robot, model = filmed
    take, moved = turned(filmed, searching)
    data = mujoco.MjData(model)
    acting = [model.joint(ROBOT_PREFIX + name).qposadr[0] for name in robot.joints]
    off = []
    for angles, rest, place in zip(
        take.angles, moved.angles, looked_at(robot, take.planar[:, 0]), strict=True
    ):
        data.qpos[acting], data.qpos[moved.addresses] = angles, rest
        mujoco.mj_kinematics(model, data)
        for eye in robot.presence.eyes:
            body = data.body(ROBOT_PREFIX + eye.name)
            way = (place - body.xpos) / np.linalg.norm(place - body.xpos)
            cosine = way @ body.xmat.reshape(3, 3) @ np.array(eye.ahead)
            off.append(np.degrees(np.arccos(min(1.0, cosine))))
    assert np.median(off) < 6.0


def test_a_head_held_still_finds_its_aim(filmed):
    robot, model = filmed
    data = mujoco.MjData(model)
    data.qpos[[model.joint(ROBOT_PREFIX + name).qposadr[0] for name in robot.joints]] = robot.posture.rest
    head, place = Head(model, data, robot.presence), np.array([0.0, 0.27, 0.02])
    for _ in range(100):
        data.qpos[head.neck] = head.aim(place)
    assert np.abs(head.aim(place) - data.qpos[head.neck]).max() < 1e-3
    mujoco.mj_kinematics(model, data)
    assert np.degrees(np.abs(head.eye_angles(place))).max() < 25.0


def test_the_hand_points_as_long_as_indicate_is_heard(filmed, champion_records):
    _, model = filmed
    indicates = next(each for each in champion_records if each.instruction.action.name == "INDICATE")
    touches = next(each for each in champion_records if each.instruction.action.name == "TOUCH")
    address = model.joint(f"{ROBOT_PREFIX}r_hand_shown_middle_1").qposadr[0]
    for record, bent in ((indicates, True), (touches, False)):
        _, moved = turned(filmed, record)
        column = moved.angles[:, list(moved.addresses).index(address)]
        assert (column > 1.0).all() if bent else (column == 0.0).all()


def test_what_acts_is_where_it_is_in_the_model_that_is_certified(filmed, searching):
    robot, model = filmed
    certified = build_model(robot)
    take, moved = turned(filmed, searching)
    places = []
    for each in (model, certified):
        data = mujoco.MjData(each)
        data.qpos[[each.joint(ROBOT_PREFIX + name).qposadr[0] for name in robot.joints]] = take.angles[-1]
        if each is model:
            data.qpos[moved.addresses] = moved.angles[-1]
        mujoco.mj_kinematics(each, data)
        places.append(data.site(f"{ROBOT_PREFIX}hand").xpos.copy())
    np.testing.assert_array_equal(*places)


def test_a_film_of_an_acting_robot_shows_the_head_as_it_moved(lab, searching, evolved_agent):
    physical, verdict = lab.open_loop(evolved_agent, start_of(searching), searching.readings)
    with Stage(lab.body.robot, 64, 64) as stage:
        moved = stage.bearing(physical_take(searching, physical, verdict, evolved_agent))
        names = lab.body.robot.head_joints
        joints = [stage.model.joint(ROBOT_PREFIX + name).qposadr[0] for name in names]
    np.testing.assert_array_equal(moved.addresses[:7], joints)
    np.testing.assert_array_equal(moved.angles[:, :7], physical.head[::20])  # 25 frames in a second


def below(model, link):
    """The shapes of a link and all that hangs on it."""
    root = model.body(ROBOT_PREFIX + link).id
    found = []
    for geom, body in enumerate(model.geom_bodyid):
        while body not in (0, root):
            body = model.body_parentid[body]
        if body == root:
            found.append(geom)
    return found


def test_the_resting_arm_is_in_nobodys_way(filmed):
    """Of the acting forearm and hand, of table and trunk, anywhere in the workspace."""
    robot, model = filmed
    alpha, beta = (each.ravel() for each in np.meshgrid(np.linspace(-30, 210, 84), [0.0, 45.0, 90.0]))
    targets = hand_targets(robot.plane, alpha, beta)
    angles = ArmKinematics(robot).follow(targets, hand_headings(robot.plane, alpha, beta))[::6]
    resting = below(model, "l_upper_arm")
    others = below(model, "r_elbow_1" if robot.name == "icub" else "r_forearm")
    others += [model.geom(name).id for name in ("top", "left_wing", "right_wing")]
    assert nearest_gap(robot, model, angles, resting, others) > ARMS_APART


def test_a_head_that_turns_is_in_nobodys_way(filmed):
    """Of the acting arm, wherever in the workspace the hand is and S1 points."""
    robot, model = filmed
    alpha, beta = (each.ravel() for each in np.meshgrid(np.linspace(-30, 210, 84), [0.0, 45.0, 90.0]))
    targets = hand_targets(robot.plane, alpha, beta)
    angles = ArmKinematics(robot).follow(targets, hand_headings(robot.plane, alpha, beta))[::6]
    gaze = Gaze(model, robot, robot.presence)
    heads = [gaze.follow(*each, None) for each in zip(angles, alpha[::6], strict=True)]
    head, arm = below(model, "head"), below(model, "r_upper_arm")
    assert nearest_gap(robot, model, angles, head, arm, heads) > ARMS_APART


def nearest_gap(robot, model, angles, some, others, heads=None):
    """The least gap [m] between two groups of shapes in some postures [F, J] of the arm, and of the head."""
    data, nearest = mujoco.MjData(model), np.inf
    acting, looking = (
        [model.joint(ROBOT_PREFIX + name).qposadr[0] for name in names]
        for names in (robot.joints, robot.head_joints)
    )
    for row, posture in enumerate(angles):
        data.qpos[acting] = posture
        if heads is not None:
            data.qpos[looking] = heads[row]
        mujoco.mj_kinematics(model, data)
        for one in some:
            for other in others:
                room = model.geom_rbound[one] + model.geom_rbound[other]
                gap = np.linalg.norm(data.geom_xpos[one] - data.geom_xpos[other]) - room
                if gap < nearest or other >= others[-1]:
                    nearest = min(nearest, mujoco.mj_geomDistance(model, data, one, other, 1.0, np.zeros(6)))
    return nearest
