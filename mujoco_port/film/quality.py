"""How much work a picture is worth: draft, normal, high."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

QualityName = Literal["draft", "normal", "high"]


@dataclass(frozen=True)
class Quality:
    """What is drawn, and how finely.

    Attributes:
        finer: How many times the triangles that do for a small picture are drawn.
        oversampling: Pixels drawn across for each pixel shown.
        shadow_px: Of the shadow map; 0 for no shadows.
        near_shadows: Whether there are any in what is seen from near.
        lamps: How many lamps share the light that casts shadows: more are softer.
        occlusion: Whether corners get less of the light that comes from everywhere.
        round_sides: Sides of a shape that is round, and
        round_stacks: bands of a round end.
    """

    finer: float
    oversampling: int
    shadow_px: int
    near_shadows: bool
    lamps: int
    occlusion: bool
    round_sides: int
    round_stacks: int


QUALITIES: Final = {
    "draft": Quality(0.5, 1, 0, False, 1, False, 16, 3),
    "normal": Quality(1.0, 1, 768, False, 1, False, 20, 4),
    "high": Quality(1e6, 2, 4096, True, 4, True, 64, 24),
}


def quality_named(name: str) -> Quality:
    """A quality by its name.

    Raises:
        ValueError: If there is none of this name; the message lists those that exist.
    """
    if name not in QUALITIES:
        raise ValueError(f"unknown quality {name!r}; there are: {', '.join(QUALITIES)}")
    return QUALITIES[name]
