"""Experiment files: what they mean, and what is said of those that mean nothing."""

import re
import tomllib
from dataclasses import replace
from pathlib import Path

import pytest

from arm2d import Readings
from arm2d.readings import PLAIN, PRESETS
from evolution.cli import main
from evolution.experiments.grid import experiment_from_mapping, read_experiment
from evolution.experiments.plan import Plan
from evolution.experiments.plan_file import read_plan, write_plan
from evolution.experiments.spec import MOST_RUNS
from evolution.experiments.variants import Variant, variant_name
from evolution.search.config import RunConfig
from evolution.search.settings import Settings


@pytest.fixture
def write(tmp_path):
    def file(text):
        path = tmp_path / "trial.toml"
        path.write_text(text)
        return path

    return file


def folders(spec):
    """Folders of all runs, below the experiment's."""
    plan = spec.plan()
    return [str(plan.path(config).relative_to(plan.folder)) for config in plan.configs]


def test_an_empty_file_is_one_run_of_the_papers_size(write):
    spec = read_experiment(write(""))
    assert spec.configs() == (RunConfig(),)
    assert spec.output == Path("runs/trial")
    assert folders(spec) == ["with-indicate/seed-0001"]


def test_every_list_is_a_factor_and_a_variant_is_called_after_what_is_special(write):
    spec = read_experiment(
        write("""
        conditions = ["with-indicate", "with-ignore"]
        seeds = [3, "7-8"]
        [settings]
        generations = 600
        population = [50, 100]
        [readings]
        mutation_sd = [0.1, 0.03]
        """)
    )
    assert len(set(folders(spec))) == 2 * 3 * 2 * 2
    assert {each.settings.generations for each in spec.configs()} == {600}
    assert set(spec.plan().variants.values()) == {
        "default", "mutation-sd-0.03", "population-50", "mutation-sd-0.03+population-50",
    }  # fmt: skip
    assert folders(spec)[0] == "population-50/with-indicate/seed-0003"


def test_a_list_of_three_centres_is_one_world_and_a_list_of_lists_is_a_grid(write):
    one = read_experiment(write("[readings]\nsector_centres = [45, 90, 135]\nsector_half_width = 3"))
    assert [each.readings.sector_centres for each in one.configs()] == [(45.0, 90.0, 135.0)]
    two = read_experiment(
        write("[readings]\nsector_centres = [[30, 90, 150], [45, 90, 135]]\nsector_half_width = 3")
    )
    assert list(two.plan().variants.values()) == [
        "sector-half-width-3",
        "sector-half-width-3+sector-centres-45-90-135",
    ]


def test_variants_go_before_the_whole_file_and_lists_in_them_are_grids_of_their_own(write):
    spec = read_experiment(
        write("""
        preset = "printed"
        [readings]
        object_radius = 8
        [[variant]]
        name = "default"
        [[variant]]
        name = "wide"
        readings = { object_radius = 5, mutation_sd = [0.1, 0.03] }
        settings = { population = 50 }
        """)
    )
    names = spec.plan().variants
    assert list(names.values()) == ["default", "wide+mutation-sd-0.1", "wide+mutation-sd-0.03"]
    variants = {name: variant for variant, name in names.items()}
    assert variants["default"] == Variant(replace(PLAIN, ignore_stops="never", object_radius=8.0), Settings())
    wide = variants["wide+mutation-sd-0.03"]
    assert (wide.readings.object_radius, wide.readings.mutation_sd, wide.settings.population) == (
        5.0,
        0.03,
        50,
    )


def test_names_tell_different_values_apart():
    radii = [5.0, 8.0, 0.1 + 0.2, 0.3, 1e-05 + 1]
    assert len({variant_name(Readings(object_radius=each)) for each in radii}) == len(radii)
    assert variant_name(Readings(object_vision="any_part")) == "object-vision-any-part"
    assert variant_name(Readings(), Settings(population=50)) == "population-50"
    assert variant_name(Readings(), Settings(population=50), Settings(population=50)) == "default"


