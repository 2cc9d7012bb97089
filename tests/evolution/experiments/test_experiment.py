"""Experiments of several variants with real runs: stopped, killed, watched, finished."""

import os
import re
import signal
import subprocess
import sys
import time
from contextlib import suppress
from dataclasses import replace

import pytest
from rich.console import Console

from arm2d import Readings
from evolution.cli import main
from evolution.experiments.live_table import plain_lines, run_table
from evolution.experiments.plan import Plan
from evolution.experiments.plan_runner import PlanWatch
from evolution.experiments.standing import Pace, Standing
from evolution.runs.run import Watcher, evolve
from evolution.search.config import RunConfig
from evolution.search.settings import Settings

FILE = """
seeds = "1-2"
[settings]
generations = 120
population = 10
elites = 2
parents = 5
[readings]
sector_half_width = [10, 5]
"""
SMALL = Settings(population=10, elites=2, parents=5, generations=120)
RUNS = [
    f"{variant}/with-indicate/seed-000{seed}"
    for seed in (1, 2)
    for variant in ("default", "sector-half-width-5")
]


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "width.toml"
    path.write_text(FILE)
    return path


def results_of(folder):
    """All that is determined by the configurations, as bytes."""
    names = [*folder.rglob("gen-*.npz"), *folder.rglob("champions.npz"), *folder.rglob("config.toml")]
    return {str(path.relative_to(folder)): path.read_bytes() for path in names}


@pytest.fixture(scope="session")
def alone(tmp_path_factory):
    """The same runs, each evolved alone in this process, without plan, workers or folders of variants."""
    folder = tmp_path_factory.mktemp("alone")
    for path in RUNS:
        readings = Readings(sector_half_width=5.0 if "width" in path else 10.0)
        evolve(folder / path, RunConfig(seed=int(path[-1]), settings=SMALL, readings=readings))
    return results_of(folder)


@pytest.fixture(scope="session")
def done(tmp_path_factory):
    """A finished experiment and what was printed."""
    path = tmp_path_factory.mktemp("done") / "width.toml"
    path.write_text(FILE)
    folder = path.parent / "out"
    command = [sys.executable, "-m", "evolution", "experiment", str(path), f"--output={folder}"]
    ended = subprocess.run(command, capture_output=True, text=True)
    assert ended.returncode == 0, ended.stdout + ended.stderr
    return folder, ended.stdout


@pytest.mark.slow
def test_a_grid_ends_with_the_bits_that_its_runs_have_alone(done, alone):
    folder, output = done
    assert results_of(folder) == alone
    assert output.endswith(f"4 of 4 runs are done: {folder}\n")
    assert "\x1b" not in output


@pytest.mark.slow
def test_a_finished_experiment_returns_at_once_and_starts_no_process(done, file, capsys):
    folder, _ = done
    before = {each: each.stat().st_mtime_ns for each in folder.rglob("*") if each.name != "lock"}
    assert main(["experiment", str(file), f"--output={folder}"]) == 0
    assert {each: each.stat().st_mtime_ns for each in before} == before
    assert capsys.readouterr().out == f"4 of 4 runs are done: {folder}\n"


@pytest.mark.slow
def test_a_run_that_was_given_up_is_named_and_is_no_success(file, tmp_path, capsys):
    """The only part of one run is cut short; the other run goes on to its end."""
    file.write_text(FILE.replace("[10, 5]", "10"))
    damaged = tmp_path / "out" / "with-indicate" / "seed-0001"
    stop = iter([False] * 110 + [True] * 2)
    assert evolve(damaged, RunConfig(seed=1, settings=SMALL), Watcher(wants_stop=stop.__next__)) == 110
    (part,) = damaged.glob("parts/*")
    part.write_bytes(part.read_bytes()[:-9])
    assert main(["experiment", str(file), f"--output={tmp_path / 'out'}"]) == 2
    said = capsys.readouterr().out
    assert "with-indicate, seed 1, given up while evolving: " in said
    assert f"wordarm verify {damaged} --repair" in said
    assert f"1 of 2 runs are done: {tmp_path / 'out'}" in said
    assert (tmp_path / "out" / "with-indicate" / "seed-0002" / "champions.npz").exists()


@pytest.mark.slow
def test_an_experiment_can_grow_and_status_knows_runs_that_were_not_started(done, file, capsys):
    folder, _ = done
    assert main(["experiment", str(file), f"--output={folder}", "--seeds=1-3", "--dry-run"]) == 0
    listed = capsys.readouterr().out
    variant, other, whole, count = listed.splitlines()
    assert re.fullmatch(
        r"default              3 x 120 generations, 2 done, about \d+ s in one process", variant
    )
    assert re.fullmatch(
        r"sector-half-width-5  3 x 120 generations, 2 done, about \d+ s in one process", other
    )
    assert re.fullmatch(r"about \d+ s in \d+ processes, by the pace of the runs so far", whole)
    assert count == f"{folder}: 6 runs, 2 variants x 1 condition x 3 seeds"
    assert not (folder / "default" / "with-indicate" / "seed-0003").exists()


