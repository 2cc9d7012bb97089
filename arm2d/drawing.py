"""Pictures of the planar world: a state into matplotlib axes.

    Scene(axes, record).show(step)      draws once, then moves what moves
    draw_state(axes, record, step)      one state

Lengths are in [cm]; the arm's base J1 is at the origin, x to the agent's right.
"""

from __future__ import annotations

from typing import Final, TypeVar

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Wedge

from arm2d import constants as c
from arm2d.instructions import ObjectWord
from arm2d.trials import TrialRecord

Shape = TypeVar("Shape", Circle, Wedge)

# Colour-blind safe; they mean the objects everywhere in the project.
OBJECT_COLOURS: Final = {ObjectWord.BLUE: "#0072B2", ObjectWord.GREEN: "#009E73", ObjectWord.RED: "#D55E00"}
ARM: Final = "#3A3F45"
JOINT: Final = "#F5F3EE"
FLOOR: Final = "#FBFAF7"
FAINT: Final = "#D9D6CF"
CAMERA: Final = "#F0E442"
INK: Final = "#1A1A1A"
CONTACT: Final = "#111111"

# The half circle of everything the arm and its objects can reach [cm].
LIMITS: Final = ((-178.0, 178.0), (-92.0, 178.0))
CAMERA_RANGE: Final = 168.0


class Scene:
    """A trial in matplotlib axes, to be moved from step to step without being drawn anew.

    Args:
        axes: Where to draw; cleared of ticks and scaled to the world.
        record: The trial.
        caption: Whether to write the instruction above the world; the time stands below it anyway.
    """

    def __init__(self, axes: Axes, record: TrialRecord, *, caption: bool = True) -> None:
        self._record = record
        _prepare(axes)
        _draw_sectors(axes, record)
        self._camera = [
            _add(axes, Wedge((0, 0), CAMERA_RANGE, 0, 1, color=CAMERA, alpha=alpha, lw=0, zorder=1))
            for alpha in (0.16, 0.3, 0.16)
        ]
        self._discs = [
            _add(axes, Circle((0, 0), record.readings.object_radius, color=colour, lw=0, zorder=3))
            for colour in OBJECT_COLOURS.values()
        ]
        self._halos = [
            _add(
                axes,
                Circle((0, 0), record.readings.object_radius + 3.5, fill=False, ec=CONTACT, lw=1.6, zorder=3),
            )
            for _ in OBJECT_COLOURS
        ]
        (self._s1,) = axes.plot([], [], color=ARM, lw=7, solid_capstyle="round", zorder=4)
        (self._s2,) = axes.plot([], [], color=ARM, lw=4.5, solid_capstyle="round", zorder=4)
        self._joints: Line2D = axes.plot([], [], "o", color=JOINT, mec=ARM, mew=1.6, ms=6.5, zorder=5)[0]
        if caption:
            place = {"ha": "center", "va": "top", "transform": axes.transAxes}
            words = axes.text(0.5, 0.985, str(record.instruction), fontsize=14, fontweight="bold", **place)
            words.set_color(OBJECT_COLOURS[record.instruction.object])
        self._clock = axes.text(0.985, 0.03, "", ha="right", va="bottom", transform=axes.transAxes)
        self._clock.set(fontsize=9, color=INK)
        self.show(0)

    def show(self, step: float) -> None:
        """Move everything to the state after `step` steps; between two whole steps, in proportion.

        Raises:
            ValueError: If the record has no such step.
        """
        alpha, beta, discs, touched = state_at(self._record, step)
        joints, tip = arm_points(alpha, beta)
        self._s1.set_data(*np.stack([[0.0, 0.0], joints]).T)
        self._s2.set_data(*np.stack([joints, tip]).T)
        self._joints.set_data(*np.stack([[0.0, 0.0], joints]).T)
        edges = alpha + np.array(
            [-c.VIEW_HALF_WIDTH, -c.MIDDLE_SECTOR_HALF_WIDTH, c.MIDDLE_SECTOR_HALF_WIDTH, c.VIEW_HALF_WIDTH]
        )
        for sector, low, high in zip(self._camera, edges[:-1], edges[1:], strict=True):
            sector.set_theta1(low)
            sector.set_theta2(high)
        for disc, halo, centre, touches in zip(self._discs, self._halos, discs, touched, strict=True):
            disc.set_center(tuple(centre))
            halo.set_center(tuple(centre))
            halo.set_visible(bool(touches))
        self._clock.set_text(f"{step * c.DT:.1f} s")


def draw_state(axes: Axes, record: TrialRecord, step: int) -> None:
    """Draw the state after `step` steps of a recorded trial: arm, camera, discs, contact, instruction.

    Args:
        axes: Where to draw.
        record: The trial.
        step: From 0, the start, to `record.steps`.

    Raises:
        ValueError: If the record has no such step.
    """
    Scene(axes, record).show(step)


def state_at(record: TrialRecord, step: float) -> tuple[float, float, np.ndarray, np.ndarray]:
    """(alpha [deg], beta [deg], discs [3, 2] in [cm], touched [3]) after `step` steps.

    Between two whole steps positions are interpolated, and contact is that of the later step.
    """
    if not 0 <= step <= record.steps:
        raise ValueError(f"step {step:g} does not exist; this trial has the states 0 to {record.steps}")
    before, after = int(np.floor(step)), int(np.ceil(step))
    part = step - before

    def between(values: np.ndarray) -> np.ndarray:
        return (1.0 - part) * values[before] + part * values[after]

    touched = record.contact[after] != 0
    return float(between(record.alpha)), float(between(record.beta)), between(record.discs), touched


def arm_points(alpha: float, beta: float) -> tuple[np.ndarray, np.ndarray]:
    """Positions [2] of J2 and of S2's tip in [cm], for alpha and beta in [deg]."""
    a, h = np.radians(alpha), np.radians(alpha + beta)
    joint = c.S1_LENGTH * np.array([np.cos(a), np.sin(a)])
    return joint, joint + c.S2_LENGTH * np.array([np.cos(h), np.sin(h)])


def _add(axes: Axes, patch: Shape) -> Shape:
    """Add a patch to axes and give it back, with its own type."""
    axes.add_patch(patch)
    return patch


def _prepare(axes: Axes) -> None:
    """Scale the axes to the world and take away what is not part of it."""
    axes.set(xlim=LIMITS[0], ylim=LIMITS[1], aspect="equal", facecolor=FLOOR, xticks=[], yticks=[])
    axes.spines[:].set_visible(False)
    bar = np.array([-168.0, -118.0])
    axes.plot(bar, [-80.0, -80.0], color=INK, lw=1.2)
    axes.text(bar.mean(), -77.0, "50 cm", ha="center", va="bottom", fontsize=8, color=INK)


def _draw_sectors(axes: Axes, record: TrialRecord) -> None:
    """Faintly: where S1 can turn to, and the chord each disc starts on."""
    axes.add_patch(
        Wedge((0, 0), c.S1_LENGTH, c.ALPHA_MIN, c.ALPHA_MAX, fc="none", ec=FAINT, lw=0.8, zorder=0)
    )
    half = record.readings.sector_half_width
    for centre, colour in zip(record.readings.sector_centres, OBJECT_COLOURS.values(), strict=True):
        ends = np.radians([centre - half, centre + half])
        x, y = c.CHORD_END_DISTANCE * np.cos(ends), c.CHORD_END_DISTANCE * np.sin(ends)
        axes.plot(x, y, color=colour, alpha=0.35, lw=1.2, zorder=1, solid_capstyle="round")
