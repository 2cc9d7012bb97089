"""Run trials with genotypes: from records to the compiled kernel and back.

Axes: P genotypes of G genes each (a network of three inter-neurons has 84), T trials, K steps.
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise
from reprlib import repr as shortened

import numpy as np
from numpy.typing import ArrayLike, NDArray

from arm2d import constants as c
from arm2d.arithmetic import bearing
from arm2d.compiling import compiled
from arm2d.kernel import exchange
from arm2d.kernel.loop import run_population
from arm2d.kernel.network import Inter
from arm2d.kernel.world import WORD_CODES, tables_of, world_of
from arm2d.network.controller import check_genotypes, decode_flat, n_inter_of
from arm2d.readings import Readings, given_or_default
from arm2d.tasks.hearing import phase_after, phases, word_bits
from arm2d.trials import TrialRecord, Trials, TrialScores

NO_RECORDING = np.empty((0, exchange.RECORD_STATE))


def run_trials(
    genotypes: ArrayLike,
    trials: Trials,
    readings: Readings | None = None,
    *,
    each_own: bool = False,
    threads: int = 1,
    word_codes: ArrayLike | None = None,
) -> TrialScores:
    """Run every trial with every genotype, or each genotype's own trials with it.

    Args:
        genotypes: [P, G], genes in [0, 1]; a single one [G] is a batch of one. The kernel is compiled
            for each size of network when it is first asked for.
        trials: T trials, the same for all genotypes; or P T, those of one genotype after those of another.
        readings: The world; the default readings if none are given.
        each_own: Whether each genotype has trials of its own.
        threads: Genotypes are shared out among so many threads. The results do not depend on it.
        word_codes: [7, 3] of 0 and 1, how three object words, then four action words are heard; by default
            as the trials' task, or else spec section 4, has them. A lesion experiment changes a row.

    Returns:
        Scores with arrays [P, T].

    Raises:
        ValueError: If a genotype has another shape, a gene is not a number in [0, 1], the trials cannot be
            shared out among the genotypes, or the words' codes are others than 0 and 1.
    """
    readings = given_or_default(readings)
    if threads < 1:
        raise ValueError(f"asked for {threads} threads; there must be at least 1")
    genes = check_genotypes(genotypes)
    n_trials = own_trials_of_each(len(genes), len(trials)) if each_own else len(trials)
    networks, arrays = decode_flat(genes, readings), arrays_of(trials)
    codes = codes_of(trials) if word_codes is None else _checked_codes(word_codes)
    world, tables = world_of(readings), tables_of(readings)._replace(codes=codes)
    outcomes, inter = empty_outcomes(len(genes), n_trials), _inter_of(genes)

    def run(part: slice) -> None:
        """Let some genotypes meet all trials."""
        rows = exchange.Outcomes._make(each[part] for each in outcomes)
        run_population(networks[part], arrays, world, tables, rows, 0, NO_RECORDING, inter)

    def run_own(part: slice) -> None:
        """Let some genotypes meet their own trials."""
        own = arrays._make(each[n_trials * part.start : n_trials * part.stop] for each in arrays)
        row = exchange.Outcomes._make(each[part].reshape(1, -1) for each in outcomes)
        run_population(networks[part], own, world, tables, row, n_trials, NO_RECORDING, inter)

    parts, run = _parts(len(genes), threads), run_own if each_own else run
    if len(parts) == 1:
        run(parts[0])
    else:
        with ThreadPoolExecutor(len(parts)) as pool:
            list(pool.map(run, parts))
    return TrialScores(*outcomes)


def own_trials_of_each(n_genotypes: int, n_trials: int) -> int:
    """How many trials of its own each genotype has; raises ValueError if they cannot be shared out."""
    if n_trials % n_genotypes:
        raise ValueError(
            f"{n_genotypes} genotypes cannot have as many trials of their own each of {n_trials}"
        )
    return n_trials // n_genotypes


def record_trial(genotype: ArrayLike, trial: Trials, readings: Readings | None = None) -> TrialRecord:
    """Run one trial with one genotype and keep every step.

    Args:
        genotype: [G].
        trial: A batch of one, such as `trials[0]`.
        readings: The world; the default readings if none are given.

    Raises:
        ValueError: If there is more than one trial or genotype, or the genotype is unsound.
    """
    readings = given_or_default(readings)
    genes = check_genotypes(genotype)
    if len(trial) != 1 or len(genes) != 1:
        raise ValueError(
            f"a recording takes one genotype and one trial, not {len(genes)} and {len(trial)}; "
            "take one by its index, such as genotypes[0] and trials[0]"
        )
    outcomes, inter = empty_outcomes(1, 1), _inter_of(genes)
    rows = np.empty((c.MAX_STEPS, exchange.RECORD_STATE + len(inter)))
    networks = decode_flat(genes, readings)
    world, tables = world_of(readings), tables_of(readings)._replace(codes=codes_of(trial))
    run_population(networks, arrays_of(trial), world, tables, outcomes, 0, rows, inter)
    scores = TrialScores(*outcomes)
    rows = rows[: scores.steps[0, 0]]
    return record_of(trial, readings, rows, _inputs_of(trial, rows), scores)


def _inter_of(genotypes: NDArray[np.float64]) -> Inter:
    """The size of the networks of checked genotypes [P, G], as the kernel takes it."""
    return (0.0,) * n_inter_of(genotypes)


def codes_of(trials: Trials) -> NDArray[np.int64]:
    """How the words of these trials are heard, [7, 3]."""
    return WORD_CODES if trials.task is None else np.array(trials.task.word_codes)


def _checked_codes(word_codes: ArrayLike) -> NDArray[np.int64]:
    """The codes of words [7, 3] as the kernel takes them: it reads them without asking where they end."""
    codes = np.asarray(word_codes, dtype=object)  # rows of unequal length as well
    right = "word_codes must be [7, 3] of 0 and 1, for three object words, then four action words"
    if codes.shape != WORD_CODES.shape:
        raise ValueError(f"{right}; these are {list(codes.shape)}")
    if len(wrong := codes[~np.isin(codes, (0, 1))]):
        raise ValueError(f"{right}; one is {shortened(wrong[0])}")
    return np.array(codes, dtype=np.int64, order="C")


def arrays_of(trials: Trials) -> exchange.TrialArrays:
    """The trials as the kernel takes them: discs by bearing and distance, and the words heard."""
    x, y = trials.discs[..., 0], trials.discs[..., 1]
    heard = np.stack([trials.actions, trials.objects], axis=-1)
    words, delays = np.stack([heard, heard], axis=1), np.full(len(trials), exchange.NO_CHANGE)
    if (changes := trials.changes) is not None:
        first = np.stack([changes.first_actions, changes.first_objects], axis=-1)
        later = np.stack([changes.later_actions, changes.later_objects], axis=-1)
        # Copied, for Numba compiles all anew for an array that cannot be written to.
        words, delays = np.stack([first, later], axis=1), changes.delays.copy()
    word_steps = np.zeros(len(trials), np.int64)
    if trials.task is not None and trials.task.in_sequence:
        words = phases(trials.actions, trials.objects, trials.task)
        word_steps[:] = trials.task.word_steps
    return exchange.TrialArrays(
        action=trials.actions,
        object=trials.objects,
        alpha=trials.alpha,
        bearing=_bearings_of(trials.discs),
        distance=np.sqrt(x * x + y * y),
        heard=words,
        delay=delays,
        word_steps=word_steps,
    )


@compiled
def _bearings_of(centres: NDArray) -> NDArray:
    """Bearings [T, 3] of the discs' centres [T, 3, 2]."""
    bearings = np.empty(centres.shape[:2])
    for trial in range(centres.shape[0]):
        for disc in range(centres.shape[1]):
            bearings[trial, disc] = bearing(centres[trial, disc, 0], centres[trial, disc, 1])
    return bearings


