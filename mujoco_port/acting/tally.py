"""Counting trials in both worlds: tables by agent, and by instruction."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from rich.table import Table

from mujoco_port.acting.agreement import Outcome


@dataclass(frozen=True)
class Tally:
    """Counts of trials.

    Attributes:
        trials: All of them.
        planar: Successes of the 2D arm.
        physical: Successes of the robot.
        both: Trials in which both succeed.
    """

    trials: int
    planar: int
    physical: int
    both: int

    @property
    def agreement(self) -> float:
        """Part of the 2D arm's successes in which the robot succeeds too; 1 where there are none."""
        return self.both / self.planar if self.planar else 1.0


def tally(outcomes: Iterable[Outcome]) -> Tally:
    """Count."""
    rows = list(outcomes)
    return Tally(
        len(rows),
        sum(each.planar for each in rows),
        sum(each.physical for each in rows),
        sum(each.planar & each.physical for each in rows),
    )


def tables(outcomes: Sequence[Outcome]) -> list[Table]:
    """Two tables: per agent and loop, and per agent, loop and instruction."""
    whole = _table("the robot and the 2D arm", "agent", "loop")
    parts = _table("by instruction", "agent", "loop", "instruction")
    for agent, loop in dict.fromkeys((each.agent, each.loop) for each in outcomes):
        rows = [each for each in outcomes if (each.agent, each.loop) == (agent, loop)]
        whole.add_row(agent, loop, *_cells(tally(rows)))
        for instruction in dict.fromkeys(each.instruction for each in rows):
            counts = tally(each for each in rows if each.instruction == instruction)
            parts.add_row(agent, loop, instruction, *_cells(counts))
        parts.add_section()
    return [parts, whole]


def _table(title: str, *names: str) -> Table:
    table = Table(title=title)
    for name in names:
        table.add_column(name)
    for name in ("trials", "2D", "robot", "both", "both of 2D"):
        table.add_column(name, justify="right")
    return table


def _cells(counts: Tally) -> tuple[str, ...]:
    part = f"{100 * counts.agreement:.1f} %" if counts.planar else "-"
    return str(counts.trials), str(counts.planar), str(counts.physical), str(counts.both), part
