"""From a robot's URDF and our scene to one MuJoCo model, built in code with `MjSpec`."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import NDArray

from models.appearance import MeshSwap, Ornament, eyeball
from models.inertias import fault, moments
from models.meshes import read_mesh, standing, thin
from models.robots import Robot
from models.spec import read_spec
from models.urdf import find_urdf, share_folder

ROBOT_PREFIX = "robot/"  # of every name that comes from the URDF, so that none meets one of the scene
HAND_SITE = "robot/hand"  # the point that plays S2's end
OBJECTS = ("blue", "green", "red")
VISUAL_GROUP = 1
SHELL_INERTIA = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL  # shown meshes need not be closed
UNCOLOURED = [0.5, 0.5, 0.5, 1.0]  # the one colour that lets a material's own through
# Triangles of one mesh: chosen by eye, at 720 lines nobody sees the others.
MAX_FACES = 800
FACES_PER_AREA = 16_000  # [1/m^2], of the box around a mesh: small ones need fewer
MAX_FACES_SWAPPED = 2800  # of a mesh that was chosen for its looks, such as a face
GYRATION = 0.03  # [m], radius of gyration of a link whose inertia is unsound

SHAPES = {
    "sphere": mujoco.mjtGeom.mjGEOM_SPHERE,
    "ellipsoid": mujoco.mjtGeom.mjGEOM_ELLIPSOID,
    "capsule": mujoco.mjtGeom.mjGEOM_CAPSULE,
    "cylinder": mujoco.mjtGeom.mjGEOM_CYLINDER,
}


def build_spec(robot: Robot, finer: float = 1.0) -> mujoco.MjSpec:
    """Put a robot at the table of `scene.xml`, with objects as wide as its record says.

    Joints that do not act are fixed at their angle in `robot.fixed`; the hand's reference point becomes
    the site "robot/hand". The robot's meshes are only looked at: they take part in no contact.

    Args:
        robot: Its record.
        finer: How many times the triangles that do for a small picture are kept.

    Raises:
        RobotNotInstalledError: If the robot's package is missing.
    """
    scene = mujoco.MjSpec.from_string(files("models").joinpath("scene.xml").read_text())
    for name in OBJECTS:
        scene.geom(name).size[0] = robot.plane.object_radius
    body = robot_spec(robot, finer)
    yaw = robot.base_yaw / 2
    frame = scene.worldbody.add_frame(
        pos=list(robot.base_position), quat=[np.cos(yaw), 0.0, 0.0, np.sin(yaw)]
    )
    scene.attach(body, frame=frame, prefix=ROBOT_PREFIX)
    dress(scene, robot, finer)
    prune_frames(scene)
    return scene


def build_model(robot: Robot) -> mujoco.MjModel:
    """Compile the robot and its table; about one second, most of it for the meshes.

    Objects are as wide as the record says; `mujoco_port.reach.workspace.for_world` gives that of a world.
    """
    return build_spec(robot).compile()


def robot_spec(robot: Robot, finer: float) -> mujoco.MjSpec:
    """Read a robot's URDF: acting joints only, and the hand's reference point as a site."""
    spec = read_spec(robot)
    mend_inertias(spec)
    keep_what_is_shown(spec)
    spec.body(robot.hand_frame).add_site(name="hand", pos=list(robot.hand_offset), size=[0.005] * 3, group=5)
    for link in robot.left_out:
        spec.delete(spec.body(link))
    thin_meshes(spec, finer * robot.appearance.detail)
    acting = {*robot.joints, *robot.loose}
    for joint in list(spec.joints):
        if joint.name not in acting:
            fix_joint(spec, joint, robot.fixed.get(joint.name, 0.0))
    return spec


def mend_inertias(spec: mujoco.MjSpec) -> None:
    """Give links with an inertia no body can have that of a ball, so that MuJoCo takes the robot at all.

    That serves kinematics, which knows no inertia; `models.physics` refuses such a robot.
    """
    for body in spec.bodies:
        if body.explicitinertial and fault(body.mass, moments(body)):
            body.fullinertia = [np.nan, 0.0, 0.0, 0.0, 0.0, 0.0]
            body.inertia = [body.mass * GYRATION**2] * 3


def keep_what_is_shown(spec: mujoco.MjSpec) -> None:
    """Delete the shapes that a URDF has for contact from links that have others to be seen."""
    for body in spec.bodies:
        seen = [geom for geom in body.geoms if geom.contype == 0]
        for geom in list(body.geoms) if seen else ():
            if geom.contype:
                spec.delete(geom)


def thin_meshes(spec: mujoco.MjSpec, detail: float) -> None:
    """Replace each mesh's file by what it holds, in few triangles; delete the meshes that nothing shows."""
    shown = {geom.meshname for geom in spec.geoms}
    for mesh in list(spec.meshes):
        if mesh.name not in shown:
            spec.delete(mesh)
            continue
        vertices, faces = read_mesh(Path(mesh.file))
        vertices = standing(Path(mesh.file), vertices)
        vertices, faces = thin(vertices, faces, faces_needed(vertices * mesh.scale, detail))
        mesh.file = ""
        mesh.uservert, mesh.userface = vertices.ravel(), faces.ravel()
        mesh.inertia = SHELL_INERTIA


