"""A ring that fills while what is asked is being done; clock, score and verdicts beside it."""

from __future__ import annotations

from typing import Final

from matplotlib.axes import Axes
from matplotlib.patches import Wedge
from matplotlib.text import Text

from arm2d import ActionWord, Instruction
from arm2d.drawing import OBJECT_COLOURS
from mujoco_port.film.panel.sheet import FAINT, LEFT, UNLIT, write

TOP: Final = 562  # [px]


def draw_ring(axes: Axes, instruction: Instruction) -> tuple[Wedge, Text, Text, Text, Text]:
    """A ring that fills while what is asked is being done; clock, score and verdicts beside it."""
    centre, top = (LEFT + 70, TOP + 70), TOP
    action = instruction.action
    asked = "turn the object by 34\N{DEGREE SIGN}" if action is ActionWord.MOVE else "hold for 10 s"
    axes.add_patch(Wedge(centre, 60, 0, 360, width=15, fc=UNLIT, lw=0))
    ring = Wedge(centre, 60, -90, -90, width=15, fc=OBJECT_COLOURS[instruction.object], lw=0)
    axes.add_patch(ring)
    x = LEFT + 160
    share = write(axes, *centre, "", size=15, ha="center", weight="bold")
    clock = write(axes, x, top + 22, "", size=17, weight="bold")
    write(axes, x, top + 50, asked, size=9, color=FAINT)
    score = write(axes, x, top + 72, "", size=9, color=FAINT)
    outcome = write(axes, x, top + 108, "", size=13, weight="bold")
    return ring, share, clock, score, outcome
