"""Who may write a folder when its lock does not reach the other machine."""

import errno
import json
import os
import signal
import subprocess
import sys
import threading
import time
from dataclasses import asdict

import pytest

from evolution.cli import main
from evolution.experiments.standing import is_held
from evolution.runs import lease
from evolution.runs.folder import LEASE
from evolution.runs.lease import EXIT_CODE, LAPSE, Holder, RunInUseError, leased
from evolution.runs.lock import locked

ELSEWHERE = Holder(process=7, host="node12", kernel="another kernel", token="one")


@pytest.fixture(autouse=True)
def quick(monkeypatch):
    monkeypatch.setattr(lease, "SETTLE", 0.2)


def leave(folder, holder=ELSEWHERE, *, age=0.0):
    """A lease as another process left it, so many seconds ago."""
    (folder / LEASE).write_text(json.dumps(asdict(holder)))
    then = time.time() - age
    os.utime(folder / LEASE, (then, then))


def test_a_lease_is_there_while_it_is_held_and_gone_after_it(tmp_path):
    with locked(tmp_path):
        held = json.loads((tmp_path / LEASE).read_text())
    assert held["process"] == os.getpid()
    assert [each.name for each in tmp_path.iterdir()] == ["lock"]


def test_a_run_that_is_alive_on_another_machine_is_refused_and_left_alone(run_copy, capsys):
    leave(run_copy)
    before = (run_copy / LEASE).read_bytes()
    assert main(["verify", str(run_copy), "--repair"]) == 2
    assert f"process 7 on node12 works on {run_copy}" in capsys.readouterr().err
    assert (run_copy / LEASE).read_bytes() == before
    assert is_held(run_copy)


def test_a_run_whose_machine_is_dead_is_taken_over_after_a_while(tmp_path):
    leave(tmp_path, age=LAPSE - 5)
    with pytest.raises(RunInUseError), locked(tmp_path):
        pass
    leave(tmp_path, age=LAPSE + 5)
    assert not is_held(tmp_path)
    with locked(tmp_path):
        assert json.loads((tmp_path / LEASE).read_text())["process"] == os.getpid()


@pytest.mark.parametrize("content", ["", "[1]", '{"process": 1}', "{"])
def test_a_lease_that_cannot_be_read_is_waited_for_like_any_other(content, tmp_path):
    (tmp_path / LEASE).write_text(content)
    with pytest.raises(RunInUseError, match="a process on another machine"), locked(tmp_path):
        pass


@pytest.mark.parametrize("holder", [ELSEWHERE, None])
def test_a_lease_dated_in_the_future_is_judged_by_whether_it_moves(holder, tmp_path):
    """A clock was set back by a day: the dead lapse as ever, and who goes on touching is alive."""
    leave(tmp_path, age=-86_400)
    if holder is None:
        (tmp_path / LEASE).write_text("")
        os.utime(tmp_path / LEASE, (time.time() + 86_400,) * 2)
    assert not is_held(tmp_path)  # for whoever only looks, such a date is no sign of life
    with pytest.raises(RunInUseError, match="or did so less than 90 s ago"), locked(tmp_path):
        pass
    dated = (tmp_path / LEASE).stat().st_mtime
    assert abs(dated - time.time()) < 3600
    with pytest.raises(RunInUseError), locked(tmp_path):  # asked again, it is not dated again
        pass
    assert (tmp_path / LEASE).stat().st_mtime == dated
    os.utime(tmp_path / LEASE, (dated - LAPSE - 5,) * 2)  # nobody touched it for so long
    with locked(tmp_path):
        assert json.loads((tmp_path / LEASE).read_text())["process"] == os.getpid()


class Clock:
    """The clock of this machine, so many seconds off; that of the file server is right."""

    def __init__(self, off):
        self._off = off

    def time(self):
        return time.time() + self._off

    def __getattr__(self, name):
        return getattr(time, name)


