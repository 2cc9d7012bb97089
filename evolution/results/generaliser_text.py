"""Where fully compositional agents stand among the five best and how long they last, in words."""

from __future__ import annotations

from collections.abc import Sequence

from evolution.results.generalisers import CHANCE_RANK, Generalisers, mean_rank_against_chance
from evolution.results.records import ConditionResults
from evolution.results.wording import TITLES, of, p_value


def generalisers_sentence(each: ConditionResults) -> str:
    """One sentence about a condition."""
    runs = [found for found in each.generalisers if len(found)]
    name = TITLES[each.condition]
    if not runs:
        return f"{name}: none of {len(each.runs)} runs has a fully compositional agent."
    agents, genotypes = sum(map(len, runs)), sum(len(found.stays) for found in runs)
    best, longest = sum(int(found.by_rank[0]) for found in runs), _longest(runs)
    rank, p = mean_rank_against_chance(runs)
    tested = f"p = {p_value(p)} over {len(runs)} run{'s' if len(runs) > 1 else ''}"
    return (
        f"{name}: {agents:,} fully compositional agents of {genotypes:,} genotypes in "
        f"{of(len(runs), len(each.runs))} runs; {best:,} of the agents are the best of their generation, "
        f"and their mean rank from 0 to 4 is {rank:.2f}, where chance gives {CHANCE_RANK:g} ({tested}); "
        f"a run has one for at most {_generations(longest[0])} in a row, a genotype of theirs is among the "
        f"five best for at most {_generations(longest[1])}, and from parent to child it goes through at most "
        f"{_generations(longest[2])}."
    )


def rank_of_generalisers(each: ConditionResults) -> str:
    """Their mean rank, over runs."""
    rank, _ = mean_rank_against_chance(each.generalisers)
    return "no such agent" if rank != rank else f"{rank:.2f}, chance {CHANCE_RANK:g}"


def longest_spell(each: ConditionResults) -> str:
    """The most generations in a row in which a run holds one."""
    runs = [found for found in each.generalisers if len(found)]
    return f"{_longest(runs)[0]:,}" if runs else "no such agent"


def _longest(runs: Sequence[Generalisers]) -> tuple[int, int, int]:
    """Longest spell, stay and line of all runs."""
    return (
        max(int(found.spells.max()) for found in runs),
        max(int(found.stays.max()) for found in runs),
        max(found.longest_line for found in runs),
    )


def _generations(n: int) -> str:
    return f"{n:,} generation{'s' if n != 1 else ''}"
