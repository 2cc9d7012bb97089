"""What is shown of many runs: names that can be told apart, and the rest of the table whatever is damaged."""

import os
import re
import shutil
from pathlib import Path
from tempfile import gettempdir

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console

from arm2d import Condition
from evolution.cli import main
from evolution.experiments.live_table import run_table
from evolution.experiments.plan import Plan
from evolution.experiments.plan_file import read_plan, write_plan
from evolution.experiments.standing import Pace, Standing, standing_of
from evolution.experiments.variants import LEAST_WIDTH, Variant, told_apart
from evolution.runs.lock import locked
from evolution.search.config import RunConfig
from evolution.search.settings import Settings
from tests.evolution.small_runs import SMALL

LONG = "sector-half-width-8+object-vision-any-part+mutation-probability-0.04+object-radius-{}"


def lines_of(table, width):
    console = Console(width=width, height=100, force_terminal=True, color_system=None)
    with console.capture() as captured:
        console.print(table)
    return captured.get().splitlines()


def evolving(*variants, seeds=(1,)):
    return [
        Standing(
            RunConfig(seed=seed, settings=Settings(generations=6000)), 4321, 2.5, at_work=True, variant=each
        )
        for each in variants
        for seed in seeds
    ]


def test_a_run_is_one_line_of_eighty_columns_and_its_name_is_whole():
    lines = lines_of(run_table(evolving("", seeds=(1, 2)), Pace(0.01, 2.0), 2, width=80), 80)
    assert len(lines) == 4
    assert lines[2].startswith("with-indicate, seed 1  evolving  4321 of 6000  2.500")
    assert max(map(len, lines)) <= 80


@pytest.mark.parametrize("width", [20, 40, 60, 80, 200])
def test_long_names_are_told_apart_in_a_terminal_and_never_dropped(width):
    standings = evolving(*(LONG.format(each) for each in (5, 8, 10)))
    lines = lines_of(run_table(standings, Pace(0.01, 2.0), 2, width=width), width)
    names = [line.partition(", with-indic")[0] for line in lines[-3:]]
    assert len(set(names)) == 3
    if width >= 60:
        assert all(re.search(", with-indicate, seed 1 +evolving +4321 of", line) for line in lines[-3:])
    assert (names == [LONG.format(each) for each in (5, 8, 10)]) == (width == 200)


def test_into_a_pipe_names_are_whole_however_long(tmp_path, capsys):
    configs = [RunConfig(seed=10**18, settings=Settings(generations=each)) for each in (10, 20)]
    names = {Variant.of(each): f"{'x' * 190}-{each.settings.generations}" for each in configs}
    write_plan(Plan(tmp_path, tuple(configs), names=names))
    assert main(["status", str(tmp_path)]) == 0
    _, heading, *rows = capsys.readouterr().out.splitlines()
    assert [row.split("  ")[0] for row in rows] == [
        f"{name}, with-indicate, seed {10**18}" for name in names.values()
    ]
    assert [len(row) for row in rows] == [len(heading)] * 2


@given(st.lists(st.text("ab-", min_size=1, max_size=40), unique=True, max_size=40), st.integers(0, 30))
def test_no_two_names_look_the_same_and_none_is_too_long(names, width):
    short = told_apart(names, width)
    assert len(set(short.values())) == len(names)
    assert all(len(each) <= max(width, LEAST_WIDTH) for each in short.values())
    assert all(short[name] == name for name in names if len(name) <= width)


def test_a_finished_run_that_nobody_planned_is_done(finished_run, capsys):
    assert main(["status", str(finished_run)]) == 0
    first, heading, row = capsys.readouterr().out.splitlines()
    assert first == "1 of 1 runs done, 0 at work"
    assert heading.split() == ["run", "state", "generation", "best", "left"]
    assert row.split()[-7:-2] == ["11", "done", "230", "of", "230"]


def test_its_tests_belong_to_it_once_they_were_begun(run_copy):
    assert standing_of(run_copy, SMALL, to_be_tested=None).done
    (run_copy / "postevaluation").mkdir()
    (run_copy / "postevaluation" / "gen-000153-000199.npz").touch()
    standing = standing_of(run_copy, SMALL, to_be_tested=None)
    assert (standing.done, standing.tested, standing.to_test) == (False, 1, 4)


