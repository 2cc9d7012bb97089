"""What `wordarm doctor --torture` is made of; that an experiment survives it stands in test_reproduce.py."""

import os
import random
import subprocess
import sys

import pytest

from arm2d.files import final_name, is_temporary
from evolution.child import calling
from evolution.runs.folder import RunFolder
from evolution.trust.disturbances import DAMAGES, _must_be_refused, damage_and_repair
from evolution.trust.killing import TortureError, _unfinished
from evolution.trust.stages import Schedule, stage_of, temporaries
from evolution.trust.tally import PARENT, WORKER, Tally
from evolution.trust.torture import MARK, Torture, _compare, _make_anew, torture
from evolution.trust.victims import kill, members, names
from evolution.trust.watch import OpenedFiles


def test_a_file_is_noticed_when_it_is_made_and_when_it_is_opened_again(tmp_path):
    (tmp_path / "old").write_text("left by a dead process")
    with OpenedFiles([tmp_path]) as opened:
        (tmp_path / "old").open("ab").close()
        (tmp_path / "new").touch()
        assert opened.wait(5.0) == [tmp_path / "old", tmp_path / "new"]
        assert opened.wait(0.0) == []


def test_a_folder_that_is_not_there_cannot_be_watched(tmp_path):
    with pytest.raises(OSError, match="No such file"):
        OpenedFiles([tmp_path / "none"])


@pytest.fixture
def sleeper(tmp_path):
    """A process in a session of its own, with a child that sleeps like itself."""
    child = "import time; print('ready', flush=True); time.sleep(60)"
    program = f"import subprocess, sys; subprocess.run([sys.executable, '-c', {child!r}, *sys.argv[1:]])"
    command = [sys.executable, "-c", program, calling("evolution", {"folder": str(tmp_path / "run")})[-1]]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, start_new_session=True)
    assert process.stdout.readline() == b"ready\n"
    yield process
    for each in members(process.pid):
        kill(each, process.pid)
    process.communicate()


def test_all_that_a_command_started_is_found_and_killed_one_by_one(sleeper, tmp_path):
    parent, child = members(sleeper.pid)
    assert parent == sleeper.pid
    assert names(child, tmp_path / "run")
    assert not names(child, tmp_path)
    assert kill(child, sleeper.pid)
    assert not kill(child, sleeper.pid)
    assert sleeper.wait() == 0
    assert members(sleeper.pid) == []


def test_a_process_of_another_session_is_spared(sleeper):
    assert not kill(sleeper.pid, os.getsid(0))
    assert not kill(0, sleeper.pid)
    assert sleeper.poll() is None


def test_temporary_files_tell_what_was_being_written(tmp_path):
    file = tmp_path / "run" / "parts" / ".gen-000000-000099.npz.0123456789abcdef.tmp"
    assert is_temporary(file.name)
    assert final_name(file.name) == "gen-000000-000099.npz"
    assert stage_of(file) == "part"
    assert stage_of(tmp_path / "run" / ".checkpoint.npz.tmp") == "checkpoint"
    assert stage_of(tmp_path / "run" / "postevaluation" / ".solved.npz.tmp") == "solved trials"
    file.parent.mkdir(parents=True)
    file.touch()
    (file.parent / "gen-000000-000099.npz").touch()
    assert temporaries(tmp_path) == {file}


def test_one_seed_gives_one_schedule_whatever_comes_between(tmp_path):
    one, other = tmp_path / "run" / "parts" / ".one.tmp", tmp_path / "run" / "parts" / ".other.tmp"
    schedules = [Schedule(3, 0), Schedule(3, 0), Schedule(4, 0)]
    schedules[1].draw(other)
    first, second, third = ([each.draw(one).random() for _ in range(3)] for each in schedules)
    assert first == second != third
    assert len(set(first)) == 3


@pytest.mark.parametrize("how", DAMAGES)
def test_every_damage_changes_a_file(how):
    data = bytes(range(1, 256))
    for seed in range(20):
        assert DAMAGES[how](data, random.Random(seed)) != data


def test_damaged_files_of_a_run_are_named_and_come_back(run_copy):
    before, tally = (run_copy / "parts" / "gen-000000-000099.npz").read_bytes(), Tally()
    damage_and_repair(run_copy, random.Random(2), tally, at_once=5)
    assert tally.damages.total() == 5  # three parts, checkpoint, champions
    assert (run_copy / "parts" / "gen-000000-000099.npz").read_bytes() == before
    assert len(RunFolder.open(run_copy).finished_spans()) == 3


def test_a_broken_promise_is_not_passed_over(tmp_path):
    with pytest.raises(TortureError, match=r"x differs from the undisturbed experiment in 2 files: a, c"):
        _compare({"a": b"1", "b": b"2"}, {"a": b"3", "b": b"2", "c": b""}, tmp_path / "x")
    with pytest.raises(TortureError, match="expected one sentence with 'File too large', but had: usage"):
        _must_be_refused(("--help",), tmp_path, "File too large")


def test_the_tally_counts_by_who_and_what():
    tally = Tally(rounds=2, starts=3)
    tally.writes.update({(WORKER, "part"): 2, (WORKER, "checkpoint"): 1})
    tally.others[PARENT] += 1
    lines = tally.lines()
    assert lines[:3] == [
        "4 kills in 2 experiments; 3 left a file half-written",
        "  worker killed while it wrote: part 2, checkpoint 1",
        "  killed at other moments: parent 1",
    ]


def test_an_unfinished_file_that_gets_its_name_while_it_is_counted_is_none(tmp_path):
    (tmp_path / ".part.npz.tmp").touch()
    (tmp_path / ".checkpoint.npz.tmp").symlink_to(
        tmp_path / "gone"
    )  # listed, and not there when it is looked at
    assert [each.name for each, _ in _unfinished(tmp_path)] == [".part.npz.tmp"]


def test_a_folder_that_an_earlier_torture_did_not_make_is_neither_removed_nor_used(tmp_path):
    (tmp_path / "tortured-1").mkdir()
    (tmp_path / "tortured-1" / "thesis.txt").write_text("a year's work")
    with pytest.raises(
        ValueError, match=r"tortured-1 is not of an earlier torture \(it has no .*give another"
    ):
        torture(Torture(tmp_path, kills=1), print, undisturbed=tmp_path / "undisturbed")
    assert [each.name for each in tmp_path.rglob("*")] == ["tortured-1", "thesis.txt"]


def test_what_an_earlier_torture_left_makes_room_for_the_next(tmp_path):
    _make_anew(tmp_path / "tortured-1")
    (tmp_path / "tortured-1" / "left").touch()
    _make_anew(tmp_path / "tortured-1")
    assert [each.name for each in (tmp_path / "tortured-1").iterdir()] == [MARK]
