"""The factorial study: a balanced draw of all readings at once, rows of runs as they come."""

import csv
import re
from itertools import combinations, pairwise
from pathlib import Path

import numpy as np
import pytest

from arm2d import Condition, Readings
from arm2d.device.opening import CHECK
from arm2d.readings import PLAIN, choices
from evolution.cli import main
from evolution.experiments.device.jobs import DeviceShares
from evolution.runs.folder import RunFolder
from evolution.runs.interrupt import StopRequest
from evolution.study.declared.factors import FACTORS, balanced_worlds, levels_of, world_of
from evolution.study.declared.parts import factorial, is_held_back
from evolution.study.declared.plan import RowFile, carry_out
from evolution.study.declared.rows import COUNTS, measured_run, read_rows, write_rows
from tests.evolution.runs.golden import ALTERNATIVES

DOCS = Path(__file__).parents[4] / "docs"


def met(worlds, *factors):
    """How often each combination of the factors' levels occurs."""
    order = [each.name for each in FACTORS]
    counts = np.zeros([len(each.levels) for each in factors], int)
    for world in worlds:
        found = levels_of(world)
        counts[tuple(list(f.levels).index(found[order.index(f.name)]) for f in factors)] += 1
    return counts


def test_every_alternative_of_the_ledger_is_a_level():
    drawn = {(name, getattr(world, name)) for world in factorial().names for name in world.to_mapping()}
    listed = {(name, value) for name, values in ALTERNATIVES.items() for value in values}
    words = {(name, value) for name, allowed in choices().items() for value in allowed}
    defaults = {(name, getattr(Readings(), name)) for name in Readings().to_mapping()}
    assert listed | words | defaults <= drawn


def test_plain_readings_are_the_first_level_of_every_factor():
    assert world_of([next(iter(each.levels)) for each in FACTORS]) == PLAIN
    assert levels_of(PLAIN) == tuple(next(iter(each.levels)) for each in FACTORS)


@pytest.mark.parametrize("first", [40, 150, 300])
def test_levels_meet_equally_often_in_the_whole_and_in_the_first_worlds(first):
    for factor in FACTORS:
        assert np.ptp(met(list(factorial().names)[:first], factor)) <= 2


@pytest.mark.parametrize(("first", "most"), [(150, 0.2), (300, 0.1)])
def test_pairs_of_levels_meet_equally_often(first, most):
    """None is off its share by more than a tenth of it in the whole, a fifth in what both conditions meet."""
    for one, other in combinations(FACTORS, 2):
        counts = met(list(factorial().names)[:first], one, other)
        share = first / counts.size
        assert np.abs(counts - share).max() <= most * share + 1e-9, (one.name, other.name)


def test_draw_is_the_same_again_and_another_with_another_seed():
    assert balanced_worlds(12, 13) == tuple(factorial().names)[:12]
    assert balanced_worlds(12, 14) != tuple(factorial().names)[:12]


def test_worlds_that_readings_refuse_are_passed_over():
    wide = [*FACTORS[:2], type(FACTORS[0])("width", {"10": {}, "too wide": {"sector_half_width": 31.0}})]
    assert {world.sector_half_width for world in balanced_worlds(12, 1, wide)} == {10.0}


def test_both_conditions_meet_the_first_150_worlds_with_the_same_seeds():
    configs = factorial().configs
    assert [sum(c.condition is which for c in configs) for which in Condition] == [300, 150]
    assert len(set(configs)) == 450
    for one, other in list(zip(configs[::2], configs[1::2], strict=True))[:150]:
        assert (one.seed, one.readings) == (other.seed, other.readings)
        assert (one.condition, other.condition) == tuple(Condition)
    assert all(a.seed <= b.seed for a, b in pairwise(configs))
    assert sum(is_held_back(each) for each in configs) == 90


def test_declaration_lists_every_factor_and_level():
    page = (DOCS / "declaration.md").read_text(encoding="utf-8")
    table = page[page.index("| factor | levels") :].split("\n\n")[0]
    named = set(re.findall(r"`(\w+)`", table))
    assert named == set(Readings().to_mapping())
    for factor in FACTORS:
        if factor.name == "mutation" or factor.name in (
            "parent_scaling",
            "object_radius",
            "tau_exponent_max",
        ):
            assert ", ".join(factor.levels) in table


