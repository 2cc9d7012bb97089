"""Lamps that share a light, for soft shadows."""

from __future__ import annotations

from typing import Final

import mujoco
import numpy as np

LAMP_SPREAD: Final = 0.07  # how far lamps that share a light are apart, seen from the table


def share_light(spec: mujoco.MjSpec, lamps: int) -> None:
    """Let several lamps, a little apart, share the light of the one that casts shadows: softer ones."""
    lamp = spec.light("lamp")
    lamp.diffuse = np.array(lamp.diffuse) / lamps
    lamp.specular = np.array(lamp.specular) / lamps
    ahead = np.array(lamp.dir) / np.linalg.norm(lamp.dir)
    right = np.cross(ahead, (0.0, 0.0, 1.0))
    for k in range(1, lamps):
        turn = 2.0 * np.pi * k / (lamps - 1)
        way = ahead + LAMP_SPREAD * (np.cos(turn) * right + np.sin(turn) * np.cross(right, ahead))
        spec.worldbody.add_light(
            name=f"lamp_{k}",
            type=lamp.type,
            pos=list(lamp.pos),
            dir=list(way),
            diffuse=list(lamp.diffuse),
            specular=list(lamp.specular),
            castshadow=True,
        )
