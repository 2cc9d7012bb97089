"""Laying what moves over a picture of what does not, darkening corners, smoothing edges."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d.compiling import compiled

# Corners: how near their walls are to be [m], how dark they become, and how much nearer to the camera
# something may be and still be a wall [m].
CORNER_M: Final = 0.04
DARKEST: Final = 0.55
WALL_M: Final = 0.035
RINGS: Final = 3
DIMMEST: Final = 0.16  # how much light is missing far from the middle of a room
SPOKES: Final = 6


@compiled
def lay_over(
    picture: NDArray[np.uint8],
    depth: NDArray[np.float32],
    backdrop: NDArray[np.uint8],
    combined: NDArray[np.uint8],
) -> None:
    """Take each pixel from the picture where something is drawn, else from the backdrop.

    Args:
        picture: [H, W, 3], rows from below as OpenGL has them.
        depth: [H, W], 0 where nothing is drawn.
        backdrop: [H, W, 3], rows from above.
        combined: [H, W, 3], rows from above; the result.
    """
    height, width, _ = picture.shape
    for row in range(height):
        below = height - 1 - row
        for column in range(width):
            source, line = (picture, below) if depth[below, column] != 0.0 else (backdrop, row)
            for channel in range(3):
                combined[row, column, channel] = source[line, column, channel]


@compiled
def distances(depth: NDArray[np.float32], near: float, far: float, result: NDArray[np.float32]) -> None:
    """How far ahead of the camera a pixel's surface is, [H, W] in [m], rows from above.

    Args:
        depth: [H, W], 1 at the near plane and 0 at the far one, rows from below.
        near: [m] and
        far: [m], where the planes are.
        result: [H, W].
    """
    height, width = depth.shape
    for row in range(height):
        for column in range(width):
            inverse = depth[height - 1 - row, column] * (1.0 / near - 1.0 / far) + 1.0 / far
            result[row, column] = 1.0 / inverse


@compiled
def darken_corners(
    picture: NDArray[np.uint8], distance: NDArray[np.float32], focal_px: float, cosines: NDArray[np.float64]
) -> None:
    """Give places among walls less of the light that comes from everywhere.

    For pairs of pixels at opposite sides of one, equally far off: where the middle of both is nearer to the
    camera than the pixel between, it lies in a hollow. A plane, however it leans, is none.

    Args:
        picture: [H, W, 3]; changed.
        distance: [H, W] in [m], of what is drawn.
        focal_px: Pixels across for something as wide as it is far away.
        cosines: [SPOKES, 2], half a turn of directions.
    """
    height, width = distance.shape
    for row in range(height):
        for column in range(width):
            here = distance[row, column]
            if here > 5.0:
                continue
            shade = 0.0
            turn = (row * 7 + column * 13) % 4 / 4.0
            for spoke in range(SPOKES):
                for ring in range(RINGS):
                    reach = CORNER_M * (ring + 0.4 + 0.6 * turn) / RINGS * focal_px / here
                    down, right = int(reach * cosines[spoke, 0]), int(reach * cosines[spoke, 1])
                    if not (0 <= row + down < height and 0 <= row - down < height):
                        continue
                    if not (0 <= column + right < width and 0 <= column - right < width):
                        continue
                    one = here - distance[row + down, column + right]
                    other = here - distance[row - down, column - right]
                    hollow = 0.5 * (one + other)
                    if hollow > 0.0015 and one < WALL_M and other < WALL_M:
                        shade += min(1.0, hollow / (0.25 * CORNER_M))
            light = 1.0 - DARKEST * min(1.0, shade / (SPOKES * RINGS))
            for channel in range(3):
                picture[row, column, channel] = np.uint8(picture[row, column, channel] * light)


def dimmed(picture: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """A room [H, W, 3] whose light is in its middle, and falls off to the sides."""
    height, width, _ = picture.shape
    down, right = np.linspace(-0.9, 1.1, height)[:, None], np.linspace(-1.0, 1.0, width)
    light = 1.0 - DIMMEST * np.clip((down**2 + right**2) / 2.2, 0.0, 1.0)
    return (picture * light[..., None]).astype(np.uint8)


def halved(picture: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """A picture [2 H, 2 W, 3] at half its size, [H, W, 3]: edges become smooth."""
    height, width, channels = picture.shape
    fours = picture.reshape(height // 2, 2, width // 2, 2, channels)
    return ((fours.sum(axis=(1, 3), dtype=np.uint16) + 2) // 4).astype(np.uint8)
