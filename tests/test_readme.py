"""What README and docs say is so: snippets run, links lead somewhere, commands parse."""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from evolution.cli import COMMANDS, parse

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
MAKEFILE = (ROOT / "Makefile").read_text(encoding="utf-8")
PAGES = [
    *(ROOT / name for name in ("README.md", "CHANGELOG.md", "CONTRIBUTING.md")),
    *sorted((ROOT / "docs").rglob("*.md")),
]


def python_of(page: Path) -> str:
    """All Python blocks of a page, one after the other."""
    return "\n".join(re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL))


def commands_of(page: Path) -> list[str]:
    """Lines of a page's code blocks that call wordarm."""
    return re.findall(r"^\s*(wordarm .*)$", page.read_text(encoding="utf-8"), re.MULTILINE)


def test_snippet_runs_as_printed(tmp_path):
    done = subprocess.run(
        [sys.executable, "-c", python_of(ROOT / "README.md")],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.startswith("0.698")  # as the comment beside it says
    assert (tmp_path / "move-green.mp4").stat().st_size > 10_000


def test_tour_of_the_api_runs_as_printed(tmp_path):
    subprocess.run(
        [sys.executable, "-c", python_of(ROOT / "docs" / "api.md")],
        cwd=tmp_path,
        env={**os.environ, "MPLBACKEND": "agg"},
        check=True,
    )
    made = {
        "touch-green.mp4",
        "touch-green.png",
        "fitness.png",
        "heat-map.png",
        "trajectories.svg",
        "mine.png",
    }
    assert made | {"mine.png"} <= {each.name for each in tmp_path.iterdir()}


def test_code_of_the_page_on_worlds_runs_as_printed(tmp_path):
    code = python_of(ROOT / "docs" / "worlds.md")
    subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, check=True)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_and_pictures_exist(page):
    links = re.findall(r"\]\(([^)#\s]+)", page.read_text(encoding="utf-8"))
    for link in links:
        if not link.startswith("https://"):
            assert (page.parent / link).exists(), link


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_commands_in_code_blocks_parse(page):
    for command in commands_of(page):
        # `$seed` stands for a number of the loop around it.
        parse(shlex.split(command.replace("$seed", "1"), comments=True)[1:])


def test_readme_shows_the_first_commands_and_a_page_all_of_them():
    def shown(page):
        return {command.split()[1] for command in commands_of(ROOT / page)}

    assert {"evolve", "evaluate", "behaviour", "port", "reproduce", "experiment"} == shown("README.md")
    assert set(COMMANDS) == shown("docs/commands.md")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_commands_and_options_named_in_the_text_exist(page):
    text = page.read_text(encoding="utf-8")
    for name in re.findall(r"`wordarm ([a-z]+)", text):
        with pytest.raises(SystemExit) as ended:
            parse([name, "--help"])
        assert ended.value.code == 0, name
    for name, value in re.findall(r"`--(readings\.[a-z0-9-]+) ([^`]+)`", text):
        parse(["evolve", f"--{name}", *value.split()])


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_make_targets_exist(page):
    text = page.read_text(encoding="utf-8")
    for target in re.findall(r"(?:^\s*|`)make ([a-z]+)", text, re.MULTILINE):
        assert re.search(rf"^{target}:", MAKEFILE, re.MULTILINE), target


def test_readme_speaks_of_the_run_that_the_demo_makes():
    (seed,) = re.findall(r"^DEMO_SEED \?= (\d+)$", MAKEFILE, re.MULTILINE)
    assert f"With-Indicate (seed {seed})" in README
    assert f"With-Ignore (seed {seed})" in README


def test_modules_named_in_the_docs_exist():
    for page in PAGES:
        for name in re.findall(
            r"`((?:arm2d|evolution|models|mujoco_port|tests)/[\w/.]+\.py)`", page.read_text(encoding="utf-8")
        ):
            assert (ROOT / name).is_file(), f"{page.name}: {name}"
