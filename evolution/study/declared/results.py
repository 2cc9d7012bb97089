"""The factorial study's results as files: tables of effects and checks, the chosen worlds, one picture."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Final

from arm2d import Condition
from evolution.experiments.variants import variant_name
from evolution.figures.page import save_figure
from evolution.runs.storage import make_folder, write_atomically
from evolution.study.declared.factors import FACTORS, levels_of
from evolution.study.declared.held_back import Check, check
from evolution.study.declared.levels_figure import levels_figure
from evolution.study.declared.lines import to_csv
from evolution.study.declared.nearest import Nearest, nearest_worlds, spreads
from evolution.study.declared.outcomes import FIGURES, OUTCOMES
from evolution.study.declared.regression import Estimate, Model, fit
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
    tables = {"effects": effect_rows(models), "interactions": interaction_rows(models)} if models else {}
    if checks:
        tables["check"] = check_rows(checks)
    if set(models) == set(Condition):
        tables["worlds"] = world_rows(chosen_worlds(models, runs))
    paths = [rows]
    for name, table in tables.items():
        paths.append(folder / f"factorial-{name}.csv")
        write_atomically(paths[-1], to_csv(table).encode())
    if models:
        title = f"What each reading does when all are mixed ({_counted(models)})"
        paths += save_figure(levels_figure(models, title), folder / "factorial-levels")
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


def effect_rows(models: Models) -> Iterable[Sequence[object]]:
    """One row per condition, outcome and level."""
    yield (
        "condition", "outcome", "factor", "level", "mean", "mean low", "mean high", "effect", "low", "high",
        "p of the factor", "after Holm", "runs",
    )  # fmt: skip
    for condition, model in _each(models):
        for place, factor in enumerate(FACTORS):
            for number, level in enumerate(factor.levels):
                yield (
                    str(condition), model.outcome.name, factor.name, level,
                    *_numbers(model.level_mean(place, number)), *_numbers(model.effect(place, number)),
                    f"{model.p[place]:.3g}", f"{model.corrected[place]:.3g}",
                    int((model.levels[:, place] == number).sum()),
                )  # fmt: skip


def interaction_rows(models: Models) -> Iterable[Sequence[object]]:
    """One row per pair of factors that was tried, and whether it entered the regression."""
    yield "condition", "outcome", "factor", "other factor", "p after Holm", "entered"
    for condition, model in _each(models):
        for pair, p in model.tried.items():
            names = (FACTORS[place].name for place in pair)
            yield (
                str(condition), model.outcome.name, *names, f"{p:.3g}",
                "yes" if pair in model.interactions else "no",
            )  # fmt: skip


def check_rows(checks: Mapping[Condition, Sequence[Check]]) -> Iterable[Sequence[object]]:
    """One row per condition and outcome: how well held-back runs were predicted."""
    ends = [f"{third} third, {what}" for third in THIRDS for what in ("predicted", "found")]
    yield "condition", "outcome", "runs fitted", "runs held back", "skill", "low", "high", *ends
    for condition, own in checks.items():
        for each in own:
            yield (
                str(condition), each.model.outcome.name, len(each.model.levels), len(each.found),
                *_numbers(each.skill), *(f"{value:.4f}" for third in each.thirds for value in third),
            )  # fmt: skip


def world_rows(worlds: Sequence[Nearest]) -> Iterable[Sequence[object]]:
    """One row per chosen world: its levels, its distance, what is predicted of it."""
    figures = [f"{figure.name}, {condition}" for condition in Condition for figure in FIGURES]
    yield "rank", "readings", "distance", *(factor.name for factor in FACTORS), *figures
    for rank, world in enumerate(worlds, 1):
        predicted = [f"{value:.4f}" for condition in Condition for value in world.predicted[condition]]
        name = variant_name(world.readings)
        yield rank, name, f"{world.distance:.4f}", *levels_of(world.readings), *predicted


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


def _numbers(estimate: Estimate) -> tuple[str, ...]:
    return tuple(f"{value:.4f}" for value in (estimate.value, estimate.low, estimate.high))


def _counted(models: Models) -> str:
    return ", ".join(f"{len(own[0].levels)} runs {condition}" for condition, own in models.items())
