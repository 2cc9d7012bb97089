"""Jobs on a real Dask scheduler with workers as separate processes, killed and restarted."""

import os
import signal
import subprocess
from dataclasses import replace
from pathlib import Path

import pytest

from evolution.child import python, reference
from evolution.cli import main
from evolution.experiments.cluster import connection
from evolution.experiments.cluster.address import connected
from evolution.experiments.cluster.agreement import Order, disagreement, fingerprint
from evolution.experiments.cluster.running import run_jobs_on
from evolution.experiments.jobs import Overseer
from evolution.experiments.stages import evolve_run
from evolution.experiments.stages import test_run as carry_out_tests
from evolution.experiments.standing import is_held
from evolution.experiments.workers import Job
from evolution.runs.lock import last_word
from tests.evolution.experiments.dask_processes import DaskProcesses, parent_of, wait_for
from tests.evolution.small_runs import SMALL, contents

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def dask(tmp_path_factory):
    """A scheduler with a worker."""
    processes = DaskProcesses(tmp_path_factory.mktemp("dask"))
    try:
        processes.start_scheduler()
        processes.start_worker()
        yield processes
    finally:
        processes.close()


def small_job(folder, **settings):
    path, config = folder / "run", SMALL.to_mapping()
    config["settings"] |= settings
    run = {"folder": str(path), "config": config}
    return Job("small", "evolving", reference(evolve_run), run, path, folder / "log")


def holder_of(path: Path) -> int:
    """The process that holds a run, or 0."""
    return last_word(path).process if is_held(path) else 0


def test_a_run_whose_worker_is_killed_goes_on_elsewhere_with_the_same_bits(dask, finished_run, tmp_path):
    path, killed = tmp_path / "run", []
    dask.start_worker()

    def kill_worker(jobs):
        if not killed and (holder := holder_of(path)):
            killed.append(parent_of(holder))
            os.kill(killed[0], signal.SIGKILL)

    with connected(dask.address, tmp_path) as cluster:
        assert run_jobs_on(cluster, [[small_job(tmp_path)]], Overseer(on_tick=kill_worker)) == ()
    assert killed[0] in [each.pid for each in dask.processes]
    assert contents(path) == contents(finished_run)
    log = (tmp_path / "log").read_text()
    assert log.count("from generation") == 2  # it was begun twice
    assert not list(tmp_path.glob(".cluster-*"))


def test_a_scheduler_that_is_restarted_costs_only_what_was_not_finished(finished_run, tmp_path, monkeypatch):
    monkeypatch.setattr(connection, "RETRY_INTERVAL", 0.2)
    dask, path, notes, restarted = DaskProcesses(tmp_path), tmp_path / "run", [], []

    def restart(jobs):
        if not restarted and holder_of(path):
            scheduler.kill()
            scheduler.wait()
            restarted.append(dask.start_scheduler(dask.port))
            dask.start_worker()

    try:
        scheduler = dask.start_scheduler()
        dask.start_worker()
        with connected(dask.address, tmp_path) as cluster:
            overseer = Overseer(on_tick=restart, on_note=notes.append)
            cluster.on_note = notes.append
            assert run_jobs_on(cluster, [[small_job(tmp_path)]], overseer) == ()
    finally:
        dask.close()
    assert restarted
    assert contents(path) == contents(finished_run)


def test_asked_to_stop_the_jobs_are_left_in_good_order(dask, tmp_path):
    path = tmp_path / "run"
    chains = [
        [small_job(folder, generations=100000)] for folder in (tmp_path, tmp_path / "b", tmp_path / "c")
    ]
    with connected(dask.address, tmp_path) as cluster:
        assert run_jobs_on(cluster, chains, Overseer(wants_stop=lambda: bool(holder_of(path)))) == ()
        wait_for(lambda: not any(is_held(each[0].folder) for each in chains))
    assert "of 100000 generations" in (tmp_path / "log").read_text()
    assert (path / "checkpoint.npz").exists()


