"""The trials of each genotype from first to last: lanes start, advance, end and are refilled."""

from typing import NamedTuple

import numpy as np

from arm2d.arithmetic import sigmoid
from arm2d.compiling import compiled
from arm2d.constants import N_OBJECTS
from arm2d.kernel import lanes as at
from arm2d.kernel.camera_at_end import look_from_end
from arm2d.kernel.contact import touch_discs
from arm2d.kernel.controller import (
    N_CAMERA_CODES,
    Drives,
    gather_drives,
    sense_camera,
    tabulate_drives,
    think,
    turn,
)
from arm2d.kernel.exchange import NO_CHANGE, Outcomes, TrialArrays, record_states, record_step
from arm2d.kernel.lanes import (
    BLOCK,
    N_INTEGER_FIELDS,
    N_LANES,
    N_NEURON_FIELDS,
    N_WORLD_FIELDS,
    Floats,
    Integers,
)
from arm2d.kernel.lifetime import finish_lane, start_lane
from arm2d.kernel.network import Inter, of_neuron, places_of, row_of, unsigned
from arm2d.kernel.scores import remember_stretch, score_step, target_in_view
from arm2d.kernel.world import N_BETA_KEYS, World, WorldTables


class Lanes(NamedTuple):
    """The flat arrays of arm2d.kernel.lanes, and as many zeros as the network has inter-neurons."""

    s: Floats
    n: Integers
    d: Floats
    inter: Inter


@compiled(nogil=True)
def run_population(
    networks: Floats,
    trials: TrialArrays,
    world: World,
    tables: WorldTables,
    outcomes: Outcomes,
    n_own: int,
    recording: Floats,
    inter: Inter,
) -> None:
    """Run all trials, or its own, with every network, one network after the other.

    Args:
        networks: [P, G] parameters in the order of the genes.
        trials: `TrialArrays` of T trials.
        world: `World` and
        tables: `WorldTables` of the readings.
        outcomes: `Outcomes` to be filled in: [P, T], or one row [1, T] where each network has its own trials.
        n_own: How many trials of its own each network has, those of one after those of another; 0 if all
            networks meet all trials.
        recording: [K, RECORD_STATE + N] for a single trial of a single network, else nothing.
        inter: As many zeros as each network has inter-neurons, N.
    """
    row = int(row_of(inter))
    lanes = Lanes(
        np.zeros((N_WORLD_FIELDS + N_NEURON_FIELDS * len(inter)) * N_LANES),
        np.zeros(N_INTEGER_FIELDS * N_LANES, np.int64),
        np.zeros(row * N_LANES),
        inter,
    )
    drives = Drives(
        np.zeros((4, row)),
        np.zeros((N_CAMERA_CODES, row)),
        np.zeros((N_BETA_KEYS, row)),
        np.zeros((5, N_OBJECTS + 1, row)),
    )
    for p in range(len(networks)):
        tabulate_drives(networks[p], tables.betas, tables.codes, drives, inter)
        row, first, last = p, int(0), len(trials.action)  # noqa: RUF046, UP018 - see below
        if n_own > 0:
            row, first, last = 0, n_own * p, n_own * (p + 1)
        _run_network(row, first, last, networks[p], trials, world, tables, lanes, drives, outcomes, recording)


