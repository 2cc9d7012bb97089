"""The figures of docs/results once more, from the numbers that lie beside them.

    python -m scripts.docs_figures

draws what tables and results.npz hold: fitness, Table II, generalisers, learning curves, and the study of
readings but for the levels of the factorial one. The others need the runs: `wordarm analyse` and `wordarm
behaviour` draw them.
"""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d import Condition, Readings
from arm2d.readings import PLAIN
from evolution.agents.subtasks import AgentClass, categories, classify, count_table
from evolution.experiments.experiment import Experiment
from evolution.figures.generalisers import generalisers_figure
from evolution.figures.learning import learning_figure
from evolution.figures.page import save_figure
from evolution.figures.paper import fitness_figure, table_figure
from evolution.results.analysis import PLATEAU_SHARE
from evolution.results.generalisers import Generalisers, spell_lengths
from evolution.results.learning import read_curves
from evolution.results.records import ConditionResults, Results
from evolution.runs.folder import RunFolder
from evolution.runs.storage import read_arrays
from evolution.search.config import RunConfig
from evolution.study.declared.confirmation.decision import WINNER
from evolution.study.declared.confirmation.figure import TITLES, draw_worlds
from evolution.study.declared.confirmation.worlds import PRINTED, PRINTED_WORLD, fresh_worlds, runs_of_worlds
from evolution.study.declared.rows import read_rows
from evolution.study.drawn import read_drawn
from evolution.study.results import write_pictures

RESULTS: Final = Path(__file__).parents[1] / "docs" / "results"
# The experiments whose results are stored, each with its readings.
WORLDS: Final = {RESULTS: Readings(), RESULTS / "plain": PLAIN}
# The parts of the study, each with the one in which what its variants stand on was evolved.
PARTS: Final = {"screening": None, "finalists": None, "around": None, "confirmation": "finalists"}


def main() -> None:
    """Draw and write all of them."""
    for folder, readings in WORLDS.items():
        results = stored_results(folder, readings)
        for name, draw in (
            ("fitness", fitness_figure),
            ("table-ii", table_figure),
            ("generalisers", generalisers_figure),
        ):
            print(*save_figure(draw(results), folder / name), sep="\n")
    curves = read_curves(RESULTS / "learning" / "curves.csv")
    print(*save_figure(learning_figure(curves), RESULTS / "learning" / "curves"), sep="\n")
    for part, before in PARTS.items():
        others = [] if before is None else read_drawn(RESULTS / "readings" / f"{before}-runs.csv")
        variants = read_drawn(RESULTS / "readings" / f"{part}-runs.csv")
        print(*write_pictures(variants, part, RESULTS / "readings", others), sep="\n")
    print(*confirmation_figures(RESULTS / "readings"), sep="\n")


def confirmation_figures(folder: Path) -> list[Path]:
    """The worlds of the confirmation and of the decision, from rows and distances; their paths."""
    runs = read_rows(folder / "fresh.csv")
    known = set(fresh_worlds([]).values())
    worlds = fresh_worlds([r for r in dict.fromkeys(run.config.readings for run in runs) if r not in known])
    paths = draw_worlds(
        runs_of_worlds(runs, worlds),
        distances_in(folder / "fresh-worlds.csv"),
        TITLES["fresh"],
        folder / "fresh-worlds",
    )
    decided = folder / "decision-worlds.csv"
    if decided.exists():
        runs = read_rows(folder / "decision.csv")
        winner = next(r for run in runs if (r := run.config.readings) != PRINTED_WORLD)
        worlds = {WINNER: winner, PRINTED: PRINTED_WORLD}
        own = runs_of_worlds(runs, worlds)
        paths += draw_worlds(own, distances_in(decided), TITLES["decision"], folder / "decision-worlds")
    return paths


def distances_in(table: Path) -> dict[str, float]:
    """The distance of each world from the paper, as its table tells it."""
    with table.open(encoding="utf-8", newline="") as file:
        return {row["world"]: float(row["distance"]) for row in csv.DictReader(file)}


def stored_results(folder: Path, readings: Readings) -> Results:
    """An experiment as far as its archive tells it: without transitions, and without stays of genotypes."""
    arrays = read_arrays(folder / "results.npz")
    found = {
        condition: _condition(condition, readings, {name: arrays[f"{condition}.{name}"] for name in ARRAYS})
        for condition in Condition
    }
    experiment = Experiment(folder, {condition: own.runs for condition, own in found.items()})
    return Results(experiment, found, {}, {})


ARRAYS: Final = ("seeds", "best", "first_solved", "generations", "successes")


def _condition(condition: Condition, readings: Readings, arrays: dict[str, NDArray]) -> ConditionResults:
    best, successes = arrays["best"].astype(float), arrays["successes"].astype(np.int16)
    generations, n_runs = arrays["generations"], len(arrays["seeds"])
    tables = np.array([count_table(categories(own.reshape(-1, 9), condition)) for own in successes])
    classes = [classify(own.reshape(-1, 9), condition) for own in successes]
    return ConditionResults(
        condition=condition,
        runs=tuple(
            RunFolder(RESULTS / f"seed-{seed:04d}", RunConfig(condition, int(seed), readings=readings))
            for seed in arrays["seeds"]
        ),
        seeds=arrays["seeds"],
        best=best,
        plateau=np.median(best[:, -round(best.shape[1] * PLATEAU_SHARE) :], axis=1),
        first_solved=arrays["first_solved"],
        genotypes=np.zeros(n_runs, np.int64),
        longest_stay=np.zeros(n_runs, np.int64),
        generations=generations,
        successes=successes,
        counts=tables.sum(axis=0),
        counts_per_run=tables,
        members={kind: np.array([own[kind].sum() for own in classes]) for kind in AgentClass},
        generalisers=tuple(
            _generalisers(own[AgentClass.FULL].reshape(-1, 5), generations) for own in classes
        ),
        transitions={},
        missing=(),
    )


def _generalisers(members: NDArray[np.bool_], generations: NDArray[np.int32]) -> Generalisers:
    """Fully compositional agents [L, 5] over time, without their genotypes."""
    rows, ranks = np.nonzero(members)
    none = np.zeros(0, np.int64)
    return Generalisers(
        counts=members.sum(axis=1),
        generations=generations[rows].astype(np.int64),
        ranks=ranks,
        spells=spell_lengths(np.asarray(members.any(axis=1))),
        first=none,
        stays=none,
        verdicts=none,
        longest_line=0,
    )


if __name__ == "__main__":
    main()
