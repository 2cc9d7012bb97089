"""The whole way from random genotypes to the report, scaled down; stopped, killed, refused."""

import json
import re
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import pytest

from arm2d import Condition, Readings
from arm2d.readings import PRESETS
from evolution.child import calling, python
from evolution.cli import main, parse
from evolution.experiments.live_table import duration, plain_lines
from evolution.experiments.plan import Plan
from evolution.experiments.stage_times import FILE, stage_times
from evolution.experiments.standing import Pace, Standing, is_held, standing_of, time_left
from evolution.runs.lock import in_use, locked
from evolution.runs.run import Watcher, evolve
from evolution.search.config import RunConfig
from evolution.search.settings import Settings
from evolution.trust.torture import Torture, torture
from tests.evolution.planted import executed, plant

# Far from the paper, so that no stage takes long.
FLAGS = ["--runs=1", "--population=10", "--elites=2", "--parents=5", "--generations=130"]


def command(folder):
    return [sys.executable, "-m", "evolution", "reproduce", *FLAGS, f"--output={folder}"]


def results_of(folder):
    """Every file of the runs that is determined by them, as bytes."""
    names = sorted(path for path in folder.glob("*/seed-*/**/*.npz") if path.name != "checkpoint.npz")
    return {str(path.relative_to(folder)): path.read_bytes() for path in names}


@pytest.fixture(scope="session")
def reproduced(tmp_path_factory):
    """A scaled-down reproduction, started among planted files and left undisturbed, and what it printed."""
    here = plant(tmp_path_factory.mktemp("reproduced"))
    start = python("-m", "evolution", "reproduce", *FLAGS, "--output=small")
    done = subprocess.run(start, capture_output=True, text=True, cwd=here)
    assert done.returncode == 0, done.stdout + done.stderr
    return here / "small", done.stdout


@pytest.mark.slow
def test_a_scaled_down_paper_ends_with_report_tables_and_times(reproduced):
    folder, output = reproduced
    assert (folder / "report.html").stat().st_size > 100_000
    assert (folder / "results" / "table-ii.csv").exists()
    assert "small/report.html" in output
    assert executed(folder.parent) == []
    for stage in ("evolving", "testing", "analysing", "tracing ancestors", "observing", "reporting"):
        assert re.search(rf"^  {stage}: \d+ s of CPU in \d processes", output, re.MULTILINE), stage
    assert "\x1b" not in output