def test_stages_follow_one_another_and_bad_input_ends_a_chain_with_its_sentence(dask, tmp_path):
    bad, never = small_job(tmp_path / "bad", elites=99), small_job(tmp_path / "never")
    good = small_job(tmp_path / "good", generations=5)
    tested = {"folder": str(good.folder)}
    test = Job("small", "testing", reference(carry_out_tests), tested, good.folder, good.log)
    begun = []
    overseer = Overseer(on_tick=lambda jobs: begun.extend(each.stage for each in jobs))
    with connected(dask.address, tmp_path) as cluster:
        (failure,) = run_jobs_on(cluster, [[bad, never], [good, test]], overseer)
    assert failure.job == bad
    assert failure.sentence == "setting elites = 99 must lie in [0, 9]"
    assert not never.folder.exists()
    assert list((good.folder / "postevaluation").glob("*.npz"))
    assert begun.index("evolving") < begun.index("testing")


def test_an_experiment_runs_on_a_cluster_with_the_bits_it_has_here(
    dask, finished_run, tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    settings = "\n".join(f"{name} = {value}" for name, value in SMALL.settings.to_mapping().items())
    (tmp_path / "small.toml").write_text(f"seeds = {SMALL.seed}\n[settings]\n{settings}\n")
    assert main(["experiment", "small.toml", f"--scheduler={dask.address}"]) == 0
    assert "1 of 1 runs are done" in capsys.readouterr().out
    assert contents(tmp_path / "runs" / "small" / "with-indicate" / "seed-0011") == contents(finished_run)


SBATCH = """#!/bin/sh
cp "$1" "{folder}/script"
sh "{folder}/script" > "{folder}/output" 2>&1 &
echo "Submitted batch job $!"
"""


def test_slurm_jobs_do_the_runs_even_where_the_name_of_a_folder_is_a_program(finished_run, tmp_path):
    """The sbatch of this test runs the script at once, as a node would."""
    programs, here = tmp_path / "bin", tmp_path / "x;touch P;$(touch Q) y"
    programs.mkdir()
    here.mkdir()
    for name, text in (("sbatch", SBATCH.format(folder=programs)), ("scancel", "#!/bin/sh\n")):
        (programs / name).write_text(text)
        (programs / name).chmod(0o755)
    settings = "\n".join(f"{name} = {value}" for name, value in SMALL.settings.to_mapping().items())
    (here / "small.toml").write_text(f"seeds = {SMALL.seed}\n[settings]\n{settings}\n")
    done = subprocess.run(
        python("-m", "evolution", "experiment", "small.toml", "--slurm", "--slurm.cores=1"),
        env={**os.environ, "PATH": f"{programs}:{os.environ['PATH']}"},
        cwd=here, capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    assert contents(here / "runs" / "small" / "with-indicate" / "seed-0011") == contents(finished_run)
    assert sorted(each.name for each in here.iterdir()) == ["runs", "small.toml"]
    assert list((here / "runs" / "small" / "logs" / "slurm").iterdir()) == []  # the keys are gone


def test_a_cluster_with_other_versions_is_refused_before_anything_begins(dask, tmp_path):
    cluster = connected(dask.address, tmp_path)
    cluster.order = replace(cluster.order, fingerprint={**fingerprint(), "numba": "0.1"})
    with pytest.raises(ValueError, match=r"has numba [\d.]+, where this command has 0.1; install the same"):
        cluster.__enter__()
    assert list(tmp_path.iterdir()) == []


def test_a_machine_that_sees_another_folder_says_so(tmp_path):
    order = Order("token", tmp_path, fingerprint())
    assert f"does not see {tmp_path} as the command's machine does" in disagreement(order)
    order.mark.touch()
    assert disagreement(order) == ""


@pytest.mark.parametrize(
    ("address", "sentence"),
    [
        ("tcp://127.0.0.1:1", "no scheduler answers at tcp://127.0.0.1:1; start one with: dask scheduler"),
        ("somewhere", "'somewhere' is not the address of a scheduler; give one such as tls://10.0.0.1:8786"),
        ("http://127.0.0.1:80", "'http://127.0.0.1:80' is not the address of a scheduler"),
        ("", "'' is not the address of a scheduler"),
    ],
)
def test_a_scheduler_that_is_not_there_gets_one_sentence_and_writes_nothing(
    address, sentence, tmp_path, monkeypatch, capsys
):
    monkeypatch.setattr(connection, "ANSWER_TIME", 0.3)
    assert main(["reproduce", f"--scheduler={address}", f"--output={tmp_path / 'new'}"]) == 2
    error = capsys.readouterr().err
    assert error.startswith(f"wordarm: {sentence}")
    assert error.count("\n") == 1
    assert list(tmp_path.iterdir()) == []
