"""Every recipe and explanation runs as it is printed, block after block."""

import shlex

import matplotlib
import pytest

from arm2d import Condition, Readings
from evolution import find_agent
from evolution.cli import main
from tests.docs.pages import DOCS, Block, blocks, matches, python_of

# Run by tests/test_readme.py.
ELSEWHERE = ("api.md", "worlds.md")
RECIPES = [page for page in sorted(DOCS.rglob("*.md")) if page.name not in ELSEWHERE and python_of(page)]
WANTED = {
    "resume",
    "reading",
    "reinforcement-learning",
    "cluster",
    "algorithm",
    "instruction",
    "object",
    "sense",
    "size",
    "robot",
    "figure",
    "task",
}


def test_every_recipe_has_code():
    assert {page.stem for page in RECIPES if page.parent.name == "how-to"} == WANTED


@pytest.mark.parametrize("page", RECIPES, ids=lambda page: page.stem)
def test_code_runs_as_printed(page, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    code = python_of(page)
    if "matplotlib" in code:
        matplotlib.use("agg")
    exec(compile(code, page.name, "exec"), {"__name__": "__main__"})
    printed = capsys.readouterr().out
    for before, block in zip(blocks(page), blocks(page)[1:], strict=False):
        if (before.language, block.language) == ("python", "text"):
            assert block.text in printed


def test_an_agent_found_without_a_run_takes_its_world_along(tmp_path, monkeypatch):
    """As the page saves it, in a world that is not the usual one."""
    monkeypatch.chdir(tmp_path)
    page = blocks(DOCS / "how-to" / "algorithm.md")
    (code,) = [block.text for block in page if block.language == "python" and "np.savez" in block.text]
    usual = "arm2d.Condition.WITH_INDICATE, arm2d.Readings()"
    assert usual in code
    other = "arm2d.Condition.WITH_IGNORE, arm2d.Readings(object_radius=5.0)"
    exec(code.replace(usual, other).replace("range(10)", "range(1)"), {"__name__": "__main__"})
    agent = find_agent("mine.npz")
    assert (agent.condition, agent.readings) == (Condition.WITH_IGNORE, Readings(object_radius=5.0))


def test_a_cluster_is_looked_at_before_it_is_used(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "geometry.toml").write_bytes((DOCS / "examples" / "geometry.toml").read_bytes())
    (command,) = [line for line in _commands(blocks(DOCS / "how-to" / "cluster.md")) if "--dry-run" in line]
    assert main(shlex.split(command)[1:]) == 0
    said = capsys.readouterr().out
    assert "64 runs" in said
    assert "#SBATCH" in said


def test_three_dots_stand_for_lines():
    assert matches("a\n...\nd\n", "a\nb \nc\nd\n")
    assert matches("a\n...\nd\n", "a\nd\n")
    assert not matches("a\n...\nd\n", "a\nb\nc\n")
    assert not matches("a\n", "a\nb\n")


def _commands(of: list[Block]) -> list[str]:
    return [line for block in of if block.language == "sh" for line in block.text.splitlines()]