@pytest.mark.slow
def test_stopped_it_ends_its_workers_and_repeated_it_does_only_what_is_missing(reproduced, tmp_path):
    folder = tmp_path / "small"
    shutil.copytree(reproduced[0], folder)
    # One run is begun anew; what is drawn of its best agent will be right again when it is done.
    for each in (folder / "with-ignore" / "seed-0001").iterdir():
        if each.name not in ("lineage", "behaviour"):
            shutil.rmtree(each) if each.is_dir() else each.unlink()
    process = subprocess.Popen(command(folder), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    wait_for(lambda: list(folder.glob("with-ignore/seed-0001/parts/*.npz")))
    process.send_signal(signal.SIGINT)
    output, errors = process.communicate(timeout=60)
    assert process.returncode == 130, errors
    assert output.endswith("stopped; go on with the same command\n")
    assert not any(is_held(path) for path in folder.glob("*/seed-0001"))
    before = (folder / FILE).read_text()
    assert main(["reproduce", *FLAGS, f"--output={folder}"]) == 0
    assert results_of(folder) == results_of(reproduced[0])
    added = (folder / FILE).read_text().removeprefix(before).splitlines()
    told = [line.split(",", 1)[0] for line in added]
    assert told[:-2] in (["evolving", "testing"], ["testing"])  # of the one run; evolved it may have been
    assert told[-2:] == ["analysing", "reporting"]


@pytest.mark.slow
def test_tortured_it_ends_with_the_bits_of_the_undisturbed_one(reproduced, tmp_path):
    """The short form of `wordarm doctor --torture`: refused, killed, damaged, repaired, compared."""
    small = Settings(population=10, elites=2, parents=5, generations=130)
    tally = torture(Torture(tmp_path, kills=3, settings=small), print, reproduced[0])
    assert tally.kills == 3
    assert tally.damages.total() == 6
    assert tally.refusals["files that may not grow, as on a full disk"] == tally.rounds == 1
    assert list(tmp_path.iterdir()) == []


def wait_for(condition, seconds=60):
    until = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < until
        time.sleep(0.02)


@pytest.mark.slow
def test_status_tells_the_same_from_another_terminal(reproduced, capsys):
    assert main(["status", str(reproduced[0])]) == 0
    output = capsys.readouterr().out
    assert output.startswith("2 of 2 runs done, 0 at work\n")
    assert re.search(r"with-ignore, seed 1 +done +130 of 130 +\d\.\d{3} +100 %", output)


def test_why_runs_were_given_up_is_told_though_nothing_can_be_analysed(tmp_path, capsys):
    """Each has a part that is cut short."""
    for condition in Condition:
        path = tmp_path / condition / "seed-0001"
        stop = iter([False] * 110 + [True] * 2)
        settings = Settings(population=10, elites=2, parents=5, generations=130)
        assert evolve(path, RunConfig(condition, 1, settings), Watcher(wants_stop=stop.__next__)) == 110
        (part,) = path.glob("parts/*")
        part.write_bytes(part.read_bytes()[:-9])
    assert main(["reproduce", *FLAGS, f"--output={tmp_path}"]) == 2
    said = capsys.readouterr()
    for condition in Condition:
        assert f"{condition}, seed 1, given up while evolving: " in said.out
        assert f"wordarm verify {tmp_path / condition / 'seed-0001'} --repair" in said.out
    assert "has no run that can be analysed" in said.err


@pytest.mark.parametrize("condition", Condition)
def test_the_job_of_a_run_starts_exactly_that_run(condition, tmp_path):
    readings = Readings(sector_centres=(45.0, 90.0, 135.0), sector_half_width=3.0, mutation_sd=0.1 + 0.2)
    config = RunConfig(condition, 7, Settings(generations=12, trials_per_area=3), readings)
    (chain,) = Plan(tmp_path, (config,)).chains()
    word = calling(chain[0].function, chain[0].arguments)[-1]
    assert RunConfig.from_mapping(json.loads(word)["config"]) == config


def test_without_options_it_is_the_papers_size():
    plan = parse(["reproduce"]).plan
    assert [len([c for c in plan.configs if c.condition is each]) for each in Condition] == [10, 10]
    assert {config.settings for config in plan.configs} == {Settings()}
    assert plan.path(plan.configs[0]) == Path("runs/paper/with-indicate/seed-0001")


def test_a_preset_is_the_start_of_its_readings():
    command = parse(["reproduce", "--preset=printed", "--readings.turn=radians"])
    assert command.plan.configs[0].readings == Readings.preset("printed").with_values({"turn": "radians"})


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["--runs=0"], "asked for 0 runs of each condition; give 1 to 10000"),
        (["--jobs=0"], "asked for 0 processes at a time; there must be at least 1"),
        (["--generations=0"], "setting generations = 0 must lie in [1, 1000000]"),
        (["--readings.object-radius=20"], "reading object_radius = 20 must lie in"),
        (
            ["--inter-neurons=5", "--device=warp-cpu"],
            "a device runs the paper's networks of three inter-neurons, not of 5",
        ),
        (["--preset=mine"], f"unknown preset of readings 'mine'; there are {', '.join(PRESETS)}"),
        (["--output={file}"], "cannot be made: it is a file; choose another folder"),
    ],
)
def test_bad_input_gets_one_sentence_before_anything_starts(arguments, sentence, tmp_path, capsys):
    (tmp_path / "file").write_text("dear reader")
    given = [each.format(file=tmp_path / "file") for each in arguments]
    assert main(["reproduce", f"--output={tmp_path / 'none'}", *given]) == 2
    assert sentence in capsys.readouterr().err
    assert [each.name for each in tmp_path.iterdir()] == ["file"]


