"""Commands in surroundings that users of the libraries below have reported as troublesome."""

import os
import subprocess
import sys

import pytest

from evolution.answers import BAD_INPUT

WORDARM = [sys.executable, "-m", "wordarm"]
EVALUATE = [*WORDARM, "evaluate", "best-generaliser", "--trials-per-area=1"]
# A paper's style, as people keep it beside their scripts; LaTeX is not there, which would be the least of it.
MATPLOTLIBRC = "text.usetex: True\nsavefig.bbox: tight\nsavefig.dpi: 20\naxes.facecolor: red\nfont.size: 30\n"


def run(command, folder, **environment):
    return subprocess.run(
        command, cwd=folder, env={**os.environ, **environment}, capture_output=True, text=True
    )


def contents(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}


@pytest.fixture(scope="module")
def evaluated(tmp_path_factory):
    """The files of an evaluation in quiet surroundings."""
    folder = tmp_path_factory.mktemp("quiet")
    done = run([*EVALUATE, "--output=out"], folder)
    assert done.returncode == 0, done.stderr
    files = contents(folder / "out")
    assert any(name.endswith(".png") for name in files)
    return files


@pytest.mark.parametrize(
    "environment",
    [
        {
            "MPLBACKEND": "module://matplotlib_inline.backend_inline",
            "NUMBA_NUM_THREADS": "0",
            "OMP_NUM_THREADS": "none",
            "OPENBLAS_NUM_THREADS": "-1",
            "SOURCE_DATE_EPOCH": "yesterday",
            "TERM": "dumb",
            "COLUMNS": "0",
        },
        {
            "MPLBACKEND": "TkAgg",
            "NUMBA_NUM_THREADS": "many",
            "PYTHONWARNINGS": "error",
            "LC_ALL": "C",
            "PYTHONUTF8": "0",
            "PYTHONCOERCECLOCALE": "0",
        },
    ],
    ids=["back end, none", "window, many"],
)
def test_variables_of_the_shell_change_nothing(environment, evaluated, tmp_path):
    """Several at a time, since a command takes seconds; whoever breaks this asks for them one by one."""
    done = run([*EVALUATE, "--output=out"], tmp_path, **environment)
    assert done.returncode == 0, done.stderr
    assert contents(tmp_path / "out") == evaluated
    assert "never met" in done.stdout  # below the table, which a screen of no columns would swallow


def test_without_docstrings_and_assertions_a_report_is_written(finished_run, tmp_path):
    """Not evaluated: everything would be compiled once more."""
    done = run([*WORDARM, "report", str(finished_run), "--output=x.html"], tmp_path, PYTHONOPTIMIZE="2")
    assert (done.returncode, done.stderr) == (0, "")
    assert "230 of 230" in (tmp_path / "x.html").read_text(encoding="utf-8")


@pytest.mark.parametrize("columns", ["0", "", "none", "-3"])
def test_a_terminal_without_columns_is_shown_everything(columns, finished_run):
    done = run([*WORDARM, "status", str(finished_run)], finished_run, COLUMNS=columns)
    assert (done.returncode, done.stderr) == (0, "")
    assert "230 of 230" in done.stdout


def test_a_librarys_damaged_settings_are_told_in_one_sentence(tmp_path):
    (tmp_path / ".numba_config.yaml").write_text("{: damaged")
    done = run([*EVALUATE, "--output=out"], tmp_path)
    assert (done.returncode, done.stdout) == (BAD_INPUT, "")
    assert done.stderr.startswith("wordarm: numba cannot be loaded (ParserError: ")
    assert done.stderr.endswith(
        'in ".numba_config.yaml", line 1, column 2); look at its settings: NUMBA_... in the environment, '
        "a file in the current folder; `wordarm doctor` tries it by itself\n"
    )
    assert done.stderr.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_a_style_of_the_users_changes_no_figure(evaluated, tmp_path):
    (tmp_path / "matplotlibrc").write_text(MATPLOTLIBRC)
    done = run([*EVALUATE, "--output=out"], tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert contents(tmp_path / "out") == evaluated


@pytest.mark.parametrize("command", [["status", "."], ["evaluate", "best-generaliser"], ["doctor"]])
def test_a_current_folder_that_was_removed_is_named(command, tmp_path):
    (tmp_path / "gone").mkdir()
    inside = (
        "import os, sys; os.rmdir(os.getcwd()); os.execv(sys.executable, [sys.executable, *sys.argv[1:]])"
    )
    # Without -P, Python itself ends there, with no word.
    words = [sys.executable, "-c", inside, "-P", "-m", "wordarm", *command]
    done = run(words, tmp_path / "gone")
    assert (done.returncode, done.stdout) == (BAD_INPUT, "")
    assert done.stderr == (
        "wordarm: the current folder cannot be used (No such file or directory); go to another: cd ~\n"
    )


def test_a_name_that_is_too_long_is_refused_with_the_reason(tmp_path):
    for name in ("b" * 300, "/".join(["folder" * 30] * 30)):
        done = run([*WORDARM, "evolve", f"--output={name}"], tmp_path)
        assert (done.returncode, done.stdout) == (BAD_INPUT, "")
        assert done.stderr.startswith(f"wordarm: {name[:100]}")
        assert done.stderr.endswith(": File name too long\n")
        assert len(done.stderr) < 1100


def test_what_draws_nothing_does_not_care_for_the_back_end(tmp_path):
    done = run([*WORDARM, "workspace", "--step-deg=90"], tmp_path, MUJOCO_GL="nonsense")
    assert "Traceback" not in done.stderr
    assert (tmp_path / "workspace-icub.png").exists(), done.stderr


@pytest.mark.parametrize("back_end", ["nonsense", "osmesa"])
def test_a_back_end_is_left_alone_only_as_long_as_nothing_draws(back_end, tmp_path):
    code = (
        "import os, subprocess, sys\n"
        "from mujoco_port.film.gl import without_drawing\n"
        "with without_drawing():\n"
        "    import mujoco\n"
        "    print(subprocess.run([sys.executable, '-c', 'import mujoco']).returncode)\n"
        "print(os.environ['MUJOCO_GL'])\n"
    )
    done = run([sys.executable, "-c", code], tmp_path, MUJOCO_GL=back_end)
    assert done.stdout.split() == ["0", back_end], done.stderr


@pytest.mark.parametrize("closed", [">&-", "2>&-", "<&- >&- 2>&-"])
def test_streams_that_are_closed_are_nobodys_loss(closed, finished_run):
    command = f'"$0" -m wordarm status "$1" {closed}'
    done = run(["sh", "-c", command, sys.executable, str(finished_run)], finished_run)
    assert (done.returncode, done.stderr) == (0, "")
    assert ("done" in done.stdout) == (closed == "2>&-")
