"""The state of one trial, which one thread carries from first to last: a lane of `arm2d.kernel.lanes`."""

import warp as wp


@wp.struct
class Lane:
    """One trial.

    Attributes:
        alpha: Angle of S1 and
        beta: of S2 [deg].
        turn: S1's last turn after clipping and
        bend: S2's [deg].
        y: States of the inter-neurons.
        z: Their outputs.
        words: What the instruction heard drives in them.
        bearing: Of the discs [deg].
        low: Right and
        high: left edge of what can be seen of the discs from J1 [deg].
        distance: Of the discs from J1 [cm].
        side: Where the discs touch: NONE, RIGHT or LEFT.
        limit: S2 may meet a disc in this step only from below this beta [deg].
        cone: A good step's largest distance from the target [deg].
        goal: The run that ends the trial, in steps or [deg].
        count: What a good step adds to the run ...
        push: ... and what each degree of its turn adds.
        run: Current run of good steps, or of turns [deg].
        best: Largest run so far.
        first_offset: d_i [deg].
        stretch: Largest 1 - beta / 90 with the target in view.
        action: What is scored, and
        target: on which disc.
        criterion: Truth table of good steps, one bit for each situation.
        camera: Nine bits, I3 lowest.
        touch: Two bits, I1 (right) lowest.
        near: 1 if the arm moved, or has just started, and may meet a disc.
        collided: 1 if a disc that is not the target touches S2.
        seen: 1 if the target is in view from the end of S1; kept where the camera is there.
        wait: Steps until the words change, NOT_SEEN or CHANGED.
        step: Steps made.
        done: 1 when the trial has ended.
    """

    alpha: wp.float64
    beta: wp.float64
    turn: wp.float64
    bend: wp.float64
    y: wp.vec3d
    z: wp.vec3d
    words: wp.vec3d
    bearing: wp.vec3d
    low: wp.vec3d
    high: wp.vec3d
    distance: wp.vec3d
    side: wp.vec3i
    limit: wp.float64
    cone: wp.float64
    goal: wp.float64
    count: wp.float64
    push: wp.float64
    run: wp.float64
    best: wp.float64
    first_offset: wp.float64
    stretch: wp.float64
    action: wp.int32
    target: wp.int32
    criterion: wp.int32
    camera: wp.int32
    touch: wp.int32
    near: wp.int32
    collided: wp.int32
    seen: wp.int32
    wait: wp.int32
    step: wp.int32
    done: wp.int32


@wp.func
def pick(values: wp.vec3d, disc: wp.int32) -> wp.float64:
    """One disc's value. An index known only at run time would move the array from registers to memory."""
    if disc == 0:
        return values[0]
    if disc == 1:
        return values[1]
    return values[2]


@wp.func
def put(values: wp.vec3d, disc: wp.int32, value: wp.float64) -> wp.vec3d:
    """The values with another one for one disc."""
    if disc == 0:
        values[0] = value
    if disc == 1:
        values[1] = value
    if disc == 2:
        values[2] = value
    return values


@wp.func
def side_of(lane: Lane, disc: wp.int32) -> wp.int32:
    """Where a disc touches."""
    if disc == 0:
        return lane.side[0]
    if disc == 1:
        return lane.side[1]
    return lane.side[2]


@wp.func
def set_side(lane: Lane, disc: wp.int32, side: wp.int32) -> Lane:
    """Note where a disc touches."""
    if disc == 0:
        lane.side[0] = side
    if disc == 1:
        lane.side[1] = side
    if disc == 2:
        lane.side[2] = side
    return lane
