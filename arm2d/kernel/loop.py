"""The trials of each genotype from first to last: lanes start, advance, end and are refilled."""

from typing import NamedTuple

import numpy as np

from arm2d.arithmetic import sigmoid
from arm2d.compiling import compiled
from arm2d.constants import N_INTER, N_OBJECTS
from arm2d.kernel import lanes as at
from arm2d.kernel.camera_at_end import look_from_end
from arm2d.kernel.contact import touch_discs
from arm2d.kernel.controller import (
    INTER_BIAS,
    N_CAMERA_CODES,
    Drives,
    gather_drives,
    sense_camera,
    tabulate_drives,
    think,
    turn,
)
from arm2d.kernel.exchange import NO_CHANGE, Outcomes, TrialArrays, record_step
from arm2d.kernel.lanes import BLOCK, N_FLOAT_FIELDS, N_INTEGER_FIELDS, N_LANES, ROW, Floats, Integers
from arm2d.kernel.lifetime import finish_lane, start_lane
from arm2d.kernel.scores import remember_stretch, score_step, target_in_view
from arm2d.kernel.world import N_BETA_KEYS, World, WorldTables


class Lanes(NamedTuple):
    """The flat arrays of arm2d.kernel.lanes."""

    s: Floats
    n: Integers
    d: Floats


@compiled(nogil=True)
def run_population(
    networks: Floats,
    trials: TrialArrays,
    world: World,
    tables: WorldTables,
    outcomes: Outcomes,
    recording: Floats,
) -> None:
    """Run all trials with every network, one network after the other.

    Args:
        networks: [P, 84] parameters in the order of the genes.
        trials: `TrialArrays` of T trials.
        world: `World` and
        tables: `WorldTables` of the readings.
        outcomes: `Outcomes` to be filled in.
        recording: [K, RECORD_COLUMNS] for a single trial of a single network, else [0, RECORD_COLUMNS].
    """
    lanes = Lanes(
        np.zeros(N_FLOAT_FIELDS * N_LANES),
        np.zeros(N_INTEGER_FIELDS * N_LANES, np.int64),
        np.zeros(ROW * N_LANES),
    )
    drives = Drives(
        np.zeros((4, ROW)),
        np.zeros((N_CAMERA_CODES, ROW)),
        np.zeros((N_BETA_KEYS, ROW)),
        np.zeros((5, N_OBJECTS + 1, ROW)),
    )
    for p in range(len(networks)):
        tabulate_drives(networks[p], tables.betas, tables.codes, drives)
        _run_network(p, networks[p], trials, world, tables, lanes, drives, outcomes, recording)


@compiled(allocates=False)
def _run_network(
    p: int,
    network: Floats,
    trials: TrialArrays,
    world: World,
    tables: WorldTables,
    lanes: Lanes,
    drives: Drives,
    outcomes: Outcomes,
    recording: Floats,
) -> None:
    """Run all trials with one network, N_LANES at a time."""
    s, n, d = lanes
    touch, camera, bend, words = drives
    n_trials, objects = len(trials.action), trials.object
    changing, in_sequence = _any_other(trials.delay, NO_CHANGE), _any_other(trials.word_steps, 0)
    active, waiting = 0, 0
    while active < N_LANES and waiting < n_trials:
        _start(lanes, active, waiting, network, trials, world, words)
        active, waiting = active + 1, waiting + 1
    steps = 0
    while active > 0:
        width = (active + BLOCK - 1) // BLOCK * BLOCK
        if not world.from_end:
            sense_camera(s, n, width, world.white_right, world.white_left)
        gather_drives(s, n, d, width, touch, camera, bend)
        think(s, width, network)
        if turn(s, n, width, network, world.turn) > 0:
            touch_discs(s, n, active, world, tables.beta_sines, objects)
        if steps < len(recording):
            record_step(s, n, recording[steps])
        if world.from_end:
            look_from_end(s, n, active, objects, world)
        if world.best_stretch:
            remember_stretch(s, n, active, world)
        if changing:
            _change_words(s, n, d, active, trials, world, words)
        if in_sequence:
            _say_next_word(n, d, active, trials, words)
        steps += 1
        if score_step(s, n, width, world.keep, world.from_end) == 0:
            continue
        i = 0
        while i < active:
            if n[at.DONE + i] == 0:
                i += 1
                continue
            finish_lane(s, n, i, p, trials.action, world, outcomes)
            if waiting < n_trials:
                _start(lanes, i, waiting, network, trials, world, words)
                waiting += 1
            else:
                active -= 1
                _copy_lane(lanes, active, i)


@compiled(allocates=False)
def _any_other(values: Integers, usual: int) -> bool:
    """Whether any of the values is another than the usual one."""
    count = 0
    for value in values:
        count += value != usual
    return count > 0


@compiled(allocates=False)
def _start(
    lanes: Lanes, i: int, trial: int, network: Floats, trials: TrialArrays, world: World, words: Floats
) -> None:
    """Put lane i at the start of a trial."""
    s, n, d = lanes
    for j in range(N_INTER):
        s[at.Y + j * N_LANES + i] = 0.0
        s[at.Z + j * N_LANES + i] = sigmoid(0.0 + network[INTER_BIAS + j])
    start_lane(s, n, i, trial, trials, world)
    _hear(d, i, trials.heard[trial, 0], words)


@compiled(allocates=False)
def _hear(d: Floats, i: int, instruction: Integers, words: Floats) -> None:
    """Let lane i hear an instruction (action, object)."""
    for j in range(N_INTER):
        d[ROW * i + j] = words[instruction[0], instruction[1], j]


@compiled(allocates=False)
def _change_words(
    s: Floats, n: Integers, d: Floats, lanes: int, trials: TrialArrays, world: World, words: Floats
) -> None:
    """Change the instruction where the drawn number of steps has passed since the target was seen."""
    for i in range(lanes):
        delay = trials.delay[n[at.TRIAL + i]]
        if delay == NO_CHANGE or n[at.WAIT + i] == at.CHANGED:
            continue
        if n[at.WAIT + i] != at.NOT_SEEN:
            n[at.WAIT + i] -= 1
        elif target_in_view(s, n, i, world):
            n[at.WAIT + i] = delay
        if n[at.WAIT + i] == 0:
            n[at.WAIT + i] = at.CHANGED
            _hear(d, i, trials.heard[n[at.TRIAL + i], 1], words)


@compiled(allocates=False)
def _say_next_word(n: Integers, d: Floats, lanes: int, trials: TrialArrays, words: Floats) -> None:
    """Say the next word, or nothing any more, where the one before has taken its steps."""
    for i in range(lanes):
        trial = n[at.TRIAL + i]
        made, each = n[at.STEP + i] + 1, trials.word_steps[trial]
        if each > 0 and (made == each or made == 2 * each):
            _hear(d, i, trials.heard[trial, made // each], words)


@compiled(allocates=False)
def _copy_lane(lanes: Lanes, source: int, target: int) -> None:
    """Move a trial to another lane."""
    s, n, d = lanes
    for field in range(N_FLOAT_FIELDS):
        s[field * N_LANES + target] = s[field * N_LANES + source]
    for j in range(ROW):
        d[ROW * target + j] = d[ROW * source + j]
    for field in range(N_INTEGER_FIELDS):
        n[field * N_LANES + target] = n[field * N_LANES + source]
