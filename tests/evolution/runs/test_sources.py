import io

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from arm2d import Condition, Readings
from evolution.runs import arrays, sources
from evolution.runs.folder import RunFolder
from evolution.runs.recorded import recorded_generation, recorded_history
from evolution.runs.replay import population_at
from evolution.runs.run import Watcher, evolve
from evolution.runs.sources import find_agent
from tests.evolution.small_runs import SMALL

GENOTYPES = np.random.default_rng(0).random((3, 84))


def test_a_finished_run_means_its_champion(finished_run):
    with np.load(finished_run / "champions.npz") as arrays:
        champions = arrays["genotypes"]
    assert np.array_equal(find_agent(str(finished_run)).genotype, champions[0])
    assert np.array_equal(find_agent(str(finished_run), rank=4).genotype, champions[4])
    assert find_agent(str(finished_run)).readings == SMALL.readings


def test_an_unfinished_run_means_the_best_of_its_newest_generation(tmp_path):
    evolve(tmp_path / "run", SMALL, Watcher(wants_stop=iter([False] * 30 + [True]).__next__))
    history = recorded_history(RunFolder.open(tmp_path / "run"))
    source = find_agent(str(tmp_path / "run"))
    assert np.array_equal(source.genotype, history.best_genotypes[-1, 0])
    assert source.origin == "with-indicate, seed 11, generation 29, rank 0"


def test_every_rank_of_a_generation_can_be_had(finished_run):
    folder = RunFolder.open(finished_run)
    scored, population = recorded_generation(folder, 123), population_at(folder, 123)
    order = np.argsort(-scored.fitness[0], kind="stable")
    for rank in range(10):
        genotype = find_agent(str(finished_run), generation=123, rank=rank).genotype
        assert np.array_equal(genotype, population.genotypes[order[rank]])


@pytest.mark.parametrize("name", ["genotypes", "genotype"])
def test_a_bare_file_means_default_readings_and_the_condition_given(tmp_path, name):
    np.savez(tmp_path / "mine.npz", **{name: GENOTYPES})
    source = find_agent(str(tmp_path / "mine.npz"), rank=2, condition=Condition.WITH_IGNORE)
    assert np.array_equal(source.genotype, GENOTYPES[2])
    assert source.condition is Condition.WITH_IGNORE
    assert source.readings == Readings()
    np.save(tmp_path / "one.npy", GENOTYPES[1])
    source = find_agent(str(tmp_path / "one.npy"))
    assert np.array_equal(source.genotype, GENOTYPES[1])
    assert source.condition is Condition.WITH_INDICATE


def test_a_shipped_champion_is_found_by_its_name(tmp_path, monkeypatch, finished_run):
    (tmp_path / "champions").mkdir()
    (tmp_path / "champions" / "hero.npz").write_bytes((finished_run / "champions.npz").read_bytes())
    monkeypatch.setattr(sources, "SHIPPED", tmp_path / "champions")
    assert find_agent("hero").readings == SMALL.readings
    with pytest.raises(ValueError, match=r"there is no 'villain'; .* or a shipped champion \(hero\)"):
        find_agent("villain")


def saved(array, **options):
    file = io.BytesIO()
    np.save(file, array, **options)
    return file.getvalue()


def packed(**arrays):
    file = io.BytesIO()
    np.savez(file, **arrays)
    return file.getvalue()


@pytest.mark.parametrize(
    ("data", "sentence"),
    [
        (b"", "is not a genotype file"),
        (b"PK\x03\x04", "is not a genotype file"),
        (b"dear reader", "is not a genotype file"),
        (saved(np.zeros(83)), r"shape \(83,\), this controller needs \[P, 84\]: 75 weights"),
        (saved(np.full(84, np.nan)), "gene 0 of genotype 0 is nan; genes lie in"),
        (saved(np.full(84, 1.5)), "gene 0 of genotype 0 is 1.5; genes lie in"),
        (saved(np.full(84, "x")), "could not convert"),
        (
            saved(np.array([{}] * 84), allow_pickle=True),
            "is not a genotype file.*it holds object, not numbers or text",
        ),
        (packed(other=GENOTYPES), "has no array genotypes; it has other"),
        (packed(genotypes=GENOTYPES, config=np.array("speed")), "carries a config that cannot be read"),
    ],
)
def test_an_unsound_file_is_refused_with_what_would_be_right(tmp_path, data, sentence):
    (tmp_path / "mine").write_bytes(data)
    with pytest.raises(ValueError, match=sentence):
        find_agent(str(tmp_path / "mine"))


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"generation": 230}, "has no generation 230; it has 230, numbered from 0"),
        ({"generation": -1}, "has no generation -1"),
        ({"generation": 3, "rank": 10}, "rank 10 does not exist; the generation has ranks 0 to 9"),
        ({"rank": 5}, "rank 5 does not exist in .*champions.npz; there are 5, numbered from 0"),
        ({"condition": Condition.WITH_IGNORE}, "belongs to with-indicate, not with-ignore"),
    ],
)
def test_what_a_run_does_not_have_is_named(finished_run, options, sentence):
    with pytest.raises(ValueError, match=sentence):
        find_agent(str(finished_run), **options)


def test_a_file_has_no_generations(tmp_path):
    np.save(tmp_path / "one.npy", GENOTYPES)
    with pytest.raises(ValueError, match="generation 3 needs a run folder"):
        find_agent(str(tmp_path / "one.npy"), generation=3)


def test_a_file_that_would_fill_the_memory_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(arrays, "LARGEST_CONTENT", 10_000)
    np.savez_compressed(tmp_path / "bomb.npz", genotypes=np.zeros((1000, 84)))
    with pytest.raises(ValueError, match="its content is larger than"):
        find_agent(str(tmp_path / "bomb.npz"))
    np.save(tmp_path / "large.npy", np.zeros((1000, 84)))
    with pytest.raises(ValueError, match="it is larger than"):
        find_agent(str(tmp_path / "large.npy"))


SOUND = packed(genotypes=GENOTYPES)


@given(
    st.binary(max_size=300)
    | st.tuples(st.integers(0, len(SOUND) - 1), st.binary(min_size=1, max_size=8)).map(
        lambda change: SOUND[: change[0]] + change[1] + SOUND[change[0] + len(change[1]) :]
    )
    | st.integers(0, len(SOUND)).map(lambda length: SOUND[:length])
)
def test_whatever_a_file_holds_it_is_read_or_refused_plainly(tmp_path_factory, data):
    path = tmp_path_factory.mktemp("fuzz") / "mine.npz"
    path.write_bytes(data)
    try:
        source = find_agent(str(path))
    except ValueError:
        return
    assert source.genotype.shape == (84,)
    assert ((source.genotype >= 0.0) & (source.genotype <= 1.0)).all()
