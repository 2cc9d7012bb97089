"""A user's own `models.py` or `evolution.py` in front of ours: the command works, the library says so."""

import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from mujoco_port.neighbours import HOME
from tests.evolution.planted import TELL, executed

PYTHON = [sys.executable]
NAMES = ("models.py", "models/__init__.py", "evolution.py", "evolution/__init__.py")


@pytest.fixture
def command(tmp_path):
    """What an installer makes of the entry point: a script in a folder of its own."""
    project = tomllib.loads((HOME / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    module, function = project["scripts"]["wordarm"].split(":")
    script = tmp_path / "bin" / "wordarm"
    script.parent.mkdir()
    script.write_text(f"import sys\nfrom {module} import {function}\nsys.exit({function}())\n")
    return [sys.executable, str(script)]


def plant(folder, name):
    file = folder / "mine" / name
    file.parent.mkdir(parents=True)
    file.write_text(TELL)
    return file


def run(words, folder, **environment):
    return subprocess.run(
        words, cwd=folder, env={**os.environ, **environment}, capture_output=True, text=True, check=False
    )


@pytest.mark.parametrize("name", NAMES)
def test_the_command_works_although_a_stranger_is_in_pythonpath(name, command, tmp_path):
    file = plant(tmp_path, name)
    done = run([*command, "workspace", "--robot", "r2d2"], tmp_path, PYTHONPATH=str(tmp_path / "mine"))
    assert done.returncode == 2
    assert done.stderr.startswith("wordarm: ")
    assert "icub" in done.stderr
    assert executed(tmp_path) == [], file


@pytest.mark.parametrize("module", ["wordarm", "evolution", "mujoco_port"])
@pytest.mark.parametrize("name", NAMES)
def test_a_module_that_is_run_works_where_a_stranger_lies(name, module, tmp_path):
    if module == name.split("/")[0].removesuffix(".py"):
        pytest.skip("asked for this name, Python runs the user's file, and nothing of ours")
    plant(tmp_path, name)
    words = ["no-agent", "touch green"] if module == "mujoco_port" else ["workspace", "--robot", "r2d2"]
    done = run([*PYTHON, "-m", module, *words], tmp_path / "mine")
    assert done.returncode == 2
    assert done.stderr.startswith("wordarm: "), done.stderr
    assert done.stderr.count("\n") == 1
    assert executed(tmp_path) == []


LIBRARY = "import arm2d, mujoco_port, evolution\n"


@pytest.mark.parametrize("name", ["models.py", "models/__init__.py"])
@pytest.mark.parametrize("use", ["mujoco_port.port_trial", "from mujoco_port.reach.driving import drive"])
@pytest.mark.parametrize("way", ["script", "session", "PYTHONPATH"])
def test_the_library_names_the_file_that_stands_in_front(way, use, name, tmp_path):
    file = plant(tmp_path, name)
    script = (tmp_path if way == "PYTHONPATH" else tmp_path / "mine") / "analysis.py"
    script.write_text(LIBRARY + use)
    if way == "session":
        done = run([*PYTHON, "-c", LIBRARY + use], tmp_path / "mine")
    else:
        path = str(tmp_path / "mine") if way == "PYTHONPATH" else ""
        done = run([*PYTHON, str(script)], tmp_path, PYTHONPATH=path)
    last = done.stderr.splitlines()[-1]
    assert f"{file} stands in front of the package 'models' that mujoco_port needs; rename it" in last
    assert executed(tmp_path) == []


def test_a_folder_of_that_name_without_python_in_it_stands_in_nobodys_way(tmp_path):
    (tmp_path / "models").mkdir()
    (tmp_path / "models" / "weights.bin").touch()
    done = run([*PYTHON, "-c", LIBRARY + "print(mujoco_port.angles_to)"], tmp_path)
    assert done.stdout.startswith("<function angles_to"), done.stderr


def test_a_spawned_process_finds_what_its_parent_found(tmp_path):
    plant(tmp_path, "models.py")
    program = (
        "from mujoco_port.neighbours import come_first; come_first()\n"
        "import importlib, multiprocessing\n"
        "context = multiprocessing.get_context('spawn')\n"
        "child = context.Process(target=importlib.import_module, args=('mujoco_port.reach.driving',))\n"
        "child.start(); child.join(); print(child.exitcode)\n"
    )
    done = run([*PYTHON, "-c", program], tmp_path / "mine")
    assert done.stdout == "0\n", done.stderr
    assert executed(tmp_path) == []


def test_without_strangers_nothing_is_moved():
    code = (
        "import sys; before = list(sys.path); from mujoco_port import neighbours; neighbours.come_first()\n"
    )
    done = run([*PYTHON, "-c", code + "print(sys.path == before)"], Path.home())
    assert done.stdout == "True\n"


USE = "evolution.Settings, mujoco_port.angles_to, arm2d.Readings"


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("way", ["script", "session", "PYTHONPATH"])
def test_what_is_imported_from_wordarm_is_ours_whatever_lies_beside(way, name, tmp_path):
    plant(tmp_path, name)
    code = f"from wordarm import arm2d, evolution, mujoco_port\nprint({USE})\n"
    script = (tmp_path if way == "PYTHONPATH" else tmp_path / "mine") / "analysis.py"
    script.write_text(code)
    if way == "session":
        done = run([*PYTHON, "-c", code], tmp_path / "mine")
    else:
        path = str(tmp_path / "mine") if way == "PYTHONPATH" else ""
        done = run([*PYTHON, str(script)], tmp_path, PYTHONPATH=path)
    assert done.returncode == 0, done.stderr
    assert "<class 'evolution.search.settings.Settings'>" in done.stdout
    assert executed(tmp_path) == []


@pytest.mark.parametrize("name", ["evolution.py", "models/__init__.py"])
def test_a_stranger_that_was_imported_first_is_named(name, tmp_path):
    file = plant(tmp_path, name)
    package = name.split("/")[0].removesuffix(".py")
    done = run([*PYTHON, "-c", f"import {package}\nfrom wordarm import evolution"], tmp_path / "mine")
    last = done.stderr.splitlines()[-1]
    assert f"{file} was imported as {package!r} before wordarm's package of that name; rename it" in last


def test_a_notebook_beside_a_stranger_finds_ours_through_wordarm_or_is_told(tmp_path):
    """A kernel begins in the notebook's folder, which it looks into first."""
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    file = plant(tmp_path, "models.py")
    cells = [
        "import mujoco_port\ntry:\n    mujoco_port.port_trial\nexcept ImportError as e:\n    print(e)",
        f"from wordarm import arm2d, evolution, mujoco_port\nprint({USE})",
    ]
    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell) for cell in cells])
    kernel = {"kernel_name": "python3", "resources": {"metadata": {"path": str(file.parent)}}}
    nbclient.NotebookClient(book, timeout=120, **kernel).execute()
    told, found = ("".join(output["text"] for output in cell["outputs"]) for cell in book.cells)
    assert f"{file} stands in front of the package 'models'" in told
    assert "Settings" in found
    assert executed(tmp_path) == []