def faces_needed(vertices: NDArray[np.float64], detail: float) -> int:
    """Triangles that show a mesh of vertices [V, 3] in [m] well enough."""
    x, y, z = np.ptp(vertices, axis=0)
    return int(detail * min(MAX_FACES, FACES_PER_AREA * 2 * (x * y + y * z + z * x)))


def fix_joint(spec: mujoco.MjSpec, joint: mujoco.MjsJoint, angle: float) -> None:
    """Replace a hinge through its body's origin by the rotation it makes at `angle` [rad]."""
    turn, quat = np.zeros(4), np.zeros(4)
    mujoco.mju_axisAngle2Quat(turn, np.array(joint.axis), angle)
    mujoco.mju_mulQuat(quat, np.array(joint.parent.quat), turn)
    joint.parent.quat = quat
    spec.delete(joint)


def prune_frames(spec: mujoco.MjSpec) -> None:
    """Delete the robot's links that are mere frames (of sensors): nothing on them, nothing below."""
    while frames := [body for body in spec.bodies if is_bare(body)]:
        for body in frames:
            spec.delete(body)


def is_bare(body: mujoco.MjsBody) -> bool:
    """Say whether a link of the robot holds nothing at all."""
    holds = (body.geoms, body.joints, body.sites, body.bodies, body.explicitinertial)
    return body.name.startswith(ROBOT_PREFIX) and not any(holds)


def dress(scene: mujoco.MjSpec, robot: Robot, finer: float) -> None:
    """Give the robot's links their materials, better meshes and ornaments; none of them touches anything."""
    appearance = robot.appearance
    left_out = {*(swap.replaces for swap in appearance.swaps), *appearance.bare}
    for body in scene.bodies:
        link = body.name.removeprefix(ROBOT_PREFIX)
        if link == body.name:
            continue
        for geom in list(body.geoms):
            if link in left_out:
                scene.delete(geom)
            else:
                show(geom, appearance.materials.get(link, appearance.otherwise))
    share = share_folder(find_urdf(robot))
    for swap in appearance.swaps:
        add_mesh_geom(scene, swap, share, finer)
    for ornament in (*appearance.ornaments, *still_eyes(robot)):
        add_ornament(scene, ornament)


def still_eyes(robot: Robot) -> tuple[Ornament, ...]:
    """Give a robot's eyes as they are where they do not turn."""
    eyes = () if robot.presence is None else robot.presence.eyes
    return tuple(part for each in eyes for part in eyeball(each.link, each.centre, each.still))


def show(geom: mujoco.MjsGeom, material: str) -> None:
    """Make a shape that is only looked at."""
    geom.material = material
    geom.rgba = UNCOLOURED
    geom.group = VISUAL_GROUP
    geom.contype = geom.conaffinity = 0
    geom.mass = 0.0


def add_mesh_geom(scene: mujoco.MjSpec, swap: MeshSwap, share: Path, finer: float) -> None:
    """Show a mesh file at a link."""
    name = f"{swap.link}_shown"
    vertices, faces = thin(*read_mesh(share / swap.file), int(finer * MAX_FACES_SWAPPED))
    scene.add_mesh(
        name=name, uservert=(vertices * swap.scale).ravel(), userface=faces.ravel(), inertia=SHELL_INERTIA
    )
    body = scene.body(ROBOT_PREFIX + swap.link)
    show(
        body.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname=name, pos=list(swap.position)), swap.material
    )


def add_ornament(scene: mujoco.MjSpec, ornament: Ornament) -> None:
    """Add one shape without mass to a link."""
    body = scene.body(ROBOT_PREFIX + ornament.link)
    size = [*ornament.size, 0.0, 0.0][:3]
    place = {"pos": list(ornament.position)}
    if ornament.to is not None:
        place = {"fromto": [*ornament.position, *ornament.to]}
    geom = body.add_geom(type=SHAPES[ornament.shape], size=size, **place)
    show(geom, ornament.material)
