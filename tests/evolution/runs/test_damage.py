import shutil

import numpy as np
import pytest

from evolution.runs.checkpoint import load_checkpoint
from evolution.runs.folder import RunFolder
from evolution.runs.recorded import recorded_history
from evolution.runs.run import Watcher, evolve
from evolution.runs.storage import DamagedFileError, read_arrays, write_arrays
from evolution.trust import repair as repair_module
from evolution.trust.repair import repair
from tests.evolution.small_runs import SMALL, contents

FIRST, SECOND, LAST = "gen-000000-000099.npz", "gen-000100-000199.npz", "gen-000200-000229.npz"


def truncate(path):
    path.write_bytes(path.read_bytes()[:-1000])


def flip(path):
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 4
    path.write_bytes(data)


def remove(path):
    path.unlink()


def empty(path):
    path.write_bytes(b"")


@pytest.mark.parametrize("part", [FIRST, SECOND, LAST])
@pytest.mark.parametrize("damage", [truncate, flip, empty])
def test_a_damaged_part_is_named_with_the_command_that_repairs(run_copy, part, damage):
    damage(run_copy / "parts" / part)
    first, last = int(part[4:10]), int(part[11:17])
    command = f"wordarm verify {run_copy} --repair"
    sentence = f"{part} is damaged .*; recompute generations {first} to {last} with: {command}"
    with pytest.raises(DamagedFileError, match=sentence):
        evolve(run_copy, SMALL)
    with pytest.raises(DamagedFileError, match=sentence):
        recorded_history(RunFolder.open(run_copy))


@pytest.mark.parametrize("part", [FIRST, SECOND])
def test_a_part_missing_before_others_is_named(run_copy, part):
    remove(run_copy / "parts" / part)
    with pytest.raises(DamagedFileError, match=rf"{part} is damaged \(it is missing\); recompute"):
        evolve(run_copy, SMALL)


@pytest.mark.parametrize("damage", [truncate, flip, remove])
def test_repaired_files_have_the_bits_they_had(finished_run, run_copy, damage):
    for name in (f"parts/{FIRST}", f"parts/{SECOND}", "champions.npz"):
        damage(run_copy / name)
    notes = []
    assert repair(run_copy, notes.append) == 3
    found = "it is missing" if damage is remove else "its checksum does not fit its content"
    assert notes == [
        f"{FIRST}: {found}; computed generations 0 to 99 again",
        f"{SECOND}: {found}; computed generations 100 to 199 again",
        f"champions.npz: {found}; chose them again",
    ]
    assert contents(run_copy) == contents(finished_run)
    assert repair(run_copy) == 0


def test_repair_computes_no_more_than_what_is_damaged(run_copy, monkeypatch):
    scored = []

    def spy(population, config):
        scored.append(population.generation)
        return score(population, config)

    score = repair_module.score_population
    monkeypatch.setattr(repair_module, "score_population", spy)
    flip(run_copy / "parts" / SECOND)
    repair(run_copy)
    assert scored == list(range(100, 200))


def stop_at_150(path):
    evolve(path, SMALL, Watcher(wants_stop=iter([False] * 150 + [True] * 2).__next__))
    assert len(recorded_history(RunFolder.open(path))) == 150


@pytest.mark.parametrize("damage", [truncate, flip, empty, remove])
def test_a_run_goes_on_from_its_parts_without_a_sound_checkpoint(finished_run, tmp_path, damage):
    stop_at_150(tmp_path / "run")
    damage(tmp_path / "run" / "checkpoint.npz")
    notes = []
    assert evolve(tmp_path / "run", SMALL, Watcher(on_note=notes.append)) == 230
    assert contents(tmp_path / "run") == contents(finished_run)
    assert len(notes) == (damage is not remove)


def test_a_run_whose_newest_parts_are_lost_computes_them_again(finished_run, tmp_path):
    path = shutil.copytree(finished_run, tmp_path / "run")
    remove(path / "parts" / LAST)
    remove(path / "parts" / SECOND)
    assert evolve(path, SMALL) == 230
    assert contents(path) == contents(finished_run)


def test_a_run_killed_between_part_and_checkpoint_goes_on(finished_run, tmp_path):
    stop_at_150(tmp_path / "run")
    shutil.copy(finished_run / "parts" / SECOND, tmp_path / "run" / "parts")
    assert evolve(tmp_path / "run", SMALL) == 230
    assert contents(tmp_path / "run") == contents(finished_run)


def test_a_run_killed_between_its_last_part_and_checkpoint_ends_like_any_other(finished_run, tmp_path):
    stop_at_150(tmp_path / "run")
    for name in (SECOND, LAST):
        shutil.copy(finished_run / "parts" / name, tmp_path / "run" / "parts")
    assert evolve(tmp_path / "run", SMALL) == 230
    assert contents(tmp_path / "run") == contents(finished_run)


