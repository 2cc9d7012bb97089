"""The study as a command: runs evolved and measured, a stop and its continuation, what is refused."""

import csv
import shutil
import signal
import subprocess
import sys
import time

import pytest

from evolution.cli import main
from evolution.runs.folder import RunFolder
from evolution.study.beyond.cells import cell_of
from evolution.study.beyond.results import NOTHING
from evolution.study.beyond.rows import measured_run, read_rows, write_rows
from evolution.study.beyond.study import BeyondStudy
from tests.evolution.study.beyond.made_up import made_study

GENERATIONS = 60
# Two runs of tasks that are not the paper's are evolved, all others are made up.
LEFT = ("twelve", "dealt")


def is_left(config):
    name = cell_of(config).name
    return config.seed == 201 and name in LEFT and config.task.third != "ignore"


@pytest.fixture(scope="module")
def begun(tmp_path_factory):
    """A file with a made-up row of all runs but two."""
    path = tmp_path_factory.mktemp("begun") / "rows.csv"
    write_rows([run for run in made_study(generations=GENERATIONS) if not is_left(run.config)], path)
    return path


def command(folder, begun):
    return [
        "study",
        "beyond",
        f"--generations={GENERATIONS}",
        f"--output={folder}",
        f"--rows={begun}",
        "--jobs=1",
    ]


