"""The robot with motors: what they pull with, how objects slide, where the eye is."""

import numpy as np
import pytest

from models.robots import get_robot
from mujoco_port.film.gl import choose_back_end

choose_back_end()

import mujoco  # noqa: E402

from models.build import OBJECTS, ROBOT_PREFIX, build_model  # noqa: E402
from models.physics import EYE, build_physics_model  # noqa: E402

ROBOT = get_robot("icub")
# Where arm and head stand while the robot rests.
REST = {**ROBOT.fixed, **dict(zip(ROBOT.joints, ROBOT.posture.rest, strict=True))}
JOINTS = (*ROBOT.joints, *ROBOT.head_joints)
AT_REST = np.array([REST.get(name, 0.0) for name in JOINTS])
GRAVITY = 9.81  # [m/s^2]


@pytest.fixture(scope="module")
def model():
    return build_physics_model(ROBOT)


@pytest.fixture
def data(model):
    """At rest, with objects where they are built."""
    data = mujoco.MjData(model)
    data.qpos[[model.joint(ROBOT_PREFIX + name).qposadr[0] for name in JOINTS]] = AT_REST
    mujoco.mj_forward(model, data)
    return data


def test_motors_are_critically_damped_springs_on_what_the_joints_move_at_rest(model, data):
    """From M q'' = -kp q - kv q': kp = M w^2 and kv = 2 M w, w being 66 rad/s."""
    inertias = []
    for name in JOINTS:
        data.qvel[:] = 0.0
        data.qvel[model.joint(ROBOT_PREFIX + name).dofadr[0]] = 1.0
        mujoco.mj_energyVel(model, data)
        inertias.append(2.0 * data.energy[1])
    inertias = np.array(inertias)
    stiffness, damping = model.actuator_gainprm[:, 0], -model.actuator_biasprm[:, 2]
    np.testing.assert_array_equal(-model.actuator_biasprm[:, 1], stiffness)
    np.testing.assert_allclose(np.sqrt(stiffness / inertias), 66.0, rtol=1e-6)
    np.testing.assert_allclose(damping**2, 4.0 * stiffness * inertias, rtol=1e-6)


@pytest.mark.parametrize("way", [-1.0, 1.0])
def test_motors_pull_as_hard_one_way_as_the_other(model, data, way):
    data.ctrl[:] = AT_REST + 10.0 * way
    mujoco.mj_forward(model, data)
    largest = [*ROBOT.limits.torque, *ROBOT.presence.limits.torque]
    np.testing.assert_allclose(data.actuator_force, way * np.array(largest))


@pytest.mark.parametrize("name", OBJECTS)
def test_an_object_that_slides_is_stopped_by_the_table(model, data, name):
    """After v^2 / (2 mu g) with mu = 0.5."""
    joint, speed = model.joint(name), 0.3
    start = data.qpos[joint.qposadr[0] : joint.qposadr[0] + 2].copy()
    data.qvel[joint.dofadr[0] + 1] = speed  # away from the robot
    data.ctrl[:] = AT_REST
    for _ in range(200):
        mujoco.mj_step(model, data)
    way = np.linalg.norm(data.qpos[joint.qposadr[0] : joint.qposadr[0] + 2] - start)
    assert way == pytest.approx(speed**2 / (2 * 0.5 * GRAVITY), rel=0.15)


def test_eye_is_in_j1_as_high_as_the_middle_of_the_objects(model, data):
    x, y, z = data.cam_xpos[model.camera(EYE).id]
    assert (x, y) == (0.0, 0.0)
    for name in OBJECTS:
        assert data.body(name).xpos[2] == pytest.approx(z, abs=1e-4)


def test_shapes_of_the_robot_meet_objects_and_nothing_else(model):
    """Neither each other nor the table, on which the hand would get stuck."""
    touching = [k for k in range(model.ngeom) if model.geom(k).name.startswith("touching/")]
    things = [model.geom(name).id for name in OBJECTS]
    tables = [model.geom(name).id for name in ("top", "right_wing", "left_wing")]

    def meet(one, other):
        types, others = model.geom_contype, model.geom_conaffinity
        return bool(types[one] & others[other] or types[other] & others[one])

    assert len(touching) == len(ROBOT.shapes)
    for shape in touching:
        assert all(meet(shape, thing) for thing in things)
        assert not any(meet(shape, other) for other in [*touching, *tables])
    assert all(meet(one, other) for one in things for other in [*things, *tables])


def test_what_touches_weighs_nothing():
    still = ROBOT.with_head_held
    np.testing.assert_array_equal(build_physics_model(still).body_mass, build_model(ROBOT).body_mass)


@pytest.mark.parametrize("eyes", [-0.5, 0.0, 0.4])
def test_eyes_that_are_cut_out_leave_head_and_eyes_what_they_were(model, eyes):
    """Wherever they look: trunk and arm move the same inertia as with the URDF's head of one piece."""
    still = build_physics_model(ROBOT.with_head_held)
    matrices = []
    for each in (still, model):
        data, names = mujoco.MjData(each), JOINTS if each is model else ROBOT.joints
        joints = [each.joint(ROBOT_PREFIX + name) for name in names]
        data.qpos[[joint.qposadr[0] for joint in joints]] = AT_REST[: len(names)]
        if each is model:
            data.qpos[[joint.qposadr[0] for joint in joints[-4:]]] = eyes
        mujoco.mj_forward(each, data)
        units, columns = np.eye(each.nv)[[joint.dofadr[0] for joint in joints[:10]]], np.empty((10, each.nv))
        for unit, column in zip(units, columns, strict=True):
            mujoco.mj_mulM(each, data, column, unit)
        matrices.append(columns @ units.T)
    np.testing.assert_allclose(*matrices, rtol=1e-9, atol=1e-12)
