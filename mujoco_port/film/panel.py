"""The picture of an agent's mind beside the robot, and the signs and badges that all pictures share."""

from __future__ import annotations

from typing import Any, Final, TypeVar

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, FancyBboxPatch, Rectangle, Wedge
from matplotlib.text import Text
from numpy.typing import ArrayLike, NDArray

from arm2d import ActionWord, Instruction, ObjectWord, Task
from arm2d import constants as c
from arm2d.drawing import FLOOR, INK, OBJECT_COLOURS, look
from arm2d.video import DPI
from mujoco_port.film.take import Mind

FAINT: Final = "#6B6B6B"
NEVER_MET: Final = "never met during evolution"
BADGE: Final = {"boxstyle": "round,pad=0.45", "fc": INK, "ec": "none"}

Mark = TypeVar("Mark", bound=Artist)

# Where things stand [px of a panel of 480 x 720], from its upper left corner.
WIDTH, HEIGHT = 480, 720
LEFT, RIGHT = 28, 452
WORDS_TOP, SENSES_TOP, NEURONS_TOP, MOTORS_TOP, RING_TOP = 26, 168, 312, 476, 562
CHIP = (128, 36, 12)  # width, height, gap
UNLIT: Final = "#E6E3DB"
QUIET: Final = "#8A877F"
NEURONS: Final = ("#1A1A1A", "#7A5AA8", "#B07C1E")
MOTORS: Final = ("S1 go", "S1 way", "S2 go", "S2 way")
TRACE_S: Final = 25.0


