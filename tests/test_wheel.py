"""The wheel in an environment of its own, outside the checkout: everything is inside, and it works."""

import os
import subprocess
import sys
import venv
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
INSIDE = {
    "wordarm.py",
    "models/scene.xml",
    "evolution/__init__.pyi",
    "evolution/py.typed",
    "evolution/report/template.html",
    "evolution/player/player.html",
    "evolution/champions/best-generaliser.npz",
    "evolution/champions/best-specialist.npz",
    "evolution/champions/with-ignore.npz",
}


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """Built as installers build it, from these sources."""
    folder = tmp_path_factory.mktemp("wheel")
    command = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return next(folder.glob("*.whl"))


@pytest.fixture(scope="module")
def installed(wheel, tmp_path_factory):
    """The commands of a fresh environment that has the wheel; other packages are lent by this one."""
    home = tmp_path_factory.mktemp("environment") / "venv"
    venv.create(home, with_pip=False, symlinks=True)
    python = home / "bin" / "python"
    install = [
        "-m",
        "pip",
        "--python",
        str(python),
        "install",
        "--quiet",
        "--no-deps",
        "--no-index",
        str(wheel),
    ]
    subprocess.run([sys.executable, *install], check=True)
    theirs = next(home.glob("lib/python*/site-packages"))
    lenders = [each for each in sys.path if each.endswith(("site-packages", "dist-packages"))]
    lines = [f"import site; site.addsitedir({each!r})" for each in lenders]
    (theirs / "lent.pth").write_text("\n".join(lines) + "\n")
    return python.parent


def run(installed, folder, *words):
    clean = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    return subprocess.run(
        [str(installed / words[0]), *words[1:]],
        cwd=folder,
        env=clean,
        capture_output=True,
        text=True,
        check=False,
    )


def test_the_wheel_has_scene_templates_agents_types_and_licence_but_no_tests(wheel):
    with zipfile.ZipFile(wheel) as archive:
        names = set(archive.namelist())
    assert INSIDE - names == set()
    assert any(name.endswith("dist-info/licenses/LICENSE") for name in names)
    rooms = {name.split("/")[0] for name in names if "dist-info" not in name}
    assert rooms == {"arm2d", "evolution", "models", "mujoco_port", "wordarm.py"}
    # Every file of a package that git keeps is inside: nothing is left out by its ending.
    kept = {
        path.relative_to(ROOT).as_posix()
        for room in rooms - {"wordarm.py"}
        for path in (ROOT / room).rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }
    assert kept - names == set()


def test_packages_come_from_the_environment_and_not_from_the_checkout(installed, tmp_path):
    code = "import arm2d, evolution, models, mujoco_port as m, wordarm; print(evolution.__file__, m.__file__)"
    done = run(installed, tmp_path, "python", "-c", code)
    assert done.returncode == 0, done.stderr
    assert all(Path(place).is_relative_to(installed.parent) for place in done.stdout.split())


@pytest.mark.slow
def test_a_shipped_agent_is_evaluated_and_drawn_outside_the_checkout(installed, tmp_path):
    done = run(installed, tmp_path, "wordarm", "evaluate", "best-generaliser", "--trials-per-area=2")
    assert (done.returncode, done.stderr) == (0, "")
    assert any(path.suffix == ".png" for path in tmp_path.rglob("*"))


@pytest.mark.slow
def test_the_robot_s_scene_the_page_s_template_and_the_licence_are_found(installed, tmp_path):
    code = (
        "from evolution.report.bundle import licence; from models.build import build_model\n"
        "from models.robots import ROBOTS\n"
        "print(build_model(ROBOTS['icub']).nbody > 10, b'Apache License' in licence())"
    )
    done = run(installed, tmp_path, "python", "-c", code)
    assert done.stdout == "True True\n", done.stderr
    done = run(installed, tmp_path, "python", "-m", "evolution.player", "--output", "play.html")
    assert (done.returncode, done.stderr) == (0, "")
    assert (tmp_path / "play.html").stat().st_size > 50_000


@pytest.mark.slow
def test_the_doctor_examines_the_wheel_s_own_needs(installed, tmp_path):
    done = run(installed, tmp_path, "wordarm", "doctor")
    assert done.returncode in (0, 1), done.stderr  # 1 where the machine lacks OpenGL
    assert done.stdout.startswith("wordarm 0.")
    assert "mujoco" in done.stdout
    assert done.stderr == ""


def test_the_version_is_told_where_there_is_no_git(installed, tmp_path):
    done = subprocess.run(
        [installed / "wordarm", "--version"], cwd=tmp_path, env={"PATH": str(tmp_path)}, capture_output=True,
        text=True, check=False,
    )  # fmt: skip
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("wordarm 0.1.0, revision ")
