"""Many populations with trials of their own in one batch, such as a generation of a hundred runs.

Axes: P genotypes of a group, T trials that each of them carries out: the same for all, or its own. Groups
do not influence one another, so a batch can be cut between any two: where memory does not suffice it is
halved, and the size that fitted is kept for the next one.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Final, NamedTuple, TypeVar

import numpy as np
import warp as wp
from numpy.typing import NDArray

from arm2d.constants import MAX_STEPS, N_INTER
from arm2d.device import loop
from arm2d.device.drives import BEND_ROW
from arm2d.device.errors import DeviceLostError, DeviceMemoryError, DeviceSizeError, DeviceTaskError
from arm2d.device.memory import fetched, launched, placed, room
from arm2d.device.opening import Device
from arm2d.device.world import worlds_on
from arm2d.kernel.exchange import TrialArrays
from arm2d.kernel.world import WORD_CODES
from arm2d.network.controller import check_genotypes, decode_flat, n_inter_of
from arm2d.readings import Readings
from arm2d.running import arrays_of, own_trials_of_each
from arm2d.trials import Trials, TrialScores

# Trials in one launch; more gain nothing.
MOST_TRIALS: Final = 2**22

T = TypeVar("T")


class Group(NamedTuple):
    """Genotypes and the trials that each of them meets, in one world.

    Attributes:
        genotypes: [P, 84].
        trials: [T]; or [P T], genotype after genotype, if each has its own.
        readings: The world.
        each_own: Whether each genotype has trials of its own.
    """

    genotypes: NDArray[np.float64]
    trials: Trials
    readings: Readings
    each_own: bool = False

    @property
    def n_trials(self) -> int:
        """T; raises ValueError if the trials cannot be shared out among the genotypes."""
        n_trials = len(self.trials)
        return own_trials_of_each(len(self.genotypes), n_trials) if self.each_own else n_trials

    @property
    def size(self) -> int:
        """Trials that are carried out, P T."""
        return len(self.genotypes) * self.n_trials


class Laboratory:
    """A device with what is kept on it from batch to batch.

    Attributes:
        device: The device.
        most_trials: As many at once fitted into its memory.
    """

    def __init__(self, device: Device) -> None:
        self.device = device
        self.most_trials = MOST_TRIALS
        self._codes = placed(WORD_CODES.astype(np.int32), wp.int32, device)
        self._worlds: dict[tuple[Readings, ...], tuple[Any, Any]] = {}

    def fitness(self, groups: Sequence[Group]) -> list[NDArray[np.float64]]:
        """Mean F1 + F2 + F3 of every genotype over its trials, [P] for each group.

        Raises:
            ValueError: If the groups have not as many trials for a genotype each, or a genotype is unsound.
            DeviceMemoryError: If the device has too little memory for a single group.
            DeviceLostError: If it does not answer.
        """
        return self._in_parts(groups, self._mean_fitness)

    def success(self, groups: Sequence[Group]) -> list[NDArray[np.bool_]]:
        """Whether each trial was carried out, [P, T] for each group; raises as `fitness`."""
        return self._in_parts(groups, self._success)

    def run_trials(self, genotypes: NDArray[np.float64], trials: Trials, readings: Readings) -> TrialScores:
        """As `arm2d.run_trials`: scores with arrays [P, T]; raises as `fitness`."""
        groups = [Group(genotypes[part], trials, readings) for part in _parts_of(len(genotypes), len(trials))]
        parts = [self._in_parts([group], self._scores)[0] for group in groups]
        return TrialScores(*(np.concatenate(arrays) for arrays in zip(*parts, strict=True)))

    def _in_parts(
        self, groups: Sequence[Group], compute: Callable[[Sequence[Group]], Sequence[T]]
    ) -> list[T]:
        """What `compute` gives for as many groups at a time as there is memory for."""
        found, done = [], 0
        while done < len(groups):
            sizes = np.cumsum([group.size for group in groups[done:]])
            part = groups[done : done + max(1, int((sizes <= self.most_trials).sum()))]
            try:
                found.extend(compute(part))
                done += len(part)
            except DeviceMemoryError:
                if len(part) == 1:
                    raise
                self.most_trials = int(sizes[len(part) - 1]) // 2
        return found

    def _mean_fitness(self, groups: Sequence[Group]) -> list[NDArray[np.float64]]:
        """[P] of each group."""
        outcomes, n_networks = self._run(groups), sum(len(group.genotypes) for group in groups)
        fitness = room(n_networks, wp.float64, self.device)
        launched(loop.mean_fitness, n_networks, [outcomes, groups[0].n_trials, fitness], self.device)
        return _by_group(fetched(fitness, self.device), groups)

    def _success(self, groups: Sequence[Group]) -> list[NDArray[np.bool_]]:
        """[P, T] of each group."""
        success = fetched(self._run(groups).success, self.device).astype(np.bool_)
        return _by_group(success.reshape(-1, groups[0].n_trials), groups)

    def _scores(self, groups: Sequence[Group]) -> list[list[NDArray]]:
        """F1, F2, F3, success and steps of one group, each [P, T]."""
        outcomes, shape = self._run(groups), (-1, groups[0].n_trials)
        arrays = [outcomes.f1, outcomes.f2, outcomes.f3, outcomes.success, outcomes.steps]
        f1, f2, f3, success, steps = (fetched(each, self.device).reshape(shape) for each in arrays)
        return [[f1, f2, f3, success.astype(np.bool_), steps.astype(np.int64)]]

    def _run(self, groups: Sequence[Group]) -> Any:
        """What becomes of every trial, still on the device."""
        device, n_trials = self.device, _trials_of_each(groups)
        for group in groups:
            if group.trials.task is not None:
                raise DeviceTaskError(group.trials.task)
            if (n_inter := n_inter_of(check_genotypes(group.genotypes))) != N_INTER:
                raise DeviceSizeError(n_inter)
        n_networks = [len(group.genotypes) for group in groups]
        rows = {world: row for row, world in enumerate(dict.fromkeys(group.readings for group in groups))}
        tables, betas = self._tables(tuple(rows))
        networks = np.concatenate([decode_flat(group.genotypes, group.readings) for group in groups])
        trials = _trials_on(device, [arrays_of(group.trials) for group in groups])
        outcomes = _room_for_outcomes(device, len(networks) * n_trials)
        placed_networks = placed(networks, wp.float64, device)
        worlds = np.repeat([rows[group.readings] for group in groups], n_networks).astype(np.int32)
        placed_worlds = placed(worlds, wp.int32, device)
        placed_first = placed(_first_trials(groups), wp.int32, device)
        drives = room((len(networks), BEND_ROW.value + betas.shape[1]), wp.vec3d, device)
        launched(
            loop.tabulate_drives,
            drives.shape,
            [placed_networks, placed_worlds, betas, self._codes, drives],
            device,
        )
        launched(
            loop.run_trials,
            len(networks) * n_trials,
            [placed_networks, placed_worlds, placed_first, n_trials, tables, drives, trials, outcomes],
            device,
        )
        self._check_ended(outcomes)
        return outcomes

    def _tables(self, worlds: tuple[Readings, ...]) -> tuple[Any, Any]:
        """Tables of these worlds and their values of beta, kept on the device."""
        if worlds not in self._worlds:
            self._worlds = {worlds: worlds_on(self.device, worlds)}
        return self._worlds[worlds]

    def _check_ended(self, outcomes: Any) -> None:
        """Refuse scores of trials that never ran: a device in trouble may answer with zeros."""
        n, ended = outcomes.steps.shape[0], room(1, wp.int32, self.device)
        launched(loop.count_ended, n, [outcomes, ended], self.device)
        if (found := int(fetched(ended, self.device)[0])) != n:
            said = f"{n - found} of {n} trials did not end within {MAX_STEPS} steps"
            raise DeviceLostError(self.device.name, said)


def _trials_of_each(groups: Sequence[Group]) -> int:
    """T of all groups; raises ValueError if they differ."""
    found = {group.n_trials for group in groups}
    if len(found) != 1:
        said = " and ".join(map(str, sorted(found))) or "no groups"
        raise ValueError(f"all genotypes of a batch carry out as many trials each; these are {said}")
    return found.pop()


def _first_trials(groups: Sequence[Group]) -> NDArray[np.int32]:
    """The first of each network's trials, when those of all groups stand in a row, [N]."""
    starts = np.cumsum([0, *(len(group.trials) for group in groups)])
    firsts = [
        start + group.n_trials * np.arange(len(group.genotypes)) * group.each_own
        for start, group in zip(starts, groups, strict=False)
    ]
    return np.concatenate(firsts).astype(np.int32)


