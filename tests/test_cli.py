import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from arm2d import Readings
from arm2d.readings import PLAIN, PRESETS, choices
from evolution.cli import COMMANDS, GROUPS, MOVED, main, overview, parse
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
    heavy = {"numpy", "numba", "matplotlib", "scipy", "mujoco", "pinocchio", "imageio"}
    code = f"""
import sys
from evolution.cli import main
main(["--help"])
assert not set(sys.modules) & {{"tyro", "rich"}}
try:
    main(["evolve", "--help"])
finally:
    assert not set(sys.modules) & {heavy}, set(sys.modules) & {heavy}
"""
    result = in_new_process(code)
    assert result.returncode == 0, result.stderr


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
    assert readings == PLAIN


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


def test_the_fitness_of_an_unfinished_run_can_be_looked_at(run, tmp_path, capsys):
    copy = shutil.copytree(run, tmp_path / "run")
    (copy / "champions.npz").unlink()
    assert main(["evaluate", str(copy), "--trials-per-area=1", f"--output={tmp_path}"]) == 0
    assert str(tmp_path / "generation-000002-rank-0.csv") in capsys.readouterr().out
    assert (tmp_path / "fitness.png").exists()


def test_a_sound_run_needs_no_repair(run, capsys):
    assert main(["verify", str(run), "--repair"]) == 0
    assert capsys.readouterr().out == f"{run} is sound\n"


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (
            ["evolve", "--condition=with-shout"],
            "unknown condition 'with-shout'; there are with-indicate, with-i",
        ),
        (["evolve", "--preset=mine"], f"unknown preset of readings 'mine'; there are {', '.join(PRESETS)}"),
        (["evolve", "--population=3"], "setting population = 3 must lie in [5, 10000]"),
        (["evolve", "--seed=-1"], "seed = -1 must be a whole number from 0 to 2**63 - 1"),
        (["evolve", "--readings.object-radius=20"], "reading object_radius = 20 must lie in [0.1, 11.8]"),
        (["evolve", "--readings.object-radius=nan"], "reading object_radius = nan must lie in"),
        (["evolve", "--output={file}/run"], "file is a file; choose another folder"),
        (
            ["evolve", "--output={link}"],
            "it is a link to nowhere, which does not exist; choose another folder",
        ),
        (
            ["evaluate", "best-generaliser", "--trials-per-area=1", "--output={link}/x"],
            "is a link to nowhere",
        ),
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
            "file is a file; choose another folder",
        ),
        (["verify", "{empty}"], "holds no run"),
        (["verify", "{none}", "--repair"], "is not there; give the folder of a run, or an archive"),
        (["verify", "{none}.tar.gz", "--unpack={empty}"], "is not there; give the folder of a run, or an ar"),
        (["verify", "{run}/champions.npz"], "champions.npz is no archive of results; give such as results"),
        (["evaluate", "{run}", "--trial-seed=-1"], "a seed of -1 was asked for; give 0 or more"),
        (["evaluate", "{above}"], "is no run but holds some; give one of them, such as"),
        (["workspace", "--seed=7"], "--evaluations and --seed are about --search; leave them out, or search"),
        (["workspace", "--search", "--evaluations=0"], "--evaluations 0 must be at least 1"),
        (["workspace", "--search", "--seed=-1"], "--seed -1 must be at least 0"),
        (["verify", "{empty}", "--repair"], "holds no run"),
        (["report", "{run}", "--output={empty}/page.pdf"], "page.pdf is no name for a page; give such as"),
        (["analyse", "{run}", "--ship={file}"], "file is a file; give a folder for the agents"),
        (["study", "foo"], "study: give one of 'readings', 'beyond', not 'foo'"),
        (["behaviour", "{run}", "--agents=3"], "--agents and --no-figures are about classes"),
        (["behaviour", "{run}", "--classes", "--rank=1"], "name one agent; leave them out"),
        (["doctor", "--kills=3"], "--kills and --seed are about --torture FOLDER"),
        (["doctor", "--torture={empty}", "--kills=0"], "asked for 0 kills; give 1 to 100000"),
        (["port", "{run}", "all", "--physics", "--no-video"], "count them without one by: wordarm agree"),
        (["evolv"], "there is no command 'evolv'; the nearest is: wordarm evolve"),
        (["plot", "{run}"], "there is no command 'plot'; the nearest is: wordarm evaluate RUN"),
        (["galery"], "the nearest is: wordarm port AGENT all"),
        (["xyz"], "there is no command 'xyz'; see: wordarm --help"),
        (["--seed=3", "evolve"], "--seed=3 stands where a command should; see: wordarm --help"),
        (["evolve", "--sede", "3"], "evolve has no option --sede; the nearest is --seed"),
        (["evaluate", "--ranc", "3"], "evaluate has no option --ranc; the nearest is --rank"),
        (["evolve", "--zzz"], "evolve has no option --zzz; see: wordarm evolve --help"),
        (["evolve", "--readings.object-radus=3"], "the nearest is --readings.object-radius"),
        (["evolve", "more"], "no argument is wanted where more stands; see: wordarm evolve --help"),
        (["evolve", "--seed=x"], "--seed: a whole number is needed, not 'x'; see: wordarm evolve --help"),
        (["evolve", "--seed"], "--seed is given too few values; it takes 1"),
        (["evolve", "--readings.success"], "--readings.success is given too few values; it takes 1"),
        (["evolve", "--readings.turn=miles"], "--readings.turn: give one of 'degrees', 'radians', not"),
        (["evolve", "--readings.crossover=x"], "--readings.crossover: a number is needed, not 'x'"),
        (["evaluate"], "evaluate needs AGENT; see: wordarm evaluate --help"),
        (["port"], "port needs AGENT and INSTRUCTION; see: wordarm port --help"),
        (["port", "x", "y", "--closed-loop=None"], "--closed-loop: give one of geometric,camera, not"),
        (["agree"], "no agent is named"),
        (["experiment", "--slurm.tls=maybe", "x"], "--slurm.tls: give one of"),
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
    (tmp_path / "link").symlink_to("nowhere")
    places = {
        "run": run,
        "above": run.parent,
        "file": tmp_path / "file",
        "empty": tmp_path / "empty",
        "none": tmp_path / "none",
        "link": tmp_path / "link",
    }
    before = sorted(tmp_path.rglob("*"))
    assert main([each.format(**places) for each in arguments]) == 2
    captured = capsys.readouterr()
    assert sentence in captured.err
    assert captured.err.startswith("wordarm: ")
    assert captured.err.count("\n") == 1
    assert sorted(tmp_path.rglob("*")) == before


