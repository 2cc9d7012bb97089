"""The front page's picture and its loop, from a shipped agent.

    python scripts/front_page.py docs/images

writes `front.png` and `front.webp`: the robot does what it has never been told, and beneath stands how often
the agent carries out each instruction.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Final

from mujoco_port.film.gl import choose_back_end

choose_back_end()  # before anything imports mujoco

import numpy as np  # noqa: E402
from matplotlib import font_manager  # noqa: E402
from numpy.typing import NDArray  # noqa: E402
from PIL import Image, ImageDraw, ImageFont  # noqa: E402
from rich.progress import track  # noqa: E402

from arm2d import NON_EXPERIENCED, ActionWord, Instruction, ObjectWord  # noqa: E402
from arm2d.constants import DT  # noqa: E402
from arm2d.drawing import FLOOR, INK, OBJECT_COLOURS  # noqa: E402
from evolution.agents.recording import record_instruction  # noqa: E402
from evolution.figures.page import SUCCESS_MAP, ink_on  # noqa: E402
from evolution.runs.sources import Agent, find_agent  # noqa: E402
from evolution.search.evaluation import evaluate  # noqa: E402
from models.robots import get_robot  # noqa: E402
from mujoco_port.film.quality import QUALITIES, Quality  # noqa: E402
from mujoco_port.film.stage import Stage  # noqa: E402
from mujoco_port.film.take import Take, kinematic_take  # noqa: E402
from mujoco_port.film.video import moment_of, robot_pictures  # noqa: E402

AGENT, INSTRUCTION, AREA, SEED = "best-generaliser", "touch green", "left", 16
# Of which the agent is the best, by the rule of `evolution.results.notable`.
RUNS: Final = 100
ROBOT: Final = get_robot("icub")
# Sizes [px] at a scale of 1; words and marks are drawn twice as large and halved, so that edges are smooth.
WIDTH, VIEW, STRIP = 800, 450, 132
SMOOTH: Final = 2
INSET, CORNER = 168, 14
# The picture: its scale, and the moment [steps]. The loop: its scale and pace.
STILL_SCALE, STILL_STEP = 1.6, 140
LOOP_SCALE, LOOP_STEPS, LOOP_PER_SECOND = 1.0, 1.5, 10
SILENT_FRAMES, ONE_WORD_FRAMES, WORDS_FRAMES, LAST_FRAMES = 5, 6, 8, 16
# Between normal and high: 200 pictures at half the size need no more.
LOOP: Final = replace(QUALITIES["high"], finer=5.0, shadow_px=2048, lamps=3)
LOOP_WEBP: Final = {"quality": 66, "method": 6}
QUIET, UNLIT = "#6B6B6B", "#8C8E94"


class Page:
    """Words, marks and heat map around a picture of the robot.

    Args:
        agent: Whose successes the heat map shows.
        scale: 1 for a page 800 pixels wide.
    """

    def __init__(self, agent: Agent, scale: float) -> None:
        self._scale = scale
        self.view = _even(WIDTH * scale), _even(VIEW * scale)
        self.inset = _even(INSET * scale)
        self._strip = self._draw_strip(agent)

    def picture(
        self, view: NDArray[np.uint8], heard: tuple[bool, bool], asked: Instruction, share: float, clock: str
    ) -> Image.Image:
        """The whole page.

        Args:
            view: [H, W, 3], of the robot.
            heard: Whether the action word and the object word are lit.
            asked: What is asked.
            share: How much of it is done.
            clock: What is said of the time.
        """
        canvas = Image.fromarray(view).resize([SMOOTH * each for each in self.view])
        pen = ImageDraw.Draw(canvas, "RGBA")
        self._draw_words(pen, heard, asked)
        self._draw_ring(pen, share, OBJECT_COLOURS[asked.object], clock)
        page = Image.new("RGB", (self.view[0], self.view[1] + self._strip.height), FLOOR)
        page.paste(canvas.resize(self.view, Image.Resampling.BOX), (0, 0))
        page.paste(self._strip, (0, self.view[1]))
        return page

    def _px(self, *lengths: float) -> list[float]:
        """Lengths of the page on the canvas, which is `SMOOTH` times as large."""
        return [SMOOTH * self._scale * each for each in lengths]

    def _write(
        self,
        pen: ImageDraw.ImageDraw,
        x: float,
        y: float,
        words: str,
        size: float,
        colour: str,
        **how: str,
    ) -> None:
        """Words at a place; in its middle unless `anchor` says otherwise."""
        font = _font(how.get("weight", "normal"), round(SMOOTH * self._scale * size))
        pen.text(self._px(x, y), words, fill=colour, font=font, anchor=how.get("anchor", "mm"))

    def _draw_words(self, pen: ImageDraw.ImageDraw, heard: tuple[bool, bool], asked: Instruction) -> None:
        """Three action words over three object words, right; those that are heard are lit."""
        width, height, gap = 84, 27, 7
        rows = tuple(ActionWord)[:3], tuple(ObjectWord)
        for row, (words, lit, chosen) in enumerate(
            zip(rows, heard, (asked.action, asked.object), strict=True)
        ):
            for column, word in enumerate(words):
                left = WIDTH - 3 * width - 2 * gap - CORNER + column * (width + gap)
                top = CORNER + row * (height + gap)
                on = lit and word == chosen
                colour = OBJECT_COLOURS[word] if isinstance(word, ObjectWord) else INK
                box = self._px(left, top, left + width, top + height)
                fill = colour if on else (255, 255, 255, 110)
                pen.rounded_rectangle(box, radius=self._px(6)[0], fill=fill, outline=None if on else UNLIT)
                name = word.name if row == 0 else word.name.capitalize()
                self._write(
                    pen, left + width / 2, top + height / 2, name, 12.5, FLOOR if on else QUIET, weight="bold"
                )
        if asked in NON_EXPERIENCED and all(heard):
            top = CORNER + 2 * (height + gap) + 9
            self._write(
                pen, WIDTH - CORNER, top, "never met during evolution", 11, INK, anchor="rm", weight="bold"
            )

    def _draw_ring(self, pen: ImageDraw.ImageDraw, share: float, colour: str, clock: str) -> None:
        """A ring that fills while the robot holds on, below the words."""
        x, y, radius = WIDTH - CORNER - 36, 152, 34
        box = self._px(x - radius, y - radius, x + radius, y + radius)
        width = round(self._px(10)[0])
        pen.arc(box, 0, 360, fill=(0, 0, 0, 28), width=width)
        if share > 0.0:
            pen.arc(box, -90, -90 + 360 * share, fill=colour, width=width)
        self._write(pen, x, y, f"{100 * share:.0f} %", 12.5, INK, weight="bold")
        self._write(pen, x - radius - 14, y - 8, clock, 15, INK, anchor="rm", weight="bold")
        self._write(pen, x - radius - 14, y + 12, "hold for 10 s", 10.5, QUIET, anchor="rm")

    def _draw_strip(self, agent: Agent) -> Image.Image:
        """How often the agent carries out each instruction; those it never met are framed."""
        size = self.view[0], _even(STRIP * self._scale)
        strip = Image.new("RGB", tuple(SMOOTH * each for each in size), FLOOR)
        pen = ImageDraw.Draw(strip)
        evaluation = evaluate(agent.genotype, agent.condition, agent.readings)
        counts, trials = evaluation.successes[0].sum(axis=-1), 2 * evaluation.per_area
        left, top, width, height = 330, 26, 146, 31
        for k, (asked, count) in enumerate(zip(agent.condition.instructions, counts, strict=True)):
            row, column = divmod(k, 3)
            x, y = left + column * (width + 5), top + row * (height + 3)
            share = float(count) / trials
            shade = tuple(round(255 * each) for each in SUCCESS_MAP(share)[:3])
            framed = asked in NON_EXPERIENCED
            outline, line = (INK, round(self._px(2.6)[0])) if framed else (None, 0)
            pen.rectangle(self._px(x, y, x + width, y + height), fill=shade, outline=outline, width=line)
            ink = INK if ink_on(share) == INK else FLOOR
            weight = "bold" if framed else "normal"
            self._write(pen, x + width / 2, y + height / 2, f"{100 * share:.0f} %", 13, ink, weight=weight)
            if row == 0:
                name, colour = asked.object.name.capitalize(), OBJECT_COLOURS[asked.object]
                self._write(pen, x + width / 2, 14, name, 12, colour, weight="bold")
            if column == 0:
                name, right = asked.action.name, left - 10
                self._write(pen, right, y + height / 2, name, 11.5, INK, anchor="rm", weight="bold")
        self._write_legend(pen, trials)
        return strip.resize(size, Image.Resampling.BOX)

    def _write_legend(self, pen: ImageDraw.ImageDraw, trials: int) -> None:
        """What the heat map shows."""
        legend = (
            (28, "25 neurons obey two words", "bold"),
            (48, f"the best network of {RUNS} runs,", "normal"),
            (65, f"{trials} trials of each instruction", "normal"),
            (92, "Framed: never met", "bold"),
            (110, "during evolution", "normal"),
        )
        for y, words, weight in legend:
            self._write(pen, CORNER + 6, y, words, 13, INK, anchor="lm", weight=weight)


def still(agent: Agent) -> Image.Image:
    """The picture: a moment of the trial, in high quality."""
    page, take = Page(agent, STILL_SCALE), _take(agent, 1.0)
    with Stage(ROBOT, *page.view, QUALITIES["high"], take.record.readings) as stage:
        view = moment_of(take, stage, STILL_STEP, page.inset)
    return _page_at(page, take, STILL_STEP, view)


def loop(agent: Agent, quality: Quality = LOOP) -> Iterator[Image.Image]:
    """The loop: silence, one word, two words, the trial, its end."""
    page, take = Page(agent, LOOP_SCALE), _take(agent, 1.0 / LOOP_STEPS)
    asked = take.record.instruction
    with Stage(ROBOT, *page.view, quality, take.record.readings) as stage:
        for moment, view in enumerate(robot_pictures(take, stage, page.inset)):
            if moment == 0:
                lit = [(False, False)] * SILENT_FRAMES + [(True, False)] * ONE_WORD_FRAMES
                for heard in lit + [(True, True)] * WORDS_FRAMES:
                    yield page.picture(view, heard, asked, 0.0, "0.0 s")
            shown = _page_at(page, take, moment, view)
            yield shown
    for _ in range(LAST_FRAMES):
        yield shown


def _page_at(page: Page, take: Take, moment: int, view: NDArray[np.uint8]) -> Image.Image:
    """The page at a moment of a take."""
    state = int(take.steps[moment] + 1e-9)
    asked, clock = take.record.instruction, f"{state * DT:.1f} s"
    return page.picture(view, (True, True), asked, float(take.mind.share[state]), clock)


def _take(agent: Agent, frames_per_step: float) -> Take:
    """The trial that is shown."""
    record = record_instruction(agent, Instruction.parse(INSTRUCTION), AREA, SEED)
    return kinematic_take(record, ROBOT, frames_per_step, agent.genotype)


def _font(weight: str, size: int) -> ImageFont.FreeTypeFont:
    """The letters that all figures have."""
    properties = font_manager.FontProperties(family="DejaVu Sans", weight=weight)
    return ImageFont.truetype(font_manager.findfont(properties), size)


def _even(length: float) -> int:
    return 2 * round(length / 2)


def main() -> None:
    """Write both files into the folder that is named."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "docs/images")
    agent = find_agent(AGENT)
    still(agent).save(folder / "front.png", optimize=True)
    frames = list(track(loop(agent), "loop", total=None))
    first, *rest = frames
    milliseconds = round(1000 / LOOP_PER_SECOND)
    first.save(
        folder / "front.webp", save_all=True, append_images=rest, duration=milliseconds, loop=0, **LOOP_WEBP
    )
    for name in ("front.png", "front.webp"):
        print(f"{folder / name}: {(folder / name).stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main()