@compiled(allocates=False)
def _run_network(
    row: int,
    first: int,
    last: int,
    network: Floats,
    trials: TrialArrays,
    world: World,
    tables: WorldTables,
    lanes: Lanes,
    drives: Drives,
    outcomes: Outcomes,
    recording: Floats,
) -> None:
    """Run the trials from `first` to before `last` with one network, N_LANES at a time; fill in a row."""
    s, n, d, inter = lanes
    touch, camera, bend, words = drives
    objects = trials.object
    changing = _any_other(trials.delay[first:last], NO_CHANGE)
    in_sequence = _any_other(trials.word_steps[first:last], 0)
    # To Numba a bare 0 is of a type of its own, for which it would compile all that is called here once more.
    active, waiting = int(0), first  # noqa: RUF046, UP018
    while active < N_LANES and waiting < last:
        _start(lanes, active, waiting, network, trials, world, words)
        active, waiting = active + 1, waiting + 1
    steps = 0
    while active > 0:
        width = (active + BLOCK - 1) // BLOCK * BLOCK
        if not world.from_end:
            sense_camera(s, n, width, world.white_right, world.white_left)
        gather_drives(s, n, d, width, touch, camera, bend, inter)
        think(s, width, network, inter)
        if turn(s, n, width, network, world.turn, inter) > 0:
            touch_discs(s, n, active, world, tables.beta_sines, objects)
        if steps < len(recording):
            record_step(s, n, recording[steps])
            record_states(s, recording[steps], inter)
        if world.from_end:
            look_from_end(s, n, active, width, objects, world)
        if world.best_stretch:
            remember_stretch(s, n, active, world)
        if changing:
            _change_words(lanes, active, trials, world, words)
        if in_sequence:
            _say_next_word(lanes, active, trials, words)
        steps += 1
        if score_step(s, n, width, world.keep, world.from_end) == 0:
            continue
        i = int(0)  # noqa: RUF046, UP018
        while i < active:
            if n[at.DONE + i] == 0:
                i += 1
                continue
            finish_lane(s, n, i, row, trials.action, world, outcomes)
            if waiting < last:
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
    biases: int = places_of(lanes.inter).inter_bias
    for j in range(unsigned(len(lanes.inter))):
        lanes.s[of_neuron(at.Y, j) + unsigned(i)] = 0.0
        lanes.s[of_neuron(at.Z, j) + unsigned(i)] = sigmoid(0.0 + network[biases + j])
    start_lane(lanes.s, lanes.n, i, trial, trials, world)
    _hear(lanes, i, trials.heard[trial, 0], words)


@compiled(allocates=False)
def _hear(lanes: Lanes, i: int, instruction: Integers, words: Floats) -> None:
    """Let lane i hear an instruction (action, object)."""
    row = int(row_of(lanes.inter)) * i
    for j in range(len(lanes.inter)):
        lanes.d[row + j] = words[instruction[0], instruction[1], j]


@compiled(allocates=False)
def _change_words(lanes: Lanes, active: int, trials: TrialArrays, world: World, words: Floats) -> None:
    """Change the instruction where the drawn number of steps has passed since the target was seen."""
    s, n = lanes.s, lanes.n
    for i in range(active):
        delay = trials.delay[n[at.TRIAL + i]]
        if delay == NO_CHANGE or n[at.WAIT + i] == at.CHANGED:
            continue
        if n[at.WAIT + i] != at.NOT_SEEN:
            n[at.WAIT + i] -= 1
        elif target_in_view(s, n, i, world):
            n[at.WAIT + i] = delay
        if n[at.WAIT + i] == 0:
            n[at.WAIT + i] = at.CHANGED
            _hear(lanes, i, trials.heard[n[at.TRIAL + i], 1], words)


@compiled(allocates=False)
def _say_next_word(lanes: Lanes, active: int, trials: TrialArrays, words: Floats) -> None:
    """Say the next word, or nothing any more, where the one before has taken its steps."""
    for i in range(active):
        trial = lanes.n[at.TRIAL + i]
        made, each = lanes.n[at.STEP + i] + 1, trials.word_steps[trial]
        if each > 0 and (made == each or made == 2 * each):
            _hear(lanes, i, trials.heard[trial, made // each], words)


@compiled(allocates=False)
def _copy_lane(lanes: Lanes, source: int, target: int) -> None:
    """Move a trial to another lane."""
    s, n, d, inter = lanes
    for field in range(N_WORLD_FIELDS + N_NEURON_FIELDS * len(inter)):
        s[field * N_LANES + target] = s[field * N_LANES + source]
    for field in range(N_INTEGER_FIELDS):
        n[field * N_LANES + target] = n[field * N_LANES + source]
    row = int(row_of(inter))
    for j in range(row):
        d[row * target + j] = d[row * source + j]