def empty_outcomes(n_genotypes: int, n_trials: int) -> exchange.Outcomes:
    """Room for what becomes of P genotypes in T trials."""
    shape = (n_genotypes, n_trials)
    return exchange.Outcomes(
        f1=np.empty(shape),
        f2=np.empty(shape),
        f3=np.empty(shape),
        success=np.empty(shape, np.bool_),
        steps=np.empty(shape, np.int64),
    )


def _parts(n: int, threads: int) -> list[slice]:
    """Share out n genotypes in runs of nearly equal length."""
    bounds = np.linspace(0, n, min(threads, max(n, 1)) + 1).astype(int)
    return [slice(first, last) for first, last in pairwise(bounds)]


def record_of(
    trial: Trials, readings: Readings, rows: NDArray, inputs: NDArray, scores: TrialScores
) -> TrialRecord:
    """A record from the kernel's rows [K, RECORD_STATE + N] and what was sensed [K, 18]."""
    beta = np.concatenate([[c.BETA_MAX], rows[:, exchange.RECORD_BETA]])
    sides = rows[:, exchange.RECORD_SIDE : exchange.RECORD_SIDE + 3].astype(np.int8)
    return TrialRecord(
        instruction=trial.instructions[0],
        readings=readings,
        alpha=np.concatenate([trial.alpha, rows[:, exchange.RECORD_ALPHA]]),
        beta=beta,
        discs=np.concatenate([trial.discs, _centres_of(trial, rows)]),
        contact=np.concatenate([np.zeros((1, c.N_OBJECTS), np.int8), sides]),
        inputs=inputs,
        states=rows[:, exchange.RECORD_STATE :].copy(),
        turns=np.stack([rows[:, exchange.RECORD_TURN], np.diff(beta)], axis=-1),
        scores=scores,
        task=trial.task,
    )


def _centres_of(trial: Trials, rows: NDArray) -> NDArray[np.float64]:
    """The discs' centres after every step, [K, 3, 2]; a disc that never moved keeps its bits."""
    start = arrays_of(trial)
    bearings = rows[:, exchange.RECORD_BEARING : exchange.RECORD_BEARING + 3]
    distances = rows[:, exchange.RECORD_DISTANCE : exchange.RECORD_DISTANCE + 3]
    angles = np.radians(bearings)
    centres = np.stack([distances * np.cos(angles), distances * np.sin(angles)], axis=-1)
    unmoved = (bearings == start.bearing) & (distances == start.distance)
    return np.where(unmoved[..., np.newaxis], trial.discs, centres)


def _inputs_of(trial: Trials, rows: NDArray) -> NDArray[np.float64]:
    """I1 to I18 of every step, [K, 18], as spec section 4 numbers them."""
    touch = np.concatenate([[0], rows[:-1, exchange.RECORD_TOUCH].astype(int)])
    camera = rows[:, exchange.RECORD_CAMERA].astype(int)
    beta_before = np.concatenate([[c.BETA_MAX], rows[:-1, exchange.RECORD_BETA]])
    which = rows[:, exchange.RECORD_CHANGED].astype(int)
    if trial.task is not None:
        which = which + phase_after(np.arange(len(rows)), trial.task)
    heard = arrays_of(trial).heard[0][which]  # [K, 2]
    return np.concatenate(
        [
            touch[:, np.newaxis] >> np.arange(2) & 1,
            camera[:, np.newaxis] >> np.arange(9) & 1,
            beta_before[:, np.newaxis] / c.BETA_MAX,
            word_bits(heard[:, 0], heard[:, 1], codes_of(trial)),
        ],
        axis=1,
        dtype=np.float64,
    )
