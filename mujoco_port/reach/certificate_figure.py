"""The workspace certificate as one picture: six maps over all (alpha, beta)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from arm2d.drawing import FULL, QUIET, SMALL, STYLE, TITLE, look
from arm2d.records import brief
from models.robots import Robot
from mujoco_port.reach.certificate import Certificate

WORST: Final = "#B0296F"
RING: Final[dict[str, Any]] = {"marker": "o", "ms": 6, "mfc": "none", "mec": WORST}
BOUNDS: Final = "alpha: S1, from the right bound to the left; beta: S2, from straight to bent"
COLOURS: Final = "cividis"  # even in lightness, and the same to all eyes


@dataclass(frozen=True)
class Layer:
    """One map: values [A, B], which of them is the worst, and what is said above it."""

    title: str
    unit: str
    values: NDArray[np.float64]
    least_is_worst: bool

    __repr__ = brief


def draw_certificate(certificate: Certificate, robot: Robot) -> Figure:
    """Draw what was measured, the worse of both walks everywhere, the worst place of each map marked."""
    with look(STYLE):
        figure = Figure(figsize=(FULL, 4.4))
        axes = figure.subplots(2, 3, sharex=True, sharey=True).ravel()
        for panel, layer in zip(axes, _layers(certificate), strict=True):
            _draw_layer(panel, certificate, layer)
        for panel in axes[3:]:
            panel.set_xlabel("alpha [deg]")
        for panel in axes[::3]:
            panel.set_ylabel("beta [deg]")
        worst = Line2D([], [], ls="", **RING, label="the worst place")
        figure.legend(handles=[worst], loc="lower right")
        figure.text(0.015, 0.025, BOUNDS, fontsize=SMALL, color=QUIET)
        figure.subplots_adjust(left=0.06, right=0.96, bottom=0.14, top=0.8, wspace=0.2, hspace=0.42)
        figure.text(0.015, 0.945, f"The workspace on {robot.title}", fontsize=TITLE, fontweight="bold")
        figure.text(0.015, 0.908, _subtitle(certificate), fontsize=SMALL, color=QUIET)
    return figure


def _subtitle(certificate: Certificate) -> str:
    n_alpha, n_beta = certificate.reached.shape
    n_faults = len(certificate.faults())
    verdict = f"not certified, {n_faults} faults" if n_faults else "no collision, no limit exceeded"
    return (
        f"{certificate.reached.mean():.1%} of {n_alpha} x {n_beta} places reached; "
        f"1 cm in the 2D world is {1e3 * certificate.scale:.2f} mm on the table; {verdict}"
    )


def _layers(certificate: Certificate) -> list[Layer]:

    def least(values: NDArray[np.float64], axis: int) -> NDArray[np.float64]:
        return np.fmin.reduce(values, axis=axis)  # of what was reached, without a word about the rest

    def most(values: NDArray[np.float64], axis: int) -> NDArray[np.float64]:
        return np.fmax.reduce(values, axis=axis)

    return [
        Layer("distance to the table", "mm", 1e3 * least(certificate.to_table, axis=0), True),
        Layer("distance to itself", "mm", 1e3 * least(certificate.to_itself, axis=0), True),
        Layer("distance to a joint limit", "deg", np.degrees(least(certificate.room, axis=0)), True),
        Layer("turn of a joint to a neighbour", "rad", most(certificate.turn, axis=0), False),
        Layer("palm off its roll", "deg", np.degrees(most(certificate.roll_error, axis=0)), False),
        Layer("hand off its heading", "deg", np.degrees(most(certificate.heading_error, axis=0)), False),
    ]


def _draw_layer(axes: Axes, certificate: Certificate, layer: Layer) -> None:
    colours = COLOURS if layer.least_is_worst else f"{COLOURS}_r"
    image = axes.pcolormesh(
        certificate.alpha, certificate.beta, layer.values.T, cmap=colours, shading="nearest", rasterized=True
    )
    worst = np.nanargmin(layer.values) if layer.least_is_worst else np.nanargmax(layer.values)
    i, j = np.unravel_index(worst, layer.values.shape)
    place = certificate.alpha[i], certificate.beta[j]
    axes.plot(*place, ls="", clip_on=False, **RING)
    word = "least" if layer.least_is_worst else "most"
    axes.set_title(f"{layer.title}\n{word} {layer.values[i, j]:.3g} {layer.unit}", fontsize="medium")
    axes.set_xticks(np.arange(-30, 211, 60))
    axes.set_yticks(np.arange(0, 91, 30))
    axes.figure.colorbar(image, ax=axes, pad=0.02, aspect=18).set_label(f"[{layer.unit}]", color=QUIET)
