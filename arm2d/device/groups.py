"""Many populations with trials of their own in one batch, such as a generation of a hundred runs.

Axes: G groups, P genotypes of a group, T trials that each genotype of a group meets: the same for all of
them, or its own. Groups do not influence one another, so a batch can be cut anywhere: where memory does not
suffice it is halved, and the size that fitted is kept for the next one.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Final, NamedTuple

import numpy as np
import warp as wp
from numpy.typing import NDArray

from arm2d.constants import MAX_STEPS
from arm2d.controller import decode_flat
from arm2d.device import loop
from arm2d.device.drives import BEND_ROW
from arm2d.device.errors import DeviceLostError, DeviceMemoryError, DeviceTaskError
from arm2d.device.memory import fetched, launched, placed, room
from arm2d.device.opening import Device
from arm2d.device.world import worlds_on
from arm2d.kernel.exchange import TrialArrays
from arm2d.kernel.world import WORD_CODES
from arm2d.readings import Readings
from arm2d.running import arrays_of
from arm2d.trials import Trials, TrialScores

# Trials in one launch, [G P T]; more gain nothing.
MOST_TRIALS: Final = 2**22


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


class _Shape(NamedTuple):
    """The size of every group of a batch."""

    n_genotypes: int  # P
    n_trials: int  # T
    each_own: bool


class Laboratory:
    """A device with what is kept on it from batch to batch.

    Attributes:
        device: The device.
        most_groups: Groups at once that fitted into its memory.
    """

    def __init__(self, device: Device) -> None:
        self.device = device
        self.most_groups = 2**31
        self._codes = placed(WORD_CODES.astype(np.int32), wp.int32, device)
        self._worlds: dict[tuple[Readings, ...], tuple[Any, Any]] = {}

    def fitness(self, groups: Sequence[Group]) -> NDArray[np.float64]:
        """Mean F1 + F2 + F3 of every genotype over its trials, [G, P].

        Raises:
            ValueError: If the groups are not of one size, or a genotype is unsound.
            DeviceMemoryError: If the device has too little memory for a single group.
            DeviceLostError: If it does not answer.
        """
        return np.concatenate(self._in_parts(groups, _shape(groups), self._mean_fitness))

    def success(self, groups: Sequence[Group]) -> NDArray[np.bool_]:
        """Whether each trial was carried out, [G, P, T]; raises as `fitness`."""
        return np.concatenate(self._in_parts(groups, _shape(groups), self._success))

    def run_trials(self, genotypes: NDArray[np.float64], trials: Trials, readings: Readings) -> TrialScores:
        """As `arm2d.run_trials`: scores with arrays [P, T]; raises as `fitness`."""
        groups = [Group(genotypes[part], trials, readings) for part in _parts_of(len(genotypes), len(trials))]
        parts = [self._in_parts([group], _shape([group]), self._scores)[0] for group in groups]
        return TrialScores(*(np.concatenate(arrays) for arrays in zip(*parts, strict=True)))

    def _in_parts(
        self, groups: Sequence[Group], shape: _Shape, compute: Callable[[Sequence[Group]], Any]
    ) -> list[Any]:
        """What `compute` gives for as many groups at a time as there is memory for."""
        parts, done = [], 0
        while done < len(groups):
            at_once = max(1, min(self.most_groups, MOST_TRIALS // (shape.n_genotypes * shape.n_trials)))
            part = groups[done : done + at_once]
            try:
                parts.append(compute(part))
                done += len(part)
            except DeviceMemoryError:
                if len(part) == 1:
                    raise
                self.most_groups = len(part) // 2
        return parts

    def _mean_fitness(self, groups: Sequence[Group]) -> NDArray[np.float64]:
        """[G, P]."""
        shape, outcomes = _shape(groups), self._run(groups)
        fitness = room(len(groups) * shape.n_genotypes, wp.float64, self.device)
        launched(loop.mean_fitness, fitness.shape[0], [outcomes, shape.n_trials, fitness], self.device)
        return fetched(fitness, self.device).reshape(len(groups), shape.n_genotypes)

    def _success(self, groups: Sequence[Group]) -> NDArray[np.bool_]:
        """[G, P, T]."""
        outcomes, shape = self._run(groups), (len(groups), *_shape(groups)[:2])
        return fetched(outcomes.success, self.device).reshape(shape).astype(np.bool_)

    def _scores(self, groups: Sequence[Group]) -> list[NDArray]:
        """F1, F2, F3, success and steps of one group, each [P, T]."""
        outcomes, shape = self._run(groups), _shape(groups)[:2]
        arrays = [outcomes.f1, outcomes.f2, outcomes.f3, outcomes.success, outcomes.steps]
        f1, f2, f3, success, steps = (fetched(each, self.device).reshape(shape) for each in arrays)
        return [f1, f2, f3, success.astype(np.bool_), steps.astype(np.int64)]

    def _run(self, groups: Sequence[Group]) -> Any:
        """What becomes of every trial, still on the device."""
        device, shape = self.device, _shape(groups)
        for group in groups:
            if group.trials.task is not None:
                raise DeviceTaskError(group.trials.task)
        worlds = tuple(dict.fromkeys(group.readings for group in groups))
        rows = np.array([worlds.index(group.readings) for group in groups], np.int32)
        # Whoever has trials of its own is, on the device, a group of one.
        n_networks = 1 if shape.each_own else shape.n_genotypes
        rows = np.repeat(rows, shape.n_genotypes // n_networks)
        tables, betas = self._tables(worlds)
        networks = np.concatenate([decode_flat(group.genotypes, group.readings) for group in groups])
        trials = _trials_on(device, [arrays_of(group.trials) for group in groups])
        outcomes = _room_for_outcomes(device, len(networks) * shape.n_trials)
        placed_networks = placed(networks, wp.float64, device)
        placed_rows = placed(rows, wp.int32, device)
        drives = room((len(networks), BEND_ROW.value + betas.shape[1]), wp.vec3d, device)
        launched(
            loop.tabulate_drives,
            drives.shape,
            [placed_networks, placed_rows, n_networks, betas, self._codes, drives],
            device,
        )
        launched(
            loop.run_trials,
            len(networks) * shape.n_trials,
            [placed_networks, placed_rows, n_networks, shape.n_trials, tables, drives, trials, outcomes],
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


def _shape(groups: Sequence[Group]) -> _Shape:
    """The size of all groups; raises ValueError if they differ."""
    shapes = {_shape_of(group) for group in groups}
    if len(shapes) != 1:
        found = ", ".join(f"{p} x {t}" for p, t, _ in sorted(shapes)) or "no groups"
        raise ValueError(f"a batch takes groups of one size, genotypes x trials; these are {found}")
    return shapes.pop()


def _shape_of(group: Group) -> _Shape:
    """The size of a group."""
    n, n_trials = len(group.genotypes), len(group.trials)
    if group.each_own and n_trials % n:
        raise ValueError(f"{n} genotypes cannot have as many trials of their own each of {n_trials}")
    return _Shape(n, n_trials // n if group.each_own else n_trials, group.each_own)


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
