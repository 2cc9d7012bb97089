"""What README and docs say is so: the snippet runs, links lead somewhere, commands exist."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]


def test_snippet_runs_as_printed():
    (snippet,) = re.findall(r"```python\n(.*?)```", README, re.DOTALL)
    done = subprocess.run([sys.executable, "-c", snippet], capture_output=True, text=True, check=True)
    assert "MOVE Blue" in done.stdout


def test_tour_of_the_api_runs_as_printed(tmp_path):
    tour = "\n".join(re.findall(r"```python\n(.*?)```", (ROOT / "docs/api.md").read_text(), re.DOTALL))
    subprocess.run(
        [sys.executable, "-c", tour], cwd=tmp_path, env={**os.environ, "MPLBACKEND": "agg"}, check=True
    )
    assert (tmp_path / "touch-green.mp4").stat().st_size > 10_000


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_and_pictures_exist(page):
    links = re.findall(r"\]\(([^)#\s]+)", page.read_text(encoding="utf-8"))
    for link in links:
        if not link.startswith("https://"):
            assert (page.parent / link).exists(), link


def test_commands_of_the_readme_exist():
    subcommands = set(re.findall(r"^wordarm (\w+)", README, re.MULTILINE))
    assert {"evolve", "evaluate", "port"} <= subcommands
    help_text = subprocess.run(
        [sys.executable, "-m", "evolution", "--help"], capture_output=True, text=True, check=True
    ).stdout
    assert all(name in help_text for name in subcommands)


def test_make_targets_of_the_readme_exist():
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    for target in re.findall(r"^make (\w+)", README, re.MULTILINE):
        assert re.search(rf"^{target}:", makefile, re.MULTILINE), target


def test_modules_named_in_the_docs_exist():
    for page in PAGES:
        for name in re.findall(
            r"`((?:arm2d|evolution|models|mujoco_port|tests)/[\w/.]+\.py)`", page.read_text()
        ):
            assert (ROOT / name).is_file(), f"{page.name}: {name}"
