"""Behaviour by class, with the run as the unit: agents of one run are relatives and are averaged first.

Axes: R runs that have agents of the class, 9 instructions, W windows, E events, B time bins.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm2d import NON_EXPERIENCED, Condition
from arm2d.records import alike, brief
from evolution.agents.classes import CLASSES, PARTS, Observation
from evolution.agents.lesions import LESIONS
from evolution.agents.subtasks import AgentClass
from evolution.agents.variance import WINDOWS
from evolution.runs.folder import RunFolder

INTACT = "intact"


@dataclass(frozen=True)
class ClassBehaviour:
    """What the agents of one class do, run by run.

    Attributes:
        kind: The class.
        condition: Names the instructions.
        seeds: [R].
        members: [R], agents of the class,
        agents: [R], observed ones.
        intact: [R, 9], mean success.
        lesioned: [R, 8, 9], with each lesion.
        windows: [R, W, 4], mean shares of variance; NaN where no agent comes to the event often enough.
        shares: [R, E, 4, B], likewise over time.
        representative: (run, generation, rank) of the observed agent whose success is nearest to the mean of
            the class; None if there is none.
    """

    kind: AgentClass
    condition: Condition
    seeds: NDArray[np.int64]
    members: NDArray[np.int64]
    agents: NDArray[np.int64]
    intact: NDArray[np.float64]
    lesioned: NDArray[np.float64]
    windows: NDArray[np.float64]
    shares: NDArray[np.float64]
    representative: tuple[RunFolder, int, int] | None

    __repr__ = brief
    __eq__ = alike

    @property
    def known(self) -> NDArray[np.bool_]:
        """[9], which instructions were met during evolution."""
        return np.array([word not in NON_EXPERIENCED for word in self.condition.instructions])

    def success(self, *, known: bool) -> NDArray[np.float64]:
        """Mean success of the experienced (or the never-met) instructions, intact and lesioned, [R, 9]."""
        own = self.known == known
        intact = self.intact[:, own].mean(axis=1, keepdims=True)
        return np.concatenate([intact, self.lesioned[..., own].mean(axis=-1)], axis=1)


def class_behaviours(
    condition: Condition, observed: Sequence[tuple[RunFolder, Observation]]
) -> dict[AgentClass, ClassBehaviour]:
    """Each class of a condition, from what was observed in its runs."""
    return {kind: _class_behaviour(condition, kind, observed) for kind in CLASSES}


def measures() -> dict[str, Callable[[ClassBehaviour], NDArray[np.float64]]]:
    """Everything that is measured: one value per run of a class [R], NaN where a run has none."""

    def share(window: int, part: int) -> Callable[[ClassBehaviour], NDArray[np.float64]]:
        return lambda behaviour: behaviour.windows[:, window, part]

    def success(known: bool, column: int) -> Callable[[ClassBehaviour], NDArray[np.float64]]:
        return lambda behaviour: behaviour.success(known=known)[:, column]

    shares = {
        f"share of variance, {part}, {window}": share(w, p)
        for w, window in enumerate(WINDOWS)
        for p, part in enumerate(PARTS)
    }
    names = [INTACT, *(f"{lesion.word} word {lesion.manner} {lesion.time}" for lesion in LESIONS)]
    successes = {
        f"success, {of_what}, {name}": success(known, column)
        for known, of_what in ((True, "experienced"), (False, "never met"))
        for column, name in enumerate(names)
    }
    return {**shares, **successes}


def _class_behaviour(
    condition: Condition, kind: AgentClass, observed: Sequence[tuple[RunFolder, Observation]]
) -> ClassBehaviour:
    index = CLASSES.index(kind)
    own = [(run, o, o.classes == index) for run, o in observed if (o.classes == index).any()]

    def mean_of(name: str, shape: tuple[int, ...]) -> NDArray[np.float64]:
        means = [_nanmean(getattr(o, name)[which]) for _, o, which in own]
        return np.array(means).reshape(len(own), *shape)

    example = observed[0][1] if observed else None
    shapes = {
        name: getattr(example, name).shape[1:] if example else (0,)
        for name in ("intact", "lesioned", "windows", "shares")
    }
    intact = mean_of("intact", shapes["intact"])
    return ClassBehaviour(
        kind=kind,
        condition=condition,
        seeds=np.array([run.config.seed for run, _, _ in own], np.int64),
        members=np.array([o.members[index] for _, o, _ in own], np.int64),
        agents=np.array([which.sum() for _, _, which in own], np.int64),
        intact=intact,
        lesioned=mean_of("lesioned", shapes["lesioned"]),
        windows=mean_of("windows", shapes["windows"]),
        shares=mean_of("shares", shapes["shares"]),
        representative=_representative(own, intact.mean(axis=0)) if own else None,
    )


def _representative(
    own: Sequence[tuple[RunFolder, Observation, NDArray[np.bool_]]], mean: NDArray[np.float64]
) -> tuple[RunFolder, int, int]:
    """The observed agent whose success is nearest to the mean; the earliest of equals."""
    agents = [
        (float(np.abs(o.intact[i] - mean).sum()), n, int(i))
        for n, (_, o, which) in enumerate(own)
        for i in np.flatnonzero(which)
    ]
    _, n, i = min(agents)
    run, observation, _ = own[n]
    return run, int(observation.generations[i]), int(observation.ranks[i])


def _nanmean(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Mean over the first axis of what is there; NaN where nothing is."""
    there = np.isfinite(values)
    n = there.sum(axis=0)
    total = np.where(there, values, 0.0).sum(axis=0)
    return np.divide(total, n, out=np.full(total.shape, np.nan), where=n > 0)
