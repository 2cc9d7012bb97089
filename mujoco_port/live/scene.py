"""Shapes and colours for the page: every body's surface as triangles in the body's frame.

    4 bytes            length of the head, little-endian
    head               JSON, filled with blanks to a multiple of 4
    float32 [V, 3]     places in [m]
    float32 [V, 3]     normals
    uint32 [F, 3]      triangles

The head lists parts: which of the moving bodies moves them (-1: none does), what they look like, and which
triangles they are.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any, Final

import mujoco
import numpy as np

from arm2d import Readings
from arm2d import constants as c
from arm2d.drawing import CAMERA_RANGE
from arm2d.records import brief
from models.build import OBJECTS, VISUAL_GROUP
from models.physics import TABLE_TOPS
from models.robots import Robot
from mujoco_port.film.light import RING
from mujoco_port.live.marks import marks
from mujoco_port.live.posture import Posture
from mujoco_port.live.surfaces import Surface, surface_of

MARK_EMISSION: Final = 0.25
DRAWN_LAST: Final = ("table", "floor")
SHOWN_GROUPS: Final = (0, VISUAL_GROUP, 2)


Material = tuple[float, float, float, float, float, float]


@dataclass(frozen=True)
class Part:
    """One piece of one colour.

    Attributes:
        body: Row of the poses that moves it; -1 for none.
        kind: "table", on which the planar world shines, "floor", an object's name, or "plain".
        material: rgb, specular, shininess and emission.
        surface: In the body's frame.
    """

    body: int
    kind: str
    material: Material
    surface: Surface

    __repr__ = brief


def scene(posture: Posture, robot: Robot, readings: Readings) -> bytes:
    """All that the page has to draw, once."""
    shapes = parts_of(posture)
    table = next(part.material for part in shapes if part.kind == "table")
    painted = [
        Part(-1, "plain", (*colour, 0.0, 0.0, MARK_EMISSION), surface)
        for colour, surface in marks(readings, robot.plane.scale, table[:3])
    ]
    parts = joined([*shapes, *painted])
    surface = Surface.joined([part.surface for part in parts])
    ends = np.cumsum([len(part.surface.triangles) for part in parts]).tolist()
    head = {
        "bodies": len(posture.bodies),
        "plane": plane_of(robot, readings),
        "vertices": len(surface.places),
        "triangles": len(surface.triangles),
        "parts": [
            {
                "body": part.body,
                "kind": part.kind,
                "material": part.material,
                "first": end - len(part.surface.triangles),
                "count": len(part.surface.triangles),
            }
            for part, end in zip(parts, ends, strict=True)
        ],
    }
    text = json.dumps(head, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    arrays = (
        surface.places.astype("<f4"),
        surface.normals.astype("<f4"),
        surface.triangles.astype("<u4"),
    )
    return b"".join([len(text).to_bytes(4, "little"), text, *(array.tobytes() for array in arrays)])


def parts_of(posture: Posture) -> list[Part]:
    """One part for every geom that is seen."""
    model = posture.model
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    rows = {int(body): row for row, body in enumerate(posture.bodies)}
    parts = []
    for geom in range(model.ngeom):
        if model.geom_group[geom] not in SHOWN_GROUPS:
            continue
        body = int(model.geom_bodyid[geom])
        row = rows.get(body, -1)
        surface = surface_of(model, geom)
        if row < 0:  # nothing moves it: it may as well be given in the world
            surface = surface.moved(data.geom_xpos[geom], data.geom_xmat[geom].reshape(3, 3))
        else:
            rotation = np.empty(9)
            mujoco.mju_quat2Mat(rotation, model.geom_quat[geom])
            surface = surface.moved(model.geom_pos[geom], rotation.reshape(3, 3))
        parts.append(Part(row, _kind(model.geom(geom).name), _material(model, geom), surface))
    return parts


def joined(parts: list[Part]) -> list[Part]:
    """The same with as few parts as there are bodies and colours: fewer calls to draw."""
    groups: dict[tuple[int, str, Material], list[Surface]] = {}
    for part in parts:
        groups.setdefault((part.body, part.kind, part.material), []).append(part.surface)
    # What stands in front first: what lies behind it need not be painted.
    keys = sorted(groups, key=lambda key: DRAWN_LAST.index(key[1]) if key[1] in DRAWN_LAST else -1)
    return [Part(*key, Surface.joined(groups[key])) for key in keys]


def plane_of(robot: Robot, readings: Readings) -> dict[str, Any]:
    """What moves and shines on the table of a robot that is laid for these readings, in [cm] and [deg]."""
    return {
        "scale": robot.plane.scale,
        "ring": RING * robot.plane.object_radius / robot.plane.scale,
        "s1": c.S1_LENGTH,
        "s2": c.S2_LENGTH,
        "cameraAtEnd": readings.camera_origin == "end",
        "cameraRange": CAMERA_RANGE,
        "view": [c.MIDDLE_SECTOR_HALF_WIDTH, c.VIEW_HALF_WIDTH],
    }


def _kind(name: str) -> str:
    if name in TABLE_TOPS:
        return "table"
    return name if name in OBJECTS else "floor" if name in ("floor", "wall") else "plain"


def _material(model: mujoco.MjModel, geom: int) -> Material:
    """Red, green, blue, specular, shininess, emission."""
    material = int(model.geom_matid[geom])
    if material < 0:
        red, green, blue = map(float, model.geom_rgba[geom, :3])
        return red, green, blue, 0.2, 0.3, 0.0
    extra = model.mat_specular[material], model.mat_shininess[material], model.mat_emission[material]
    numbers = (*model.mat_rgba[material, :3], *extra)
    red, green, blue, specular, shininess, emission = (round(float(each), 4) for each in numbers)
    return red, green, blue, specular, shininess, emission
