"""One trial from first to last, in one thread: `arm2d.kernel.loop` and `lifetime`.

Thread after thread takes trial after trial of one network, so that neighbours read the same tables. A batch
is N networks that carry out T trials each, which several of them may have in common, out of M.
"""

import warp as wp

from arm2d.device import numbers as c
from arm2d.device.camera_at_end import look_from_end
from arm2d.device.contact import place_disc, set_limit, touch_discs
from arm2d.device.controller import (
    hear,
    network_of,
    outputs,
    sense_camera,
    think,
    turn_joints,
)
from arm2d.device.drives import tabulated_drive
from arm2d.device.lanes import Lane, pick
from arm2d.device.scores import (
    final_f1,
    final_f2,
    final_f3,
    final_success,
    offset_from_target,
    remember_stretch,
    score_step,
    set_criterion,
    target_in_view,
)
from arm2d.device.world import Tables, World
from arm2d.kernel import exchange

NO_CHANGE = wp.int32(exchange.NO_CHANGE)
# Of a thread. All that it could use are 255: then fewer threads fit, and an H200 took a quarter longer.
REGISTERS = 168

# Neither products and sums in one rounding nor approximate divisions: the processor has neither.
wp.set_module_options({"enable_backward": False, "fuse_fp": False, "fast_math": False})


@wp.struct
class TrialArrays:
    """`arm2d.kernel.exchange.TrialArrays` of all trials, [M]."""

    action: wp.array[wp.int32]
    object: wp.array[wp.int32]
    alpha: wp.array[wp.float64]
    bearing: wp.array[wp.vec3d]
    distance: wp.array[wp.vec3d]
    heard: wp.array2d[wp.vec2i]
    delay: wp.array[wp.int32]


@wp.struct
class Outcomes:
    """`arm2d.kernel.exchange.Outcomes` of all networks' trials, network after network, [N T]."""

    f1: wp.array[wp.float64]
    f2: wp.array[wp.float64]
    f3: wp.array[wp.float64]
    success: wp.array[wp.bool]
    steps: wp.array[wp.int32]


@wp.kernel
def tabulate_drives(
    networks: wp.array2d[wp.float64],
    worlds: wp.array[wp.int32],
    betas: wp.array2d[wp.float64],
    codes: wp.array2d[wp.int32],
    drives: wp.array2d[wp.vec3d],
):
    """Fill in one row of one network's table of drives.

    Args:
        networks: [N, 84].
        worlds: [N], row of each network's world.
        betas: [W, B] values of beta [deg].
        codes: [7, 3], the words' codes.
        drives: [N, 40 + B], to be filled in.
    """
    p, row = wp.tid()
    drives[p, row] = tabulated_drive(networks, p, row, betas, worlds[p], codes)


@wp.kernel(cuda_max_registers=REGISTERS)
def run_trials(
    networks: wp.array2d[wp.float64],
    worlds: wp.array[wp.int32],
    first: wp.array[wp.int32],
    n_trials: wp.int32,
    tables: Tables,
    drives: wp.array2d[wp.vec3d],
    trials: TrialArrays,
    outcomes: Outcomes,
):
    """Carry out one trial with one network.

    Args:
        networks: [N, 84].
        worlds: [N], row of each network's world.
        first: [N], the first of each network's trials, which follow one another.
        n_trials: T.
        tables: Of the worlds.
        drives: [N, 40 + B], as tabulated.
        trials: All of them.
        outcomes: To be filled in.
    """
    thread = wp.tid()
    p = thread // n_trials
    trial = first[p] + thread % n_trials
    world = tables.worlds[worlds[p]]
    network = network_of(networks, p)
    lane = start(trial, trials, world, tables)
    lane.z = outputs(network.bias)
    said = trials.heard[trial, 0]
    lane = hear(lane, drives, p, said[0], said[1])
    while lane.done == 0:
        if world.from_end == 0:
            lane = sense_camera(lane, world)
        lane = think(lane, network, drives, p, world, tables)
        lane = turn_joints(lane, network, world)
        if lane.near != 0:
            lane = touch_discs(lane, world, tables)
        if world.from_end != 0 and (lane.turn != c.ZERO or lane.near != 0):
            lane = look_from_end(lane, world)
        if world.best_stretch != 0:
            lane = remember_stretch(lane, world)
        if trials.delay[trial] != NO_CHANGE and lane.wait != c.CHANGED:
            lane = wait_for_change(lane, trials.delay[trial], world)
            if lane.wait == c.CHANGED:
                later = trials.heard[trial, 1]
                lane = hear(lane, drives, p, later[0], later[1])
        lane = score_step(lane, world)
    f1 = final_f1(lane, world)
    f2 = final_f2(lane, f1, world)
    f3 = final_f3(lane, world)
    outcomes.f1[thread] = f1
    outcomes.f2[thread] = f2
    outcomes.f3[thread] = f3
    outcomes.success[thread] = final_success(lane, f1, f2, f3, world)
    outcomes.steps[thread] = lane.step


@wp.func
def start(trial: wp.int32, trials: TrialArrays, world: World, tables: Tables) -> Lane:
    """Arm, discs and scores at the start of a trial; what is not named is 0."""
    lane = Lane()
    lane.alpha = trials.alpha[trial]
    lane.beta = c.BETA_MAX
    lane.action = trials.action[trial]
    lane.target = trials.object[trial]
    disc = wp.int32(0)
    while disc < 3:
        bearing_deg, distance = pick(trials.bearing[trial], disc), pick(trials.distance[trial], disc)
        lane = place_disc(lane, disc, bearing_deg, distance, world)
        disc = disc + 1
    lane = set_limit(lane, world, tables)
    if world.from_end != 0:
        lane = look_from_end(lane, world)
    lane.first_offset = offset_from_target(lane)
    lane.wait = c.NOT_SEEN
    return set_criterion(lane, world, tables)


@wp.func
def wait_for_change(lane: Lane, delay: wp.int32, world: World) -> Lane:
    """Count the steps since the target was seen; CHANGED when the drawn number of them has passed."""
    if lane.wait != c.NOT_SEEN:
        lane.wait = lane.wait - 1
    elif target_in_view(lane, world):
        lane.wait = delay
    if lane.wait == 0:
        lane.wait = c.CHANGED
    return lane


@wp.kernel
def mean_fitness(outcomes: Outcomes, n_trials: wp.int32, fitness: wp.array[wp.float64]):
    """Mean of F1 + F2 + F3 over the trials of one network, from first to last."""
    p = wp.tid()
    total = wp.float64(0.0)
    for trial in range(n_trials):
        at = p * n_trials + trial
        total = total + (outcomes.f1[at] + outcomes.f2[at] + outcomes.f3[at])
    fitness[p] = total / wp.float64(n_trials)


@wp.kernel
def count_ended(outcomes: Outcomes, ended: wp.array[wp.int32]):
    """Count the trials that were carried out to their end."""
    if outcomes.steps[wp.tid()] > 0:
        wp.atomic_add(ended, 0, 1)