class MindPanel:
    """Pictures of a mind, [720, 480, 3]: `MindPanel(...).frame(12.5)`.

    Args:
        mind: What to show.
        instruction: What is scored.
        title: Whose body it is.
        verdicts: Who judges and whether the instruction was carried out; shown from `end` on.
        end: The step at which the verdicts are known.
        task: Whose words are heard; by default the paper's.
    """

    @look()
    def __init__(
        self,
        mind: Mind,
        instruction: Instruction,
        title: str,
        verdicts: tuple[tuple[str, bool], ...],
        end: float,
        task: Task | None = None,
    ) -> None:
        self._mind, self._instruction, self._verdicts, self._end = mind, instruction, verdicts, end
        third = "ignore" if instruction.action is ActionWord.IGNORE else "indicate"
        self._task = task or Task(third=third)
        figure = blank(WIDTH, HEIGHT)
        self._canvas = FigureCanvasAgg(figure)
        self._axes = axes = figure.add_axes((0, 0, 1, 1))
        axes.set(xlim=(0, WIDTH), ylim=(HEIGHT, 0))
        axes.axis("off")
        _write(axes, WIDTH / 2, HEIGHT - 14, title, size=7, color=QUIET, ha="center")
        self._moving: list[Artist] = []
        self._chips = self._draw_words()
        self._lamps, self._bend = self._draw_senses()
        self._traces, self._cursor = self._draw_neurons()
        self._bars = self._draw_motors()
        self._ring, self._share, self._clock, self._score, self._outcome = self._draw_ring()
        for artist in self._moving:
            artist.set_animated(True)
        self._heard: tuple[ActionWord | None, ObjectWord | None] | None = None
        self._background: Any = None  # of the canvas, without what moves
        self._shown: tuple[int, bool] | None = None
        self._picture = np.empty(0, np.uint8)

    def frame(self, step: float) -> NDArray[np.uint8]:
        """The picture after `step` steps; what changes with a control step is drawn anew with it."""
        ended, last = step >= self._end, len(self._mind.share) - 1
        key = last if ended else min(int(step + 1e-9), last), ended
        if key != self._shown:
            with look():
                self._show(*key)
                self._canvas.restore_region(self._background)
                for artist in self._moving:
                    self._axes.draw_artist(artist)
            self._picture = np.asarray(self._canvas.buffer_rgba())[..., :3].copy()
            self._shown = key
        return self._picture

    def _show(self, state: int, ended: bool) -> None:
        """Set everything as it is after `state` steps."""
        mind, step = self._mind, min(state, self._mind.steps - 1)
        self._light_words(mind.heard(step, self._task))
        values = mind.inputs[step]
        for lamp, index, colour in self._lamps:
            lamp.set_facecolor(colour if values[index] > 0.5 else UNLIT)
        self._bend.set_width(112 * values[11])
        seconds = np.arange(step + 1) * c.DT
        for trace, rates in zip(self._traces, mind.rates.T, strict=True):
            trace.set_data(_across(seconds), _trace_height(rates[: step + 1]))
        self._cursor.set_xdata([_across(seconds[-1])] * 2)
        for bar, value in zip(self._bars, mind.motors[step], strict=True):
            bar.set_width(82 * value)
            bar.set_facecolor(INK if value > 0.5 else "#A9A69E")
        share = float(mind.share[state])
        self._ring.set_theta2(-90.0 + 360.0 * share)  # y points down: from the top, clockwise
        self._ring.set_visible(share > 0.0)
        self._share.set_text(f"{100 * share:.0f} %")
        self._clock.set_text(f"{state * c.DT:.1f} s")
        if mind.score is not None:
            self._score.set_text(f"score {mind.score[state]:.2f}")
        shown = [f"{mark(success)} {judge}" for judge, success in self._verdicts] if ended else []
        self._outcome.set_text("\n".join(shown))

    def _light_words(self, heard: tuple[ActionWord | None, ObjectWord | None]) -> None:
        """Light the words that are heard; as they seldom change, all that stands still is drawn with them."""
        if heard == self._heard:
            return
        said = [word.name for word in heard if word is not None]
        for name, (patch, text) in self._chips.items():
            lit = name in said
            colour = OBJECT_COLOURS[ObjectWord[name]] if name in ObjectWord.__members__ else INK
            patch.set_facecolor(colour if lit else FLOOR)
            patch.set_edgecolor(colour if lit else UNLIT)
            text.set_color(FLOOR if lit else QUIET)
        self._canvas.draw()
        self._background = self._canvas.copy_from_bbox(self._axes.figure.bbox)
        self._heard = heard

    def _add(self, artist: Mark) -> Mark:
        self._moving.append(artist)
        return artist

    def _draw_words(self) -> dict[str, tuple[FancyBboxPatch, Text]]:
        """The action words over the object words: those that are heard are lit."""
        usual, height, gap = CHIP
        chips = {}
        for row, words in enumerate((self._task.actions, tuple(ObjectWord))):
            width = (3 * usual + 2 * gap - (len(words) - 1) * gap) / len(words)
            for column, word in enumerate(words):
                x, y = LEFT + column * (width + gap) + 8, WORDS_TOP + row * (height + gap)
                shape = "round,pad=0,rounding_size=9"
                patch = FancyBboxPatch((x, y), width, height, boxstyle=shape, lw=1.4)
                self._axes.add_patch(patch)
                name = word.name if row == 0 else word.name.capitalize()
                size = 13 if row == 0 else 14
                text = _write(
                    self._axes, x + width / 2, y + height / 2, name, size=size, ha="center", weight="bold"
                )
                chips[word.name] = patch, text
        met = self._instruction not in self._task.held_out
        y = WORDS_TOP + 2 * (height + gap) + 14
        if met:
            _write(self._axes, WIDTH / 2, y, "met during evolution", size=9, color=FAINT, ha="center")
        else:
            note = _write(self._axes, WIDTH / 2, y, NEVER_MET, size=10, color=FLOOR, ha="center")
            note.set_bbox(BADGE)
        return chips

    def _draw_senses(self) -> tuple[list[tuple[Circle, int, str]], Rectangle]:
        """Eighteen inputs in their groups: lamps, and a bar for how far S2 is bent."""
        axes, top = self._axes, SENSES_TOP
        _rule(axes, top, "18 inputs")
        lamps = []

        def lamp(x: float, y: float, index: int, colour: str) -> None:
            circle = Circle((x, y), 7.5, lw=0)
            axes.add_patch(circle)
            lamps.append((self._add(circle), index, colour))

        _write(axes, LEFT, top + 30, "sees", size=9, color=FAINT)
        # Sector 1 is the rightmost; the robot faces the viewer, so it stands on the left.
        for column, name in enumerate(("its right", "ahead", "its left")):
            x = LEFT + 84 + 72 * column
            _write(axes, x, top + 30, name, size=7.5, color=QUIET, ha="center")
            for colour, word in enumerate(ObjectWord):
                lamp(x + 19 * (colour - 1), top + 48, 2 + 3 * column + colour, OBJECT_COLOURS[word])
        _write(axes, LEFT, top + 82, "feels", size=9, color=FAINT)
        for index, name in enumerate(("right side", "left side")):
            lamp(LEFT + 76 + 94 * index, top + 82, index, INK)
            _write(axes, LEFT + 89 + 94 * index, top + 82, name, size=7.5, color=QUIET)
        _write(axes, LEFT + 262, top + 82, "S2 bent", size=7.5, color=QUIET)
        place = LEFT + 312, top + 77
        axes.add_patch(Rectangle(place, 112, 10, fc=UNLIT, lw=0))
        bend = Rectangle(place, 0, 10, fc=INK, lw=0)
        axes.add_patch(bend)
        _write(axes, LEFT, top + 116, "hears", size=9, color=FAINT)
        for group, (name, first) in enumerate((("action word", 15), ("object word", 12))):
            x = LEFT + 76 + 172 * group
            for k in range(3):
                lamp(x + 19 * k, top + 116, first + k, INK)
            _write(axes, x + 54, top + 116, name, size=7.5, color=QUIET)
        return lamps, self._add(bend)

    def _draw_neurons(self) -> tuple[list[Line2D], Line2D]:
        """Three strips: how each inter-neuron's rate went."""
        axes, top = self._axes, NEURONS_TOP
        _rule(axes, top, "3 inter-neurons")
        traces = []
        axes.add_patch(Rectangle((LEFT, top + 20), RIGHT - LEFT, 124, fc="white", ec=UNLIT, lw=0.8))
        for colour in NEURONS:
            (line,) = axes.plot([], [], color=colour, lw=1.7, solid_capstyle="round")
            traces.append(self._add(line))
        cursor = axes.axvline(LEFT, color=QUIET, lw=0.7)
        cursor.set_ydata([1 - (top + 144) / HEIGHT, 1 - (top + 20) / HEIGHT])
        return traces, self._add(cursor)

    def _draw_motors(self) -> list[Rectangle]:
        """Four bars: the motor neurons; beyond the middle they switch."""
        axes, top = self._axes, MOTORS_TOP
        _rule(axes, top, "4 motors")
        bars = []
        for k, name in enumerate(MOTORS):
            x = LEFT + 112 * k
            axes.add_patch(Rectangle((x, top + 22), 82, 14, fc=UNLIT, lw=0))
            bar = Rectangle((x, top + 22), 0, 14, fc=INK, lw=0)
            axes.add_patch(bar)
            bars.append(self._add(bar))
            axes.plot([x + 41] * 2, [top + 19, top + 39], color=QUIET, lw=0.8)
            _write(axes, x, top + 52, name, size=7.5, color=QUIET)
        return bars

    def _draw_ring(self) -> tuple[Wedge, Text, Text, Text, Text]:
        """A ring that fills while what is asked is being done; clock, score and verdicts beside it."""
        axes, centre, top = self._axes, (LEFT + 70, RING_TOP + 70), RING_TOP
        action = self._instruction.action
        asked = "turn the object by 34\N{DEGREE SIGN}" if action is ActionWord.MOVE else "hold for 10 s"
        axes.add_patch(Wedge(centre, 60, 0, 360, width=15, fc=UNLIT, lw=0))
        ring = Wedge(centre, 60, -90, -90, width=15, fc=OBJECT_COLOURS[self._instruction.object], lw=0)
        axes.add_patch(ring)
        x = LEFT + 160
        share = _write(axes, *centre, "", size=15, ha="center", weight="bold")
        clock = _write(axes, x, top + 22, "", size=17, weight="bold")
        _write(axes, x, top + 50, asked, size=9, color=FAINT)
        score = _write(axes, x, top + 72, "", size=9, color=FAINT)
        outcome = _write(axes, x, top + 108, "", size=13, weight="bold")
        for artist in (ring, share, clock, score, outcome):
            self._add(artist)
        return ring, share, clock, score, outcome


