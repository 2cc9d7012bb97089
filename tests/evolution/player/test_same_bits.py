"""The page's JavaScript against the compiled kernel: the same bits at every step of every trial."""

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest

from arm2d import Condition, LabelChanges, Readings, Trials, draw_trials, record_trial
from arm2d.readings import PLAIN
from evolution.player.bundle import bundle
from tests.arm2d.kernel.test_kernel import ALTERNATIVES, changes_of, genotypes_of
from tests.evolution.player.node import NODE

TRIALS = 2000
WORLDS = [*map(PLAIN.with_values, ALTERNATIVES), Readings()]
PER_WORLD = -(-TRIALS // len(WORLDS))


def draw(place, evolved):
    """(genotype, trial, readings) of one of the worlds; in every third trial the words change."""
    readings = WORLDS[place]
    rng = np.random.default_rng([15, place])
    genotypes = genotypes_of(evolved, PER_WORLD, rng)
    rng.shuffle(genotypes)
    for condition in Condition:
        n = PER_WORLD // 2 + (condition is Condition.WITH_INDICATE) * (PER_WORLD % 2)
        drawn = draw_trials(condition.instructions, 3, readings, rng)[rng.permutation(54)[:n]]
        changes = LabelChanges(
            rng.permutation(drawn.actions),
            drawn.objects,
            drawn.actions,
            rng.integers(0, 3, n),
            rng.integers(0, 10, n),
        )
        changing = Trials(drawn.actions, drawn.objects, drawn.alpha, drawn.discs, changes)
        for t in range(n):
            yield (
                genotypes[t if condition is Condition.WITH_INDICATE else -1 - t],
                (changing if t % 3 == 0 else drawn)[t],
                readings,
            )


def job(genotype, trial, readings):
    """A trial as the page takes it."""

    def plain(instruction):
        return {"action": int(instruction.action), "object": int(instruction.object)}

    changes = changes_of(trial, 0)
    return {
        "genotype": genotype.tolist(),
        "readings": readings.to_mapping(),
        "start": {"alpha": float(trial.alpha[0]), "centres": trial.discs[0].tolist()},
        "instruction": plain(trial.instructions[0]),
        "changes": changes and {"first": plain(changes[0]), "later": plain(changes[1]), "delay": changes[2]},
    }


def replay(jobs, folder):
    """What the page makes of the trials: rows of states [K, 34] and of outcomes [T, 5]."""
    script, jobs_file = folder / "replay.js", folder / "jobs.json"
    own = Path(__file__).with_name("replay.js").read_text(encoding="utf-8")
    script.write_text(bundle("main") + own, encoding="utf-8")
    jobs_file.write_text(json.dumps(jobs), encoding="utf-8")
    subprocess.run([NODE, script, jobs_file, folder / "steps", folder / "outcomes"], check=True)
    steps = np.fromfile(folder / "steps").reshape(-1, 34)
    return steps, np.fromfile(folder / "outcomes").reshape(-1, 5)


def centres(bearings, distances):
    """As the kernel's recordings have them."""
    angles = np.radians(bearings)
    return np.stack([distances * np.cos(angles), distances * np.sin(angles)], axis=-1)


def assert_same_bits(record, rows):
    """A recording of the kernel and the page's rows [K + 1, 34] of the same trial."""
    unmoved = (rows[:, 7:13] == rows[0, 7:13]).reshape(-1, 2, 3).all(axis=1)[..., np.newaxis]
    pairs = {
        "alpha": (record.alpha, rows[:, 0]),
        "beta": (record.beta, rows[:, 1]),
        "turns": (record.turns, rows[1:, 2:4]),
        "states": (record.states, rows[1:, 4:7]),
        "discs": (record.discs, np.where(unmoved, record.discs[0], centres(rows[:, 7:10], rows[:, 10:13]))),
        "contact": (record.contact, rows[:, 13:16]),
        "inputs": (record.inputs, rows[1:, 16:34]),
    }
    for name, (kernel, page) in pairs.items():
        np.testing.assert_array_equal(kernel, page, err_msg=name)


@pytest.mark.slow
def test_page_and_kernel_give_the_same_bits_in_two_thousand_trials_of_all_readings(
    evolved, evolved_plain, tmp_path
):
    able = [evolved if world == Readings() else evolved_plain for world in WORLDS]
    drawn = [each for place, genotypes in enumerate(able) for each in draw(place, genotypes)]
    assert len(drawn) >= TRIALS
    steps, outcomes = replay([job(*each) for each in drawn], tmp_path)
    first = 0
    for each, (*outcome, n_steps) in zip(drawn, outcomes, strict=True):
        record = record_trial(*each)
        scores = record.scores
        assert [scores.f1[0, 0], scores.f2[0, 0], scores.f3[0, 0], record.success] == outcome
        assert record.steps == n_steps
        assert_same_bits(record, steps[first : first + record.steps + 1])
        first += record.steps + 1
    assert first == len(steps)
    # Enough succeeded, and so touched or moved objects, for the comparison to mean something.
    assert (outcomes[:, 3] == 1).sum() > 200
