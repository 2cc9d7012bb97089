"""What the experiment is, in one picture: words and senses in, a network of 25 neurons, two joints out.

    python -m evolution.figures.concept docs/images/concept.svg

writes what the front page shows. The arm is a moment of a real trial of a shipped agent.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, FancyArrowPatch, FancyBboxPatch
from numpy.typing import NDArray

from arm2d import Instruction, ObjectWord, Readings, Trials, record_trial
from arm2d import constants as c
from arm2d.drawing import ARM, CAMERA, INK, OBJECT_COLOURS, STYLE, Scene, arm_points, look, state_at
from arm2d.trials import TrialRecord
from evolution.figures.page import svg_bytes
from evolution.runs.sources import find_agent
from evolution.runs.storage import write_atomically

SIZE: Final = (11.0, 4.4)  # [inches]
QUIET: Final = "#5F6368"
LINE: Final = "#C9C6BE"
STEPS_BEFORE_CONTACT: Final = 6
CAMERA_LABEL: Final = (52.0, 112.0)  # [cm]
START_LABELS_AT: Final = 92.0  # from the shoulder, within S1's reach [cm]
AGENT: Final = "best-generaliser"
INSTRUCTION: Final = "touch green"
TITLES: Final = ("An arm and three objects, from above", "A network that hears two words")
WORDS: Final = (("MOVE", "TOUCH", "INDICATE"), ("Blue", "Green", "Red"))


@dataclass(frozen=True)
class Sense:
    """A group of the network's inputs.

    Attributes:
        name: What it is, for people.
        inputs: How many there are.
        colour: Of its neurons in the picture.
    """

    name: str
    inputs: int
    colour: str


SENSES: Final = (
    Sense("action word", 3, "#8E9AA5"),
    Sense("object word", 3, "#A9BCCB"),
    Sense("camera", 9, CAMERA),
    Sense("touch", 2, ARM),
    Sense("elbow", 1, LINE),
)


def concept_figure(record: TrialRecord) -> Figure:
    """The arm and its world in the middle of a trial, what the agent hears, and its network."""
    figure = Figure(figsize=SIZE, facecolor="white")
    world = figure.add_axes((0.0, 0.0, 0.44, 0.88))
    network = figure.add_axes((0.46, 0.0, 0.54, 0.9))
    _draw_world(world, record)
    _draw_network(network, record.instruction)
    for left, title in (
        (0.025, "An arm and three objects, from above"),
        (0.47, "A network that hears two words"),
    ):
        figure.text(left, 0.93, title, fontsize=13, fontweight="bold", color=INK)
    return figure


def example(genotype: NDArray[np.float64], readings: Readings) -> TrialRecord:
    """The trial that is drawn: every object in the middle of its sector, the arm between Blue and Green."""
    distance = c.CHORD_END_DISTANCE * np.cos(np.radians(readings.sector_half_width))
    bearings = np.radians(readings.sector_centres)
    discs = distance * np.stack([np.cos(bearings), np.sin(bearings)], axis=1)  # [3, 2]
    instruction = Instruction.parse(INSTRUCTION)
    alpha = sum(readings.start_intervals[0]) / 2
    trials = Trials(
        np.array([instruction.action]), np.array([instruction.object]), np.array([alpha]), discs[None]
    )
    return record_trial(genotype, trials, readings)


def _draw_world(axes: Axes, record: TrialRecord) -> None:
    """The state some steps before the target is touched: searching is over, the forearm comes down."""
    touched = record.contact[:, record.instruction.object] != 0  # [K + 1]
    step = max(0, int(np.argmax(touched)) - STEPS_BEFORE_CONTACT)
    Scene(axes, record, caption=False).show(step)
    axes.set(xlim=(-178, 178), ylim=(-62, 182), facecolor="white")
    for text in axes.texts:
        text.set_visible(False)  # scale and clock
    alpha, beta, discs, _ = state_at(record, step)
    joint, tip = arm_points(alpha, beta)
    forearm = (joint + tip) / 2
    label = {"fontsize": 10, "color": QUIET, "ha": "center", "va": "center"}
    axes.text(0, -17, "shoulder", **label)
    axes.text(joint[0] - 26, joint[1] - 9, "elbow", **label)
    for interval in record.readings.start_intervals:
        start = np.radians(sum(interval) / 2)
        axes.text(START_LABELS_AT * np.cos(start), START_LABELS_AT * np.sin(start), "start", **label)
    axes.text(forearm[0] - 56, forearm[1] + 12, "forearm, feels\nboth its sides", **label)
    axes.text(*CAMERA_LABEL, "camera with\nthree sectors", **label)
    for disc, word in zip(discs, ObjectWord, strict=True):
        outward = disc / np.linalg.norm(disc)
        x, y = disc + (14 + 12 * abs(outward[0])) * outward  # words are wider than high
        look = {"fontsize": 11, "ha": "center", "va": "center", "fontweight": "bold"}
        sheet = {"fc": "white", "ec": "none", "alpha": 0.85, "pad": 1.0}  # over what the camera sees
        axes.text(x, y, word.name.capitalize(), color=OBJECT_COLOURS[word], bbox=sheet, **look)


def _draw_network(axes: Axes, instruction: Instruction) -> None:
    axes.set(xlim=(0, 100), ylim=(0, 66), xticks=[], yticks=[])
    axes.set_axis_off()
    _draw_words(axes, instruction)
    heights = _input_heights()
    inters = [(62.0, y) for y in (46.0, 33.0, 20.0)]
    motors = [(80.0, y) for y in (47.5, 40.5, 25.5, 18.5)]
    for y in heights:
        for inter in inters:
            axes.plot([41, inter[0]], [y, inter[1]], color=LINE, lw=0.35, zorder=1)
    for inter in inters:
        for other in (*inters, *motors):
            axes.plot([inter[0], other[0]], [inter[1], other[1]], color=LINE, lw=0.6, zorder=1)
    _draw_inputs(axes, heights)
    for x, y in inters:
        axes.add_patch(Circle((x, y), 2.6, fc="white", ec=ARM, lw=1.6, zorder=3))
        axes.add_patch(
            FancyArrowPatch(
                (x - 1.4, y + 2.4),
                (x + 1.4, y + 2.4),
                connectionstyle="arc3,rad=-1.6",
                arrowstyle="-|>",
                mutation_scale=6,
                lw=0.8,
                color=ARM,
                zorder=2,
            )
        )
    for x, y in motors:
        axes.add_patch(Circle((x, y), 1.9, fc=ARM, ec=ARM, zorder=3))
    for y, text in ((44.0, "turn the\nshoulder"), (22.0, "bend the\nelbow")):
        axes.text(84.5, y, text, fontsize=10, va="center", color=INK)
    for x, text in ((41, "18 inputs"), (62, "3 neurons with\nmemory"), (80, "4 motors")):
        axes.text(x, 3.5, text, fontsize=9.5, color=QUIET, ha="center", va="center")


def _draw_words(axes: Axes, instruction: Instruction) -> None:
    """The six words; the two that are heard are lit, each beside the inputs that it sets."""
    heard = str(instruction).split()
    for group, words in enumerate(WORDS):
        top = 57.5 - 27.0 * group
        for row, word in enumerate(words):
            y = top - 8.0 * row
            lit = word == heard[group]
            colour = (OBJECT_COLOURS[instruction.object] if group else ARM) if lit else "white"
            axes.add_patch(
                FancyBboxPatch(
                    (1, y), 16, 5.0, boxstyle="round,pad=0.4", fc=colour, ec=colour if lit else LINE, lw=1
                )
            )
            style: dict[str, Any] = {"color": "white", "fontweight": "bold"} if lit else {"color": QUIET}
            axes.text(9, y + 2.4, word, ha="center", va="center", fontsize=10, **style)
        heights = _input_heights()[3 * group : 3 * group + 3]
        axes.add_patch(
            FancyArrowPatch(
                (18.5, top - 5.6), (25.0, heights[1]), arrowstyle="-|>", mutation_scale=9, lw=1.1, color=QUIET
            )
        )


def _input_heights() -> list[float]:
    """Heights of the 18 inputs, sense by sense from the top."""
    heights, y = [], 60.5
    for sense in SENSES:
        for _ in range(sense.inputs):
            heights.append(y)
            y -= 2.6
        y -= 1.6
    return heights


def _draw_inputs(axes: Axes, heights: list[float]) -> None:
    places = iter(heights)
    for sense in SENSES:
        own = [next(places) for _ in range(sense.inputs)]
        for y in own:
            axes.add_patch(Circle((41, y), 1.0, fc=sense.colour, ec=ARM, lw=0.7, zorder=3))
        axes.text(38.8, float(np.mean(own)), sense.name, fontsize=9.5, ha="right", va="center", color=INK)


def main(path: Path) -> None:
    """Write the picture."""
    agent = find_agent(AGENT)
    with look(STYLE):
        write_atomically(path, svg_bytes(concept_figure(example(agent.genotype, agent.readings))))
    print(path)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