def _write(axes: Axes, x: float, y: float, words: str, *, size: float, **how: Any) -> Text:
    """Words at a place, in the middle of their line."""
    return axes.text(x, y, words, fontsize=size, va="center", **{"color": INK, **how})


def _rule(axes: Axes, top: float, name: str) -> None:
    """A thin line with a heading, over one group."""
    axes.plot([LEFT, RIGHT], [top - 6] * 2, color=UNLIT, lw=0.8)
    _write(axes, LEFT, top + 8, name, size=9.5, weight="bold")


def _across(seconds: ArrayLike) -> NDArray[np.float64]:
    """Where a time stands in the strip [px]."""
    return LEFT + 4 + (RIGHT - LEFT - 8) * np.asarray(seconds) / TRACE_S


def _trace_height(rates: NDArray[np.float64]) -> NDArray[np.float64]:
    """Where a rate stands in the strip [px]."""
    return NEURONS_TOP + 138 - 112 * rates


def mark(success: bool) -> str:
    """A sign that needs no colour."""
    return "\N{CHECK MARK}" if success else "\N{MULTIPLICATION X}"


def blank(width_px: int, height_px: int, colour: str = FLOOR) -> Figure:
    """An empty figure of this size."""
    return Figure(figsize=(width_px / DPI, height_px / DPI), dpi=DPI, facecolor=colour)


def pixels(figure: Figure) -> NDArray[np.uint8]:
    """A figure as a picture, [height, width, 3]."""
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[..., :3].copy()
