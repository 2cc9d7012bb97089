"""What is said of a robot's motors and shapes, against what the packages say that bring the robot."""

import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest

from models.robots import get_robot
from models.urdf import find_urdf, share_folder
from mujoco_port.film.gl import choose_back_end

choose_back_end()

import mujoco  # noqa: E402

from models.physics import build_physics_model  # noqa: E402

ROBOT = get_robot("icub")
MARGIN = 0.01  # [m], by which a shape may stand out of the mesh that is shown


def test_torques_are_the_efforts_of_the_other_published_description():
    tree = ElementTree.parse(find_urdf(get_robot("icub-erd")))
    efforts = {
        joint.get("name"): float(joint.find("limit").get("effort"))
        for joint in tree.iter("joint")
        if joint.find("limit") is not None
    }
    assert list(ROBOT.limits.torque) == [efforts[name] for name in ROBOT.joints]


def test_speeds_are_those_of_the_simulators_files():
    folder = share_folder(find_urdf(ROBOT)) / "iCub" / "conf"
    speeds = {}
    for name in ("torso", "right_arm_no_hand_for_no_hand_model"):
        lines = [line.split() for line in (folder / f"gazebo_icub_{name}.ini").read_text().splitlines()]
        said = {words[0]: words[1:] for words in lines if len(words) > 1}
        speeds |= dict(zip(said["jointNames"], map(float, said["jntVelMax"]), strict=True))
    assert list(np.degrees(ROBOT.limits.velocity)) == pytest.approx([speeds[name] for name in ROBOT.joints])


def corners(model, data, geom):
    """Vertices [V, 3] of a mesh, a box, or the box around a capsule, in the world [m]."""
    size, kind = model.geom_size[geom], model.geom_type[geom]
    ends = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T
    if kind == mujoco.mjtGeom.mjGEOM_MESH:
        mesh = model.mesh(model.geom_dataid[geom])
        places = model.mesh_vert[mesh.vertadr[0] : mesh.vertadr[0] + mesh.vertnum[0]]
    elif kind == mujoco.mjtGeom.mjGEOM_BOX:
        places = ends * size
    else:
        places = ends * [size[0], size[0], size[0] + size[1]]
    return places @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom]


def test_what_meets_objects_lies_in_the_link_that_is_seen():
    """In the box around it, in the link's own directions."""
    model = build_physics_model(ROBOT)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    link_of = model.body_weldid[model.geom_bodyid]
    shapes = [k for k in range(model.ngeom) if model.geom(k).name.startswith("touching/")]
    assert len(shapes) == len(ROBOT.shapes)
    for shape in shapes:
        seen = [k for k in range(model.ngeom) if link_of[k] == link_of[shape] and k not in shapes]
        rotation = data.xmat[model.geom_bodyid[shape]].reshape(3, 3)
        shown = np.concatenate([corners(model, data, k) for k in seen]) @ rotation
        own = corners(model, data, shape) @ rotation
        assert (own.min(axis=0) > shown.min(axis=0) - MARGIN).all(), model.geom(shape).name
        assert (own.max(axis=0) < shown.max(axis=0) + MARGIN).all(), model.geom(shape).name
