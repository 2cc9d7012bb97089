"""The session, without page and socket: orders in, moments and states out."""

from dataclasses import replace

import numpy as np
import pytest

from arm2d import ActionWord, Instruction, ObjectWord, Readings, Trials, record_trial
from mujoco_port.acting.lab import Lab
from mujoco_port.live.orders import Again, Loop, Place, Reset, Run, Say, Speed
from mujoco_port.live.placing import Placing
from mujoco_port.live.planar import PlanarTrial
from mujoco_port.live.session import Session
from mujoco_port.live.trial import LET_GO, held
from mujoco_port.reach.workspace import for_world


def words(text):
    return Instruction.parse(text)


def to_the_end(session):
    """The last moment of a trial, and how many there were."""
    session.do(Run(True))
    moments = [session.tick()]
    while session.running:
        moments.append(session.tick())
    return moments


def asked(trial, instruction):
    return Trials(np.array([instruction.action]), np.array([instruction.object]), trial.alpha, trial.discs)


@pytest.mark.parametrize("closed", [False, True])
@pytest.mark.parametrize("text", ["touch blue", "move red"])
def test_both_verdicts_are_those_of_the_same_trial_in_a_lab(
    lab, actor, draw_trial, draw_start, evolved_agent, closed, text
):
    session = Session(lab, actor, draw_start, closed=closed, seed=3)
    session.do(Say.both(words(text)))
    to_the_end(session)
    told = session.state()
    trial = asked(draw_trial("right", 3), words(text))
    carry_out = lab.closed_loop if closed else lab.open_loop
    _, verdict = carry_out(evolved_agent, trial, Readings())
    assert told["robot"] == {"success": verdict.success, "reason": verdict.reason}
    assert told["planar"] == record_trial(evolved_agent, trial, Readings()).success
    assert told["phase"] == "ended"


def test_the_planar_trial_is_judged_as_the_kernel_judges_it(champion_records, evolved_agent):
    outcomes = []
    for record in champion_records:
        start = float(record.alpha[0]), record.discs[0]
        trial = PlanarTrial(evolved_agent, record.instruction, *start, record.readings)
        while trial.judgement.success is None:
            trial.after()
        outcomes.append(trial.judgement.success)
    assert outcomes == [record.success for record in champion_records]
    assert len(set(outcomes)) == 2


def test_a_trial_of_25_seconds_is_seen_in_25_moments_a_second(session):
    moments = to_the_end(session)
    seconds = np.array([moment.seconds for moment in moments])
    assert seconds[0] == pytest.approx(0.04)
    assert np.diff(seconds)[:-1] == pytest.approx(0.04)
    assert np.abs(np.diff([moment.angles for moment in moments], axis=0)).max() < 0.07  # [rad]


@pytest.mark.parametrize("factor", [0.25, 4.0])
def test_time_goes_slower_and_faster_and_nothing_else_changes(session, factor):
    session.do(Run(True))
    plain = [session.tick() for _ in range(40)][-1]
    session.do(Again())
    session.do(Speed(factor))
    session.do(Run(True))
    other = [session.tick() for _ in range(round(40 / factor))][-1]
    assert other.seconds == pytest.approx(plain.seconds)
    assert (other.angles == plain.angles).all()


def test_while_it_is_paused_nothing_moves_and_then_it_goes_on(session):
    session.do(Run(True))
    before = [session.tick() for _ in range(10)][-1]
    session.do(Run(False))
    still = [session.tick() for _ in range(5)][-1]
    assert (still.angles == before.angles).all()
    assert still.seconds == before.seconds
    session.do(Run(True))
    assert session.tick().seconds == pytest.approx(before.seconds + 0.04)


def test_other_words_are_heard_at_once_and_judged_anew(session):
    session.do(Say.both(words("indicate red")))
    session.do(Run(True))
    for _ in range(100):
        session.tick()
    session.do(Say.both(words("move blue")))
    for _ in range(10):
        session.tick()
    told = session.state()
    assert told["inputs"][12:] == [1, 1, 0, 0, 1, 1]  # blue, move
    assert told["changes"] == [(0, "INDICATE Red"), (40, "MOVE Blue")]
    assert told["words"] == ["MOVE", "BLUE"]
    last = to_the_end(session)[-1]
    assert session.state()["phase"] == "ended"
    assert last.seconds <= 4.0 + 25.6


def test_after_a_verdict_other_words_go_on_from_where_the_robot_is(session):
    session.do(Say.both(words("move red")))
    last = to_the_end(session)[-1]
    session.do(Say.both(words("indicate blue")))
    assert session.running
    assert session.state()["robot"] is None
    following = session.tick()
    assert not following.jumped
    assert following.seconds > last.seconds
    assert np.abs(following.angles - last.angles).max() < 0.07


