"""Errors of libraries while they are imported are told; mistakes of ours are not passed off as theirs."""

import sys

import pytest

from evolution.answers import BAD_INPUT, answer
from evolution.unloadable import unloadable


@pytest.fixture
def stranger(tmp_path, monkeypatch):
    """Makes a library of some source, and imports it as a command would."""
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setattr(sys, "dont_write_bytecode", True)

    def load(source):
        (tmp_path / "strange").mkdir()
        (tmp_path / "strange" / "__init__.py").write_text("from strange import deep")
        (tmp_path / "strange" / "deep.py").write_text(source)
        import strange  # noqa: F401

        return 0

    yield load
    for name in ("strange", "strange.deep"):
        sys.modules.pop(name, None)


@pytest.mark.parametrize(
    ("source", "reason"),
    [
        ("{}['xx']", "KeyError: 'xx'"),
        ("int('abc')", "ValueError: invalid literal for int() with base 10: 'abc'"),
        ("def read():\n    open('/nowhere/settings')\nread()", "FileNotFoundError: [Errno 2] No such file"),
        ("import no_such_library", "ModuleNotFoundError: No module named 'no_such_library'"),
    ],
)
def test_a_library_that_fails_while_it_is_loaded_is_named_with_its_reason(source, reason, stranger, capsys):
    assert answer(lambda: stranger(source)) == BAD_INPUT
    said = capsys.readouterr().err
    assert said.startswith(f"wordarm: strange cannot be loaded ({reason}")
    assert "look at its settings: STRANGE_... in the environment" in said
    assert said.count("\n") == 1


def test_a_library_that_is_not_there_is_named(capsys):
    def command():
        import no_such_library  # noqa: F401

        return 0

    assert answer(command) == BAD_INPUT
    assert "no_such_library cannot be loaded (ModuleNotFoundError: No module" in capsys.readouterr().err


def test_a_mistake_that_is_made_when_all_is_loaded_is_nobody_elses(stranger):
    def command():
        stranger("def double(x):\n    return x['a']")
        import strange

        return strange.deep.double({})

    with pytest.raises(KeyError):
        answer(command)


def test_a_lack_of_memory_is_no_librarys_fault(stranger, capsys):
    assert answer(lambda: stranger("raise MemoryError")) == BAD_INPUT
    assert "the memory does not suffice" in capsys.readouterr().err
    assert unloadable(MemoryError()) is None