def test_a_part_of_another_run_is_not_taken_for_one_of_this(run_copy, tmp_path):
    other = tmp_path / "other"
    shutil.copytree(run_copy, other)
    config = other / "config.toml"
    config.write_text(config.read_text().replace("seed = 11", "seed = 12"))
    with pytest.raises(DamagedFileError, match=r"it does not belong to this config.toml"):
        recorded_history(RunFolder.open(other))


def test_a_part_with_a_fitting_checksum_but_other_content_is_noticed(run_copy):
    path = run_copy / "parts" / SECOND
    arrays = read_arrays(path)
    write_arrays(path, {**arrays, "parents": arrays["parents"][::-1].copy()})
    remove(run_copy / "checkpoint.npz")
    with pytest.raises(DamagedFileError, match="generation 100 is not bred from the one before"):
        evolve(run_copy, SMALL)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lambda arrays: arrays.pop("fitness"), "it has no array fitness"),
        (
            lambda arrays: arrays.update(fitness=arrays["fitness"][:, :5].copy()),
            r"its fitness is float64 \(100, 5\), not float64 \(100, 10\)",
        ),
        (
            lambda arrays: arrays.update(generations=arrays["generations"] + 1),
            "its generations are not 100 to 199",
        ),
    ],
)
def test_a_part_of_another_shape_is_noticed(run_copy, change, sentence):
    path = run_copy / "parts" / SECOND
    arrays = read_arrays(path)
    change(arrays)
    write_arrays(path, arrays)
    with pytest.raises(DamagedFileError, match=sentence):
        RunFolder.open(run_copy).read_part(range(100, 200))


BEYOND = {
    **dict.fromkeys(("fitness", "best", "mean", "median", "worst"), (-1e-9, 3.0 + 1e-9, np.nan, np.inf)),
    "parents": (-2, 10),
    "best_genotypes": (-1e-9, 1.0 + 1e-9, np.nan),
}
NEXT_BEYOND = {
    "generation": (-1, 231),
    "next_parents": (-2, 10),
    "next_genotypes": (-1e-9, 1.0 + 1e-9, np.nan),
}


def cases_of(beyond):
    return [(name, value) for name, values in beyond.items() for value in values]


def put(path, name, value):
    """One number of an array becomes another, and the checksum fits."""
    arrays = read_arrays(path)
    arrays[name] = arrays[name].copy()
    arrays[name].reshape(-1)[-1] = value
    write_arrays(path, arrays)


@pytest.mark.parametrize(("name", "value"), cases_of(BEYOND))
def test_a_part_with_an_impossible_value_is_noticed_whatever_its_checksum_says(run_copy, name, value):
    put(run_copy / "parts" / SECOND, name, value)
    with pytest.raises(DamagedFileError, match=rf"its {name} are not all in \["):
        RunFolder.open(run_copy).read_part(range(100, 200))


@pytest.mark.parametrize(("name", "value"), cases_of(NEXT_BEYOND))
def test_a_checkpoint_with_an_impossible_value_is_noticed_too(run_copy, name, value):
    put(run_copy / "checkpoint.npz", name, value)
    with pytest.raises(DamagedFileError, match=rf"its {name} are not all in \["):
        load_checkpoint(RunFolder.open(run_copy))


def test_values_at_their_bounds_are_no_damage(run_copy):
    folder, span = RunFolder.open(run_copy), range(100, 200)
    for name, values in {"fitness": (0.0, 3.0), "parents": (-1, 9), "best_genotypes": (0.0, 1.0)}.items():
        for value in values:
            put(run_copy / "parts" / SECOND, name, value)
            assert getattr(folder.read_part(span), name).reshape(-1)[-1] == value


@pytest.mark.parametrize("text", ["", "seed = ", "\x00\xff", "format = 1"])
def test_a_damaged_config_is_named_with_the_way_out(run_copy, text):
    (run_copy / "config.toml").write_text(text, encoding="latin-1")
    with pytest.raises(ValueError, match=r"config.toml cannot be read: .*; remove it and repeat the command"):
        RunFolder.open(run_copy)


def test_a_lost_config_comes_back_with_the_command_that_started_the_run(finished_run, run_copy):
    remove(run_copy / "config.toml")
    assert evolve(run_copy, SMALL) == 230
    assert contents(run_copy) == contents(finished_run)


@pytest.mark.parametrize("damage", [truncate, flip, empty])
def test_a_repaired_checkpoint_is_that_of_the_end_of_the_parts(finished_run, run_copy, damage):
    damage(run_copy / "checkpoint.npz")
    assert repair(run_copy) == 1
    assert contents(run_copy) == contents(finished_run)
    for name in (LAST, SECOND):
        remove(run_copy / "parts" / name)
    damage(run_copy / "checkpoint.npz")
    notes = []
    assert repair(run_copy, notes.append) == 1
    assert notes[0].endswith("wrote that of the end of the parts, generation 100")
    remove(run_copy / "champions.npz")
    assert evolve(run_copy, SMALL) == 230
    assert contents(run_copy) == contents(finished_run)
