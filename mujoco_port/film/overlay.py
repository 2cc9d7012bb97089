"""Laying what moves over a picture of what does not, and smoothing edges."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from arm2d.compiling import compiled


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


def halved(picture: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """A picture [2 H, 2 W, 3] at half its size, [H, W, 3]: edges become smooth."""
    height, width, channels = picture.shape
    fours = picture.reshape(height // 2, 2, width // 2, 2, channels)
    return ((fours.sum(axis=(1, 3), dtype=np.uint16) + 2) // 4).astype(np.uint8)
