import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from arm2d import Condition, Readings
from arm2d.readings import PLAIN
from evolution.search.config import FORMAT, RunConfig
from evolution.search.settings import Settings

OTHER = RunConfig(
    Condition.WITH_IGNORE,
    2**63 - 1,
    Settings(population=20, elites=0, parents=20, generations=7),
    Readings(object_radius=0.1 + 0.2, sector_centres=(45.0, 90.0, 135.0), turn="radians"),
)


@pytest.mark.parametrize("config", [RunConfig(), OTHER])
def test_reading_a_written_config_gives_it_back(config):
    assert RunConfig.from_toml(config.to_toml()) == config


def test_defaults_are_the_papers():
    settings = Settings()
    assert (settings.population, settings.elites, settings.parents) == (100, 3, 50)
    assert (settings.generations, settings.trials_per_area) == (6000, 2)


def test_a_missing_setting_has_its_default_and_a_missing_reading_is_the_plain_one():
    text = f'format = {FORMAT}\ncondition = "with-ignore"\nseed = 3\n'
    assert RunConfig.from_toml(text) == RunConfig(Condition.WITH_IGNORE, 3, readings=PLAIN)


def test_differences_are_named_with_both_values():
    other = RunConfig(seed=4, settings=Settings(population=80))
    assert RunConfig(seed=3).differences(other) == ["seed = 3, not 4", "settings.population = 100, not 80"]
    assert RunConfig().differences(RunConfig()) == []


HEAD = f'format = {FORMAT}\ncondition = "with-indicate"\nseed = 3\n'


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("seed 3", "this is not TOML: "),
        ("", "format is missing; a run needs format, condition and seed"),
        (f"{HEAD}speed = 3", "unknown key 'speed'; there are format, condition, seed, task, settings"),
        (HEAD.replace("= 1\n", "= 2\n", 1), "format 2 is not known here; this version reads format 1"),
        (
            HEAD.replace("indicate", "shout"),
            "unknown condition 'with-shout'; there are with-indicate, with-ignore",
        ),
        (HEAD.replace("seed = 3", "seed = -1"), "seed = -1 must be a whole number from 0 to 2**63 - 1"),
        (HEAD.replace("seed = 3", "seed = true"), "seed = True must be a whole number"),
        (f"{HEAD}settings = 3", "settings and readings must be tables, such as [settings]"),
        (f"{HEAD}[settings]\nsize = 3", "unknown setting 'size'; there are population, elites, parents"),
        (f"{HEAD}[settings]\npopulation = 3", "setting population = 3 must lie in [5, 10000]"),
        (f"{HEAD}[settings]\npopulation = 50.5", "setting population = 50.5 must be a whole number"),
        (f"{HEAD}[settings]\nelites = 100", "setting elites = 100 must lie in [0, 99]"),
        (f"{HEAD}[settings]\nparents = 101", "setting parents = 101 must lie in [1, 100]"),
        (f"{HEAD}[settings]\ngenerations = 0", "setting generations = 0 must lie in [1, 1000000]"),
        (f"{HEAD}[readings]\ncolour = 3", "unknown reading 'colour'; there are mutation_probability"),
        (f"{HEAD}[readings]\nobject_radius = nan", "reading object_radius = nan must lie in"),
    ],
)
def test_an_impossible_config_is_refused_with_what_would_be_right(text, sentence):
    with pytest.raises(ValueError, match=re.escape(sentence)):
        RunConfig.from_toml(text)


@given(st.text() | st.binary().map(lambda data: data.decode("latin-1")))
def test_any_other_text_is_refused_plainly(text):
    with pytest.raises(ValueError, match=r"\w"):
        RunConfig.from_toml(text)


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        (
            {"settings": {"population": 10}},
            "settings = {'population': 10} must be a record, such as Settings(",
        ),
        ({"settings": Readings()}, "settings = Readings() must be a record, such as Settings("),
        ({"readings": "plain"}, "readings = 'plain' must be a record, such as Readings("),
        ({"readings": Settings()}, "must be a record, such as Readings("),
        ({"condition": None}, "None is no task; give an arm2d.Task, or with-indicate"),
        ({"seed": 1.0}, "seed = 1.0 must be a whole number"),
    ],
)
def test_parts_of_another_kind_are_refused(values, sentence):
    with pytest.raises(ValueError, match=re.escape(sentence)):
        RunConfig(**values)


def test_whole_numbers_of_numpy_are_written_as_pythons():
    numbers = {"population": 20, "elites": 1, "parents": 5, "generations": 7, "inter_neurons": 4}
    of_numpy = Settings(**{name: np.int64(value) for name, value in numbers.items()})
    config = RunConfig(seed=np.arange(4)[3], settings=of_numpy)
    assert config.to_toml() == RunConfig(seed=3, settings=Settings(**numbers)).to_toml()
    assert {type(config.seed), *(type(getattr(of_numpy, name)) for name in numbers)} == {int}
    assert type(Settings(algorithm="cma-es", cma_sigma=np.float32(0.5)).cma_sigma) is float


def test_a_whole_number_and_its_fraction_are_the_same_setting():
    whole, fraction = (Settings(algorithm="cma-es", cma_sigma=sigma) for sigma in (1, 1.0))
    assert repr(whole) == repr(fraction)
    assert type(whole.cma_sigma) is float
