"""Jobs as real processes; most of them are shell commands that stand in for ours."""

import os
import resource
import signal
import sys
import time

import pytest

from evolution.child import reference
from evolution.experiments import warm_workers
from evolution.experiments.jobs import MOST_RESTARTS, Overseer, finished_files, run_jobs
from evolution.experiments.stages import evolve_run
from evolution.experiments.warm_workers import WarmStart
from evolution.experiments.workers import LOST, ColdStart, Job
from evolution.runs.lock import last_word
from tests.evolution.experiments.dask_processes import parent_of
from tests.evolution.small_runs import SMALL, contents

STAND_IN = """#!{python}
import json, os, sys
os.execvp('sh', ['sh', '-c', json.loads(sys.argv[-1])['command']])
"""


@pytest.fixture
def shell(monkeypatch, tmp_path):
    """Jobs whose only argument is a shell command, carried out by a program in the place of Python."""
    program = tmp_path / "program"
    program.write_text(STAND_IN.format(python=sys.executable))
    program.chmod(0o755)
    monkeypatch.setattr(sys, "executable", str(program))
    monkeypatch.chdir(tmp_path)

    def job(command, name="one"):
        log = tmp_path / "logs" / f"{name}.log"
        return Job(name, "working", reference(evolve_run), {"command": command}, tmp_path / name, log)

    return job


def test_jobs_of_a_chain_follow_one_another(shell, tmp_path):
    first, second = shell("sleep 0.2; echo first >> order"), shell("echo second >> order")
    assert run_jobs([[first, second]], at_once=4) == ()
    assert (tmp_path / "order").read_text().split() == ["first", "second"]


def test_no_more_run_at_once_than_allowed(shell):
    at_work = []
    jobs = [[shell("sleep 0.1", name=str(i))] for i in range(5)]
    run_jobs(jobs, at_once=2, overseer=Overseer(on_tick=lambda each: at_work.append(len(each))))
    assert max(at_work) == 2


def test_bad_input_ends_its_chain_with_its_sentence_and_no_other(shell, tmp_path):
    bad = shell("echo 'wordarm: seed = -1 is bad' >&2; exit 2", name="bad")
    never, good = shell("touch never", name="bad"), shell("touch good", name="good")
    (failure,) = run_jobs([[bad, never], [good]], at_once=1)
    assert (failure.job, failure.sentence) == (bad, "seed = -1 is bad")
    assert (tmp_path / "good").exists()
    assert not (tmp_path / "never").exists()


def test_sentences_of_earlier_attempts_are_not_taken_for_the_last(shell, tmp_path):
    (tmp_path / "logs").mkdir()
    (tmp_path / "logs" / "one.log").write_text("wordarm: long ago\n")
    (failure,) = run_jobs([[shell("exit 2")]], at_once=1)
    assert failure.sentence == f"bad input, but no word of it; see {tmp_path / 'logs' / 'one.log'}"


def test_a_job_that_dies_without_progress_is_started_again_three_times(shell, tmp_path):
    notes, ends = [], []
    dying, other = shell("echo x >> starts; kill -9 $$"), shell("sleep 0.5; touch other", name="other")
    overseer = Overseer(on_note=notes.append, on_end=ends.append)
    (failure,) = run_jobs([[dying], [other]], at_once=2, overseer=overseer)
    assert len((tmp_path / "starts").read_text().split()) == 1 + MOST_RESTARTS == 4
    assert notes == ["one: killed by SIGKILL while working; started again"] * MOST_RESTARTS
    assert failure.sentence.startswith("killed by SIGKILL, 4 times without progress")
    assert [each.exit_code for each in ends if each.job is dying] == [-signal.SIGKILL] * 4
    assert (tmp_path / "other").exists()


def test_a_job_that_gets_on_between_deaths_is_never_given_up(shell, tmp_path):
    (tmp_path / "one").mkdir()
    # Writes a file of its run at each start, dies six times, then ends well.
    command = "n=$(ls one | wc -l); [ $n -lt 6 ] || exit 0; touch one/part-$n.npz; kill -9 $$"
    assert run_jobs([[shell(command)]], at_once=1) == ()
    assert finished_files(tmp_path / "one") == 6


def test_files_that_are_rewritten_are_no_progress(tmp_path):
    for name in ("checkpoint.npz", "meta.json", ".gen-000000-000099.npz.tmp"):
        (tmp_path / name).touch()
    assert finished_files(tmp_path) == 0
    (tmp_path / "gen-000000-000099.npz").touch()
    assert finished_files(tmp_path) == 1


