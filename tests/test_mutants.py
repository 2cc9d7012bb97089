"""The faults of `make mutants`: what they are, where there are none, and that the tree is left alone."""

import ast
import re
import subprocess

import pytest

from scripts import trying_faults
from scripts.equivalents import key_of, reasons
from scripts.faults import faults_in
from scripts.mutants import all_mutants, sample_of, summary
from scripts.trying_faults import ROOT, Attempts, Copy, Mutant, name_of, read_rows, row_of

SOURCE = '''"""A number is 1 here."""
from typing import TYPE_CHECKING
if TYPE_CHECKING:
    LIMIT = 1

@decorated(3)
def clipped(value, low: "int | None" = 0, strict: bool = False) -> int:
    """Between 1 and 2."""
    # λ stands before what is found by its bytes
    if not strict and (value < low or value is None):
        raise ValueError(f"{value + 1} is below {low - 1}")
    total = max(value, -low)
    total += 2.5
    values[total] = 1
    return total * 3
'''
TINY_TEST = """
from arm2d.instructions import ActionWord


def test_touch_is_one():
    assert ActionWord.TOUCH == 1
"""


def changed(source):
    """Every changed line, with what was done to it."""
    for fault in faults_in(source.encode()):
        text = fault.put_into(source.encode()).decode()
        ast.parse(text)
        before, after = source.splitlines(), text.splitlines()
        assert before != after
        if fault.kind != "early return":
            yield fault.kind, next(line for line in after if line not in before).strip()


def test_faults_are_those_of_arithmetic_of_logic_and_of_what_is_left_out():
    assert set(changed(SOURCE)) == {
        ("number plus one", 'def clipped(value, low: "int | None" = 1, strict: bool = False) -> int:'),
        ("other truth value", 'def clipped(value, low: "int | None" = 0, strict: bool = True) -> int:'),
        ("not dropped", "if  strict and (value < low or value is None):"),
        ("or for and", "if not strict or (value < low or value is None):"),
        ("and for or", "if not strict and (value < low and value is None):"),
        ("other comparison", "if not strict and (value <= low or value is None):"),
        ("other comparison", "if not strict and (value < low or value is not None):"),
        ("condition negated", "if (not (not strict and (value < low or value is None))):"),
        ("statement dropped", "pass"),
        ("other function", "total = min(value, -low)"),
        ("- dropped", "total = max(value, low)"),
        ("other operator", "total -= 2.5"),
        ("number plus one", "total += 3.5"),
        ("number plus one", "values[total] = 2"),
        ("other operator", "return total / 3"),
        ("number plus one", "return total * 4"),
    }  # fmt: skip


@pytest.fixture(scope="module")
def found():
    return all_mutants()


def test_every_fault_of_every_module_is_python(found):
    assert len(found) > 5000
    assert len({each.row.what for each in found}) == len(found)
    for each in found[::40]:
        ast.parse(each.fault.put_into((ROOT / each.row.path).read_bytes()))
        assert each.row.before != each.row.after


def test_tests_of_every_module_exist(found):
    for test in {test for each in found for test in each.tests}:
        assert (ROOT / test).exists(), test


def test_a_sample_outlives_changes_of_the_sources(found):
    """A larger one begins with it, and of what is still there nothing else takes its place."""
    sample = sample_of(found, 1, 50)
    assert sample_of(found, 1, 80)[:50] == sample
    assert sample_of(found, 2, 50) != sample
    left = [each for each in found if each is not sample[10]]
    assert sample_of(left, 1, 49) == sample[:10] + sample[11:]


def test_what_is_called_equivalent_is_still_a_fault(found):
    keys = {key_of(each.row) for each in found}
    for key, reason in reasons().items():
        assert key in keys, f"{key[0]} holds no such line any more; remove it from equivalent.toml"
        assert len(reason.split()) > 4


