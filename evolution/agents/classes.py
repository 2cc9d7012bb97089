"""What a sample of a run's compositional, partial and non-compositional agents does, kept beside the run.

`behaviour/classes-10-agents-10-trials-seed-0.npz` holds what was measured, agent by agent; a run that was
observed once is read. Axes: A agents of a run, 9 instructions, W windows, E events, B time bins.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d.records import alike, brief
from evolution.agents.behaviour import record_behaviour
from evolution.agents.lesions import LESIONS, lesion_scores
from evolution.agents.parts import late_history
from evolution.agents.postevaluation import N_INSTRUCTIONS, POST_EVALUATION
from evolution.agents.subtasks import AgentClass, classify
from evolution.agents.variance import WINDOWS, VarianceShares, bin_times, shares_by_event
from evolution.runs.folder import AnyRun, RunFolder
from evolution.runs.history import check_array, check_range
from evolution.runs.storage import DamagedFileError, make_folder
from evolution.search.settings import N_BEST

FOLDER: Final = "behaviour"
CLASSES: Final = tuple(AgentClass)
# The parts into which a neuron's variance is split, in the order of the arrays.
PARTS: Final = ("object", "action", "crossed", "rest")
N_EVENTS: Final = 3


@dataclass(frozen=True)
class Sampling:
    """How many agents are observed in how many trials.

    Attributes:
        agents: Of each class and run, at most.
        per_area: Trials of each instruction from each start area.
        trial_seed: Draws the trials, the same for all agents.
    """

    agents: int = 10
    per_area: int = 10
    trial_seed: int = 0

    def __post_init__(self) -> None:
        for name in ("agents", "per_area"):
            if getattr(self, name) < 1:
                what = name.replace("per_area", "trials per area")
                raise ValueError(f"asked for {getattr(self, name)} {what}; there must be at least 1")


@dataclass(frozen=True)
class Observation:
    """A run's observed agents.

    Attributes:
        generations: [A] and
        ranks: [A], which agents.
        classes: [A], index into `CLASSES`, by their post-evaluation.
        members: [3], how many agents of the run belong to each class.
        intact: [A, 9], share of successful trials, fresh ones.
        lesioned: [A, 8, 9], with each of `LESIONS`.
        windows: [A, W, 4], mean shares of variance by `PARTS` in `WINDOWS`; NaN with too few trials.
        shares: [A, E, 4, B], the same over time from each event.
    """

    generations: NDArray[np.int64]
    ranks: NDArray[np.int64]
    classes: NDArray[np.int64]
    members: NDArray[np.int64]
    intact: NDArray[np.float64]
    lesioned: NDArray[np.float64]
    windows: NDArray[np.float64]
    shares: NDArray[np.float64]

    __repr__ = brief
    __eq__ = alike


def observation_path(run: RunFolder, sampling: Sampling) -> Path:
    """Where the measurements are kept."""
    name = f"classes-{sampling.agents}-agents-{sampling.per_area}-trials-seed-{sampling.trial_seed}.npz"
    return run.path / FOLDER / name


def observe(run: AnyRun, sampling: Sampling = Sampling()) -> Observation:
    """Observe a post-evaluated run's classes, or read what was observed before.

    Args:
        run: The run, or the path of its folder.
        sampling: How many agents in how many trials.

    Raises:
        ValueError: If there is no such run, it is not post-evaluated, or it is of a task that is not the
            paper's.
        DamagedFileError: If a file is damaged.
    """
    run = RunFolder.open(run)
    condition = run.config.papers_condition
    if observation_path(run, sampling).exists():
        return read_observation(run, sampling)
    evaluation = POST_EVALUATION.read(run)
    by_class = classify(evaluation.agents, condition)
    members = np.stack([by_class[kind] for kind in CLASSES]).reshape(len(CLASSES), -1, N_BEST)
    nobody = np.empty((*members.shape[1:], run.config.settings.n_genes))
    genotypes = late_history(run).best_genotypes if members.any() else nobody
    chosen = _chosen(members, genotypes, sampling)
    kinds, rows, ranks = np.array(chosen, np.int64).reshape(-1, 3).T
    measured = [_measure(run, genotypes[row, rank], sampling) for _, row, rank in chosen]
    intact, lesioned, windows, shares = (_stacked(measured, i, shape) for i, shape in enumerate(_shapes()))
    observation = Observation(
        generations=evaluation.generations[rows].astype(np.int64),
        ranks=ranks,
        classes=kinds,
        members=members.sum(axis=(1, 2)),
        intact=intact,
        lesioned=lesioned,
        windows=windows,
        shares=shares,
    )
    make_folder(run.path / FOLDER)
    run.write_arrays(observation_path(run, sampling), vars(observation))
    return observation


def read_observation(run: RunFolder, sampling: Sampling = Sampling()) -> Observation:
    """What was observed before.

    Raises:
        ValueError: If nothing was.
        DamagedFileError: If the file is damaged.
    """
    path, next_move = observation_path(run, sampling), f"wordarm behaviour {run.path} --classes"
    if not path.exists():
        raise ValueError(f"{path} is missing; go on with: {next_move}")
    try:
        arrays = run.read_arrays(path)
        _check(path, arrays, run.config.settings.generations)
    except DamagedFileError as error:
        raise DamagedFileError(path, error.found, f"remove it and repeat: {next_move}") from None
    return Observation(*(arrays[field.name] for field in fields(Observation)))


def _check(path: Path, arrays: Mapping[str, NDArray], n_generations: int) -> None:
    """Refuse arrays that no observation of a run of so many generations gives."""
    n = len(arrays.get("ranks", ()))
    shapes = {"generations": (n,), "ranks": (n,), "classes": (n,), "members": (len(CLASSES),)}
    for name, shape in shapes.items():
        check_array(path, arrays, name, shape, np.dtype(np.int64))
    for name, shape in zip(("intact", "lesioned", "windows", "shares"), _shapes(), strict=True):
        check_array(path, arrays, name, (n, *shape), np.dtype(np.float64))
    highest = {"generations": n_generations - 1, "ranks": N_BEST - 1, "classes": len(CLASSES) - 1}
    for name, high in {**highest, "members": N_BEST * n_generations, "intact": 1, "lesioned": 1}.items():
        check_range(path, arrays, name, 0, high)


def choose(members: NDArray[np.bool_], genotypes: NDArray[np.float64], most: int) -> list[tuple[int, int]]:
    """(row, rank) of at most so many members, distinct genotypes spread evenly over the generations.

    Args:
        members: [L, 5].
        genotypes: [L, 5, G].
        most: How many.
    """
    rows, ranks = np.nonzero(members)
    if not len(rows):
        return []
    _, first = np.unique(genotypes[rows, ranks], axis=0, return_index=True)
    first = np.sort(first)
    picked = first[np.linspace(0, len(first) - 1, min(most, len(first))).round().astype(int)]
    return [(int(rows[i]), int(ranks[i])) for i in picked]


def _chosen(
    members: NDArray[np.bool_], genotypes: NDArray[np.float64], sampling: Sampling
) -> list[tuple[int, int, int]]:
    """(class, row, rank) of the agents to be observed; members are [3, L, 5]."""
    return [
        (kind, row, rank)
        for kind, own in enumerate(members)
        for row, rank in choose(own, genotypes, sampling.agents)
    ]


def _measure(run: RunFolder, genotype: NDArray[np.float64], sampling: Sampling) -> tuple[NDArray, ...]:
    """Intact and lesioned success, shares of variance in windows and over time, of one agent."""
    world = (genotype, run.config.papers_condition, run.config.readings)
    trials = {"per_area": sampling.per_area, "trial_seed": sampling.trial_seed}
    lesions = lesion_scores(*world, **trials)
    shares = shares_by_event(record_behaviour(*world, **trials))
    windows = np.array([_window(shares[event], start, stop) for event, start, stop in WINDOWS.values()])
    over_time = np.array([[getattr(each, part) for part in PARTS] for each in shares.values()])
    return lesions.intact[0], lesions.lesioned[0], windows, over_time


def _window(shares: VarianceShares, start: float, stop: float) -> list[float]:
    """Mean shares by `PARTS` between two times [s]."""
    explained = shares.mean(start, stop)
    return [*explained, 1.0 - sum(explained)]


def _shapes() -> tuple[tuple[int, ...], ...]:
    """Of what is measured of one agent."""
    return (
        (N_INSTRUCTIONS,),
        (len(LESIONS), N_INSTRUCTIONS),
        (len(WINDOWS), len(PARTS)),
        (N_EVENTS, len(PARTS), len(bin_times())),
    )


def _stacked(measured: list[tuple[NDArray, ...]], place: int, shape: tuple[int, ...]) -> NDArray[np.float64]:
    return np.array([each[place] for each in measured], np.float64).reshape(-1, *shape)
