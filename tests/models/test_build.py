"""The robot and its table as a MuJoCo model."""

import dataclasses

import pytest

from models.robots import UnknownRobotError, get_robot
from models.urdf import RobotNotInstalledError, find_urdf
from mujoco_port.film.gl import choose_back_end

choose_back_end()

import mujoco  # noqa: E402
from matplotlib.colors import to_rgb  # noqa: E402

from arm2d.drawing import OBJECT_COLOURS  # noqa: E402
from models.build import ROBOT_PREFIX, build_model  # noqa: E402
from models.spec import read_spec  # noqa: E402

ROBOT = get_robot("icub")


@pytest.fixture(scope="module")
def model():
    return build_model(ROBOT)


def test_only_the_acting_joints_and_the_objects_can_move(model):
    names = {model.joint(i).name for i in range(model.njnt)}
    assert names == {ROBOT_PREFIX + name for name in ROBOT.joints} | {"blue", "green", "red"}


def test_what_is_left_out_is_not_built_nor_what_hangs_on_it(model):
    built = {model.body(k).name.removeprefix(ROBOT_PREFIX) for k in range(model.nbody)}
    assert ROBOT.left_out
    assert not {*ROBOT.left_out, "l_foot", "r_lower_leg"} & built
    everything = {body.name for body in read_spec(ROBOT).bodies}
    assert {*ROBOT.left_out, "l_foot", "r_lower_leg"} <= everything


def test_hessian_is_dense(model):
    assert model.opt.jacobian == mujoco.mjtJacobian.mjJAC_DENSE


def test_objects_stand_upright_on_the_table(model):
    for name in ("blue", "green", "red"):
        assert model.body(name).pos[2] == pytest.approx(model.geom(name).size[1])


def test_objects_have_the_colours_they_have_in_every_figure(model):
    for word, colour in OBJECT_COLOURS.items():
        material = model.material(word.name.lower())
        assert material.rgba[:3] == pytest.approx(to_rgb(colour), abs=1e-3)


def test_every_link_of_the_robot_has_a_sound_inertia(model):
    for i in range(1, model.nbody):
        moments = sorted(model.body_inertia[i])
        assert moments[2] <= moments[0] + moments[1] + 1e-12, model.body(i).name


def test_shown_meshes_take_part_in_no_contact(model):
    for i in range(model.ngeom):
        if model.geom_type[i] == mujoco.mjtGeom.mjGEOM_MESH:
            assert model.geom_contype[i] == model.geom_conaffinity[i] == 0


def test_unknown_robot_lists_the_known_ones():
    with pytest.raises(UnknownRobotError, match="unknown robot 'asimo'; there are: icub"):
        get_robot("asimo")


def test_robot_of_a_missing_package_says_what_to_install():
    with pytest.raises(RobotNotInstalledError, match="is not installed; run: pip install no-such-robot"):
        find_urdf(dataclasses.replace(ROBOT, package="no-such-robot"))


def test_numbers_that_do_not_fit_the_joints_are_refused():
    with pytest.raises(ValueError, match="robot 'icub' has 3 joints, but 10 numbers in posture\\.rest"):
        dataclasses.replace(ROBOT, joints=ROBOT.joints[:3])