def test_a_plan_is_read_back_as_it_was_written(write, tmp_path):
    spec = read_experiment(
        write('seeds = "1-3"\npost_evaluate = true\n[readings]\nturn = ["degrees", "radians"]')
    )
    plan = Plan(tmp_path / "out", spec.configs(), spec.post_evaluate)
    write_plan(plan)
    read = read_plan(plan.folder)
    assert {plan.path(each) for each in plan.configs} == {read.path(each) for each in read.configs}
    assert set(read.configs) == set(plan.configs)
    assert read.post_evaluate


@pytest.mark.parametrize("text", ["", "format = 2", "format = 1\npost_evaluate = 1\nruns = 3", "\0", "a = ["])
def test_a_plan_that_cannot_be_understood_is_named(text, tmp_path):
    (tmp_path / "plan.toml").write_text(text)
    with pytest.raises(ValueError, match=r"plan\.toml cannot be understood \(.+\); repeat the command"):
        read_plan(tmp_path)


def test_a_plan_cannot_lead_out_of_its_folder(tmp_path):
    plan = Plan(tmp_path, (RunConfig(), RunConfig(readings=Readings(object_radius=3.0))))
    write_plan(plan)
    text = (tmp_path / "plan.toml").read_text()
    (tmp_path / "plan.toml").write_text(text.replace('"object-radius-3"', '"../../elsewhere"'))
    with pytest.raises(ValueError, match="cannot be a folder's"):
        read_plan(tmp_path)


BAD = {
    "seed = 3": "unknown key 'seed'; did you mean seeds? there are output, jobs, conditions, task",
    "zzz = 3": "unknown key 'zzz'; there are output, jobs,",
    "[readings]\nobject_radus = 3": "unknown reading 'object_radus' in [readings]; did you mean",
    "[settings]\ngeneration = 3": "unknown setting 'generation' in [settings]; did you mean generations?",
    "[[variant]]\nname = 'a'\nreading = {}": "unknown key 'reading' in [[variant]]; did you mean readings?",
    "[[variant]]\nname = 'a'\nsettings = {elite = 1}": "did you mean elites?",
    "[[variant]]\nreadings = {}": "a [[variant]] has no name; give it one",
    "[[variant]]\nname = '../up'": "variant name '../up' cannot be a folder's; give letters",
    "[[variant]]\nname = 'with-ignore'": "variant name 'with-ignore' is taken",
    "[[variant]]\nname = 'a'\n[[variant]]\nname = 'b'": "variant 'b' is the same as 'a'; leave one out",
    "[[variant]]\nname = 'a'\n[[variant]]\nname = 'a'\nreadings = {object_radius = 3}": "are called 'a'",
    "[variant]\nname = 'a'": "variant must be tables, each headed [[variant]]",
    "conditions = 'with-music'": "with-music",
    "conditions = []": "conditions = [] must be a list of with-indicate and with-ignore, or one of them",
    "conditions = [1]": "conditions = [1] must be a list of",
    "conditions = ['with-ignore', 'with-ignore']": "conditions has with-ignore twice; leave one out",
    "seeds = []": "seeds = [] names none; give 7, '1-8' or [1, 2, '5-8']",
    "seeds = '8-1'": "'8-1' must rise within 0 to 2**63 - 1",
    "seeds = 'few'": "seeds = 'few' is not understood; give 7",
    "seeds = true": "seeds = True is not understood",
    "seeds = [1, '1-2']": "seeds has 1 twice; leave one out",
    "seeds = '1-1000000000000'": "are too many; an experiment has at most 10,000",
    "preset = 'mine'": f"unknown preset of readings 'mine'; there are {', '.join(PRESETS)}",
    "jobs = 'two'": "jobs = 'two' must be a whole number",
    "jobs = 0": "asked for 0 processes at a time; there must be at least 1",
    "post_evaluate = 1": "post_evaluate = 1 must be true or false",
    "output = '/etc'": "output = '/etc' must be a folder below the current one",
    "output = 'a/../../b'": "must be a folder below the current one",
    "output = 3": "output = 3 must be text in quotes",
    "settings = 3": "settings = 3 must be a table, such as [settings]",
    "[readings]\nobject_radius = []": "object_radius = [] is an empty grid; give at least one value",
    "[readings]\nobject_radius = [5, 5.0]": "object_radius has 5.0 twice; leave one out",
    "[readings]\nobject_radius = 'big'": "reading object_radius = 'big' is not of the kind of its default",
    "[readings]\nobject_radius = [5, 20]": "reading object_radius = 20 must lie in",
    "[readings]\nobject_radius = nan": "reading object_radius = nan must lie in",
    "[readings]\nsector_centres = []": "sector_centres = [] is an empty grid",
    "[readings]\nsector_centres = [30, 90]": "give three rising bearings",
    "[settings]\ngenerations = 1.5": "setting generations = 1.5 must be a whole number",
    "[settings]\ngenerations = true": "setting generations = True must be a whole number",
    "[settings]\ngenerations = {a = 1}": "generations = {'a': 1} must be a whole number",
    "seeds = '1-9000'\n[settings]\nelites = [1,2,3,4,5,6]\nparents = [20,30]": f"at most {MOST_RUNS:,}",
    "a = [": "is not TOML",
    "a = " + 2000 * "[": "trial.toml",
}