def test_a_folder_of_another_experiment_is_refused_and_left_alone(finished_run, tmp_path, capsys):
    (tmp_path / "with-indicate").mkdir()
    (tmp_path / "with-indicate" / "seed-0001").symlink_to(finished_run)
    before = sorted(finished_run.rglob("*"))
    assert main(["reproduce", "--runs=1", f"--output={tmp_path}"]) == 2
    error = capsys.readouterr().err
    assert "was started with seed = 11, not 1; settings.population = 10, not 100" in error
    assert sorted(finished_run.rglob("*")) == before
    assert [each.name for each in tmp_path.iterdir()] == ["with-indicate"]


def test_two_at_once_on_one_folder_are_refused(tmp_path, capsys):
    with locked(tmp_path):
        assert main(["reproduce", "--runs=1", f"--output={tmp_path}"]) == 2
    assert "another process" in capsys.readouterr().err


def test_stages_left_to_do_follow_from_the_files(finished_run, tmp_path):
    config = RunConfig.from_toml((finished_run / "config.toml").read_text())
    path = tmp_path / "with-indicate" / "seed-0011"
    path.parent.mkdir()
    path.symlink_to(finished_run)
    other = replace(config, seed=12)
    evolved, fresh = Plan(tmp_path, (config, other)).chains()
    assert [job.stage for job in evolved] == ["testing"]
    assert [job.stage for job in fresh] == ["evolving", "testing"]


def test_a_held_run_is_seen_without_touching_its_lock(run_copy):
    config = RunConfig.from_toml((run_copy / "config.toml").read_text())
    assert not in_use(run_copy)
    with locked(run_copy):
        assert in_use(run_copy)
        if Path("/proc/locks").exists():
            assert is_held(run_copy)
            assert standing_of(run_copy, config).at_work
    assert not is_held(run_copy)


def test_a_damaged_part_is_told_as_the_state_of_its_run(run_copy):
    config = RunConfig.from_toml((run_copy / "config.toml").read_text())
    (run_copy / "parts" / "gen-000200-000229.npz").write_bytes(b"nothing")
    standing = standing_of(run_copy, config)
    assert standing.state == "damaged"
    assert "--repair" in standing.damage


def test_what_is_left_is_shared_by_the_processes():
    settings = Settings(generations=1000)
    runs = [Standing(RunConfig(seed=i, settings=settings), generations=500, to_test=4) for i in range(4)]
    pace = Pace(generation=0.01, test=2.0)
    assert pace.left(runs[0]) == pytest.approx(5 + 8)
    assert time_left(runs, pace, at_once=2) == pytest.approx(26)
    assert time_left(runs, pace, at_once=8) == pytest.approx(13)  # no run is shared
    assert plain_lines(runs, pace, 2) == ["0 of 4 runs done, 0 at work, 26 s to go"]


def test_durations_are_as_exact_as_anyone_wants_to_know():
    told = [duration(seconds) for seconds in (4.4, 89, 300, 6000, float("nan"))]
    assert told == ["4 s", "89 s", "5 min", "1 h 40 min", "-"]


def test_times_survive_a_line_that_a_crash_left_unfinished(tmp_path):
    (tmp_path / FILE).write_text(
        "stage,run,exit_code,wall_s,cpu_s,peak_mb\nevolving,a,0,2,1,100\nevolving,b,0,2"
    )
    (only,) = stage_times(tmp_path)
    assert (only.stage, only.processes, only.wall, only.cpu, only.peak) == ("evolving", 1, 2.0, 1.0, 100.0)