def test_without_a_command_all_are_listed_and_the_exit_code_is_2(capsys):
    assert main([]) == 2
    captured = capsys.readouterr()
    assert (captured.out, captured.err) == ("", overview() + "\n")


def test_the_list_of_commands_fits_a_screen(capsys):
    assert main(["--help"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert max(map(len, lines)) <= 80
    assert len(lines) <= 40
    assert len(COMMANDS) <= 17
    assert [line for line in lines if line in GROUPS] == list(GROUPS)
    for name, entry in COMMANDS.items():
        assert sum(line.startswith(f"  {name} ") and line.endswith(entry.line) for line in lines) == 1


def test_what_commands_became_is_understood():
    for new in MOVED.values():
        words = ["x.npy" if word.isupper() else word for word in new.split()]
        parse(words)


@pytest.mark.parametrize("columns", ["1", "60", "80", "300"])
@pytest.mark.parametrize("name", COMMANDS)
def test_help_of_a_command_fits_and_says_nothing_of_what_is_not_given(name, columns, monkeypatch, capsys):
    monkeypatch.setenv("COLUMNS", columns)
    with pytest.raises(SystemExit) as end:
        main([name, "--help"])
    assert end.value.code == 0
    text = capsys.readouterr().out
    assert max(map(len, text.splitlines())) <= max(40, min(80, int(columns)))
    assert "None" not in text
    assert "(default: )" not in text
    assert os.environ["COLUMNS"] == columns


def test_version_says_revision_too(capsys):
    assert main(["--version"]) == 0
    assert re.fullmatch(r"wordarm \d+\.\d+\.\d+, revision \S+\n", capsys.readouterr().out)


def test_a_switch_takes_no_word_and_help_shows_none(capsys):
    from evolution.cli import parse

    assert parse(["status", "runs", "--all"]).every_run
    assert not parse(["status", "runs"]).every_run
    with pytest.raises(SystemExit):
        main(["status", "--help"])
    assert "{True,False}" not in capsys.readouterr().out


def test_help_names_every_part_of_the_study_and_says_what_it_is(capsys):
    from typing import get_args, get_type_hints

    from evolution.commands.study import StudyCommand

    with pytest.raises(SystemExit):
        main(["study", "--help"])
    text = " ".join(re.sub(r"[│╭╮╰╯─]", " ", capsys.readouterr().out).split())
    for part in get_args(get_type_hints(StudyCommand)["part"]):
        assert f"{part} (" in text, part
