"""The first and the last moment of a trial in a lane, whoever controls the arm in between."""

from arm2d.compiling import compiled
from arm2d.constants import BETA_MAX, N_OBJECTS
from arm2d.kernel import lanes as at
from arm2d.kernel.camera_at_end import look_in_lane
from arm2d.kernel.contact import place_disc, set_limit
from arm2d.kernel.exchange import Outcomes, TrialArrays
from arm2d.kernel.lanes import N_LANES, Floats, Integers
from arm2d.kernel.scores import final_scores, offset_from_target, set_criterion
from arm2d.kernel.world import World


@compiled(allocates=False)
def start_lane(s: Floats, n: Integers, i: int, trial: int, trials: TrialArrays, world: World) -> None:
    """Put arm, discs and scores of lane i at the start of a trial."""
    n[at.TRIAL + i] = trial
    s[at.ALPHA + i] = trials.alpha[trial]
    s[at.BETA + i] = BETA_MAX
    for disc in range(N_OBJECTS):
        n[at.SIDE + disc * N_LANES + i] = at.NONE
        place_disc(s, disc * N_LANES + i, trials.bearing[trial, disc], trials.distance[trial, disc], world)
    set_limit(s, i, world)
    n[at.TARGET_BITS + i] = 0o111 << trials.object[trial]
    if world.from_end:
        look_in_lane(s, n, i, trials.object[trial], world)
    s[at.TARGET + i] = trials.bearing[trial, trials.object[trial]]
    s[at.FIRST_OFFSET + i] = offset_from_target(s, i)
    n[at.TOUCH + i] = 0
    n[at.TARGET_SIDE + i] = at.NONE
    n[at.COLLIDED + i] = 0
    n[at.STEP + i] = 0
    n[at.DONE + i] = 0
    s[at.RUN + i] = 0.0
    s[at.BEST + i] = 0.0
    s[at.STRETCH + i] = 0.0
    n[at.WAIT + i] = at.NOT_SEEN
    set_criterion(s, n, i, trials.action[trial], world)


@compiled(allocates=False)
def finish_lane(
    s: Floats, n: Integers, i: int, row: int, actions: Integers, world: World, outcomes: Outcomes
) -> None:
    """Score the trial of lane i, as it stands now, into a row of the outcomes."""
    trial = n[at.TRIAL + i]
    f1, f2, f3, success = final_scores(s, n, i, world, actions[trial])
    outcomes.f1[row, trial] = f1
    outcomes.f2[row, trial] = f2
    outcomes.f3[row, trial] = f3
    outcomes.success[row, trial] = success
    outcomes.steps[row, trial] = n[at.STEP + i]
