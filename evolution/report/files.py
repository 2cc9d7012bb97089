"""An analysed experiment as files: tables for people and programs, one compact archive, all figures."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from evolution.figures.paper import all_figures
from evolution.figures.run import save_figure
from evolution.report.rows import (
    generaliser_rows,
    genotype_rows,
    run_rows,
    table_ii_rows,
    test_rows,
    to_csv,
    transition_rows,
)
from evolution.results.analysis import check_some_tested, interval_of_mean
from evolution.results.generaliser_text import generalisers_sentence
from evolution.results.records import ConditionResults, Results
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
        "table-ii.csv": table_ii_rows(results),
        "runs.csv": run_rows(results),
        "transitions.csv": transition_rows(results),
        "tests.csv": test_rows(results),
        "generalisers.csv": generaliser_rows(results),
        "generaliser-genotypes.csv": genotype_rows(results),
    }
    paths = []
    for name, rows in tables.items():
        paths.append(folder / name)
        write_atomically(paths[-1], to_csv(rows).encode())
    paths.append(folder / "results.npz")
    write_arrays(paths[-1], arrays_of(results))
    for name, figure in all_figures(results).items():
        paths += save_figure(figure, folder / name)
    return paths


def arrays_of(results: Results) -> dict[str, np.ndarray]:
    """The numbers behind the figures, condition by condition; all trials are out of 80."""
    arrays = {}
    for condition, each in results.conditions.items():
        for name, array in _condition_arrays(each).items():
            arrays[f"{condition}.{name}"] = array
    return arrays


def summary(results: Results) -> str:
    """The result in a few sentences."""
    sentences = []
    for condition, each in results.conditions.items():
        if not each.runs:
            sentences.append(f"{condition}: no run can be analysed.")
            continue
        share = each.share_in_top("I")
        low, high = interval_of_mean(share)
        top = f"{100 * share.mean():.1f} % of the agents [{100 * low:.1f}, {100 * high:.1f}]"
        sentences.append(
            f"{condition}: {each.at_plateau} of {len(each.runs)} runs end at the largest fitness; {top} "
            "are in category 10 of sub-task I."
        )
        sentences.append(generalisers_sentence(each))
    return "\n".join([*sentences, *results.missing])


def _condition_arrays(each: ConditionResults) -> dict[str, np.ndarray]:
    return {
        "instructions": np.array([str(instruction) for instruction in each.condition.instructions]),
        "seeds": each.seeds,
        "best": each.best.astype(np.float32),
        "first_solved": each.first_solved,
        "generations": each.generations,
        "successes": each.successes.astype(np.uint8),
    }
