"""How truly the hand plays S2: where it overlaps objects S2 does not touch, and misses those it touches.

python -m benchmarks.overlap [AGENT ...]

An agent is a run folder, a genotype file or the name of a shipped champion; by default all shipped ones.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import numpy as np
from rich.console import Console
from rich.table import Table

from arm2d import TrialRecord, draw_trials, record_trial
from evolution.runs.sources import Agent, find_agent
from models.robots import get_robot
from mujoco_port.acting.gaps import Gaps
from mujoco_port.film.kinematic import roll_out
from mujoco_port.reach.workspace import for_world

AGENTS: Final = ("best-generaliser", "best-specialist", "with-ignore")
PER_AREA: Final = 3
SEED: Final = 5
DEEP: Final = -0.002  # [m]; less is what friction and soft contacts hide
WIDE: Final = 0.005  # [m]; a touched object further away than this is missed
RIGHT: Final = 1


@dataclass
class Tally:
    """Gaps in [m] between hand or arm and an object, by what the 2D world says of it."""

    touched: list[float] = field(default_factory=list)
    untouched: list[float] = field(default_factory=list)
    arm: list[float] = field(default_factory=list)
    trials: int = 0
    successes: int = 0
    overlapping: int = 0
    missing: int = 0


def tally(agent: Agent) -> Tally:
    """Go through an agent's trials of all nine instructions, at the table of its world."""
    gaps = Gaps(for_world(get_robot("icub"), agent.readings))
    trials = draw_trials(agent.condition.instructions, PER_AREA, agent.readings, np.random.default_rng(SEED))
    total = Tally()
    for t in range(len(trials)):
        add(total, record_trial(agent.genotype, trials[t], agent.readings), gaps)
    return total


def add(total: Tally, record: TrialRecord, gaps: Gaps) -> None:
    """Go through one trial; moments in which nothing changes count once."""
    rollout = roll_out(record, gaps.robot, frames_per_step=1)
    states = np.column_stack([record.alpha, record.beta, record.contact])
    overlaps = misses = False
    for k in np.flatnonzero(np.r_[True, (np.diff(states, axis=0) != 0).any(axis=1)]):
        hand, arm = gaps.measure(rollout.angles[k], rollout.objects[k])
        touched = record.contact[k] == RIGHT
        total.touched.extend(hand[touched])
        total.untouched.extend(hand[record.contact[k] == 0])
        total.arm.extend(arm)
        overlaps |= bool((hand[record.contact[k] == 0] < DEEP).any() or (arm < DEEP).any())
        misses |= bool((hand[touched] > WIDE).any())
    total.trials += 1
    total.successes += record.success
    total.overlapping += record.success and overlaps
    total.missing += record.success and misses


def main(agents: tuple[str, ...]) -> None:
    """Print a table, one row for each agent."""
    table = Table(title="gaps between hand and objects in mm; trials are those that succeed in 2D")
    for name in ("agent", "trials", "overlapping", "missing", "deepest", "touched p1, 50, 99", "arm least"):
        table.add_column(name, justify="left" if name == "agent" else "right")
    for each in agents:
        agent = find_agent(each, generation=None, rank=0, condition=None)
        total = tally(agent)
        touched = np.percentile(total.touched, [1, 50, 99]) * 1e3 if total.touched else [np.nan] * 3
        table.add_row(
            Path(each).name,
            str(total.successes),
            str(total.overlapping),
            str(total.missing),
            f"{1e3 * min(total.untouched):.1f}",
            ", ".join(f"{gap:.1f}" for gap in touched),
            f"{1e3 * min(total.arm):.1f}",
        )
    Console().print(table)


if __name__ == "__main__":
    main(tuple(sys.argv[1:]) or AGENTS)
