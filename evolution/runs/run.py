"""One run from its first generation to its last: the loop, its checkpoints, and how it goes on."""

from __future__ import annotations

import time
from collections.abc import Callable, Generator
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from evolution.runs import meta
from evolution.runs.champion import keep_champions
from evolution.runs.checkpoint import Checkpoint, load_checkpoint, save_checkpoint
from evolution.runs.folder import CHAMPIONS, META, RunFolder, refuse_other
from evolution.runs.history import HistoryBuilder
from evolution.runs.intervals import at_intervals
from evolution.runs.lock import Hold, locked
from evolution.runs.replay import replay_part
from evolution.runs.storage import DamagedFileError, make_folder
from evolution.search.algorithm import mean_in_order
from evolution.search.ask_tell import maker_of
from evolution.search.config import RunConfig
from evolution.search.population import Population, first_population, next_population
from evolution.search.scoring import score_population

# Seconds between two notes in the lock file of how far the run has come.
TELL_INTERVAL: Final = 0.5


@dataclass(frozen=True)
class Progress:
    """A generation that was just scored.

    Attributes:
        generation: Its number.
        best: Its highest fitness.
        mean: Its mean fitness.
    """

    generation: int
    best: float
    mean: float


@dataclass(frozen=True)
class Watcher:
    """What a run tells its caller, and asks of it.

    Attributes:
        on_start: Called with the number of the first generation to be scored.
        on_generation: Called after each generation.
        on_note: Called with a sentence when something unexpected was put right.
        wants_stop: Asked after each generation; if so, the run is left in good order.
        cpu_seconds: Asked for the processor time that the run has taken [s], from whenever on.
        choose_champions: Writes the champions of a finished run.
    """

    on_start: Callable[[int], None] = lambda generation: None
    on_generation: Callable[[Progress], None] = lambda progress: None
    on_note: Callable[[str], None] = lambda note: None
    wants_stop: Callable[[], bool] = lambda: False
    cpu_seconds: Callable[[], float] = time.process_time
    choose_champions: Callable[[RunFolder], None] = lambda folder: keep_champions(folder)


def evolve(path: Path, config: RunConfig, watcher: Watcher | None = None) -> int:
    """Start a run in a folder, or go on with it, until its last generation or until stopped.

    Args:
        path: The run folder; made if it is not there.
        config: The run. A folder with another one is refused.
        watcher: Is told of progress, and may stop the run.

    Returns:
        How many generations are scored: all of `config.settings.generations` unless stopped.

    Raises:
        ValueError: If the folder holds something else, a damaged part, or is in use, or the algorithm is not
            known.
        OSError: If it cannot be written; what was written before stays whole.
    """
    with closing(evolving(path, config, watcher)) as run:
        try:
            population = next(run)
            while True:
                population = run.send(score_population(population, config))
        except StopIteration as end:
            return end.value


def evolving(
    path: Path, config: RunConfig, watcher: Watcher | None = None
) -> Generator[Population, NDArray[np.float64], int]:
    """The same for a caller who scores: yields generation after generation, and is sent its fitness [P]."""
    watcher = watcher or Watcher()
    maker_of(config)  # refuses an algorithm that is not known, before anything is written
    refuse_other(path, config)
    make_folder(path)
    with locked(path) as hold:
        folder = RunFolder.create(path, config)
        reached = resume(folder, watcher)
        if reached.population.generation < config.settings.generations:
            reached = yield from _score_generations(folder, reached, watcher, hold)
        else:
            _keep_last_checkpoint(folder, reached)
        if reached.population.generation == config.settings.generations and not (path / CHAMPIONS).exists():
            watcher.choose_champions(folder)
    return reached.population.generation


def resume(folder: RunFolder, watcher: Watcher) -> Checkpoint:
    """Where a run can go on: at its checkpoint, or after its parts if they are newer or it is damaged."""
    spans = folder.finished_spans()
    end = spans[-1].stop if spans else 0
    checkpoint = _sound_checkpoint(folder, watcher)
    population = first_population(folder.config)
    if checkpoint and checkpoint.first <= end:
        population = checkpoint.population
    for span in spans:
        if span.stop <= population.generation:
            folder.check_part(span)
        else:
            population = replay_part(folder, span, population)
    if checkpoint and checkpoint.first == end:
        return checkpoint
    return Checkpoint(population, HistoryBuilder(folder.config).build())


def _sound_checkpoint(folder: RunFolder, watcher: Watcher) -> Checkpoint | None:
    """The checkpoint; none if it is damaged, for it holds nothing that cannot be computed again."""
    try:
        return load_checkpoint(folder)
    except DamagedFileError as error:
        watcher.on_note(f"{error.path} is damaged ({error.found}); going on from the parts instead")
        return None


def _keep_last_checkpoint(folder: RunFolder, reached: Checkpoint) -> None:
    """Write the checkpoint of a finished run, if a kill came between its last part and that."""
    kept = _sound_checkpoint(folder, Watcher())
    if kept is None or kept.population.generation != reached.population.generation:
        save_checkpoint(folder, reached)


def _score_generations(
    folder: RunFolder, start: Checkpoint, watcher: Watcher, hold: Hold
) -> Generator[Population, NDArray[np.float64], Checkpoint]:
    """Let generation after generation be scored; write a part and a checkpoint at the end of each part."""
    config, began = folder.config, watcher.cpu_seconds()
    population, part = start.population, HistoryBuilder(config)
    part.extend(start.unfinished)
    span_until = {span.stop: span for span in folder.spans}
    tell = at_intervals(TELL_INTERVAL, hold.tell)
    meta.note_start(folder.path / META, population.generation)
    watcher.on_start(population.generation)
    while population.generation < config.settings.generations and not watcher.wants_stop():
        fitness = yield population  # [P]
        part.append(population, fitness)
        best = float(fitness.max())
        watcher.on_generation(Progress(population.generation, best, float(mean_in_order(fitness))))
        tell(population.generation + 1, best)
        population = next_population(population, fitness, config)
        if population.generation in span_until:
            folder.write_part(span_until[population.generation], part.build())
            part = HistoryBuilder(config)
            save_checkpoint(folder, Checkpoint(population, part.build()))
    reached = Checkpoint(population, part.build())
    save_checkpoint(folder, reached)
    meta.note_end(folder.path / META, population.generation, watcher.cpu_seconds() - began)
    return reached
