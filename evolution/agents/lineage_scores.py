"""What an agent's ancestors could do, and when each skill came (section VII, phylogeny).

Axes: G generations of the line, A distinct ancestors, C skills of a kind: the 9 instructions, or the
3 action words, in the order of `condition.instructions`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d import Condition, Readings, TrialRecord, Trials, draw_trials, record_trial, run_trials
from arm2d.records import alike, brief
from arm2d.tasks.task import AnyTask, papers_condition
from evolution.agents.firsts import first_rows
from evolution.agents.lineage import Lineage
from evolution.agents.subtasks import USUALLY
from evolution.search.randomness import Purpose, generator

# A skill is had above the limit of the paper's classes of agents. It has come when 25 generations
# of the line in a row have it, and come for good when the agent at the end and nine tenths of the rest have
# it too: one lucky or unlucky ancestor neither makes nor undoes it. Chosen.
IN_A_ROW: Final = 25
REST_OF_LINE: Final = 0.9

# "S1 on the target with S2 bent": for one second at a stretch, so that sweeping across it (three steps)
# does not count; S2 is bent while beta exceeds half its range. Chosen.
BENT_STEPS: Final = 10
BENT_BETA: Final = 45.0  # [deg]

TRIALS_PER_AREA: Final = 10
# Watching every step takes longer than scoring: of so many trials per instruction and area.
WATCHED_PER_AREA: Final = 3
# What the seeded draws are for; these stand in the place of a generation.
SCORED, WATCHED = 0, 1


@dataclass(frozen=True)
class Skills:
    """Skills of one kind along a line.

    Attributes:
        shares: [G, C], share of trials in which the ancestor showed the skill.
        first: [C], generation in which it first came, or -1.
        for_good: [C], generation in which it came for good, or -1.
    """

    shares: NDArray[np.float64]
    first: NDArray[np.int64]
    for_good: NDArray[np.int64]

    __repr__ = brief
    __eq__ = alike

    @classmethod
    def along(cls, shares: NDArray[np.float64]) -> Skills:
        """The skills with these shares of trials, [G, C]."""
        above = shares > USUALLY
        in_a_row = _all_ahead(above, IN_A_ROW)
        rest = np.arange(len(shares), 0, -1)[:, np.newaxis]
        lasting = np.cumsum(above[::-1], axis=0)[::-1] >= REST_OF_LINE * rest
        return cls(shares, first_rows(in_a_row), first_rows(in_a_row & lasting & above[-1]))


@dataclass(frozen=True)
class LineageScores:
    """What the ancestors make of fresh trials, the same for all of them.

    Attributes:
        condition: Names the instructions.
        per_area: Trials of each instruction from each start area.
        trial_seed: What the trials were drawn with.
        success: Carrying out each of the 9 instructions.
        reached_bent: Bringing S1 onto the target while S2 is bent, for each of the 3 action words heard.
        held_bent: Keeping it there for a second, likewise.
    """

    condition: Condition
    per_area: int
    trial_seed: int
    success: Skills
    reached_bent: Skills
    held_bent: Skills


def score_lineage(
    lineage: Lineage,
    condition: AnyTask | str,
    readings: Readings,
    *,
    per_area: int = TRIALS_PER_AREA,
    trial_seed: int = 0,
    on_ancestor: Callable[[int, int], None] = lambda done, total: None,
) -> LineageScores:
    """Let each distinct ancestor carry out all nine instructions.

    Args:
        lineage: The line.
        condition: Which nine instructions; its name will do.
        readings: The world they evolved in.
        per_area: Trials of each instruction from each start area.
        trial_seed: Draws the trials.
        on_ancestor: Is told how many of how many ancestors are done.

    Raises:
        ValueError: If there are no trials.
    """
    condition = papers_condition(condition, "this analysis")
    trials, watched = _draw(condition, readings, per_area, trial_seed)
    distinct, success, stays = lineage.distinct, [], []
    for done, genotype in enumerate(distinct, start=1):
        scores = run_trials(genotype, trials, readings)
        success.append(scores.success.reshape(len(condition.instructions), -1).mean(axis=1))
        stays.append([longest_bent_stay(record_trial(genotype, trial, readings)) for trial in watched])
        on_ancestor(done, len(distinct))
    by_action = np.reshape(stays, (len(distinct), 3, -1))  # [A, 3, trials]
    return LineageScores(
        condition,
        per_area,
        trial_seed,
        success=Skills.along(np.array(success)[lineage.versions]),
        reached_bent=Skills.along((by_action >= 1).mean(axis=-1)[lineage.versions]),
        held_bent=Skills.along((by_action >= BENT_STEPS).mean(axis=-1)[lineage.versions]),
    )


def longest_bent_stay(record: TrialRecord) -> int:
    """Steps for which S1 stays on the target at a stretch while S2 is bent; 0 if it never is."""
    target = record.discs[:, record.instruction.object]
    good = (offsets(record.alpha, target) < record.readings.target_cone) & (record.beta > BENT_BETA)
    bounds = np.flatnonzero(np.diff(np.concatenate([[False], good, [False]])))
    return int((bounds[1::2] - bounds[::2]).max(initial=0))


def offsets(alpha: NDArray[np.float64], centres: NDArray[np.float64]) -> NDArray[np.float64]:
    """d, the smaller angle between S1 and the bearing of a disc [deg], [K].

    Args:
        alpha: [K], angle of S1 in [deg].
        centres: [K, 2], the disc's centre in [cm].
    """
    bearing = np.degrees(np.arctan2(centres[:, 1], centres[:, 0]))
    return np.abs((bearing - alpha + 180.0) % 360.0 - 180.0)


def _all_ahead(above: NDArray[np.bool_], n: int) -> NDArray[np.bool_]:
    """Whether a row and the n - 1 after it are all True, as far as there are rows, [G, C]."""
    misses = np.concatenate([np.zeros((1, above.shape[1]), int), np.cumsum(~above, axis=0)])
    rows = np.arange(len(above))
    return misses[np.minimum(rows + n, len(above))] == misses[rows]


def _draw(condition: Condition, readings: Readings, per_area: int, seed: int) -> tuple[Trials, list[Trials]]:
    """Trials to be scored, and trials to be watched step by step."""
    scored, watched = (
        draw_trials(condition.instructions, n, readings, generator(seed, Purpose.BEHAVIOUR, use))
        for n, use in ((per_area, SCORED), (WATCHED_PER_AREA, WATCHED))
    )
    return scored, [watched[i] for i in range(len(watched))]