def test_asked_to_stop_it_tells_all_and_starts_no_other(shell, tmp_path):
    trap = "trap 'touch $0 stopped-{0}; exit 130' TERM; touch begun-{0}; while :; do sleep 0.05; done"
    chains = [[shell(trap.format(i), name=str(i))] for i in range(2)] + [[shell("touch third", name="third")]]
    both_begun = lambda: len(list(tmp_path.glob("begun-*"))) == 2  # noqa: E731
    assert run_jobs(chains, at_once=2, overseer=Overseer(wants_stop=both_begun)) == ()
    assert len(list(tmp_path.glob("stopped-*"))) == 2
    assert not (tmp_path / "third").exists()


def test_left_by_an_exception_it_leaves_no_process_behind(shell, tmp_path):
    def interrupt(jobs):
        if (tmp_path / "number").exists() and (tmp_path / "number").read_text().strip():
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run_jobs([[shell("echo $$ > number; exec sleep 60")]], 1, Overseer(on_tick=interrupt))
    with pytest.raises(ProcessLookupError):
        os.kill(int((tmp_path / "number").read_text()), 0)


def test_a_job_that_may_not_start_yet_is_asked_for_again(shell, tmp_path):
    may_start_at = time.monotonic() + 0.4
    overseer = Overseer(may_start=lambda job: time.monotonic() > may_start_at)
    assert run_jobs([[shell("touch done")]], 1, overseer) == ()
    assert (tmp_path / "done").exists()


@pytest.mark.slow
def test_a_run_whose_worker_is_killed_equals_an_undisturbed_one(finished_run, tmp_path):
    path, killed = tmp_path / "run", []

    def kill_twice(jobs):
        if jobs and len(list(path.glob("parts/*.npz"))) > len(killed) and len(killed) < 2:
            holder = last_word(path).process
            if holder and holder not in killed:  # else the next worker does not hold the run yet
                killed.append(holder)
                os.kill(holder, signal.SIGKILL)

    run = {"folder": str(path), "config": SMALL.to_mapping()}
    job = Job("small", "evolving", reference(evolve_run), run, path, tmp_path / "log")
    assert run_jobs([[job]], at_once=1, overseer=Overseer(on_tick=kill_twice)) == ()
    assert killed
    assert contents(path) == contents(finished_run)


def test_the_fork_server_is_reached_by_no_path(tmp_path):
    """A socket with a name could be spoken to by others."""
    server = warm_workers._Server(tmp_path / "workers.log")
    try:
        assert server._socket.getsockname() == server._socket.getpeername() == ""
    finally:
        server.close()


def long_job(folder, name="long"):
    """Evolution that does not end by itself, in a folder of its own."""
    config = SMALL.to_mapping()
    config["settings"] |= {"generations": 1_000_000}
    run = {"folder": str(folder / name), "config": config}
    return Job(name, "evolving", reference(evolve_run), run, folder / name, folder / f"{name}.log")


def wait_until(condition):
    until = time.monotonic() + 120
    while not condition():
        assert time.monotonic() < until
        time.sleep(0.01)


def generations_of(job):
    return last_word(job.folder).generations


def ended(worker):
    """How a worker ended, once it has."""
    found = []
    wait_until(lambda: found.append(worker.look()) or found[-1])
    return found[-1]


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["cold", "warm"])
def test_of_a_killed_worker_it_is_known_how_it_ended_and_what_it_took(kind, tmp_path):
    with WarmStart(tmp_path / "server.log") as warm:
        worker = (warm if kind == "warm" else ColdStart()).start(job := long_job(tmp_path))
        wait_until(lambda: generations_of(job) > 100)
        pid = last_word(job.folder).process
        assert os.getpgid(pid) == pid  # Ctrl-C reaches it through us only
        open_files = {os.path.realpath(f"/proc/{pid}/fd/{each}") for each in os.listdir(f"/proc/{pid}/fd")}
        assert open_files == {"/dev/null", str(job.log), str(job.folder / "lock")}
        os.kill(pid, signal.SIGKILL)
        end = ended(worker)
    assert (end.exit_code, end.how) == (-signal.SIGKILL, "killed by SIGKILL")
    assert end.wall > end.cpu > 0.02
    # Linux counts what a process held while it was still a copy of the one that started it.
    ours = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    assert 50 < end.peak < max(1000.0, ours + 100.0)
    assert "from generation 0 on" in job.log.read_text()


@pytest.mark.slow
def test_workers_outlive_their_server_and_the_next_one_gets_another(tmp_path):
    with WarmStart(tmp_path / "server.log") as warm:
        first = warm.start(one := long_job(tmp_path, "one"))
        wait_until(lambda: generations_of(one) > 0)
        os.kill(parent_of(last_word(one.folder).process), signal.SIGKILL)
        scored = generations_of(one)
        wait_until(lambda: generations_of(one) > scored)
        assert first.look() is None
        second = warm.start(two := long_job(tmp_path, "two"))
        wait_until(lambda: generations_of(two) > 0)
        for worker in (first, second):
            worker.stop()
        assert ended(first).exit_code == LOST  # nobody saw its end
        assert ended(second).exit_code == 130