def test_what_is_said_of_the_sample_is_what_its_rows_hold():
    rows = list(read_rows(ROOT / "tests" / "mutants" / "seed-1.csv").values())
    survivors = [row for row in rows if row.outcome == "survived"]
    page = " ".join((ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8").split())
    (said,) = re.findall(r"Of (\d+) faults of seed 1, (\d+) are noticed and (\d+) equivalent", page)
    assert tuple(map(int, said)) == (len(rows), len(rows) - len(survivors), len(survivors))


@pytest.fixture
def copy(tmp_path, git):
    """A copy whose only test is a tiny one."""
    (tmp_path / "copy").mkdir(mode=0o700)
    copy = Copy(tmp_path / "copy")
    (tmp_path / "copy" / "tree" / "tests" / "test_tiny.py").write_text(TINY_TEST)
    return copy


def mutants_in_line(line, kind):
    """The faults of one kind in a line of the instructions."""
    source = (ROOT / "arm2d" / "instructions.py").read_bytes()
    rows = [(row_of("arm2d/instructions.py", source, fault), fault) for fault in faults_in(source)]
    tests = ("tests/test_tiny.py",)
    return [
        Mutant(row, fault, tests) for row, fault in rows if (row.before.strip(), row.kind) == (line, kind)
    ]


@pytest.mark.slow
def test_what_is_tried_is_written_once_and_the_tree_is_left_alone(copy, tmp_path):
    status = ["git", "-C", str(ROOT), "status", "--porcelain"]
    before = subprocess.run(status, capture_output=True, check=True).stdout
    (noticed,) = mutants_in_line("TOUCH = 1", "number plus one")
    (survives,) = mutants_in_line("IGNORE = 3", "number plus one")
    output = tmp_path / "rows.csv"
    attempts = Attempts(output, [copy])
    for each in (noticed, survives):
        attempts.with_fault(each)
    rows = list(attempts.rows.values())
    assert [row.outcome for row in rows] == ["noticed", "survived"]
    assert rows[0].seen_by == "tests/test_tiny.py::test_touch_is_one"
    attempts.without_fault(rows)
    written = output.read_bytes()
    again = Attempts(output, [])  # no copy to try anything in
    again.with_fault(noticed)
    assert output.read_bytes() == written
    assert list(again.rows.values()) == rows
    assert subprocess.run(status, capture_output=True, check=True).stdout == before
    said = summary(rows, {}).splitlines()
    assert said[0] == "arm2d: 1 of 2 noticed"
    assert said[2:5] == [
        f"arm2d/instructions.py:{survives.row.line}: number plus one, survived",
        "-     IGNORE = 3",
        "+     IGNORE = 4",
    ]
    assert said[-1] == "1 of 2 noticed"
    said = summary(rows, {key_of(rows[1]): "a word that nobody counts"}).splitlines()
    assert said[0] == "arm2d: 1 of 1 noticed"
    assert said[2].endswith("number plus one, survived; equivalent: a word that nobody counts")
    assert said[-1] == "1 of 1 noticed; 1 more are equivalent"
    once_more = Attempts(output, [copy], again=True)
    assert [row.outcome for row in once_more.rows.values()] == ["noticed"]
    once_more.with_fault(survives)
    assert [row.outcome for row in Attempts(output, []).rows.values()] == ["noticed", "survived"]


@pytest.mark.slow
def test_a_test_that_fails_without_any_fault_is_no_witness(copy, tmp_path):
    (noticed,) = mutants_in_line("TOUCH = 1", "number plus one")
    attempts = Attempts(tmp_path / "rows.csv", [copy])
    attempts.with_fault(noticed)
    (tmp_path / "copy" / "tree" / "tests" / "test_tiny.py").write_text(TINY_TEST.replace("== 1", "== 7"))
    with pytest.raises(SystemExit, match="test_touch_is_one: fails without any fault; put this right"):
        attempts.without_fault(list(attempts.rows.values()))


@pytest.mark.slow
def test_a_fault_with_which_a_test_does_not_end_is_too_slow(copy, tmp_path, monkeypatch):
    monkeypatch.setattr(trying_faults, "LIMIT", 3.0)
    endless = TINY_TEST.replace("assert ActionWord", "while ActionWord").replace("== 1", "== 2: pass")
    (tmp_path / "copy" / "tree" / "tests" / "test_tiny.py").write_text(endless)
    (fault,) = mutants_in_line("TOUCH = 1", "number plus one")
    outcome, _, seen_by = copy.attempt(fault)
    assert (outcome, seen_by) == ("too slow", "")


def test_a_test_is_known_by_its_name_whatever_its_message():
    assert (
        name_of("FAILED tests/test_a.py::test_b[one two] - ValueError: 1 - 2\n")
        == "tests/test_a.py::test_b[one two]"
    )
    assert name_of("ERROR tests/test_a.py\n") == "tests/test_a.py"