def test_an_agent_is_not_asked_for_what_it_never_heard(session):
    with pytest.raises(ValueError, match="this agent has no instruction IGNORE Red; it has MOVE Blue"):
        session.do(Say.both(words("ignore red")))


def test_what_is_touched_when_words_change_is_forgiven_until_it_is_let_go():
    on, off = np.ones(30, bool), np.zeros(LET_GO, bool)
    assert held(np.concatenate([on, off, on])) == 30 + LET_GO
    assert held(np.concatenate([on, off[1:], on])) == len(on) + LET_GO - 1 + len(on)
    assert held(off) == LET_GO


def test_objects_are_moved_between_trials_only(session):
    session.do(Place(ObjectWord.RED, -120.0, 90.0))
    moment = session.tick()
    assert moment.jumped
    assert moment.places[2, :2] / 0.0018 == pytest.approx([-120.0, 90.0])
    session.do(Run(True))
    session.tick()
    with pytest.raises(ValueError, match="objects are moved between trials"):
        session.do(Place(ObjectWord.RED, 0.0, 150.0))


def test_after_a_trial_the_others_stand_where_they_lie(session):
    session.do(Say.both(words("move red")))
    lying = to_the_end(session)[-1].places[:, :2]
    session.do(Place(ObjectWord.BLUE, 140.0, 40.0))
    standing = session.tick().places[:, :2]
    assert standing[2] == pytest.approx(lying[2], abs=1e-9)
    assert session.state()["phase"] == "ready"


def test_no_object_is_put_into_another(session):
    _, green, _ = session.tick().places[:, :2] / 0.0018
    with pytest.raises(ValueError, match="another object stands there"):
        session.do(Place(ObjectWord.RED, green[0] + 15.0, green[1]))


@pytest.mark.parametrize("radius", [5.0, 8.0, 11.8])
def test_objects_are_put_as_near_to_each_other_as_they_are_wide(robot, radius):
    plane = for_world(robot, Readings(object_radius=radius)).plane
    discs, wide = (
        np.array([[0.0, 150.0], [-130.0, 75.0], [130.0, 75.0]]),
        2 * plane.object_radius / plane.scale,
    )
    placing = Placing(plane)
    with pytest.raises(ValueError, match="another object stands there"):
        placing.placed(discs, 1, 1.02 * wide, 150.0)
    assert placing.placed(discs, 1, 1.1 * wide, 150.0)[1] == pytest.approx([1.1 * wide, 150.0])


@pytest.mark.parametrize("radius", [5.0, 8.0, 11.8])
def test_wherever_an_object_is_put_it_stands_on_the_table_in_reach(lab, robot, radius):
    tops = [lab.body.model.geom(name) for name in ("top", "right_wing", "left_wing")]
    plane = for_world(robot, Readings(object_radius=radius)).plane
    rim, within = plane.object_radius, Placing(plane).within
    for angle in np.linspace(0.0, 2 * np.pi, 73):
        for far in (0.0, 50.0, 130.0, 400.0):
            place = 0.0018 * within(far * np.cos(angle), far * np.sin(angle))
            corners = place + rim * np.array([(1, 0), (-1, 0), (0, 1), (0, -1), (0, 0)])
            on_top = [(np.abs(corners - top.pos[:2]) <= top.size[:2] + 1e-9).all(axis=1) for top in tops]
            assert np.any(on_top, axis=0).all(), (angle, far)


def test_a_reset_draws_the_start_that_its_seed_means(session, draw_start):
    session.do(Reset("left", 7))
    moment, start = session.tick(), draw_start("left", 7)
    assert moment.planar[0] == start.alpha
    assert moment.places[:, :2] / 0.0018 == pytest.approx(start.discs)
    assert session.state()["seed"] == 7


def test_orders_that_come_together_do_not_take_each_other_back(session):
    """A reader clicks two words, or an area and a seed, before the page has heard of the first."""
    for order in (Say(ActionWord.MOVE, None), Say(None, ObjectWord.RED), Reset("left"), Reset(seed=9)):
        session.do(order)
    told = session.state()
    assert (told["words"], told["area"], told["seed"]) == (["MOVE", "RED"], "left", 9)


def test_the_loop_is_closed_and_opened_between_trials(session):
    session.do(Loop(True))
    assert session.state()["closed"]
    assert session.state()["phase"] == "ready"


def test_where_the_robot_cannot_reach_the_trial_breaks_off_with_a_reason(robot, actor, draw_start):
    far = Lab(replace(robot, plane=replace(robot.plane, scale=0.0028)))
    session = Session(far, actor, draw_start)
    session.do(Say.both(words("touch red")))
    to_the_end(session)
    told = session.state()
    assert told["phase"] == "ended"
    assert "beyond the reach of the arm" in told["fault"]
    with pytest.raises(ValueError, match="this trial broke off"):
        session.do(Say.both(words("touch blue")))
    session.do(Again())
    assert session.state()["fault"] == ""