@pytest.fixture(scope="module")
def studied(tmp_path_factory):
    """The first worlds of a study of very short runs, stopped when some of them are measured."""
    folder = tmp_path_factory.mktemp("study")
    part = factorial(30)
    few = type(part)(part.name, part.configs[:4], part.names)
    rows = RowFile(folder / "rows.csv", few)
    with StopRequest() as stop:
        assert carry_out(rows, folder / "factorial", 2, stop) == ()
    return folder, rows


def test_every_run_has_a_row_as_soon_as_it_is_measured(studied):
    folder, rows = studied
    assert tuple(rows.read()) == rows.part.configs
    plan = rows.plan(folder / "factorial")
    for config, run in rows.read().items():
        again = measured_run(RunFolder.open(plan.path(config)))
        assert (again.config, again.plateau, again.counts) == (config, run.plateau, run.counts)
        np.testing.assert_array_equal(again.successes, run.successes)


def test_a_device_gives_the_rows_that_the_processor_gives(studied, tmp_path):
    pytest.importorskip("warp", reason="the extra gpu is not installed")
    _, rows = studied
    one = type(rows.part)(rows.part.name, rows.part.configs[:1], rows.part.names)
    there = RowFile(tmp_path / "rows.csv", one)
    with StopRequest() as stop:
        shares = DeviceShares((CHECK,), 1)
        assert carry_out(there, tmp_path / "factorial", 1, stop, shares=shares) == ()
    assert there.path.read_text().splitlines() == rows.path.read_text().splitlines()[:2]


def test_runs_whose_row_is_there_are_not_evolved_again(studied, tmp_path):
    _, rows = studied
    plan = rows.plan(tmp_path / "elsewhere")
    assert plan.chains() == []
    assert all(each.done for each in plan.standings())
    two = RowFile(tmp_path / "rows.csv", rows.part)
    two.add(list(rows.read().values())[1:3])
    chains = two.plan(tmp_path / "elsewhere").chains()
    assert [[job.stage for job in chain] for chain in chains] == [["evolving", "measuring"]] * 2
    assert [chain[0].name for chain in chains] == [
        "world-001, with-indicate, seed 1001",
        "world-002, with-ignore, seed 1002",
    ]


def test_rows_are_read_back_as_they_were_written(studied, tmp_path):
    _, rows = studied
    found = list(rows.read().values())
    write_rows(found, tmp_path / "again.csv")
    assert (tmp_path / "again.csv").read_bytes() == rows.path.read_bytes()
    back = read_rows(tmp_path / "again.csv")
    assert [each.config for each in back] == [each.config for each in found]
    assert set(back[0].counts) == set(COUNTS)


def test_row_of_another_world_is_refused(studied, tmp_path):
    _, rows = studied
    lines = list(csv.reader(rows.path.read_text(encoding="utf-8").splitlines()))
    place = lines[0].index("crossover")
    lines[1][place] = "0.25"
    other = RowFile(tmp_path / "other.csv", rows.part)
    other.path.write_text("\n".join(",".join(f'"{v}"' for v in line) for line in lines), encoding="utf-8")
    with pytest.raises(ValueError, match="has a row of with-indicate, seed 1001, that is no run of the part"):
        other.read()


def test_file_that_holds_no_rows_is_refused_in_one_sentence(tmp_path, capsys):
    (tmp_path / "rows.csv").write_text("plateau\n2.5\n", encoding="utf-8")
    command = ["study", "readings", "--part=factorial", f"--rows={tmp_path / 'rows.csv'}"]
    assert main([*command, f"--output={tmp_path / 'out'}"]) == 2
    assert "is no file of measured rows of this version" in capsys.readouterr().err
    assert main([*command, "--seeds=3"]) == 2
    assert "every run of the part factorial has its seed" in capsys.readouterr().err
