import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from arm2d import Readings
from arm2d.readings import choices
from evolution.cli import main, parse
from evolution.commands.evolve import Evolve
from evolution.runs.folder import RunFolder

SMALL = ["--population=10", "--elites=2", "--parents=5"]


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    path = tmp_path_factory.mktemp("cli") / "run"
    assert main(["evolve", *SMALL, "--generations=3", f"--output={path}"]) == 0
    return path


def run_of(arguments):
    """The run that `wordarm evolve` with these arguments is about."""
    command = parse(["evolve", *arguments])
    assert isinstance(command, Evolve)
    return command.config


def in_new_process(code):
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)


def test_help_waits_for_nothing_that_is_compiled_or_drawn():
    heavy = ("numpy", "numba", "matplotlib", "scipy", "mujoco", "pinocchio", "imageio")
    code = f"""
import sys
from evolution.cli import main
try:
    main(["--help"])
finally:
    assert not set(sys.modules) & set({heavy}), set(sys.modules) & set({heavy})
"""
    result = in_new_process(code)
    assert result.returncode == 0, result.stderr
    for command in ("evolve", "evaluate", "plot", "port", "repair"):
        assert command in result.stdout


def test_evolving_imports_neither_the_humanoid_nor_figures(tmp_path):
    code = f"""
import sys
from evolution.cli import main
main(["evolve", *{SMALL}, "--generations=2", "--output={tmp_path / "run"}"])
heavy = set(sys.modules) & {{"mujoco", "pinocchio", "matplotlib", "imageio"}}
assert not heavy, heavy
"""
    result = in_new_process(code)
    assert result.returncode == 0, result.stderr


def test_both_ways_of_calling_are_the_same_program():
    script = str(Path(sys.executable).with_name("wordarm"))  # whether or not the environment is entered
    texts = [
        subprocess.run([*command, "--help"], capture_output=True, text=True).stdout
        for command in ([script], [sys.executable, "-m", "evolution"])
    ]
    assert texts[0] == texts[1] != ""


def test_without_options_the_run_is_the_papers():
    config = run_of([])
    assert config.readings == Readings.preset("default")
    assert (config.condition, config.seed, config.settings.generations) == ("with-indicate", 1, 6000)


@pytest.mark.parametrize("name", Readings().to_mapping())
def test_every_reading_can_be_set(name):
    value = getattr(Readings(), name)
    if name in choices():
        new = next(each for each in choices()[name] if each != value)
        flags = [str(new)]
    elif isinstance(value, tuple):
        new = (45.0, 90.0, 135.0)
        flags = ["45", "90", "135"]
    else:
        new = value / 2
        flags = [str(new)]
    readings = run_of([f"--readings.{name.replace('_', '-')}", *flags]).readings
    assert getattr(readings, name) == new


def test_single_readings_can_be_set_on_top_of_a_preset():
    readings = run_of(["--preset=printed", "--readings.turn=radians"]).readings
    assert readings == Readings.preset("printed").with_values({"turn": "radians"})
    readings = run_of(["--readings.ignore-stops=early", "--preset=printed"]).readings
    assert readings == Readings.preset("default")


def test_conditions_are_understood_in_any_spelling():
    assert run_of(["--condition=With_Ignore"]).condition == "with-ignore"


