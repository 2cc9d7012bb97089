"""A run recomputed from its config.toml alone and held against its files, bit by bit. Nothing is written.

Chosen generations are scored again; through the others the recorded fitness leads, and what is checked there
is that parents and best genotypes follow from it. Where a part cannot be read, its generations are scored.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from evolution.runs.champion import LAST_GENERATIONS, champion_arrays
from evolution.runs.checkpoint import Checkpoint, load_checkpoint
from evolution.runs.folder import CHAMPIONS, CHECKPOINT, AnyRun, RunFolder
from evolution.runs.history import History, HistoryBuilder
from evolution.runs.run import Progress
from evolution.runs.storage import DamagedFileError
from evolution.search.algorithm import mean_in_order
from evolution.search.config import RunConfig
from evolution.search.population import Population, first_population, next_population
from evolution.search.scoring import score_population


@dataclass
class Findings:
    """What came of a verification.

    Attributes:
        walked: Generations whose parents and best genotypes follow from the fitness before them.
        scored: Generations among them that were scored again.
        damage: What cannot be read, each with the command that computes it again.
        difference: The first thing that is otherwise, or nothing.
        champions: Whether champions.npz was compared and is the same.
    """

    walked: int = 0
    scored: int = 0
    damage: list[str] = field(default_factory=list)
    difference: str = ""
    champions: bool = False

    @property
    def agrees(self) -> bool:
        """Whether all that was looked at is there and the same."""
        return not self.damage and not self.difference


def verify(
    run: AnyRun,
    chosen: Collection[int] | None = None,
    on_generation: Callable[[Progress], None] = lambda progress: None,
) -> Findings:
    """Recompute a run as far as it has come, up to the first difference.

    Args:
        run: The run, or the path of its folder.
        chosen: Generations to be scored again; all, if None.
        on_generation: Told of every generation.

    Returns:
        What was found.

    Raises:
        ValueError: If there is no such run.
    """
    folder, findings = RunFolder.open(run), Findings()
    population, newest = first_population(folder.config), deque[History](maxlen=LAST_GENERATIONS)
    for span, recorded in _recorded(folder, findings):
        for row, generation in enumerate(span):
            if recorded is None or chosen is None or generation in chosen:
                fitness = score_population(population, folder.config)
                findings.scored += 1
            else:
                fitness = recorded.fitness[row]
            newest.append(_one_generation(population, fitness, folder.config))
            findings.walked += 1
            on_generation(Progress(generation, float(fitness.max()), float(mean_in_order(fitness))))
            if recorded and (otherwise := _difference(newest[-1], recorded[row : row + 1])):
                findings.difference = f"in generation {generation} {otherwise}"
                return findings
            population = next_population(population, fitness, folder.config)
    _compare_ends(folder, population, newest, findings)
    return findings


def reached(folder: RunFolder) -> int:
    """How many generations a run has recorded, unreadable parts among them."""
    end = max((span.stop for span in folder.spans if folder.part_path(span).exists()), default=0)
    unfinished = _unfinished(folder, end)
    return end + (len(unfinished) if unfinished else 0)


def _recorded(folder: RunFolder, findings: Findings) -> Iterator[tuple[range, History | None]]:
    """The recorded generations part by part; None for a part that cannot be read, which is noted."""
    present = [span for span in folder.spans if folder.part_path(span).exists()]
    end = present[-1].stop if present else 0
    unfinished = _unfinished(folder, end)
    for span in folder.spans:
        if span.stop > end:
            break
        try:
            yield span, folder.read_part(span)
        except FileNotFoundError:
            findings.damage.append(str(folder.damaged(span, "it is missing")))
            yield span, None
        except DamagedFileError as error:
            findings.damage.append(str(error))
            yield span, None
    if unfinished:
        yield range(end, end + len(unfinished)), unfinished


def _unfinished(folder: RunFolder, end: int) -> History | None:
    """What the checkpoint holds beyond the parts, if it can be read."""
    try:
        checkpoint = load_checkpoint(folder)
    except DamagedFileError:
        return None
    return checkpoint.unfinished if checkpoint and checkpoint.unfinished and checkpoint.first == end else None


def _compare_ends(
    folder: RunFolder, population: Population, newest: Iterable[History], findings: Findings
) -> None:
    """Compare the population a run goes on with, and the champions of one that is over."""
    try:
        checkpoint = load_checkpoint(folder)
    except DamagedFileError as error:
        findings.damage.append(str(error))
    else:
        findings.difference = _other_population(checkpoint, population)
    if findings.difference or population.generation < folder.config.settings.generations:
        return
    path = folder.path / CHAMPIONS
    try:
        recorded = folder.read_arrays(path)
    except FileNotFoundError:
        repair = f"compute it again with: wordarm verify {folder.path} --repair"
        findings.damage.append(str(DamagedFileError(path, "it is missing", repair)))
    except DamagedFileError as error:
        findings.damage.append(str(error))
    else:
        computed = champion_arrays(History.join(newest), folder.config)
        # As a record: a version that knows more readings writes it with more lines.
        if _config_of(recorded) == folder.config:
            del computed["config"]
        other = _first_other(computed, recorded)
        findings.difference = f"in {CHAMPIONS} the array {other} is another" if other else ""
        findings.champions = not other


def _other_population(checkpoint: Checkpoint | None, population: Population) -> str:
    """How the checkpoint's population differs, if it is that of the same generation."""
    if checkpoint is None or checkpoint.population.generation != population.generation:
        return ""
    found = checkpoint.population
    same = _same(found.genotypes, population.genotypes) and np.array_equal(found.parents, population.parents)
    same = same and not _first_other(dict(population.memory), dict(found.memory))
    return (
        "" if same else f"the next population in {CHECKPOINT}, of generation {found.generation}, is another"
    )


def _one_generation(population: Population, fitness: NDArray[np.float64], config: RunConfig) -> History:
    """A scored generation as a history of one."""
    builder = HistoryBuilder(config)
    builder.append(population, fitness)
    return builder.build()


def _difference(computed: History, recorded: History) -> str:
    """How two histories of one generation differ, in words; nothing if they do not."""
    fitness, found = computed.fitness[0], recorded.fitness[0]
    if not _same(fitness, found):
        i = int(np.argmax(fitness.view(np.int64) != found.view(np.int64)))
        return f"genotype {i} has the fitness {float(found[i])!r}, but recomputed {float(fitness[i])!r}"
    if other := _first_other(computed.arrays(), recorded.arrays()):
        return f"the array {other} is another"
    return ""


def _first_other(computed: dict[str, NDArray], recorded: dict[str, NDArray]) -> str:
    """The first array that is not the same, or nothing."""
    return next((name for name, array in computed.items() if not _same(array, recorded.get(name))), "")


def _same(array: NDArray, other: NDArray | None) -> bool:
    """Whether two arrays are the same to the last bit."""
    return (
        other is not None
        and array.shape == other.shape
        and array.dtype == other.dtype
        and array.tobytes() == other.tobytes()
    )


def _config_of(arrays: dict[str, NDArray]) -> RunConfig | None:
    """The run that a file says it belongs to, if it does."""
    try:
        return RunConfig.from_toml(str(arrays["config"]))
    except (KeyError, ValueError):
        return None