def _by_group(values: NDArray, groups: Sequence[Group]) -> list[NDArray]:
    """What is known of all networks in a row, group by group."""
    return np.split(values, np.cumsum([len(group.genotypes) for group in groups])[:-1])


def _parts_of(n_genotypes: int, n_trials: int) -> list[slice]:
    """Share out the genotypes of a large group, for a group is never cut."""
    size = max(1, MOST_TRIALS // max(n_trials, 1))
    return [slice(first, first + size) for first in range(0, n_genotypes, size)]


def _trials_on(device: Device, arrays: Sequence[TrialArrays]) -> Any:
    """The trials of all groups in a row."""

    def joined(name: str, dtype: Any, kind: Any) -> Any:
        values = np.concatenate([getattr(each, name) for each in arrays])
        return placed(values.astype(kind, copy=False), dtype, device)

    trials = loop.TrialArrays()
    trials.action = joined("action", wp.int32, np.int32)
    trials.object = joined("object", wp.int32, np.int32)
    trials.alpha = joined("alpha", wp.float64, np.float64)
    trials.bearing = joined("bearing", wp.vec3d, np.float64)
    trials.distance = joined("distance", wp.vec3d, np.float64)
    trials.heard = joined("heard", wp.vec2i, np.int32)
    trials.delay = joined("delay", wp.int32, np.int32)
    return trials


def _room_for_outcomes(device: Device, n: int) -> Any:
    """Room for what becomes of n trials."""
    outcomes = loop.Outcomes()
    for name in ("f1", "f2", "f3"):
        setattr(outcomes, name, room(n, wp.float64, device))
    outcomes.success = room(n, wp.bool, device)
    outcomes.steps = room(n, wp.int32, device)
    return outcomes