@pytest.mark.parametrize("text", BAD, ids=range(len(BAD)))
def test_what_is_wrong_with_a_file_is_told_in_one_sentence(text, write, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["experiment", str(write(text))]) == 2
    error = capsys.readouterr().err
    assert BAD[text] in error
    assert error.count("\n") == 1
    assert [each.name for each in tmp_path.iterdir()] == ["trial.toml"]


@pytest.mark.parametrize("content", [b"\xff\xfe", b"#" * 1_000_001, None])
def test_a_file_that_is_none_is_told_too(content, tmp_path, capsys):
    path = tmp_path / "trial.toml"
    if content is not None:
        path.write_bytes(content)
    assert main(["experiment", str(path)]) == 2
    assert capsys.readouterr().err.startswith(f"wordarm: {path}: ")


ROOT = Path(__file__).parents[3]
BLOCKS = re.findall(r"```toml\n(.*?)```", (ROOT / "docs" / "experiments.md").read_text(), re.DOTALL)


@pytest.mark.parametrize(("block", "names"), [*zip(BLOCKS, (4, 4), strict=True)], ids=range(len(BLOCKS)))
def test_what_the_docs_show_can_be_run(block, names, write):
    assert len(read_experiment(write(block)).plan().variants) == names


def test_the_example_is_the_one_that_the_docs_show():
    shown, example = tomllib.loads(BLOCKS[0]), (ROOT / "docs" / "examples" / "geometry.toml").read_text()
    assert tomllib.loads(example) == shown


def test_a_grid_too_large_to_be_listed_is_refused_before_it_is_made(write, capsys):
    many = "[" + ",".join(str(i / 1e6) for i in range(2, 102)) + "]"
    text = f"[readings]\nmutation_sd = {many}\nmutation_probability = {many}\nobject_radius = [5, 8]"
    assert main(["experiment", str(write(text))]) == 2
    assert "at most 10,000 can be told apart" in capsys.readouterr().err


def test_runs_of_one_variant_and_of_several_are_not_mixed(write, tmp_path, capsys):
    run = tmp_path / "out" / "with-indicate" / "seed-0001"
    run.mkdir(parents=True)
    (run / "config.toml").write_text(RunConfig().to_toml())
    path = write("[readings]\nobject_radius = [5, 8]")
    assert main(["experiment", str(path), f"--output={tmp_path / 'out'}"]) == 2
    error = capsys.readouterr().err
    assert f"holds runs of one variant, such as {run}, not of 2 variants; choose another" in error


def test_an_algorithm_may_be_a_grid_like_any_setting():
    spec = experiment_from_mapping({"settings": {"algorithm": ["genetic", "cma-es"]}}, Path("x"))
    assert list(spec.plan().variants.values()) == ["default", "algorithm-cma-es"]
