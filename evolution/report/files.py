"""An analysed experiment as files: tables for people and programs, one compact archive, all figures."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from evolution.figures.page import save_figure
from evolution.figures.paper import all_figures
from evolution.report.rows import (
    generaliser_table,
    genotype_table,
    run_table,
    significance_table,
    table_ii,
    transition_table,
)
from evolution.results.analysis import check_some_tested, interval_of_mean
from evolution.results.records import ConditionResults, Results
from evolution.results.wording import generalisers_sentence
from evolution.runs.storage import make_folder, write_arrays, write_atomically


def write_results(results: Results, folder: Path | str) -> list[Path]:
    """Write everything into a folder; the paths, tables first.

    Raises:
        ValueError: If no run can be analysed; nothing is written then.
        OSError: If it cannot be written.
    """
    check_some_tested(results)
    folder = Path(folder)
    make_folder(folder)
    tables = {
        "table-ii.csv": table_ii(results),
        "runs.csv": run_table(results),
        "transitions.csv": transition_table(results),
        "tests.csv": significance_table(results),
        "generalisers.csv": generaliser_table(results),
        "generaliser-genotypes.csv": genotype_table(results),
    }
    paths = []
    for name, table in tables.items():
        paths.append(folder / name)
        write_atomically(paths[-1], table.to_csv().encode())
    paths.append(folder / "results.npz")
    write_arrays(paths[-1], arrays_of(results))
    for name, figure in all_figures(results).items():
        paths += save_figure(figure, folder / name)
    return paths


def arrays_of(results: Results) -> dict[str, np.ndarray]:
    """The numbers behind the figures, condition by condition; all trials are out of 80."""
    arrays = {}
    for condition, found in results.conditions.items():
        for name, array in _condition_arrays(found).items():
            arrays[f"{condition}.{name}"] = array
    return arrays


def summary(results: Results) -> str:
    """The result in a few sentences."""
    sentences = []
    for condition, found in results.conditions.items():
        if not found.runs:
            sentences.append(f"{condition}: no run can be analysed.")
            continue
        share = found.share_in_top("I")
        low, high = interval_of_mean(share)
        top = f"{100 * share.mean():.1f} % of the agents [{100 * low:.1f}, {100 * high:.1f}]"
        sentences.append(
            f"{condition}: {found.at_plateau} of {len(found.runs)} runs end at the largest fitness; {top} "
            "are in category 10 of sub-task I."
        )
        sentences.append(generalisers_sentence(found))
    return "\n".join([*sentences, *results.missing])


def _condition_arrays(found: ConditionResults) -> dict[str, np.ndarray]:
    return {
        "instructions": np.array([str(instruction) for instruction in found.condition.instructions]),
        "seeds": found.seeds,
        "best": found.best.astype(np.float32),
        "first_solved": found.first_solved,
        "generations": found.generations,
        "successes": found.successes.astype(np.uint8),
    }
