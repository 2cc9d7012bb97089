"""Counting trials in both worlds: the file of outcomes, and the tables."""

import multiprocessing

import numpy as np
import pytest

from arm2d import Instruction, Readings, run_trials
from mujoco_port.acting import agreement
from mujoco_port.acting.agreement import Candidate, Outcome, carry_out_job, jobs, outcomes
from mujoco_port.acting.camera import CameraEyes
from mujoco_port.acting.tally import tally


@pytest.fixture(scope="module")
def listed(evolved_agent):
    words = (Instruction.parse("move red"), Instruction.parse("indicate red"))
    return jobs([Candidate("evolved", evolved_agent, words, Readings())], ("open",), 1, seed=4)


@pytest.fixture(scope="module")
def complete(listed, tmp_path_factory):
    path = tmp_path_factory.mktemp("agreement") / "trials.csv"
    return list(outcomes(listed, "icub", path, processes=1)), path


def test_every_agent_and_loop_meets_the_same_starts(evolved_agent):
    words = (Instruction.parse("move red"),)
    agents = [Candidate(name, evolved_agent, words, Readings()) for name in ("one", "other")]
    listed = jobs(agents, ("open", "geometric"), 2, seed=0)
    assert len(listed) == 2 * 2 * 4
    alphas = [job.trial.alpha[0] for job in listed]
    assert alphas[:4] * 4 == alphas
    assert [job.area for job in listed[:4]] == ["right", "right", "left", "left"]


def test_file_holds_one_row_for_each_trial_in_order(complete, listed):
    rows, path = complete
    assert [(each.instruction, each.area) for each in rows] == [
        ("MOVE Red", "right"),
        ("MOVE Red", "left"),
        ("INDICATE Red", "right"),
        ("INDICATE Red", "left"),
    ]
    assert len(path.read_text().splitlines()) == 2 + len(listed)


def test_file_that_was_cut_short_is_continued_to_the_same_bytes(complete, listed, tmp_path):
    rows, path = complete
    whole, cut = path.read_bytes(), tmp_path / "cut.csv"
    cut.write_bytes(whole[: whole.rfind(b"INDICATE Red,left") + 5])
    assert list(outcomes(listed, "icub", cut, processes=1)) == rows
    assert cut.read_bytes() == whole


def test_file_of_other_trials_is_refused_and_left_alone(complete, evolved_agent, tmp_path):
    _, path = complete
    other = jobs(
        [Candidate("x", evolved_agent, (Instruction.parse("move red"),), Readings())], ("open",), 1, 5
    )
    before = path.read_bytes()
    with pytest.raises(
        ValueError, match="holds no outcomes of these trials with this version of the robot; ch"
    ):
        list(outcomes(other, "icub", path, processes=1))
    assert path.read_bytes() == before


def test_killed_process_is_told_and_what_is_done_is_kept(listed, complete, tmp_path):
    path, whole = tmp_path / "trials.csv", complete[1].read_bytes()
    running = outcomes(listed, "icub", path, processes=1)
    first = next(running)
    for child in multiprocessing.active_children():
        child.kill()
    with pytest.raises(OSError, match=r"was killed; .* keeps what is done, go on with the same command"):
        list(running)
    assert first == complete[0][0]
    assert whole.startswith(path.read_bytes())


def test_agreement_is_the_part_of_the_2d_successes_that_the_robot_shares():
    def row(planar, physical):
        return Outcome("a", "open", "MOVE Red", "right", 0, planar, physical, 0.0, "")

    counts = tally([row(1, 1), row(1, 1), row(1, 0), row(0, 1), row(0, 0)])
    assert (counts.trials, counts.planar, counts.physical, counts.both) == (5, 3, 3, 2)
    assert counts.agreement == pytest.approx(2 / 3)
    assert np.isfinite(tally([row(0, 0)]).agreement)


@pytest.fixture
def robot_of_this_process():
    agreement._move_in("icub")
    yield agreement
    for eyes in agreement._eyes.values():
        eyes.close()
    agreement._eyes.clear()
    agreement._lab = None


def test_each_loop_is_what_it_is_called(robot_of_this_process, lab, evolved_agent):
    """The same trials by hand: answered at once, a step late, by the robot's body, by its camera."""
    candidate = Candidate("evolved", evolved_agent, (Instruction.parse("move red"),), Readings())
    found, by_hand = {}, {}
    with CameraEyes(lab.body) as eyes:
        for loop in ("open", "delayed", "geometric", "camera"):
            first, *_ = jobs([candidate], (loop,), 1, seed=4)
            done = carry_out_job(first)
            assert (loop == "camera") == bool(robot_of_this_process._eyes)  # not opened before it is needed
            trial = evolved_agent, first.trial, Readings()
            _, verdict = {
                "open": lambda trial=trial: lab.open_loop(*trial),
                "delayed": lambda trial=trial: lab.open_loop(*trial, 1),
                "geometric": lambda trial=trial: lab.closed_loop(*trial),
                "camera": lambda trial=trial: lab.closed_loop(*trial, eyes),
            }[loop]()
            found[loop] = done.physical, done.progress, done.reason
            by_hand[loop] = (
                verdict.success,
                round(verdict.progress, 2),
                "" if verdict.success else verdict.reason,
            )
            assert done.planar == run_trials(evolved_agent, first.trial, Readings()).success[0, 0]
    assert found == by_hand
    assert len({progress for _, progress, _ in found.values()}) >= 3
    before = dict(robot_of_this_process._eyes)
    carry_out_job(first)
    assert robot_of_this_process._eyes == before  # opened once
