"""Pictures of the planar world: a state into matplotlib axes.

    Scene(axes, record).show(step)      draws once, then moves what moves
    draw_state(axes, record, step)      one state
    with look(): ...                    the same on every machine

Lengths are in [cm]; the arm's base J1 is at the origin, x to the agent's right.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Final, TypeVar

import matplotlib as mpl
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.patches import Arc, Circle, Wedge

from arm2d import constants as c
from arm2d.geometry import camera_position
from arm2d.instructions import ObjectWord
from arm2d.trials import TrialRecord

Shape = TypeVar("Shape", Circle, Wedge)

# What everybody calls blue, green and red, told apart with any colour blindness; as in `models/scene.xml`.
OBJECT_COLOURS: Final = {ObjectWord.BLUE: "#1242B2", ObjectWord.GREEN: "#21A366", ObjectWord.RED: "#CC0007"}
ARM: Final = "#3A3F45"
JOINT: Final = "#F5F3EE"
FLOOR: Final = "#FBFAF7"
FAINT: Final = "#D9D6CF"
CAMERA: Final = "#F0E442"
INK: Final = "#1A1A1A"
QUIET: Final = "#6B6B6B"  # of what is said by the way
CONTACT: Final = "#111111"

# Everything the arm and its objects can reach, with room for the instruction above [cm].
LIMITS: Final = ((-180.0, 180.0), (-104.0, 200.0))
CAMERA_RANGE: Final = 172.0  # from J1, straight ahead
# The world gives S2 no width and S1 no obstacle; these only make them visible [cm].
S1_WIDTH: Final = 7.0
S2_WIDTH: Final = 3.4
# Below this a small panel's letters can no longer be read [points].
SMALLEST_LETTERS: Final = 6.0

# Figures are drawn as wide as they are printed: in a column of a journal, or across its page [inches].
COLUMN: Final = 85 / 25.4
FULL: Final = 178 / 25.4
# Letters of a figure's title, a panel's title, axes, and of ticks, notes and legends [points].
TITLE, HEADING, TEXT, SMALL = 10.0, 8.0, 7.0, 6.2
STYLE: Final[dict[Any, Any]] = {
    "font.family": "DejaVu Sans",
    "font.size": TEXT,
    "axes.titlesize": HEADING,
    "axes.titlelocation": "left",
    "axes.titlepad": 4.0,
    "axes.labelsize": TEXT,
    "axes.labelpad": 2.5,
    "axes.edgecolor": QUIET,
    "axes.labelcolor": INK,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "figure.titlesize": TITLE,
    "figure.titleweight": "bold",
    "figure.constrained_layout.h_pad": 0.06,
    "figure.constrained_layout.w_pad": 0.06,
    "legend.fontsize": SMALL,
    "legend.title_fontsize": SMALL,
    "legend.frameon": False,
    "legend.columnspacing": 1.4,
    "legend.handlelength": 1.6,
    "legend.handletextpad": 0.5,
    "lines.linewidth": 1.0,
    "text.color": INK,
    **{
        f"{axis}tick.{name}": value
        for axis in "xy"
        for name, value in (
            ("color", QUIET),
            ("labelcolor", INK),
            ("labelsize", SMALL),
            ("major.size", 2.2),
            ("major.width", 0.6),
            ("major.pad", 2.5),
        )
    },
    "svg.fonttype": "path",
    "svg.hashsalt": "wordarm",
}


@contextmanager
def look(style: dict[Any, Any] | None = None) -> Iterator[None]:
    """While open, what is drawn looks as Matplotlib comes, but for a style, whatever a `matplotlibrc` says.

    Such a file may ask for LaTeX, cut pages or colour them; and Matplotlib reads one from the current folder.
    """
    with mpl.rc_context():
        mpl.rcdefaults()
        with mpl.rc_context(style):
            yield


class Scene:
    """A trial in matplotlib axes, to be moved from step to step without being set up anew.

    All widths and letters are in proportion to the axes' size when the scene is made, so that a small
    panel shows the same picture as a large one; but no letters become too small to be read.

    Args:
        axes: Where to draw; cleared of ticks and scaled to the world.
        record: The trial.
        caption: Whether to write the instruction above the world.
        note: A line under the instruction, such as the agent and the trial it is about.
        outcome: Whether to say how it went, by default with the caption; not of a trial that goes on.
    """

    def __init__(
        self,
        axes: Axes,
        record: TrialRecord,
        *,
        caption: bool = True,
        note: str = "",
        outcome: bool | None = None,
    ) -> None:
        self._record, self._outcome = record, caption if outcome is None else outcome
        axes.set(xlim=LIMITS[0], ylim=LIMITS[1], aspect="equal", facecolor=FLOOR, xticks=[], yticks=[])
        axes.spines[:].set_visible(False)
        points = _points_per_cm(axes)
        _draw_ground(axes, record, points)
        edge = {"ec": FLOOR, "lw": 0.5 * points, "zorder": 1}
        reach = CAMERA_RANGE - np.hypot(*camera_position(0.0, record.readings))
        self._camera = [
            _add(axes, Wedge((0, 0), reach, 0, 1, fc=(CAMERA, alpha), **edge)) for alpha in (0.28, 0.55, 0.28)
        ]
        radius = record.readings.object_radius
        self._halos = [
            _add(axes, Circle((0, 0), radius + 3, fill=False, ec=CONTACT, lw=1.2 * points, zorder=3))
            for _ in OBJECT_COLOURS
        ]
        stroke = {"color": ARM, "solid_capstyle": "round", "zorder": 4}
        (self._s2,) = axes.plot([], [], lw=S2_WIDTH * points, **stroke)
        (self._s1,) = axes.plot([], [], lw=S1_WIDTH * points, **stroke)
        self._discs = [
            _add(axes, Circle((0, 0), radius, color=colour, lw=0, zorder=5))
            for colour in OBJECT_COLOURS.values()
        ]
        joint = {"color": JOINT, "mec": ARM, "mew": 1.6 * points, "zorder": 6}
        (base,) = axes.plot(0, 0, "o", ms=9 * points, **joint)
        (self._joint,) = axes.plot([], [], "o", ms=6 * points, **joint)
        if caption:
            _write_caption(axes, record, note, points)
        self._clock = axes.text(0, -98, "", ha="center", fontsize=_letters(8, points), color=INK)
        arm = [self._s2, self._s1, *self._discs, base, self._joint]
        # From back to front: what a step can change, or what lies above that.
        self.moving: list[Artist] = [*self._camera, *self._halos, *arm, self._clock]
        self.show(0)

    def show(self, step: float) -> None:
        """Move everything to the state after `step` steps; between two whole steps, in proportion.

        Raises:
            ValueError: If the record has no such step.
        """
        alpha, beta, discs, touched = state_at(self._record, step)
        joint, tip = arm_points(alpha, beta)
        self._s1.set_data(*np.stack([[0.0, 0.0], joint]).T)
        self._s2.set_data(*np.stack([joint, tip]).T)
        self._joint.set_data(joint[:1], joint[1:])
        edges = alpha + np.array(
            [-c.VIEW_HALF_WIDTH, -c.MIDDLE_SECTOR_HALF_WIDTH, c.MIDDLE_SECTOR_HALF_WIDTH, c.VIEW_HALF_WIDTH]
        )
        eye = tuple(camera_position(alpha, self._record.readings))
        for sector, low, high in zip(self._camera, edges[:-1], edges[1:], strict=True):
            sector.set_center(eye)
            sector.set_theta1(low)
            sector.set_theta2(high)
        for disc, halo, centre, touches in zip(self._discs, self._halos, discs, touched, strict=True):
            disc.set_center(tuple(centre))
            halo.set_center(tuple(centre))
            halo.set_visible(bool(touches))
        self._clock.set_text(self._time(step))

    def _time(self, step: float) -> str:
        """The clock and, at the end of a captioned trial, whether the instruction was carried out."""
        outcome = ""
        if self._outcome and step == self._record.steps:
            outcome = "carried out, " if self._record.success else "not carried out, "
        return f"{outcome}{step * c.DT:.1f} s"


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


def _points_per_cm(axes: Axes) -> float:
    """How many typographic points one centimetre of the world takes."""
    extent = axes.get_window_extent()
    (left, right), (bottom, top) = LIMITS
    pixels = min(extent.width / (right - left), extent.height / (top - bottom))
    return pixels * 72.0 / axes.figure.dpi


def _letters(size: float, points: float) -> float:
    """Font size [points] of letters that are `size` centimetres of the world, as far as they can be read."""
    return max(size * points, SMALLEST_LETTERS)


def _draw_ground(axes: Axes, record: TrialRecord, points: float) -> None:
    """Faintly: where J2 can be and where it starts, the chord each disc starts on, and a scale."""
    reach = {"fill": False, "ec": FAINT, "zorder": 0}
    axes.add_patch(Wedge((0, 0), c.S1_LENGTH, c.ALPHA_MIN, c.ALPHA_MAX, lw=0.7 * points, **reach))
    for low, high in record.readings.start_intervals:
        axes.add_patch(Arc((0, 0), *[2 * c.S1_LENGTH] * 2, theta1=low, theta2=high, lw=2 * points, **reach))
    half = record.readings.sector_half_width
    for centre, colour in zip(record.readings.sector_centres, OBJECT_COLOURS.values(), strict=True):
        ends = np.radians([centre - half, centre + half])
        x, y = c.CHORD_END_DISTANCE * np.cos(ends), c.CHORD_END_DISTANCE * np.sin(ends)
        axes.plot(x, y, color=colour, alpha=0.35, lw=points, zorder=0, solid_capstyle="round")
    axes.plot([-172, -122], [-98, -98], color=INK, lw=0.9 * points)
    axes.text(-147, -95, "50 cm", ha="center", va="bottom", fontsize=_letters(8, points), color=INK)


def _write_caption(axes: Axes, record: TrialRecord, note: str, points: float) -> None:
    """The instruction in its object's colour, and the note below it."""
    words = axes.text(0, 193, str(record.instruction), fontsize=_letters(14, points), fontweight="bold")
    words.set_color(OBJECT_COLOURS[record.instruction.object])
    line = axes.text(0, 177, note, fontsize=_letters(7, points), color=INK)
    for text in (words, line):
        text.set(ha="center", va="top")
