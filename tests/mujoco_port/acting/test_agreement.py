"""Counting trials in both worlds: the file of outcomes, and the tables."""

import multiprocessing

import numpy as np
import pytest

from arm2d import Instruction, Readings
from mujoco_port.acting import agreement
from mujoco_port.acting.agreement import Candidate, Outcome, carry_out_job, fingerprint, jobs, outcomes
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


def test_two_commands_do_not_write_to_one_file(complete, listed, tmp_path):
    """The second is refused; what the first writes is whole, and a file with trials twice is not believed."""
    rows, path = complete
    whole, shared = path.read_bytes(), tmp_path / "shared.csv"
    first = outcomes(listed, "icub", shared, processes=1)
    begun = [next(first)]
    with pytest.raises(ValueError, match=r"another command writes to .*shared\.csv; wait until it has ended"):
        next(outcomes(listed, "icub", shared, processes=1))
    assert begun + list(first) == rows
    assert shared.read_bytes() == whole
    lines = whole.splitlines(keepends=True)
    for doubled in (whole + lines[-1], b"".join([*lines[:3], *lines[2:4]])):
        shared.write_bytes(doubled)
        with pytest.raises(ValueError, match="holds other trials than these, or some of them twice"):
            list(outcomes(listed, "icub", shared, processes=1))
        assert shared.read_bytes() == doubled


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


def test_a_head_that_is_held_makes_other_outcomes_of_the_same_trials(listed, complete):
    """Told from the file's mark; its robot has no motors in neck and eyes."""
    _, path = complete
    assert path.read_text().startswith(f"# {fingerprint(listed, 'icub')}\n")
    with pytest.raises(ValueError, match="holds no outcomes of these trials"):
        list(outcomes(listed, "icub", path, processes=1, head="held"))
    for head, motors in (("turns", 17), ("held", 10)):
        agreement._move_in("icub", head)
        assert agreement.lab_for(Readings()).body.model.nu == motors
    agreement._move_in("icub")


def test_agents_of_worlds_with_other_discs_act_at_tables_of_their_own():
    agreement._move_in("icub", "held")
    small, large = (agreement.lab_for(Readings(object_radius=radius)) for radius in (5.0, 8.0))
    assert agreement.lab_for(Readings(object_radius=8.0, turn="radians")) is large
    widths = [lab.body.model.geom("red").size[0] for lab in (small, large)]
    assert widths == pytest.approx([0.017, 0.0224])
    narrow = agreement.lab_for(Readings(object_radius=5.0, sector_half_width=5.0))
    assert narrow.body.robot.plane.lift_range[0] < small.body.robot.plane.lift_range[0] - 4.0
    agreement._move_in("icub")


def test_agreement_is_the_part_of_the_2d_successes_that_the_robot_shares():
    def row(planar, physical):
        return Outcome("a", "open", "MOVE Red", "right", 0, planar, physical, 0.0, "")

    counts = tally([row(1, 1), row(1, 1), row(1, 0), row(0, 1), row(0, 0)])
    assert (counts.trials, counts.planar, counts.physical, counts.both) == (5, 3, 3, 2)
    assert counts.agreement == pytest.approx(2 / 3)
    assert np.isfinite(tally([row(0, 0)]).agreement)


@pytest.fixture
def asked_of_the_lab(monkeypatch):
    """What is asked of the robot of this process: a word for the loop, the delay, the eyes."""
    agreement._move_in("icub")
    lab, asked = agreement.lab_for(Readings()), []
    open_loop, closed_loop = lab.open_loop, lab.closed_loop

    def in_the_plane(genotype, trial, readings, delay=0):
        asked.append(("open", delay, None))
        return open_loop(genotype, trial, readings, delay)

    def in_the_body(genotype, trial, readings, eyes=None):
        asked.append(("closed", 0, eyes))
        return closed_loop(genotype, trial, readings, eyes)

    monkeypatch.setattr(lab, "open_loop", in_the_plane)
    monkeypatch.setattr(lab, "closed_loop", in_the_body)
    yield asked
    for eyes in agreement._eyes.values():
        eyes.close()
    agreement._move_in("icub")


def test_each_loop_is_what_it_is_called_and_a_camera_is_opened_once(asked_of_the_lab, evolved_agent):
    candidate = Candidate("evolved", evolved_agent, (Instruction.parse("move blue"),), Readings())
    done = []
    for loop in ("open", "delayed", "geometric", "camera", "camera"):
        done.append(carry_out_job(jobs([candidate], (loop,), 1, seed=4)[0]))
        assert (loop == "camera") == bool(agreement._eyes)
    *others, first, second = asked_of_the_lab
    assert others == [("open", 0, None), ("open", 1, None), ("closed", 0, None)]
    assert isinstance(first[2], CameraEyes)
    assert first == second
    assert [each.loop for each in done] == ["open", "delayed", "geometric", "camera", "camera"]
    assert all(each.planar == each.physical == 1 and 34.4 < each.progress < 36.0 for each in done)
