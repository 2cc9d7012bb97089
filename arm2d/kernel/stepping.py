"""Trials advanced one step at a time by turns from outside: the kernel's world without its network.

N trials stand in B blocks of `N_LANES` lanes; block b has its own row of the two flat arrays of
`arm2d.kernel.lanes`. Every stage is the kernel's own, so a trial driven by the turns of an evolved
network ends with the kernel's bits. A trial that has ended stays as it is.
"""

from typing import Final, NamedTuple

from numpy.typing import NDArray

from arm2d.compiling import compiled
from arm2d.constants import ALPHA_MAX, ALPHA_MIN, BETA_MAX, BETA_MIN, N_OBJECTS
from arm2d.kernel import lanes as at
from arm2d.kernel.camera_at_end import look_from_end
from arm2d.kernel.contact import touch_discs
from arm2d.kernel.controller import BEND_INPUT, FIRST_CAMERA_INPUT, sense_camera
from arm2d.kernel.exchange import Outcomes, TrialArrays, record_step
from arm2d.kernel.lanes import BLOCK, N_LANES, Floats, Integers
from arm2d.kernel.lifetime import finish_lane, start_lane
from arm2d.kernel.scores import remember_stretch, score_step
from arm2d.kernel.world import World

N_CAMERA_INPUTS: Final = 9
# The criterion of a lane whose trial is over: no step is good any more.
NEVER_GOOD: Final = 0


class Blocks(NamedTuple):
    """The lanes of N trials and what is seen in them; filled in and kept up by `start` and `step`.

    Attributes:
        s: [B, N_WORLD_FIELDS * N_LANES] and
        n: [B, N_INTEGER_FIELDS * N_LANES], the lanes.
        inputs: [N, 18], I1 to I18; the words I13 to I18 are the caller's to set.
    """

    s: Floats
    n: Integers
    inputs: Floats


