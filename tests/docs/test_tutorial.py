"""The tutorial: its commands, given in its order in an empty folder, print what it shows."""

import shlex

import pytest

from evolution.cli import main
from tests.docs.pages import DOCS, blocks, matches

PAGE = DOCS / "tutorial.md"
# Films have tests of their own, and take a quarter of the tutorial's time.
SKIPPED = ("port",)


@pytest.mark.slow
def test_commands_print_what_is_shown(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")
    shown = blocks(PAGE)
    (tmp_path / "steps.toml").write_text(next(each.text for each in shown if each.language == "toml"))
    compared = 0
    for block, after in zip(shown, [*shown[1:], None], strict=True):
        if block.language != "sh":
            continue
        for line in block.text.splitlines():
            command = shlex.split(line)[1:]
            if command[0] in SKIPPED:
                continue
            capsys.readouterr()
            assert main(command) == 0, line
        if after is not None and after.language == "text":
            printed = capsys.readouterr().out
            assert matches(after.text, printed), printed
            compared += 1
    assert compared == 5
    assert (tmp_path / "comparison" / "comparison.csv").is_file()
    assert (tmp_path / "runs" / "steps" / "default" / "report.html").is_file()