def test_runs_are_kept_by_experiment_condition_and_seed(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    arguments = ["evolve", *SMALL, "--generations=2", "--seed=7", "--experiment=try"]
    assert main([*arguments, "--condition=with-ignore"]) == 0
    folder = RunFolder.open(tmp_path / "runs" / "try" / "with-ignore" / "seed-0007")
    assert folder.config.seed == 7


def test_output_that_is_no_terminal_gets_plain_lines(tmp_path, capsys):
    main(["evolve", *SMALL, "--generations=3", f"--output={tmp_path / 'run'}"])
    output = capsys.readouterr().out
    assert re.search(r"^generation 1 of 3: best \d\.\d{3}, mean \d\.\d{3}$", output, re.MULTILINE)
    assert "\x1b" not in output
    assert output.endswith(f"look at it with: wordarm evaluate {tmp_path / 'run'}\n")


def test_a_run_is_evaluated_with_table_figures_csv_and_json(run, capsys):
    assert main(["evaluate", str(run), "--trials-per-area=2"]) == 0
    output = capsys.readouterr().out
    assert output.count(" *") == 3  # two instructions and the legend
    written = [
        "champion-heat-map.png",
        "champion-heat-map.svg",
        "champion.csv",
        "champion.json",
        "fitness.png",
        "fitness.svg",
    ]
    assert sorted(each.name for each in (run / "evaluation").iterdir()) == written
    assert [each for each in written if str(run / "evaluation" / each) in output] == written
    content = json.loads((run / "evaluation" / "champion.json").read_text())
    assert [each["trials"] for each in content["instructions"]] == [4] * 9


def test_a_bare_genotype_file_is_evaluated_where_one_stands(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    np.save("mine.npy", np.random.default_rng(0).random(84))
    assert main(["evaluate", "mine.npy", "--condition=with-ignore", "--trials-per-area=1"]) == 0
    content = json.loads((tmp_path / "evaluation" / "mine.json").read_text())
    assert content["condition"] == "with-ignore"


def test_the_fitness_of_an_unfinished_run_can_be_plotted(run, tmp_path, capsys):
    assert main(["plot", str(run), f"--output={tmp_path}"]) == 0
    assert capsys.readouterr().out.split() == [str(tmp_path / "fitness.png"), str(tmp_path / "fitness.svg")]


def test_a_sound_run_needs_no_repair(run, capsys):
    assert main(["repair", str(run)]) == 0
    assert capsys.readouterr().out == f"{run} is sound\n"


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (
            ["evolve", "--condition=with-shout"],
            "unknown condition 'with-shout'; there are with-indicate, with-i",
        ),
        (["evolve", "--preset=mine"], "unknown preset of readings 'mine'; there are default, printed"),
        (["evolve", "--population=3"], "setting population = 3 must lie in [5, 10000]"),
        (["evolve", "--seed=-1"], "seed = -1 must be a whole number from 0 to 2**63 - 1"),
        (["evolve", "--readings.object-radius=20"], "reading object_radius = 20 must lie in [0.1, 11.8]"),
        (["evolve", "--readings.object-radius=nan"], "reading object_radius = nan must lie in"),
        (["evolve", "--output={file}/run"], "cannot be made: Not a directory; choose another folder"),
        (["evolve", "--output={run}"], "was started with settings.population = 10, not 100; settings.elites"),
        (["evaluate", "{none}"], "give a run folder, a genotype file (.npz, .npy) or a shipped champion"),
        (["evaluate", "{empty}"], "holds no run: config.toml is missing; start one with: wordarm evolve"),
        (["evaluate", "{file}"], "is not a genotype file: give an .npz with an array genotypes [P, 84]"),
        (["evaluate", "{run}", "--generation=3"], "has no generation 3; it has 3, numbered from 0"),
        (["evaluate", "{run}", "--rank=99"], "rank 99 does not exist"),
        (["evaluate", "{run}", "--condition=with-ignore"], "belongs to with-indicate, not with-ignore"),
        (["evaluate", "{run}", "--condition=aloud"], "unknown condition 'aloud'"),
        (["evaluate", "{run}", "--trials-per-area=0"], "0 trials per area"),
        (
            ["evaluate", "{run}", "--trials-per-area=1", "--output={file}/x"],
            "cannot be made: Not a directory",
        ),
        (["plot", "{empty}"], "holds no run"),
        (["plot", "{none}"], "is not a folder"),
        (["repair", "{empty}"], "holds no run"),
        (
            ["port", "{run}", "touch yellow"],
            "unknown object word 'yellow'; this world knows blue, green, red",
        ),
        (["port", "{run}", "touch blue", "--robot=asimo"], "unknown robot 'asimo'; there are: icub"),
        (["port", "{run}", "touch"], "has 1 words, not two"),
        (["port", "{run}", "ignore blue"], "with-indicate has no instruction IGNORE Blue"),
    ],
)
def test_bad_input_gets_one_sentence_and_exit_code_2(run, tmp_path, capsys, arguments, sentence):
    (tmp_path / "empty").mkdir()
    (tmp_path / "file").write_text("dear reader")
    places = {"run": run, "file": tmp_path / "file", "empty": tmp_path / "empty", "none": tmp_path / "none"}
    before = sorted(tmp_path.rglob("*"))
    assert main([each.format(**places) for each in arguments]) == 2
    captured = capsys.readouterr()
    assert sentence in captured.err
    assert captured.err.startswith("wordarm: ")
    assert captured.err.count("\n") == 1
    assert sorted(tmp_path.rglob("*")) == before


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["evolv"],
        ["evolve", "--speed=3"],
        ["evolve", "--seed=x"],
        ["evolve", "--readings.turn=miles"],
        ["evaluate"],
        ["evaluate", "x", "--rank=best"],
    ],
)
def test_options_that_cannot_be_parsed_exit_with_code_2(arguments, capsys):
    with pytest.raises(SystemExit) as caught:
        main(arguments)
    assert caught.value.code == 2
    assert "Traceback" not in capsys.readouterr().err