@compiled(allocates=False)
def start(blocks: Blocks, which: Integers, trials: TrialArrays, world: World) -> None:
    """Put the trials numbered by `which` [k] at their starts."""
    for trial in which:
        b, i = trial // N_LANES, trial % N_LANES
        start_lane(blocks.s[b], blocks.n[b], i, trial, trials, world)
    for trial in which:
        _sense(blocks, trial // N_LANES, _lanes_of(blocks, trial // N_LANES), world)


@compiled(allocates=False)
def step(
    blocks: Blocks,
    turns: NDArray,
    trials: TrialArrays,
    world: World,
    beta_sines: Floats,
    outcomes: Outcomes,
    row: Floats,
) -> None:
    """Turn the joints of all trials that have not ended, and let the world follow.

    Args:
        blocks: The lanes.
        turns: [N, 2], -1, 0 or 1 for S1 and S2.
        trials: Their starts and instructions.
        world: `World` and
        beta_sines: [N_BETA_KEYS, 2], its table of sines and cosines.
        outcomes: [1, N], filled in for the trials that end with this step.
        row: [RECORD_STATE] or more, where the first trial is written down; nothing if it is empty.
    """
    for b in range(len(blocks.s)):
        s, n, lanes = blocks.s[b], blocks.n[b], _lanes_of(blocks, b)
        width = (lanes + BLOCK - 1) // BLOCK * BLOCK
        if _turn(s, n, lanes, turns[b * N_LANES :], world.turn) > 0:
            touch_discs(s, n, lanes, world, beta_sines, trials.object)
        if len(row) > 0 and b == 0:
            record_step(s, n, row)
        if world.from_end:
            look_from_end(s, n, lanes, width, trials.object, world)
        if world.best_stretch:
            remember_stretch(s, n, lanes, world)
        if score_step(s, n, width, world.keep, world.from_end) > 0:
            _note_ends(s, n, lanes, trials, world, outcomes)
        _sense(blocks, b, lanes, world)


@compiled(allocates=False)
def _lanes_of(blocks: Blocks, b: int) -> int:
    """How many lanes of block b hold a trial."""
    return min(N_LANES, len(blocks.inputs) - b * N_LANES)


@compiled(allocates=False)
def _turn(s: Floats, n: Integers, lanes: int, turns: NDArray, size: float) -> int:
    """Turn the joints, each cut off at its bounds; in how many lanes S2 may meet a disc on its way."""
    near = 0
    for i in range(lanes):
        going = n[at.CRITERION + i] != NEVER_GOOD
        alpha, beta = s[at.ALPHA + i], s[at.BETA + i]
        new_alpha = min(ALPHA_MAX, max(ALPHA_MIN, alpha + size * turns[i, 0])) if going else alpha
        new_beta = min(BETA_MAX, max(BETA_MIN, beta + size * turns[i, 1])) if going else beta
        turned, bent = new_alpha - alpha, new_beta - beta
        s[at.ALPHA + i], s[at.TURN + i] = new_alpha, turned
        s[at.BETA + i], s[at.BEND + i] = new_beta, bent
        moved = (turned != 0.0) | (bent != 0.0) | (n[at.STEP + i] == 0)
        may_meet = 1 if (beta < s[at.LIMIT + i]) & moved else 0
        n[at.NEAR + i] = may_meet
        near += may_meet
    return near


@compiled(allocates=False)
def _note_ends(
    s: Floats, n: Integers, lanes: int, trials: TrialArrays, world: World, outcomes: Outcomes
) -> None:
    """Score the trials that this step ended, and let nothing happen in them any more."""
    for i in range(lanes):
        if n[at.DONE + i] != 0 and n[at.CRITERION + i] != NEVER_GOOD:
            finish_lane(s, n, i, 0, trials.action, world, outcomes)
            n[at.CRITERION + i] = NEVER_GOOD


@compiled(allocates=False)
def _sense(blocks: Blocks, b: int, lanes: int, world: World) -> None:
    """Write I1 to I12 of the trials of block b; a camera at the end of S1 has looked already."""
    s, n = blocks.s[b], blocks.n[b]
    if not world.from_end:
        sense_camera(s, n, lanes, world.white_right, world.white_left)
    for i in range(lanes):
        trial = b * N_LANES + i
        touch, camera = n[at.TOUCH + i], n[at.CAMERA + i]
        blocks.inputs[trial, 0] = touch & 1
        blocks.inputs[trial, 1] = touch >> 1 & 1
        for bit in range(N_CAMERA_INPUTS):
            blocks.inputs[trial, FIRST_CAMERA_INPUT + bit] = camera >> bit & 1
        blocks.inputs[trial, BEND_INPUT] = s[at.BETA + i] / BETA_MAX


@compiled(allocates=False)
def score_now(blocks: Blocks, trials: TrialArrays, world: World, outcomes: Outcomes) -> None:
    """Score, as they stand, the trials that have not ended."""
    for b in range(len(blocks.s)):
        for i in range(_lanes_of(blocks, b)):
            if blocks.n[b, at.CRITERION + i] != NEVER_GOOD:
                finish_lane(blocks.s[b], blocks.n[b], i, 0, trials.action, world, outcomes)


@compiled(allocates=False)
def positions(blocks: Blocks, arm: Floats, discs: Floats, sides: Integers) -> None:
    """Write [N, 2] alpha and beta [deg], [N, 3, 2] bearings [deg] and distances [cm], [N, 3] contacts."""
    for trial in range(len(blocks.inputs)):
        b, i = trial // N_LANES, trial % N_LANES
        arm[trial, 0], arm[trial, 1] = blocks.s[b, at.ALPHA + i], blocks.s[b, at.BETA + i]
        for disc in range(N_OBJECTS):
            discs[trial, disc, 0] = blocks.s[b, at.BEARING + disc * N_LANES + i]
            discs[trial, disc, 1] = blocks.s[b, at.DISTANCE + disc * N_LANES + i]
            sides[trial, disc] = blocks.n[b, at.SIDE + disc * N_LANES + i]
