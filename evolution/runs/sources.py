"""From what a user names (a run, a genotype file, a shipped champion) to a genotype and its world."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from reprlib import repr as shortened
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d import Condition, Readings, check_genotypes
from arm2d.records import alike
from arm2d.tasks.task import AnyTask
from evolution.runs.arrays import read_genotype_file
from evolution.runs.folder import CHAMPIONS, AnyRun, RunFolder
from evolution.runs.recorded import recorded_generation, recorded_histories
from evolution.runs.replay import population_at
from evolution.search.algorithm import rank as ranking
from evolution.search.config import RunConfig
from evolution.search.settings import N_BEST

SHIPPED: Final = Path(__file__).parents[1] / "champions"
PROVENANCE: Final = ("generations", "ranks")


@dataclass(frozen=True)
class Agent:
    """An agent: a genotype and what is known of it.

    Attributes:
        genotype: [G], or of a network of another size.
        condition: Whose instructions it hears, or a task of one's own.
        readings: The world it evolved in.
        origin: Where it comes from, for people.
        name: The same, fit for a file name.
        folder: The run folder it was taken from, if it was.
    """

    genotype: NDArray[np.float64]
    condition: AnyTask
    readings: Readings
    origin: str
    name: str
    folder: RunFolder | None = None

    __eq__ = alike

    def __hash__(self) -> int:
        return hash((self.origin, self.name))

    def __repr__(self) -> str:
        return f"<Agent: {self.origin}>"


def find_agent(
    source: AnyRun, *, generation: int | None = None, rank: int = 0, condition: AnyTask | None = None
) -> Agent:
    """The genotype that a user means.

    Args:
        source: A run, its folder, a genotype file (.npz or .npy), or the name of a shipped champion.
        generation: Of the run; by default its champions are meant.
        rank: 0 for the best of the generation, of the champions, or of the file.
        condition: For files that do not tell; with-indicate if none is given.

    Raises:
        ValueError: If there is no such thing, or it is not what it should be.
    """
    if isinstance(source, RunFolder):
        folder = RunFolder(source.path, source.config)
        return _of_known_condition(_from_run(folder, generation, rank), condition)
    if not isinstance(source, (str, PathLike)):
        raise ValueError(
            f"{shortened(source)} names no agent; give a run, its folder, a genotype file or a shipped name"
        )
    text, path = str(source), Path(source)
    if path.is_dir():
        return _of_known_condition(_from_run(RunFolder.open(path), generation, rank), condition)
    if generation is not None:
        raise ValueError(f"generation {generation} needs a run folder, which {text} is not")
    if path.is_file():
        return _from_file(path, rank, condition)
    if (SHIPPED / f"{text}.npz").is_file():
        return _from_file(SHIPPED / f"{text}.npz", rank, condition)
    names = ", ".join(sorted(each.stem for each in SHIPPED.glob("*.npz"))) or "none yet"
    raise ValueError(
        f"there is no {text!r}; give a run folder, a genotype file (.npz, .npy) "
        f"or a shipped champion ({names})"
    )


def _from_run(folder: RunFolder, generation: int | None, rank: int) -> Agent:
    """A champion of the run; or the genotype of some rank in a generation."""
    if generation is None and (folder.path / CHAMPIONS).exists():
        arrays = folder.read_arrays(folder.path / CHAMPIONS)
        return _pick(folder.path / CHAMPIONS, arrays, rank, folder.config, folder)
    if generation is None:
        generation = sum(len(each) for each in recorded_histories(folder)) - 1
    genotype = _of_generation(folder, generation, rank)
    return Agent(
        genotype,
        folder.config.condition,
        folder.config.readings,
        _describe(folder.config, generation, rank),
        f"generation-{generation:06d}-rank-{rank}",
        folder,
    )


def _of_generation(folder: RunFolder, generation: int, rank: int) -> NDArray[np.float64]:
    """The genotype [G] of some rank; beyond the five best that are kept, it is bred again."""
    scored = recorded_generation(folder, generation)
    n_genotypes = scored.fitness.shape[1]
    if not 0 <= rank < n_genotypes:
        raise ValueError(f"rank {rank} does not exist; the generation has ranks 0 to {n_genotypes - 1}")
    if rank < N_BEST:
        return scored.best_genotypes[0, rank]
    order = ranking(scored.fitness[0], folder.config.readings)
    return population_at(folder, generation).genotypes[order[rank]]


def _from_file(path: Path, rank: int, condition: AnyTask | None) -> Agent:
    """A genotype of a file, with the config it carries or, if it carries none, the default readings."""
    arrays = read_genotype_file(path)
    if "config" not in arrays:
        config = RunConfig(condition or Condition.WITH_INDICATE)
        return _pick(path, arrays, rank, config, None)
    try:
        config = RunConfig.from_toml(str(arrays["config"]))
    except ValueError as error:
        raise ValueError(f"{path} carries a config that cannot be read: {error}") from None
    return _of_known_condition(_pick(path, arrays, rank, config, None), condition)


def _pick(
    path: Path, arrays: Mapping[str, NDArray], rank: int, config: RunConfig, folder: RunFolder | None
) -> Agent:
    """One of the genotypes of a file, which must be of the size that its config tells, if it has one."""
    name = next((each for each in ("genotypes", "genotype") if each in arrays), None)
    if name is None:
        raise ValueError(f"{path} has no array genotypes; it has {', '.join(arrays) or 'none'}")
    try:
        told = folder is not None or "config" in arrays
        genotypes = check_genotypes(arrays[name], config.settings.inter_neurons if told else None)
    except (ValueError, TypeError) as error:
        raise ValueError(f"{path}: {error}") from None
    if not 0 <= rank < len(genotypes):
        raise ValueError(f"rank {rank} does not exist in {path}; there are {len(genotypes)}, numbered from 0")
    origin = f"{path.name}, number {rank}"
    if "config" in arrays and all(_numbers_each(arrays.get(each), genotypes) for each in PROVENANCE):
        origin = _describe(config, *(int(arrays[each][rank]) for each in PROVENANCE))
    name = ("champion" if folder else path.stem) + (f"-{rank}" if rank else "")
    return Agent(genotypes[rank], config.condition, config.readings, origin, name, folder)


def _numbers_each(array: NDArray | None, genotypes: NDArray) -> bool:
    """Whether an array has a whole number for each genotype."""
    return array is not None and array.shape == (len(genotypes),) and array.dtype.kind in "iu"


def _describe(config: RunConfig, generation: int, rank: int) -> str:
    """Where a genotype stood in its run."""
    return f"{config.condition}, seed {config.seed}, generation {generation}, rank {rank}"


def _of_known_condition(agent: Agent, condition: AnyTask | None) -> Agent:
    """Refuse another condition than the agent's own."""
    if condition not in (None, agent.condition):
        raise ValueError(
            f"{agent.origin} belongs to {agent.condition}, not {condition}; leave --condition out"
        )
    return agent
