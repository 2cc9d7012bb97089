"""The factorial study's results as files: tables of effects and checks, the chosen worlds, one picture."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from arm2d import Condition
from evolution.experiments.variants import variant_name
from evolution.figures.page import save_figure
from evolution.report.columns import PlainTable
from evolution.results.wording import TITLES
from evolution.runs.storage import make_folder, write_atomically
from evolution.study.declared.claim import answer_table, averaged_over_worlds
from evolution.study.declared.factors import FACTORS, levels_of
from evolution.study.declared.held_back import Check, check
from evolution.study.declared.levels_figure import levels_figure
from evolution.study.declared.nearest import Nearest, nearest_worlds, spreads
from evolution.study.declared.outcomes import FIGURES, OUTCOMES
from evolution.study.declared.regression import Model, estimate_columns, fit
from evolution.study.declared.rows import MeasuredRun, write_rows

THIRDS: Final = ("lower", "middle", "upper")

Models = Mapping[Condition, Sequence[Model]]


def write_factorial(runs: Sequence[MeasuredRun], folder: Path) -> tuple[list[Path], list[str]]:
    """Write what the runs measured by now allow: paths, and a sentence for everything that has to wait.

    Raises:
        OSError: If a file cannot be written.
    """
    make_folder(folder)
    rows = folder / "factorial.csv"
    write_rows(runs, rows)
    models, checks, notes = _models(runs)
    tables = {"effects": effect_table(models), "interactions": interaction_table(models)} if models else {}
    if checks:
        tables["check"] = check_table(checks)
    if set(models) == set(Condition):
        tables["worlds"] = world_table(chosen_worlds(models, runs))
        tables["claim"] = answer_table([("factorial worlds", averaged_over_worlds(runs))])
    paths = [rows]
    for name, table in tables.items():
        paths.append(folder / f"factorial-{name}.csv")
        write_atomically(paths[-1], table.to_csv().encode())
    if models:
        title = "What each reading does when all are mixed"
        paths += save_figure(levels_figure(models, title, _counted(models)), folder / "factorial-levels")
    return paths, notes


def chosen_worlds(models: Models, runs: Sequence[MeasuredRun]) -> list[Nearest]:
    """The worlds that the declared rule puts nearest to the paper."""
    used = {c: [model for model in own if model.outcome in FIGURES] for c, own in models.items()}
    return nearest_worlds(used, spreads(runs))


def regressions(runs: Sequence[MeasuredRun]) -> dict[Condition, list[Model]]:
    """All declared regressions, by condition.

    Raises:
        ValueError: If there are too few runs of a condition, or statsmodels is missing.
    """
    return {c: [fit(_of(runs, c), outcome) for outcome in OUTCOMES] for c in Condition}


def effect_table(models: Models) -> PlainTable[Any]:
    """One row per condition, outcome and level."""
    return PlainTable(
        {
            "condition": lambda row: str(row.condition),
            "outcome": lambda row: row.model.outcome.name,
            "factor": lambda row: FACTORS[row.place].name,
            "level": lambda row: list(FACTORS[row.place].levels)[row.number],
            **estimate_columns(
                "mean", "mean low", "mean high", of=lambda row: row.model.level_mean(row.place, row.number)
            ),
            **estimate_columns(
                "effect", "low", "high", of=lambda row: row.model.effect(row.place, row.number)
            ),
            "p of the factor": lambda row: f"{row.model.p[row.place]:.3g}",
            "after Holm": lambda row: f"{row.model.corrected[row.place]:.3g}",
            "runs": lambda row: int((row.model.levels[:, row.place] == row.number).sum()),
        },
        [
            _Level(condition, model, place, number)
            for condition, model in _each(models)
            for place, factor in enumerate(FACTORS)
            for number in range(len(factor.levels))
        ],
    )


def interaction_table(models: Models) -> PlainTable[Any]:
    """One row per pair of factors that was tried, and whether it entered the regression."""
    return PlainTable(
        {
            "condition": lambda row: str(row.condition),
            "outcome": lambda row: row.model.outcome.name,
            "factor": lambda row: FACTORS[row.pair[0]].name,
            "other factor": lambda row: FACTORS[row.pair[1]].name,
            "p after Holm": lambda row: f"{row.model.tried[row.pair]:.3g}",
            "entered": lambda row: "yes" if row.pair in row.model.interactions else "no",
        },
        [_Pair(condition, model, pair) for condition, model in _each(models) for pair in model.tried],
    )


def check_table(checks: Mapping[Condition, Sequence[Check]]) -> PlainTable[Any]:
    """One row per condition and outcome: how well held-back runs were predicted."""
    return PlainTable(
        {
            "condition": lambda row: str(row[0]),
            "outcome": lambda row: row[1].model.outcome.name,
            "runs fitted": lambda row: len(row[1].model.levels),
            "runs held back": lambda row: len(row[1].found),
            **estimate_columns("skill", "low", "high", of=lambda row: row[1].skill),
            **{
                f"{third} third, {what}": lambda row, i=i, j=j: f"{row[1].thirds[i][j]:.4f}"
                for i, third in enumerate(THIRDS)
                for j, what in enumerate(("predicted", "found"))
            },
        },
        [(condition, found) for condition, own in checks.items() for found in own],
    )


def world_table(worlds: Sequence[Nearest]) -> PlainTable[Any]:
    """One row per chosen world: its levels, its distance, what is predicted of it."""
    return PlainTable(
        {
            "rank": lambda row: row[0],
            "readings": lambda row: variant_name(row[1].readings),
            "distance": lambda row: f"{row[1].distance:.4f}",
            **{
                factor.name: lambda row, place=place: levels_of(row[1].readings)[place]
                for place, factor in enumerate(FACTORS)
            },
            **{
                f"{figure.name}, {condition}": lambda row, c=condition, i=i: f"{row[1].predicted[c][i]:.4f}"
                for condition in Condition
                for i, figure in enumerate(FIGURES)
            },
        },
        list(enumerate(worlds, 1)),
    )


@dataclass(frozen=True)
class _Level:
    """A row of the table of effects: a level of a factor in one regression."""

    condition: Condition
    model: Model
    place: int
    number: int


@dataclass(frozen=True)
class _Pair:
    """A row of the table of interactions: two factors in one regression."""

    condition: Condition
    model: Model
    pair: tuple[int, int]


def _models(
    runs: Sequence[MeasuredRun],
) -> tuple[dict[Condition, list[Model]], dict[Condition, list[Check]], list[str]]:
    """Regressions and checks for which there are enough runs, and what has to wait."""
    models, checks, notes = {}, {}, []
    for condition in Condition:
        own = _of(runs, condition)
        try:
            models[condition] = [fit(own, outcome) for outcome in OUTCOMES]
            checks[condition] = [check(own, outcome) for outcome in OUTCOMES]
        except ValueError as error:
            what = "the check on held-back runs" if condition in models else "the regression"
            notes.append(f"{condition}, {what} has to wait: {error}")
    return models, checks, notes


def _of(runs: Sequence[MeasuredRun], condition: Condition) -> list[MeasuredRun]:
    return [run for run in runs if run.config.condition is condition]


def _each(models: Models) -> Iterable[tuple[Condition, Model]]:
    return ((condition, model) for condition, own in models.items() for model in own)


def _counted(models: Models) -> str:
    return ", ".join(f"{len(own[0].levels)} runs {TITLES[condition]}" for condition, own in models.items())
