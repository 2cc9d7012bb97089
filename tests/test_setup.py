"""The scripts of the first hour: what is missing is named at once, and the demo goes on without drawing."""

import json
import os
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
# What the scripts themselves call; every system has these.
TOOLS = ("sh", "id", "dirname", "wc", "tr", "env")
# EGL finds no driver, as on a machine without OpenGL.
NO_DRAWING = {"__EGL_VENDOR_LIBRARY_DIRS": "/nonexistent", "__EGL_VENDOR_LIBRARY_FILENAMES": ""}


@pytest.fixture
def bare(tmp_path):
    """A folder of commands with the tools of a minimal system alone."""
    folder = tmp_path / "bin"
    folder.mkdir()
    for tool in TOOLS:
        (folder / tool).symlink_to(shutil.which(tool))
    return folder


def missing(folder):
    """What set-up says is missing, with these commands alone."""
    done = subprocess.run(
        ["/bin/sh", "scripts/setup.sh", "--missing"],
        cwd=ROOT, env={"PATH": str(folder)}, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stderr.splitlines()


def test_all_that_is_missing_is_named_in_one_line_that_can_be_copied(bare):
    first, *rest = missing(bare)
    assert first.startswith(
        "wordarm: this system lacks 7 packages; on Debian or Ubuntu: sudo apt-get install "
    )
    named = first.split("apt-get install ")[1].split()
    assert named == ["python3", "python3-venv", "git", "libgomp1", "libegl1", "libgl1", "libgl1-mesa-dri"]
    assert [line.split(":")[1].strip() for line in rest] == named[:5]


def test_what_is_there_is_not_named(bare):
    (bare / "python3").symlink_to(sys.executable)
    text = "\n".join(missing(bare))
    assert "python3 " not in text
    assert "git" in text


def test_the_page_on_installing_names_what_set_up_looks_for():
    page = (ROOT / "docs" / "install.md").read_text(encoding="utf-8")
    (line,) = [line for line in page.splitlines() if line.startswith("sudo apt-get install ")]
    script = (ROOT / "scripts" / "setup.sh").read_text(encoding="utf-8")
    packages = set(line.removeprefix("sudo apt-get install ").split())
    assert packages - {"make"} == {
        "git", "python3", "python3-venv", "libgomp1", "libegl1", "libgl1", "libgl1-mesa-dri",
    }  # fmt: skip
    for package in packages - {"make"}:
        assert package in script
    container = (ROOT / "Containerfile").read_text(encoding="utf-8")
    assert all(package in container for package in packages)


def test_the_page_on_installing_has_a_row_for_every_extra():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    page = (ROOT / "docs" / "install.md").read_text(encoding="utf-8")
    for extra in project["optional-dependencies"]:
        assert f"| `{extra}` |" in page, extra


@pytest.mark.slow
def test_the_demo_goes_on_to_the_figures_where_nothing_can_be_drawn(tmp_path):
    """With evolutions of a few generations in the place of the long ones."""
    commands = tmp_path / "bin"
    commands.mkdir()
    short = "[settings]\\ngenerations = 30\\npopulation = 20\\nelites = 2\\nparents = 10\\n"
    (commands / "wordarm").write_text(
        f"#!/bin/sh\ncase $1 in experiment) printf '{short}' >> \"$2\" ;; esac\n"
        f'exec {sys.executable} -P -m wordarm "$@"\n'
    )
    (commands / "python").write_text(f'#!/bin/sh\nexec {sys.executable} "$@"\n')
    for command in commands.iterdir():
        command.chmod(0o755)
    path = f"{commands}:{os.environ['PATH']}"
    done = subprocess.run(
        ["/bin/sh", "scripts/demo.sh", str(tmp_path / "demo"), "13"],
        cwd=ROOT, env={**os.environ, **NO_DRAWING, "PATH": path}, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert done.stderr.startswith("wordarm: the robot cannot be drawn here: ")
    for condition in ("with-indicate", "with-ignore"):
        assert (tmp_path / "demo" / condition / "fitness.png").is_file()
        assert f"demo/{condition}/champion-heat-map.png" in done.stdout
    assert not list((tmp_path / "demo").glob("*.mp4"))
    assert done.stdout.splitlines()[-2].startswith("There are no films, since the robot cannot be drawn here")


def test_the_citation_the_archive_s_record_and_the_package_agree():
    record = json.loads((ROOT / ".zenodo.json").read_text(encoding="utf-8"))
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert (record["version"], record["license"]) == (project["version"], project["license"])
    assert record["keywords"] == project["keywords"]
    for text in (f"version: {record['version']}", f"license: {record['license']}", record["title"]):
        assert text in citation
    assert all(f"name: {creator['name']}" in citation for creator in record["creators"])
    assert all(f"doi: {related['identifier']}" in citation for related in record["related_identifiers"])
