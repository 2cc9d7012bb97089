"""What the comparisons say: whether a change helps or hinders, in sentences, as declared (docs/beyond.md)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Final

from evolution.study.beyond.cells import PAPER, Cell
from evolution.study.beyond.comparisons import Comparison, verdict_of
from evolution.study.beyond.groups import Group
from evolution.study.beyond.outcomes import PLATEAU, SOLVED, TESTED, UNDERSTOOD, Words

# What a change does, of these outcomes.
SUBJECTS: Final = {"evolution": (SOLVED, PLATEAU), "understanding": (UNDERSTOOD,)}


def effects_of(cell: Cell, groups: Iterable[Group], found: Sequence[Comparison]) -> dict[str, str]:
    """Whether a change helps, hinders or is undecided as to evolution and as to understanding.

    It helps (hinders) if an outcome says more (less) in at least one condition and none says the contrary.
    """
    own = [group for group in groups if group.cell == cell]
    told = {}
    for subject, outcomes in SUBJECTS.items():
        said = {verdict_of(group, outcome, found) for group in own for outcome in outcomes}
        shown = said - {"undecided"}
        told[subject] = {"more": "helps", "less": "hinders"}[shown.pop()] if len(shown) == 1 else "undecided"
    return told


def sentences(groups: Sequence[Group], found: Sequence[Comparison]) -> list[str]:
    """Every verdict with its comparisons, and what each change does."""
    told = []
    for group in groups:
        for outcome in TESTED:
            if verdict_of(group, outcome, found) != "undecided":
                told += [each.sentence for each in found if (each.group, each.outcome) == (group, outcome)]
    for cell in dict.fromkeys(group.cell for group in groups if group.cell != PAPER):
        shown = {s: effect for s, effect in effects_of(cell, groups, found).items() if effect != "undecided"}
        told += [f"{cell.name} {effect} {subject}" for subject, effect in shown.items()]
        if [*shown.values()] in (["helps"] * len(SUBJECTS), ["hinders"] * len(SUBJECTS)):
            told.append(_with_success(cell, shown["evolution"], found))
    return told


def _with_success(cell: Cell, effect: str, found: Iterable[Comparison]) -> str:
    """What is said of a cell where understanding goes with the success of evolution."""
    more = "more" if effect == "helps" else "less"
    own = [each for each in found if each.group.cell == cell and each.outcome == UNDERSTOOD]
    shares = "; ".join(
        f"{each.paper.task} {_of_obeying(each.group, each.words)} "
        f"({_of_obeying(each.paper, each.words)} in the paper's task)"
        for each in own
    )
    return (
        f"{cell.name}: {more} is understood where evolution succeeds {more}; of the agents that obey all "
        f"experienced instructions understand: {shares}"
    )


def _of_obeying(group: Group, words: Words) -> str:
    """Of agents that obey, the share that understands, if there is such an agent."""
    return f"{100 * group.of_obeying(words):.1f} %" if group.obeying_runs else "none, for none obeys"