def test_a_run_at_work_is_shown_as_far_as_its_process_tells(run_copy):
    for part in ("gen-000100-000199.npz", "gen-000200-000229.npz"):
        (run_copy / "parts" / part).unlink()
    recorded = standing_of(run_copy, SMALL)
    assert recorded.generations == 100
    with locked(run_copy) as hold:
        hold.tell(157, 1.25)
        standing = standing_of(run_copy, SMALL)
        assert (standing.generations, standing.best, standing.state) == (157, 1.25, "evolving")
        hold.tell(99, 1.25)  # an old word counts less than the parts
        assert standing_of(run_copy, SMALL).generations == 100
    hold = standing_of(run_copy, SMALL)
    assert (hold.generations, hold.best, hold.state) == (100, recorded.best, "waiting")


def test_one_damaged_config_among_many_costs_one_line(finished_run, tmp_path, capsys):
    for seed in (1, 2, 3):
        shutil.copytree(finished_run, tmp_path / "with-indicate" / f"seed-000{seed}")
    (tmp_path / "with-indicate" / "seed-0002" / "config.toml").write_text("seed = ")
    assert main(["status", str(tmp_path)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "2 of 2 runs done, 0 at work"
    assert len(lines) == 5
    assert lines[-1].startswith(f"{tmp_path}/with-indicate/seed-0002/config.toml cannot be read: ")


def test_a_damaged_plan_costs_one_line_too(finished_run, tmp_path, capsys):
    shutil.copytree(finished_run, tmp_path / "with-indicate" / "seed-0011")
    (tmp_path / "plan.toml").write_text("runs = 3")
    assert main(["status", str(tmp_path)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "1 of 1 runs done, 0 at work"
    assert "plan.toml cannot be understood" in lines[-1]


@pytest.mark.parametrize(
    ("name", "sentence"),
    [
        ("none", "none is not there; give the folder of an experiment or of a run"),
        ("file", "file is not a folder; give that of an experiment or of a run"),
        ("empty", "empty holds no runs; an experiment holds <condition>/seed-<seed>/config.toml"),
        ("damaged", "config.toml cannot be read: this is not TOML"),
    ],
)
def test_what_is_no_experiment_is_told_in_one_sentence(name, sentence, tmp_path, capsys):
    (tmp_path / "file").touch()
    (tmp_path / "empty").mkdir()
    (tmp_path / "damaged").mkdir()
    (tmp_path / "damaged" / "config.toml").write_text("[")
    assert main(["status", str(tmp_path / name)]) == 2
    error = capsys.readouterr().err
    assert sentence in error
    assert error.count("\n") == 1


@pytest.fixture
def locked_up(finished_run, tmp_path):
    """An experiment, one run of which nobody but root may read; while a test lasts, nobody is who we are."""
    for seed in (1, 2):
        shutil.copytree(finished_run, tmp_path / "with-indicate" / f"seed-000{seed}")
    main(["status", str(tmp_path)])  # loads what nobody may read
    for each in (tmp_path, *tmp_path.parents):
        if each.is_relative_to(gettempdir()) and each != Path(gettempdir()):
            each.chmod(0o755)
    theirs, me = tmp_path / "with-indicate" / "seed-0002", os.geteuid()
    theirs.chmod(0o000)
    if me == 0:
        os.seteuid(65534)
    yield theirs
    os.seteuid(me)
    theirs.chmod(0o755)


def test_a_folder_that_may_not_be_read_is_named_with_the_reason(locked_up, capsys):
    capsys.readouterr()
    assert main(["status", str(locked_up)]) == 2
    assert f"{locked_up} cannot be read: Permission denied; ask whoever owns it" in capsys.readouterr().err


def test_a_run_that_may_not_be_read_costs_one_line(locked_up, capsys):
    capsys.readouterr()
    assert main(["status", str(locked_up.parents[1])]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "1 of 1 runs done, 0 at work"
    assert lines[-1] == f"{locked_up} cannot be read: Permission denied"


def test_a_plan_remembers_which_runs_are_known_and_they_are_done(tmp_path):
    configs = tuple(RunConfig(condition, seed) for condition in Condition for seed in (1, 2))
    known = {configs[1], configs[2]}
    write_plan(Plan(tmp_path, configs, post_evaluate=False, known=known))
    plan = read_plan(tmp_path)
    assert set(plan.known) == known
    assert [standing.done for standing in plan.standings()] == [config in known for config in configs]
