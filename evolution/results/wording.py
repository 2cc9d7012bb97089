"""Numbers as text, the same in every table, sentence and figure; generalisers in words."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

from arm2d import Condition
from evolution.results.generalisers import CHANCE_RANK, Generalisers, mean_rank_against_chance
from evolution.results.records import ConditionResults

TITLES: Final = MappingProxyType(
    {Condition.WITH_INDICATE: "With-Indicate", Condition.WITH_IGNORE: "With-Ignore"}
)
NOT_GIVEN: Final = "not given"


@dataclass(frozen=True)
class Line:
    """One row of a table of pairs: what it is, then (paper, ours) for each condition."""

    what: str
    pairs: tuple[tuple[str, str], ...]


def percent(share: float) -> str:
    """A share in per cent; small ones with more digits, so that few agents are not shown as none."""
    if share == 0:
        return "0 %"
    return f"{100 * share:.1f} %" if share >= 0.001 else f"{100 * share:.3f} %"


def p_value(p: float) -> str:
    """A p-value as exact as it makes sense."""
    if math.isnan(p):
        return "not defined"
    if p < 1e-300:
        return "below 1e-300"
    return f"{p:.2g}" if p < 0.995 else "1"


def of(part: int, whole: int) -> str:
    """Such as "3 of 10"."""
    return f"{part:,} of {whole:,}"


def points(difference: float) -> str:
    """A difference of shares in percentage points, with its sign."""
    rounded = round(100 * difference, 1) + 0.0  # no minus before nought
    return f"{rounded:+.1f}".replace("-", "−") if rounded else "0.0"  # noqa: RUF001 - minus


def generalisers_sentence(found: ConditionResults) -> str:
    """One sentence about a condition."""
    runs = [run for run in found.generalisers if len(run)]
    name = TITLES[found.condition]
    if not runs:
        return f"{name}: none of {len(found.runs)} runs has a fully compositional agent."
    agents, genotypes = sum(map(len, runs)), sum(len(run.stays) for run in runs)
    best, longest = sum(int(run.by_rank[0]) for run in runs), _longest(runs)
    rank, p = mean_rank_against_chance(runs)
    tested = f"p = {p_value(p)} over {len(runs)} run{'s' if len(runs) > 1 else ''}"
    return (
        f"{name}: {agents:,} fully compositional agents of {genotypes:,} genotypes in "
        f"{of(len(runs), len(found.runs))} runs; {best:,} of the agents are the best of their generation, "
        f"and their mean rank from 0 to 4 is {rank:.2f}, where chance gives {CHANCE_RANK:g} ({tested}); "
        f"a run has one for at most {_generations(longest[0])} in a row, a genotype of theirs is among the "
        f"five best for at most {_generations(longest[1])}, and from parent to child it goes through at most "
        f"{_generations(longest[2])}."
    )


def rank_of_generalisers(found: ConditionResults) -> str:
    """Their mean rank, over runs."""
    rank, _ = mean_rank_against_chance(found.generalisers)
    return "no such agent" if rank != rank else f"{rank:.2f}, chance {CHANCE_RANK:g}"


def longest_spell(found: ConditionResults) -> str:
    """The most generations in a row in which a run holds one."""
    runs = [run for run in found.generalisers if len(run)]
    return f"{_longest(runs)[0]:,}" if runs else "no such agent"


def _longest(runs: Sequence[Generalisers]) -> tuple[int, int, int]:
    """Longest spell, stay and line of all runs."""
    return (
        max(int(run.spells.max()) for run in runs),
        max(int(run.stays.max()) for run in runs),
        max(run.longest_line for run in runs),
    )


def _generations(n: int) -> str:
    return f"{n:,} generation{'s' if n != 1 else ''}"
