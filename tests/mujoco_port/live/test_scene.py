"""What the page draws: closed surfaces that look outwards, and the planar world on the table."""

import json

import mujoco
import numpy as np
import pytest

from arm2d import Readings
from mujoco_port.live import surfaces
from mujoco_port.live.marks import marks
from mujoco_port.live.posture import Posture
from mujoco_port.live.scene import plane_of, scene
from mujoco_port.live.session import Moment
from mujoco_port.reach.workspace import for_world

SIZE = np.array([0.05, 0.03, 0.02])


@pytest.fixture(scope="module")
def posture(robot):
    return Posture(robot)


@pytest.mark.parametrize(
    ("surface", "volume"),
    [
        (surfaces.box(SIZE), 8 * SIZE.prod()),
        (surfaces.ball(0.05), 4 / 3 * np.pi * 0.05**3),
        (surfaces.ball(0.05, 0.1), 4 / 3 * np.pi * 0.05**3 + np.pi * 0.05**2 * 0.2),
        (surfaces.ellipsoid(SIZE), 4 / 3 * np.pi * SIZE.prod()),
        (surfaces.cylinder(0.05, 0.1), np.pi * 0.05**2 * 0.2),
    ],
)
def test_a_shape_is_closed_and_seen_from_outside(surface, volume):
    a, b, c = (surface.places[corner] for corner in surface.triangles.T)
    assert np.einsum("fk,fk->f", a, np.cross(b, c)).sum() / 6 == pytest.approx(volume, rel=0.06)
    ahead = surface.normals[surface.triangles].mean(axis=1)
    across = np.cross(b - a, c - a)
    large = np.linalg.norm(across, axis=1) > 1e-12
    assert (np.einsum("fk,fk->f", ahead, across)[large] > 0).all()
    assert np.linalg.norm(surface.normals, axis=1) == pytest.approx(1.0)


def test_a_shape_that_our_scene_has_not_is_refused():
    model = mujoco.MjModel.from_xml_string(
        '<mujoco><asset><hfield name="h" nrow="2" ncol="2" size="1 1 1 1"/></asset>'
        '<worldbody><geom type="hfield" hfield="h"/></worldbody></mujoco>'
    )
    with pytest.raises(ValueError, match="geom 0 has the shape mjGEOM_HFIELD, which is not drawn"):
        surfaces.surface_of(model, 0)


def test_the_bytes_hold_what_their_head_says(posture, robot):
    content = scene(posture, robot, Readings())
    length = int.from_bytes(content[:4], "little")
    head = json.loads(content[4 : 4 + length])
    assert (4 + length) % 4 == 0
    assert len(content) == 4 + length + 24 * head["vertices"] + 12 * head["triangles"]
    triangles = np.frombuffer(content, "<u4", offset=4 + length + 24 * head["vertices"])
    assert triangles.max() == head["vertices"] - 1
    ends = [part["first"] + part["count"] for part in head["parts"]]
    assert [part["first"] for part in head["parts"]] == [0, *ends[:-1]]
    assert ends[-1] == head["triangles"]
    assert max(part["body"] for part in head["parts"]) < head["bodies"] == len(posture.bodies)
    kinds = [part["kind"] for part in head["parts"]]
    assert {"blue", "green", "red", "plain"} < set(kinds)
    behind = kinds.index("table")  # is painted last
    assert kinds[behind:] == ["table", "floor", "floor"]
    assert len(content) < 3_000_000


def test_a_ring_is_as_wide_as_the_object_it_lies_around(robot):
    for radius, wide in ((5.0, 0.017), (8.0, 0.0224)):
        readings = Readings(object_radius=radius)
        laid = for_world(robot, readings)
        model = Posture(laid).model
        assert model.geom("green").size[0] == pytest.approx(wide)
        assert plane_of(laid, readings)["ring"] == pytest.approx(1.12 * wide / 0.0018)


def test_marks_lie_where_the_planar_world_has_them():
    ribbons = [surface for _, surface in marks(Readings(), 0.0018, (0.3, 0.3, 0.3))]
    bearing = [np.degrees(np.arctan2(each.places[:, 1], each.places[:, 0])) % 360 for each in ribbons]
    arc, right, left, blue, green, red = ribbons
    assert np.linalg.norm(arc.places[:, :2], axis=1) / 0.0018 == pytest.approx(100.0, abs=1.0)
    for area, (low, high) in zip(bearing[1:3], Readings().start_intervals, strict=True):
        assert (np.min(area), np.max(area)) == pytest.approx((low % 360, high % 360), abs=1.5)
    for chord, centre in zip((blue, green, red), Readings().sector_centres, strict=True):
        x, y, _ = chord.places.mean(axis=0)
        assert np.degrees(np.arctan2(y, x)) == pytest.approx(centre)
    for each in ribbons:
        a, b, c = (each.places[corner] for corner in each.triangles.T)
        assert (np.cross(b - a, c - a)[:, 2] > 0).all()
    assert right.places[:, 2].min() == left.places[:, 2].min() > arc.places[:, 2].max()


def test_the_head_is_shown_as_the_robot_holds_it_and_the_hand_points_while_indicate_is_heard(
    posture, lab, draw_start
):
    start, body = draw_start("right", 0), lab.body
    turned = np.array([0.2, 0.1, -0.6, 0.3, -0.2, 0.1, 0.25])
    body.start(lab.kinematics.settle(np.array([0.0, 0.25, 0.09]), 1.5), 0.0018 * start.discs, turned)

    def seen(pointing):
        moment = Moment(0.0, body.angles, body.head, body.places, np.zeros(3, bool), np.zeros(2), True)
        return posture.poses(moment, pointing)

    straight, bent = seen(False), seen(True)
    for name in ("robot/head", "robot/left_eye", "robot/right_eye"):
        row, acts = list(posture.bodies).index(posture.model.body(name).id), body.data.body(name)
        np.testing.assert_allclose(straight[row], [*acts.xpos, *acts.xquat], atol=1e-6)
    finger = list(posture.bodies).index(posture.model.body("robot/r_hand_shown_middle_2").id)
    assert np.linalg.norm(straight[finger, :3] - bent[finger, :3]) > 0.02
    objects = [list(posture.bodies).index(posture.model.body(name).id) for name in ("blue", "green", "red")]
    assert straight[objects, :2] / 0.0018 == pytest.approx(start.discs, rel=1e-5)
