"""The commands that let the robot act: what they say, write and refuse."""

import numpy as np
import pytest

from evolution.cli import main
from evolution.commands.robot import candidate, candidates
from mujoco_port.acting.agreement import fingerprint, jobs
from mujoco_port.acting.lab import instruction_of


def test_port_with_physics_prints_both_verdicts_and_without_a_video_writes_nothing(
    tmp_path, capsys, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    assert main(["port", "best-generaliser", "move red", "--physics", "--no-video"]) == 0
    assert capsys.readouterr().out == "2D: carried out\n3D: carried out\n"
    assert not any(tmp_path.iterdir())


def test_agree_only_counts_what_a_complete_file_holds(tmp_path, capsys):
    path, agent = tmp_path / "trials.csv", candidate("best-generaliser")
    listed = jobs([agent], ("open",), 1, seed=0)
    rows = [
        f"{agent.name},open,{instruction_of(job.trial)},{job.area},{job.start},1,0,0.0,x" for job in listed
    ]
    path.write_text("\n".join((f"# {fingerprint(listed, 'icub')}", "agent,...", *rows)) + "\n")
    before = path.read_bytes()
    assert main(["agree", "best-generaliser", "--starts", "1", "--output", str(path)]) == 0
    said = capsys.readouterr().out
    assert said.count("0.0 %") == 10  # nine instructions and all together
    assert path.read_bytes() == before


def test_agents_that_would_be_called_alike_are_told_apart_and_one_named_twice_is_refused(tmp_path):
    """Their trials would be counted in one row, those of one agent twice."""
    paths = [tmp_path / each / "mine.npz" for each in "ab"]
    for number, path in enumerate(paths):
        path.parent.mkdir()
        np.savez(path, genotype=np.random.default_rng(number).random(84))
    names = [str(path) for path in paths]
    assert [each.name for each in candidates(names)] == names
    assert [each.name for each in candidates([names[0], "best-generaliser"])] == ["mine", "best-generaliser"]
    other = f"{tmp_path}/b/../a/mine.npz"
    with pytest.raises(ValueError, match=r"a/mine.npz and .*/b/../a/mine.npz are the same agent; name each"):
        candidates([names[0], "best-generaliser", other])


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["port", "best-generaliser", "move red", "--no-video"], "without a video there is nothing to do"),
        (
            ["port", "best-generaliser", "move red", "--physics", "--no-video", "--robot", "icub-erd"],
            "links that cannot act",
        ),
        (
            ["port", "best-generaliser", "move red", "--physics", "--robot", "icub-erd"],
            "links that cannot act",
        ),
        (["port", "best-generaliser", "all", "--physics", "--robot", "icub-erd"], "links that cannot act"),
        (["agree", "best-generaliser", "--starts", "0"], "--starts 0 must be at least 1"),
        (["agree", "best-generaliser", "--seed", "-1"], "--seed -1 must be at least 0"),
        (["agree", "best-generaliser", "--loops"], "give one or more, each of them once"),
        (["agree", "best-generaliser", "--loops", "open", "open"], "--loops open open: give one or more, ea"),
        (["agree", "with-ignore", "with-ignore"], "with-ignore and with-ignore are the same agent; name ea"),
        (["agree", "nobody"], "nobody"),
        (["agree", "best-generaliser", "--robot", "nao"], "unknown robot 'nao'; there are: icub, icub-erd"),
    ],
)
def test_bad_input_gets_one_sentence_and_writes_nothing(arguments, sentence, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == 2
    said = capsys.readouterr().err
    assert sentence in said
    assert said.count("\n") == 1
    assert not any(tmp_path.iterdir())
