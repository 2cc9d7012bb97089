"""Compute the damaged or missing files of a run again, its tests included."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from evolution.agents import solving
from evolution.agents.parts import late_spans
from evolution.agents.postevaluation import POST_EVALUATION
from evolution.agents.transitions import TRANSITION_TEST
from evolution.runs.champion import keep_champions
from evolution.runs.checkpoint import Checkpoint, load_checkpoint, save_checkpoint
from evolution.runs.folder import CHAMPIONS, RunFolder
from evolution.runs.history import HistoryBuilder
from evolution.runs.lock import locked
from evolution.runs.replay import replay
from evolution.runs.storage import DamagedFileError
from evolution.search.population import Population, first_population, next_population
from evolution.search.scoring import score_population

Tell = Callable[[str], None]


def repair(path: Path | str, on_note: Tell = lambda note: None) -> int:
    """Make every file of a run sound again, with the bits it had before.

    Tests that were not yet made are left to `wordarm postevaluate`.

    Args:
        path: The run folder.
        on_note: Is told of each repair in a sentence, with the file and what was wrong with it.

    Returns:
        How many files were repaired.

    Raises:
        ValueError: If this is no run folder, it is in use, or its sound parts were computed with other
            bits than this version computes.
        OSError: If the folder cannot be written.
    """
    folder = RunFolder.open(path)
    with locked(folder.path):
        n_repaired, population = _repair_parts(folder, on_note)
        n_repaired += _repair_checkpoint(folder, population, on_note)
        if len(folder.finished_spans()) == len(folder.spans):
            n_repaired += _repair_champions(folder, on_note) + _repair_tests(folder, on_note)
        return n_repaired


def _repair_parts(folder: RunFolder, on_note: Tell) -> tuple[int, Population]:
    """Walk through all parts up to the last one there is, computing anew those that cannot be read.

    How many these were, and the population after them.
    """
    present = [span for span in folder.spans if folder.part_path(span).exists()]
    population, n_repaired = first_population(folder.config), 0
    for span in folder.spans[: folder.spans.index(present[-1]) + 1] if present else []:
        if found := _fault(lambda span=span: folder.read_part(span)):
            population = _score_part(folder, span, population)
            name = folder.part_path(span).name
            on_note(f"{name}: {found}; computed generations {span.start} to {span.stop - 1} again")
            n_repaired += 1
        else:
            population = replay(population, folder.read_part(span), folder.config)
    return n_repaired, population


def _score_part(folder: RunFolder, span: range, population: Population) -> Population:
    """Score the generations of a part, write it, and return the population after it."""
    part = HistoryBuilder(folder.config)
    while population.generation < span.stop:
        fitness = score_population(population, folder.config)
        part.append(population, fitness)
        population = next_population(population, fitness, folder.config)
    folder.write_part(span, part.build())
    return population


def _repair_checkpoint(folder: RunFolder, population: Population, on_note: Tell) -> int:
    """Put a damaged checkpoint back to the end of the parts; of a finished run, it has the bits it had."""
    try:
        load_checkpoint(folder)
    except DamagedFileError as error:
        nothing = HistoryBuilder(folder.config).build()
        save_checkpoint(folder, Checkpoint(population, nothing))
        generation = population.generation
        on_note(
            f"{error.path.name}: {error.found}; wrote that of the end of the parts, generation {generation}"
        )
        return 1
    return 0


def _repair_champions(folder: RunFolder, on_note: Tell) -> int:
    """Choose lost champions again."""
    path = folder.path / CHAMPIONS
    if found := _fault(lambda: folder.read_arrays(path)):
        keep_champions(folder)
        on_note(f"{CHAMPIONS}: {found}; chose them again")
        return 1
    return 0


def _repair_tests(folder: RunFolder, on_note: Tell) -> int:
    """Make again what is damaged of both tests: first the instructions, on which the transitions rest."""
    n_repaired = 0
    for test in (POST_EVALUATION, TRANSITION_TEST):
        for span in late_spans(folder):
            path = test.path(folder, span)
            if path.exists() and (found := _fault(lambda test=test, span=span: test.read_part(folder, span))):
                test.write_part(folder, span)
                on_note(f"{path.parent.name}/{path.name}: {found}; tested its agents again")
                n_repaired += 1
    path = solving.file_path(folder)
    if path.exists() and (found := _fault(lambda: solving.read_solved_trials(folder))):
        solving.write_solved_trials(folder)
        on_note(f"{path.name}: {found}; counted the trials again")
        n_repaired += 1
    return n_repaired


def _fault(read: Callable[[], object]) -> str:
    """What is wrong with a file, or nothing."""
    try:
        read()
    except DamagedFileError as error:
        return error.found
    except FileNotFoundError:
        return "it is missing"
    return ""