@pytest.fixture(scope="module")
def studied(begun, tmp_path_factory):
    """The study carried out, and what its command said."""
    folder = tmp_path_factory.mktemp("study") / "beyond"
    process = subprocess.run(
        [sys.executable, "-m", "evolution", *command(folder, begun)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert process.returncode == 0, process.stderr
    return folder, process.stdout


@pytest.mark.slow
def test_what_has_no_row_is_evolved_and_measured_by_one_command(studied, begun):
    folder, said = studied
    rows = {run.config: run for run in read_rows(folder / "rows.csv")}
    study = BeyondStudy(folder, GENERATIONS)
    assert list(rows) == list(study.part.configs)
    evolved = [config for config in rows if is_left(config)]
    assert len(evolved) == len(LEFT)
    assert len([*folder.glob("**/config.toml")]) == len(LEFT)
    plan = study.rows(study.part).plan(folder)
    for config in evolved:
        again = measured_run(RunFolder.open(plan.path(config)))
        assert (again.config, again.plateau, again.understood) == (
            config, rows[config].plateau, rows[config].understood,
        )  # fmt: skip
        assert again.agents == 2 * 5
    for run in read_rows(begun):
        assert rows[run.config].successes == run.successes
    assert "380 of 380 runs are measured so far" in said
    assert "dealt, with-ignore: plateau less, -" in said
    assert NOTHING not in said


@pytest.mark.slow
def test_status_counts_runs_that_have_a_row_from_elsewhere_as_done(studied, capsys):
    folder, _ = studied
    assert main(["status", str(folder)]) == 0
    assert "380 of 380 runs done, 0 at work" in capsys.readouterr().out


@pytest.mark.slow
def test_tables_and_picture_are_made_again_from_rows_alone(studied, tmp_path, capsys):
    folder, _ = studied
    assert sorted(path.name for path in (folder / "results").iterdir()) == [
        "beyond-cells.csv", "beyond-comparisons.csv", "beyond-runs.csv", "beyond.png", "beyond.svg",
    ]  # fmt: skip
    (rows := tmp_path / "rows.csv").write_bytes((folder / "rows.csv").read_bytes())
    arguments = [f"--generations={GENERATIONS}", f"--output={tmp_path / 'new'}", f"--rows={rows}", "--now"]
    assert main(["study", "beyond", *arguments]) == 0
    assert "380 of 380 runs" in capsys.readouterr().out
    for path in (folder / "results").iterdir():
        assert (tmp_path / "new" / "results" / path.name).read_bytes() == path.read_bytes()
    assert (tmp_path / "new" / "results" / "beyond-runs.csv").read_bytes() == rows.read_bytes()


@pytest.mark.slow
def test_stopped_it_goes_on_with_the_same_command_to_the_same_bits(studied, begun, tmp_path, capsys):
    folder = shutil.copytree(studied[0], tmp_path / "beyond")
    # One run is begun anew.
    study = BeyondStudy(folder, GENERATIONS)
    run = study.rows(study.part).plan(folder).path(next(each for each in study.part.configs if is_left(each)))
    shutil.rmtree(run)
    shutil.rmtree(folder / "results")
    (folder / "rows.csv").unlink()
    process = subprocess.Popen(
        [sys.executable, "-m", "evolution", *command(folder, begun)],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    wait_for((run / "config.toml").exists)
    process.send_signal(signal.SIGINT)
    output, errors = process.communicate(timeout=60)
    assert process.returncode == 130, errors
    assert output.endswith("stopped; go on with the same command\n")
    assert 380 - len(LEFT) <= len(read_rows(folder / "rows.csv")) < 380
    assert main(command(folder, begun)) == 0
    capsys.readouterr()
    assert (folder / "rows.csv").read_bytes() == (studied[0] / "rows.csv").read_bytes()
    for path in (studied[0] / "results").iterdir():
        assert (folder / "results" / path.name).read_bytes() == path.read_bytes()


def wait_for(condition, seconds=60):
    until = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < until
        time.sleep(0.02)


def refused(capsys, *arguments):
    """What the command says when it refuses."""
    assert main(["study", "beyond", *arguments]) == 2
    (sentence,) = capsys.readouterr().err.splitlines()
    return sentence


def test_what_was_declared_is_not_changed(tmp_path, capsys):
    output = f"--output={tmp_path}"
    assert "every run of the study beyond has its seed; leave --seeds away" in refused(
        capsys, "--seeds=3", output
    )
    assert "--part and --early are for the study readings" in refused(capsys, "--part=fresh", output)
    assert "--part and --early are for the study readings" in refused(capsys, "--early", output)
    assert "it needs at least 30" in refused(capsys, "--generations=29", output)
    assert list(tmp_path.iterdir()) == []


def test_without_a_run_there_is_nothing_to_tell(tmp_path, capsys):
    sentence = refused(capsys, "--now", f"--output={tmp_path}")
    assert "no run is measured yet; leave --now away to evolve them" in sentence
    assert list(tmp_path.iterdir()) == []


def test_rows_of_another_study_are_refused(tmp_path, capsys):
    (tmp_path / "rows.csv").write_text("plateau\n2.5\n", encoding="utf-8")
    sentence = refused(capsys, "--now", f"--output={tmp_path}")
    assert "rows.csv is no file of measured rows of this version; move it away and repeat" in sentence


def test_rows_of_another_length_or_world_are_refused(begun, tmp_path, capsys):
    arguments = [f"--rows={begun}", f"--output={tmp_path / 'out'}", "--now"]
    assert "has a row of with-indicate, seed 201" in (said := refused(capsys, *arguments))
    assert "that is no run of the part beyond with these readings and generations" in said
    lines = list(csv.reader(begun.read_text(encoding="utf-8").splitlines()))
    lines[1][lines[0].index("crossover")] = "0.25"
    (other := tmp_path / "other.csv").write_text(
        "\n".join(",".join(f'"{v}"' for v in line) for line in lines), encoding="utf-8"
    )
    said = refused(capsys, f"--rows={other}", f"--generations={GENERATIONS}", arguments[1], "--now")
    assert "that is no run of the part beyond" in said
    assert not (tmp_path / "out").exists()


def test_folder_of_another_experiment_is_refused_before_anything_is_written(tmp_path, capsys):
    spec = tmp_path / "few.toml"
    spec.write_text(
        'seeds = "1-2"\nconditions = "with-ignore"\n[settings]\ngenerations = 1\npopulation = 60\n'
    )
    assert main(["experiment", str(spec), f"--output={tmp_path / 'few'}"]) == 0
    capsys.readouterr()
    before = sorted(tmp_path.rglob("*"))
    sentence = refused(capsys, f"--output={tmp_path / 'few'}")
    assert (
        "few was begun with other runs, such as with-ignore, seed 1, that are not of this study" in sentence
    )
    assert sorted(tmp_path.rglob("*")) == before


def test_a_device_that_knows_the_paper_s_task_only_is_refused(tmp_path, capsys):
    pytest.importorskip("warp", reason="the extra gpu is not installed")
    from arm2d.device.opening import CHECK

    sentence = refused(capsys, f"--device={CHECK}", f"--output={tmp_path}")
    assert "a device runs the paper's conditions, with-indicate and with-ignore, not with-both" in sentence
    assert list(tmp_path.iterdir()) == []


def test_every_run_has_a_folder_of_its_own(tmp_path):
    study = BeyondStudy(tmp_path, GENERATIONS)
    plan = study.rows(study.part).plan(tmp_path)
    assert len({plan.path(config) for config in study.part.configs}) == 380
