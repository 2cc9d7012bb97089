"""Laying what moves over a picture of what does not."""

from __future__ import annotations

from arm2d.compiling import compiled


@compiled
def lay_over(picture, depth, backdrop, combined):
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
