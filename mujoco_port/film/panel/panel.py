"""The picture of an agent's mind beside the robot: what stands still is drawn once, the rest step by step."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from numpy.typing import NDArray

from arm2d import ActionWord, Instruction, Task
from arm2d import constants as c
from arm2d.drawing import INK, look
from mujoco_port.film.panel.neurons import across, draw_motors, draw_neurons, trace_height
from mujoco_port.film.panel.ring import draw_ring
from mujoco_port.film.panel.senses import draw_senses
from mujoco_port.film.panel.sheet import HEIGHT, QUIET, UNLIT, WIDTH, blank, mark, write
from mujoco_port.film.panel.words import Heard, draw_words, light_words
from mujoco_port.film.take import Mind


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
        write(axes, WIDTH / 2, HEIGHT - 14, title, size=7, color=QUIET, ha="center")
        self._chips = draw_words(axes, instruction, self._task)
        self._lamps, self._bend = draw_senses(axes)
        self._traces, self._cursor = draw_neurons(axes, mind.rates.shape[1])
        self._bars = draw_motors(axes)
        ring = draw_ring(axes, instruction)
        self._ring, self._share, self._clock, self._score, self._outcome = ring
        lamps = [lamp for lamp, _, _ in self._lamps]
        self._moving = [*lamps, self._bend, *self._traces, self._cursor, *self._bars, *ring]
        for artist in self._moving:
            artist.set_animated(True)
        self._heard: Heard | None = None
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
            trace.set_data(across(seconds), trace_height(rates[: step + 1]))
        self._cursor.set_xdata([across(seconds[-1])] * 2)
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

    def _light_words(self, heard: Heard) -> None:
        """Light the words that are heard; as they seldom change, all that stands still is drawn with them."""
        if heard == self._heard:
            return
        light_words(self._chips, heard)
        self._canvas.draw()
        self._background = self._canvas.copy_from_bbox(self._axes.figure.bbox)
        self._heard = heard