def test_a_dry_run_names_tasks_and_refuses_a_device_that_could_not_do_them(tmp_path, capsys):
    file = tmp_path / "tasks.toml"
    file.write_text(
        'conditions = ["with-indicate", "with-both"]\nseeds = "1"\n[task]\nplaces = ["own", "dealt"]\n'
        "[settings]\ninter_neurons = [3, 5]\n"
    )
    command = ["experiment", str(file), f"--output={tmp_path / 'out'}", "--dry-run"]
    assert main(command) == 0
    listed = capsys.readouterr().out.splitlines()
    assert listed[-1] == (
        "conditions: with-indicate, with-both, with-indicate+places-dealt, with-both+places-dealt"
    )
    file.write_text('conditions = "with-both"\nseeds = "1"\n')
    assert main(command) == 0
    assert capsys.readouterr().out.splitlines()[-1] == "conditions: with-both"
    for device, sentence in (("tpu", "unknown device 'tpu'"), ("cuda", "not with-both; leave --device away")):
        assert main([*command, f"--device={device}"]) == 2
        assert sentence in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


@pytest.mark.slow
def test_killed_workers_and_servers_cost_nothing_but_time(alone, file, tmp_path):
    """First the process that forks, then two workers, then the command itself; then it may end in peace."""
    folder, killed = tmp_path / "out", []
    command = [sys.executable, "-m", "evolution", "experiment", str(file), f"--output={folder}", "--jobs=2"]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while process.poll() is None and len(killed) < 3:
        there = descendants(process.pid)
        if there and (not killed or len(there) > 1):
            killed += [there[-1] if killed else there[0]]
            kill(killed[-1])
        time.sleep(0.02)
    process.kill()
    process.wait()
    assert killed
    ended = subprocess.run(command, capture_output=True, text=True)
    assert ended.returncode == 0, ended.stdout + ended.stderr
    assert results_of(folder) == alone


def descendants(pid):
    """The fork server of an experiment, then its workers."""
    found, above = [], [pid]
    while above:
        parent = above.pop(0)
        try:
            with open(f"/proc/{parent}/task/{parent}/children") as children:
                own = [int(each) for each in children.read().split()]
        except OSError:
            own = []
        found += own
        above += own
    return found


def kill(pid):
    with suppress(ProcessLookupError):
        os.kill(pid, signal.SIGKILL)


@pytest.mark.slow
def test_each_variant_is_an_experiment_of_its_own(done, capsys):
    folder, _ = done
    assert main(["status", str(folder / "sector-half-width-5")]) == 0
    assert capsys.readouterr().out.startswith("2 of 2 runs done, 0 at work\n")
    for command in ("analyse", "behaviour"):
        assert main([command, str(folder)]) == 2
        assert (
            f"holds 2 variants, which are looked at one by one; give the folder of one, such as {folder}"
            in (capsys.readouterr().err)
        )


@pytest.mark.slow
def test_status_counts_runs_that_wait_and_runs_nobody_planned(done, tmp_path, capsys):
    folder, _ = done
    moved = tmp_path / "out"
    moved.mkdir()
    (moved / "plan.toml").write_bytes((folder / "plan.toml").read_bytes())
    (moved / "default").symlink_to(folder / "default")
    (moved / "stranger").symlink_to(folder / "sector-half-width-5")
    assert main(["status", str(moved)]) == 0
    output = capsys.readouterr().out
    assert output.startswith("4 of 6 runs done, 0 at work, ")
    assert re.search(r"sector-half-width-5, with-indicate, seed 1 +waiting +0 of 120", output)
    assert re.search(r"stranger, with-indicate, seed 2 +done +120 of 120", output)


def many(n):
    """Runs of three variants: two at work, some done, the rest waiting."""
    for i in range(n):
        config = RunConfig(seed=i, settings=Settings(generations=1000))
        done = 2 <= i < 42
        best = 1 + i / 100 if i < 42 else float("nan")
        yield Standing(config, 1000 * done, best, evolved=done, done=done, at_work=i < 2, variant=f"v{i % 3}")


def test_hundreds_of_runs_fit_a_terminal_and_lose_none():
    console = Console(width=100, height=24, force_terminal=True, color_system=None)
    with console.capture() as captured:
        console.print(run_table(list(many(400)), Pace(0.01, 2.0), 2, most_rows=20))
    lines = captured.get().splitlines()
    assert len(lines) <= 20
    assert lines[0].startswith("40 of 400 runs done, 2 at work, 30 min to go")
    assert sum("evolving" in line for line in lines) == 2
    sums = [re.search(r"^v\d, with-indicate +(\d+) of (\d+) +(\d+) +(\d+) ", line) for line in lines]
    told = [[int(number) for number in found.groups()] for found in sums if found]
    assert [sum(column) for column in zip(*told, strict=True)] == [40, 400, 2, 358]
    assert len(plain_lines(list(many(400)), Pace(0.01, 2.0), 2)) == 3


def test_only_runs_that_can_have_changed_are_read_again(tmp_path, monkeypatch):
    plan, read = Plan(tmp_path, tuple(RunConfig(seed=i) for i in range(5))), []
    standing = Plan.standing
    monkeypatch.setattr(
        Plan, "standing", lambda self, config: read.append(config.seed) or standing(self, config)
    )
    watch = PlanWatch(plan)
    assert len(watch.read()[0]) == 5
    watch.at_work = {"with-indicate, seed 2"}
    assert [each.at_work for each in watch.read()[0]] == [False, False, True, False, False]
    watch.at_work = set()
    watch.forget("with-indicate, seed 3")
    watch.read()
    assert read == [0, 1, 2, 3, 4, 2, 3]


def test_pace_counts_trials_so_that_small_populations_are_not_taken_for_fast_machines():
    paper = Standing(RunConfig(settings=Settings(generations=100)))
    small = replace(paper, config=RunConfig(settings=Settings(generations=100, population=50)))
    pace = Pace(generation=0.02, test=float("nan"))
    assert pace.left(paper) == pytest.approx(2.0)
    assert pace.left(small) == pytest.approx(1.0)
