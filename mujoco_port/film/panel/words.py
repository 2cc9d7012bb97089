"""The words of an instruction: those that are heard are lit."""

from __future__ import annotations

from typing import Final

from matplotlib.axes import Axes
from matplotlib.patches import FancyBboxPatch
from matplotlib.text import Text

from arm2d import ActionWord, Instruction, ObjectWord, Task
from arm2d.drawing import FLOOR, INK, OBJECT_COLOURS
from mujoco_port.film.panel.sheet import BADGE, FAINT, LEFT, NEVER_MET, QUIET, UNLIT, WIDTH, write

TOP: Final = 26  # [px]
CHIP: Final = (128, 36, 12)  # width, height, gap
Chips = dict[str, tuple[FancyBboxPatch, Text]]
# None for a word that is not said.
Heard = tuple[ActionWord | None, ObjectWord | None]


def draw_words(axes: Axes, instruction: Instruction, task: Task) -> Chips:
    """The action words over the object words: those that are heard are lit."""
    usual, height, gap = CHIP
    chips = {}
    for row, words in enumerate((task.actions, tuple(ObjectWord))):
        width = (3 * usual + 2 * gap - (len(words) - 1) * gap) / len(words)
        for column, word in enumerate(words):
            x, y = LEFT + column * (width + gap) + 8, TOP + row * (height + gap)
            shape = "round,pad=0,rounding_size=9"
            patch = FancyBboxPatch((x, y), width, height, boxstyle=shape, lw=1.4)
            axes.add_patch(patch)
            name = word.name if row == 0 else word.name.capitalize()
            size = 13 if row == 0 else 14
            text = write(axes, x + width / 2, y + height / 2, name, size=size, ha="center", weight="bold")
            chips[word.name] = patch, text
    met = instruction not in task.held_out
    y = TOP + 2 * (height + gap) + 14
    if met:
        write(axes, WIDTH / 2, y, "met during evolution", size=9, color=FAINT, ha="center")
    else:
        note = write(axes, WIDTH / 2, y, NEVER_MET, size=10, color=FLOOR, ha="center")
        note.set_bbox(BADGE)
    return chips


def light_words(chips: Chips, heard: Heard) -> None:
    """Light the words that are heard."""
    said = [word.name for word in heard if word is not None]
    for name, (patch, text) in chips.items():
        lit = name in said
        colour = OBJECT_COLOURS[ObjectWord[name]] if name in ObjectWord.__members__ else INK
        patch.set_facecolor(colour if lit else FLOOR)
        patch.set_edgecolor(colour if lit else UNLIT)
        text.set_color(FLOOR if lit else QUIET)
