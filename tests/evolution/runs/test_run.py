import json
import os
import re
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from evolution.runs import meta
from evolution.runs.folder import RunFolder
from evolution.runs.lock import locked
from evolution.runs.recorded import recorded_generation, recorded_history
from evolution.runs.replay import population_at
from evolution.runs.run import Watcher, evolve
from evolution.search.population import first_population, next_population
from evolution.search.scoring import score_population
from evolution.search.settings import Settings
from tests.evolution.small_runs import SMALL, contents


def stopping_at(*generations):
    """A watcher that stops the run after each of these generations."""
    seen = []
    return Watcher(
        on_generation=lambda progress: seen.append(progress.generation),
        wants_stop=lambda: bool(seen) and seen[-1] in generations,
    )


def test_a_run_is_its_loop_written_out(finished_run):
    """Random genotypes; score, record, breed: nothing else happens to them."""
    history = recorded_history(RunFolder.open(finished_run))
    population = first_population(SMALL)
    places = np.arange(10) if SMALL.readings.ties == "elders" else -np.arange(10)
    for row in range(len(history)):
        fitness = score_population(population, SMALL)
        best = np.lexsort((places, -fitness))[:5]
        assert np.array_equal(history.fitness[row], fitness)
        assert np.array_equal(history.parents[row], population.parents)
        assert np.array_equal(history.best_genotypes[row], population.genotypes[best])
        population = next_population(population, fitness, SMALL)
    assert history.generations.tolist() == list(range(230))


def test_statistics_are_those_of_the_fitness(finished_run):
    history = recorded_history(RunFolder.open(finished_run))
    assert np.array_equal(history.best, history.fitness.max(axis=1))
    assert np.array_equal(history.worst, history.fitness.min(axis=1))
    assert np.array_equal(history.median, np.median(history.fitness, axis=1))
    np.testing.assert_allclose(history.mean, history.fitness.mean(axis=1), rtol=1e-14)


def test_the_same_run_twice_gives_the_same_bytes(finished_run, tmp_path):
    evolve(tmp_path / "again", SMALL)
    assert contents(tmp_path / "again") == contents(finished_run)


def test_another_seed_gives_another_run(finished_run, tmp_path):
    evolve(tmp_path / "other", replace(SMALL, seed=12), stopping_at(0))
    other = recorded_generation(RunFolder.open(tmp_path / "other"), 0)
    assert not np.array_equal(other.fitness, recorded_generation(RunFolder.open(finished_run), 0).fitness)


def test_resumed_run_equals_uninterrupted_run(finished_run, tmp_path):
    for generation in (0, 57, 98, 99, 100, 228):
        done = evolve(tmp_path / "run", SMALL, stopping_at(generation))
        assert done == generation + 1
    assert evolve(tmp_path / "run", SMALL) == 230
    assert contents(tmp_path / "run") == contents(finished_run)


def test_a_finished_run_is_left_as_it_is(run_copy):
    before, times = contents(run_copy), {each: each.stat().st_mtime_ns for each in run_copy.rglob("*.npz")}
    assert evolve(run_copy, SMALL) == 230
    assert contents(run_copy) == before
    assert all(each.stat().st_mtime_ns == time for each, time in times.items())


def test_any_population_is_rebuilt_from_seeds_and_fitness(finished_run):
    folder = RunFolder.open(finished_run)
    for generation in (0, 1, 99, 100, 229):
        population, scored = population_at(folder, generation), recorded_generation(folder, generation)
        assert np.array_equal(score_population(population, SMALL), scored.fitness[0])
        assert np.array_equal(population.parents, scored.parents[0])


def test_an_unfinished_run_can_be_read(tmp_path):
    evolve(tmp_path / "run", SMALL, stopping_at(149))
    folder = RunFolder.open(tmp_path / "run")
    assert len(recorded_history(folder)) == 150
    assert recorded_generation(folder, 149).generations.tolist() == [149]
    with pytest.raises(ValueError, match="has no generation 150; it has 150, numbered from 0"):
        recorded_generation(folder, 150)
    with pytest.raises(ValueError, match="has no generation 151"):
        population_at(folder, 151)


def test_a_second_process_is_refused_while_the_first_works(run_copy):
    with locked(run_copy), pytest.raises(ValueError, match=r"another process \(number \d+\) works on"):
        evolve(run_copy, SMALL)
    assert evolve(run_copy, SMALL) == 230


def test_another_configuration_is_refused_with_the_difference(run_copy):
    before = contents(run_copy)
    other = replace(SMALL, settings=Settings(population=80))
    with pytest.raises(
        ValueError, match=r"started with settings.population = 10, not 80; .*choose a new dir"
    ):
        evolve(run_copy, other)
    assert contents(run_copy) == before


def test_a_folder_with_other_things_is_refused_and_left_alone(tmp_path):
    (tmp_path / "letter.txt").write_text("dear")
    with pytest.raises(ValueError, match=r"holds letter.txt but no run; choose a new directory"):
        evolve(tmp_path, SMALL)
    assert [each.name for each in tmp_path.iterdir()] == ["letter.txt"]


def test_a_run_begun_anew_does_not_mind_what_commands_have_put_beside_its_files(tmp_path):
    """As the message about a damaged config.toml advises."""
    assert evolve(tmp_path / "run", SMALL, stopping_at(10)) == 11
    (tmp_path / "run" / "config.toml").unlink()
    (tmp_path / "run" / "videos").mkdir()
    (tmp_path / "run" / "report.html").write_text("a report")
    assert evolve(tmp_path / "run", SMALL, stopping_at(20)) == 21


def test_meta_tells_each_start_and_end(tmp_path):
    evolve(tmp_path / "run", SMALL, stopping_at(10))
    evolve(tmp_path / "run", SMALL, stopping_at(20))
    starts = json.loads((tmp_path / "run" / "meta.json").read_text())["starts"]
    assert [each["first_generation"] for each in starts] == [0, 11]
    assert [each["next_generation"] for each in starts] == [11, 21]
    assert all(each["started"] <= each["ended"] and each["cpu_seconds"] >= 0.0 for each in starts)
    assert {"started", "ended", "versions", "revision", "machine"} <= starts[0].keys()


@pytest.mark.usefixtures("git")
def test_asking_for_the_revision_leaves_the_index_alone(tmp_path):
    """A process killed while git has the index locked would leave the lock in the user's checkout."""
    package = tmp_path / "evolution"
    shutil.copytree(Path(meta.__file__).parents[1], package, ignore=shutil.ignore_patterns("__pycache__"))
    git = ("git", "-C", str(tmp_path), "-c", "user.name=a", "-c", "user.email=a@b")
    for arguments in (["init", "-q"], ["add", "."], ["commit", "-qm", "first"]):
        subprocess.run([*git, *arguments], check=True)
    index = tmp_path / ".git" / "index"
    before = index.stat().st_mtime_ns, index.stat().st_ino
    os.utime(
        package / "runs" / "run.py", (1, 1)
    )  # git would note in the index that it is unchanged all the same
    code = "from evolution.runs.meta import revision; print(revision())"
    environment = {**os.environ, "PYTHONPATH": str(tmp_path)}
    asked = [sys.executable, "-c", code]

    def revision():
        done = subprocess.run(
            asked, cwd=tmp_path, env=environment, capture_output=True, text=True, check=True
        )
        return done.stdout.strip()

    clean = revision()
    assert re.fullmatch("[0-9a-f]{12}", clean)
    assert (index.stat().st_mtime_ns, index.stat().st_ino) == before
    (package / "runs" / "run.py").write_text("changed")
    assert revision() == f"{clean}-dirty"
