"""Compute the damaged or missing files of a run again."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from evolution.champion import keep_champions
from evolution.checkpoint import load_checkpoint
from evolution.folder import CHAMPIONS, CHECKPOINT, RunFolder
from evolution.history import HistoryBuilder
from evolution.lock import locked
from evolution.population import Population, first_population, next_population
from evolution.replay import replay
from evolution.scoring import score_population
from evolution.storage import DamagedFileError


def repair(path: Path, on_note: Callable[[str], None] = lambda note: None) -> int:
    """Make every file of a run sound again, with the bits it had before.

    Args:
        path: The run folder.
        on_note: Is told of each repair in a sentence.

    Returns:
        How many files were repaired.

    Raises:
        ValueError: If this is no run folder, it is in use, or its sound parts were computed with other
            bits than this version computes.
        OSError: If the folder cannot be written.
    """
    folder = RunFolder.open(path)
    with locked(path):
        return _repair_parts(folder, on_note) + _repair_rest(folder, on_note)


def _repair_parts(folder: RunFolder, on_note: Callable[[str], None]) -> int:
    """Walk through all parts up to the last one there is; compute those anew that cannot be read."""
    present = [span for span in folder.spans if folder.part_path(span).exists()]
    population, n_repaired = first_population(folder.config), 0
    for span in folder.spans[: folder.spans.index(present[-1]) + 1] if present else []:
        try:
            history = folder.read_part(span)
        except (DamagedFileError, FileNotFoundError):
            population = _score_part(folder, span, population)
            on_note(f"computed generations {span.start} to {span.stop - 1} again")
            n_repaired += 1
        else:
            population = replay(population, history, folder.config)
    return n_repaired


def _score_part(folder: RunFolder, span: range, population: Population) -> Population:
    """Score the generations of a part, write it, and return the population after it."""
    part = HistoryBuilder(folder.config.settings.population)
    while population.generation < span.stop:
        fitness = score_population(population, folder.config)
        part.append(population, fitness)
        population = next_population(population, fitness, folder.config)
    folder.write_part(span, part.build())
    return population


def _repair_rest(folder: RunFolder, on_note: Callable[[str], None]) -> int:
    """Drop a damaged checkpoint, which the parts replace; choose lost champions again."""
    n_repaired = 0
    try:
        load_checkpoint(folder)
    except DamagedFileError as error:
        error.path.unlink()
        on_note(f"removed the damaged {CHECKPOINT}; the run will go on from its parts")
        n_repaired += 1
    if len(folder.finished_spans()) == len(folder.spans) and not _sound_champions(folder):
        keep_champions(folder)
        on_note(f"wrote {CHAMPIONS} again")
        n_repaired += 1
    return n_repaired


def _sound_champions(folder: RunFolder) -> bool:
    """Whether champions.npz is there as it was written."""
    try:
        folder.read_arrays(folder.path / CHAMPIONS)
    except (DamagedFileError, FileNotFoundError):
        return False
    return True