@pytest.mark.parametrize("hours", [-6, 6])
def test_a_clock_hours_off_neither_takes_over_the_living_nor_waits_for_the_dead(hours, tmp_path, monkeypatch):
    monkeypatch.setattr(lease, "time", Clock(3600 * hours))
    leave(tmp_path, age=LAPSE - 5)
    before = (tmp_path / LEASE).stat().st_mtime
    with pytest.raises(RunInUseError, match="process 7 on node12"), locked(tmp_path):
        pass
    assert (tmp_path / LEASE).stat().st_mtime == before  # nor is it dated anew
    leave(tmp_path, age=LAPSE + 5)
    with locked(tmp_path):
        assert json.loads((tmp_path / LEASE).read_text())["process"] == os.getpid()


def holder_process(folder, renewal=15.0):
    """A real process that holds a folder, and has said so."""
    code = (
        "import sys, time; from pathlib import Path; from evolution.runs import lease; "
        "from evolution.runs.lock import locked\n"
        f"lease.RENEWAL = {renewal}\nwith locked(Path(sys.argv[1])):\n"
        "    print('held', flush=True); time.sleep(60)"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", code, str(folder)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert process.stdout.readline() == "held\n"
    return process


def test_a_killed_process_of_this_machine_is_followed_at_once(tmp_path):
    process = holder_process(tmp_path)
    with pytest.raises(RunInUseError, match=f"number {process.pid}"), locked(tmp_path):
        pass
    process.send_signal(signal.SIGKILL)
    process.communicate()
    assert (tmp_path / LEASE).exists()
    with locked(tmp_path):
        pass


def test_a_process_whose_run_was_taken_over_ends_itself(tmp_path):
    process = holder_process(tmp_path, renewal=0.05)
    leave(tmp_path)
    _, errors = process.communicate(timeout=120)
    assert process.returncode == EXIT_CODE
    assert errors.startswith(f"wordarm: node12 has taken over {tmp_path}")
    assert json.loads((tmp_path / LEASE).read_text()) == asdict(ELSEWHERE)


def test_a_holder_that_cannot_touch_its_lease_gives_up_before_others_take_over(tmp_path, monkeypatch):
    monkeypatch.setattr(lease, "RENEWAL", 0.01)
    monkeypatch.setattr(lease, "GIVE_UP", 0.05)
    lost = threading.Event()
    with leased(tmp_path, lock_held=True, on_loss=lambda sentence: lost.set()):
        (tmp_path / LEASE).unlink()
        assert lost.wait(30)
    assert lease.GIVE_UP < LAPSE


def test_a_lease_is_touched_as_long_as_it_is_held(tmp_path, monkeypatch):
    monkeypatch.setattr(lease, "RENEWAL", 0.01)
    with locked(tmp_path):
        os.utime(tmp_path / LEASE, (0, 0))
        until = time.monotonic() + 30
        while (tmp_path / LEASE).stat().st_mtime == 0:
            assert time.monotonic() < until


def test_of_two_that_take_over_in_the_same_moment_one_does(tmp_path):
    for _ in range(5):
        leave(tmp_path, age=LAPSE + 5)
        together, won, over = threading.Barrier(2), [], threading.Barrier(2)

        def take(name, together=together, won=won, over=over):
            together.wait()
            try:
                with leased(tmp_path, lock_held=True):
                    won.append(name)
                    over.wait()
            except RunInUseError:
                over.wait()

        takers = [threading.Thread(target=take, args=(i,)) for i in range(2)]
        for each in takers:
            each.start()
        for each in takers:
            each.join()
        assert len(won) == 1


def test_where_the_file_system_keeps_no_locks_the_lease_keeps_processes_apart(tmp_path, monkeypatch):
    def refuse(file, operation):
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr("arm2d.files.locks.fcntl.flock", refuse)
    with locked(tmp_path), pytest.raises(RunInUseError, match=f"process {os.getpid()} on"), locked(tmp_path):
        pass
    with locked(tmp_path):
        pass
