"""Python processes of our own: what they find, what they call, and what they must not import."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from evolution import child
from evolution.child import calling, perform, python, reference, resolve
from evolution.experiments.stages import evolve_run
from tests.evolution.planted import TELL, executed, plant

WHERE = """
import arm2d, evolution, random
def tell(word):
    print(evolution.__file__, arm2d.__file__, random.__file__, word)
    return 3
"""


def run(command, folder, **environment):
    return subprocess.run(
        command, cwd=folder, capture_output=True, text=True, env={**os.environ, **environment}
    )


def test_a_function_is_known_by_its_module_and_name():
    assert reference(evolve_run) == "evolution.experiments.stages:evolve_run"
    assert resolve(reference(evolve_run)) is evolve_run


@pytest.mark.parametrize(
    "text",
    ["os:system", "subprocess:run", "evolution", "evolution.child:nothing", "evolution.child:HOME", ""],
)
def test_what_is_no_function_of_ours_is_refused(text, capsys):
    with pytest.raises(ValueError, match="is no function of ours; expected evolution"):
        resolve(text)
    assert perform(text, {}) == 2
    assert capsys.readouterr().err.startswith("wordarm: ")


def test_a_function_that_another_process_would_not_find_is_refused():
    def inner():
        return 0

    inner.__module__ = child.__name__
    with pytest.raises(ValueError, match="is no function of ours"):
        reference(inner)
    inner.__qualname__ = "python"
    with pytest.raises(ValueError, match=r"evolution\.child:python is not what another process would find"):
        reference(inner)


def test_bad_input_of_a_call_is_one_sentence_and_exit_code_2(tmp_path):
    done = run(calling(reference(evolve_run), {"folder": "x", "config": {"seed": -1}}), tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == "wordarm: format is missing; a run needs format, condition and seed\n"
    assert list(tmp_path.iterdir()) == []


@pytest.fixture
def installation(tmp_path):
    """Packages of our names in a folder that is not installed, with a module that tells where it is."""
    folder = tmp_path / "sources"
    for package in ("evolution", "arm2d"):
        (folder / package).mkdir(parents=True)
        (folder / package / "__init__.py").touch()
    for name in ("child.py", "answers.py", "unloadable.py"):
        shutil.copy(Path(child.__file__).with_name(name), folder / "evolution")
    (folder / "evolution" / "where.py").write_text(WHERE)
    # In the checkout itself, as in any other current folder, nothing takes the place of Python's own.
    (folder / "random.py").write_text(TELL)
    return folder


@pytest.mark.parametrize("place", ["sources", "elsewhere"])
def test_a_child_has_the_packages_of_its_parent_and_nothing_of_the_current_folder(
    place, installation, tmp_path
):
    plant(tmp_path / "elsewhere")
    start = (
        "import sys; sys.path.insert(0, sys.argv[1]); from evolution.child import calling; import subprocess"
    )
    code = f"{start}; sys.exit(subprocess.run(calling('evolution.where:tell', {{'word': 'x y'}})).returncode)"
    parent = [sys.executable, "-P", "-c", code, str(installation)]
    done = run(parent, tmp_path / place)
    assert done.returncode == 3, done.stderr
    ours, world, chance, *words = done.stdout.split()
    assert ours == str(installation / "evolution" / "__init__.py")
    assert world == str(installation / "arm2d" / "__init__.py")
    assert Path(chance).parent == Path(json.__file__).parents[1]
    assert words == ["x", "y"]
    assert executed(tmp_path) == []


def test_the_command_line_runs_where_a_package_of_the_same_name_lies(tmp_path):
    plant(tmp_path / "here")
    done = run(python("-m", "evolution", "status", "."), tmp_path / "here")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("wordarm: . holds no runs")
    (tmp_path / "there").mkdir()
    (tmp_path / "there" / "evolution.py").write_text(TELL)
    assert run(python("-m", "evolution", "--help"), tmp_path / "there").stdout.startswith("usage: wordarm")
    assert executed(tmp_path) == []


@pytest.mark.slow
def test_an_experiment_executes_nothing_that_lies_where_it_is_started(tmp_path):
    plant(tmp_path)
    text = "seeds = '1-2'\n[settings]\ngenerations = 3\npopulation = 10\nelites = 2\nparents = 5\n"
    (tmp_path / "two.toml").write_text(text)
    done = run(python("-m", "evolution", "experiment", "two.toml"), tmp_path)
    assert done.stdout.endswith("2 of 2 runs are done: runs/two\n"), done.stdout + done.stderr
    assert executed(tmp_path) == []


def test_the_probe_of_the_graphics_executes_nothing_that_lies_where_it_is_started(tmp_path):
    plant(tmp_path)
    code = "from mujoco_port.film.gl import works; print(works('no such back end'), works('egl'))"
    done = run([sys.executable, "-P", "-c", code], tmp_path)
    assert done.stdout in ("False True\n", "False False\n"), done.stderr
    assert executed(tmp_path) == []


def test_processes_that_count_trials_execute_nothing_that_lies_where_they_are_started(tmp_path):
    plant(tmp_path)
    (tmp_path / "multiprocessing.py").write_text(TELL)
    code = (
        "import multiprocessing, os; from mujoco_port.acting.agreement import _current_folder_is_no_library\n"
        "if __name__ == '__main__':\n"
        "    with _current_folder_is_no_library():\n"
        "        child = multiprocessing.get_context('spawn').Process(target=print, args=('here',))\n"
        "        child.start(); child.join(); print(child.exitcode, os.environ['PYTHONSAFEPATH'])\n"
        "    print('PYTHONSAFEPATH' in os.environ)"
    )
    (tmp_path / "elsewhere").mkdir()
    program = tmp_path / "elsewhere" / "program.py"
    program.write_text(code)
    done = run([sys.executable, str(program)], tmp_path)
    assert done.stdout == "here\n0 1\nFalse\n", done.stderr
    assert executed(tmp_path) == []
