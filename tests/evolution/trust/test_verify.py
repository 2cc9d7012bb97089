"""A run recomputed from its config.toml alone: what agrees, what differs, what cannot be read."""

import os

import numpy as np
import pytest

from evolution.cli import main
from evolution.runs.folder import RunFolder
from evolution.runs.lock import locked
from evolution.runs.run import Watcher, evolve
from tests.evolution.small_runs import SMALL

HOW = "parents, best genotypes and champions compared in all\n"


def verdict(capsys, path, *flags):
    """Exit code and last line of the command; the run must not have been touched by it."""
    before = {each: each.stat().st_mtime_ns for each in path.rglob("*")}
    code = main(["verify", str(path), *flags])
    assert {each: each.stat().st_mtime_ns for each in path.rglob("*")} == before
    return code, capsys.readouterr().out.splitlines(keepends=True)[-1]


def rewrite(path, name, change, part="parts/gen-000100-000199.npz"):
    """Change an array of a sound file, which stays sound."""
    folder = RunFolder.open(path)
    arrays = folder.read_arrays(path / part)
    change(arrays[name])
    folder.write_arrays(path / part, arrays)


def test_a_sound_run_agrees_in_every_generation(finished_run, capsys):
    told = f"{finished_run} agrees to the last bit: 230 of 230 generations scored again; {HOW}"
    assert verdict(capsys, finished_run) == (0, told)


@pytest.mark.parametrize(
    ("flags", "n"), [(["--generations=100-149"], 50), (["--generations=42"], 1), (["--sample=7"], 7)]
)
def test_chosen_generations_are_scored_and_the_others_bred(flags, n, finished_run, capsys):
    told = f"{finished_run} agrees to the last bit: {n} of 230 generations scored again; {HOW}"
    assert verdict(capsys, finished_run, *flags) == (0, told)


def test_the_first_generation_that_differs_is_named_with_both_values(run_copy, capsys):
    rewrite(run_copy, "fitness", lambda array: np.nextafter(array[23, 4:], 9, out=array[23, 4:]))
    found = RunFolder.open(run_copy).read_arrays(run_copy / "parts" / "gen-000100-000199.npz")["fitness"][
        23, 4
    ]
    code, told = verdict(capsys, run_copy)
    assert code == 1
    assert "in generation 123 genotype 4 has the fitness" in told
    assert f"fitness {float(found)!r}, but recomputed {float(np.nextafter(found, 0))!r}" in told


def test_an_altered_genotype_is_found_even_where_nothing_is_scored_again(run_copy, capsys):
    rewrite(run_copy, "best_genotypes", lambda array: array[50, 2].__setitem__(3, 0.5))
    code, told = verdict(capsys, run_copy, "--generations=0")
    assert (code, told) == (
        1,
        f"{run_copy} DIFFERS from what its config.toml gives: in generation 150 the array best_genotypes "
        "is another\n",
    )


def test_an_altered_fitness_outside_the_chosen_generations_is_found_by_what_it_breeds(run_copy, capsys):
    rewrite(run_copy, "fitness", lambda array: array[10].__setitem__(slice(None), array[10, ::-1]))
    code, told = verdict(capsys, run_copy, "--generations=229")
    assert code == 1
    assert "in generation 110" in told


def test_other_champions_and_another_next_population_are_found(run_copy, capsys):
    rewrite(run_copy, "successes", lambda array: np.add(array, 1, out=array), "champions.npz")
    assert "in champions.npz the array successes is another" in verdict(capsys, run_copy, "--sample=1")[1]
    rewrite(run_copy, "next_genotypes", lambda array: array[9].__setitem__(0, 0.5), "checkpoint.npz")
    assert "the next population in checkpoint.npz, of generation 230" in verdict(capsys, run_copy)[1]


def test_a_run_of_another_seed_differs_from_the_start(run_copy, capsys):
    other = run_copy.parent / "other"
    evolve(other, SMALL)
    config = (other / "config.toml").read_text().replace("seed = 11", "seed = 12")
    old = RunFolder.open(other)
    arrays = {path: old.read_arrays(path) for path in other.rglob("*.npz")}
    (other / "config.toml").write_text(config)
    for path, each in arrays.items():
        RunFolder.open(other).write_arrays(path, each)
    assert "DIFFERS from what its config.toml gives: in generation 0 " in verdict(capsys, other)[1]


def test_what_is_damaged_or_missing_is_named_with_its_repair_and_all_else_compared(run_copy, capsys):
    (run_copy / "parts" / "gen-000000-000099.npz").unlink()
    data = bytearray((run_copy / "parts" / "gen-000100-000199.npz").read_bytes())
    data[1000] ^= 1
    (run_copy / "parts" / "gen-000100-000199.npz").write_bytes(data)
    (run_copy / "champions.npz").unlink()
    assert main(["verify", str(run_copy), "--sample=1"]) == 1
    *_, first, second, third, last = capsys.readouterr().out.splitlines()
    repair = f"wordarm verify {run_copy} --repair"
    assert first.endswith(f"is damaged (it is missing); recompute generations 0 to 99 with: {repair}")
    assert second.endswith(f"does not fit its content); recompute generations 100 to 199 with: {repair}")
    assert third.endswith(f"champions.npz is damaged (it is missing); compute it again with: {repair}")
    assert last == f"{run_copy} is not whole: 3 files are missing or damaged; all else agrees, " + (
        "200 of 230 generations scored again"
    )
    assert main(["verify", str(run_copy), "--repair"]) == 0
    assert main(["verify", str(run_copy), "--sample=1"]) == 0


def test_a_stopped_run_is_compared_as_far_as_it_has_come(tmp_path, capsys):
    path, scored = tmp_path / "run", []
    watcher = Watcher(on_generation=scored.append, wants_stop=lambda: len(scored) == 130)
    evolve(path, SMALL, watcher)
    code, told = verdict(capsys, path)
    assert code == 0
    assert "agrees to the last bit so far, 130 of 230 generations: 130 of 130 generations scored" in told


def test_a_run_that_another_process_holds_or_nobody_may_write_is_verified(run_copy, capsys):
    with locked(run_copy):
        assert verdict(capsys, run_copy, "--sample=2")[0] == 0
    os.chmod(run_copy, 0o555)
    assert verdict(capsys, run_copy, "--sample=2")[0] == 0
    os.chmod(run_copy, 0o755)


@pytest.mark.parametrize(
    ("flags", "sentence"),
    [
        (["--generations=200-300"], "--generations 200-300 is no range of this run's; it has 0-229"),
        (["--generations=9-3"], "is no range of this run's"),
        (["--generations=all"], "--generations all is no range of this run's"),
        (["--sample=0"], "--sample 0 must lie in [1, 230], the run's generations"),
        (["--sample=2", "--generations=3"], "exclude each other; give one of them"),
        (["--sample=2", "--repair"], "leave --generations and --sample out"),
    ],
)
def test_bad_input_gets_one_sentence(flags, sentence, finished_run, capsys):
    assert main(["verify", str(finished_run), *flags]) == 2
    assert sentence in capsys.readouterr().err


def test_a_folder_without_a_run_is_named(tmp_path, capsys):
    assert main(["verify", str(tmp_path)]) == 2
    assert "holds no run" in capsys.readouterr().err
