"""Films of different trials have different names, and nothing is made where none can be written."""

from itertools import product

import pytest

from arm2d import Instruction
from evolution.agents.recording import record_instruction
from evolution.cli import main
from evolution.runs.sources import find_agent
from mujoco_port.film.names import film_name
from mujoco_port.film.take import task_heard


def test_a_plain_film_has_a_plain_name():
    assert film_name("champion", "MOVE Red") == "champion-move-red.mp4"
    assert film_name("champion", "gallery") == "champion-gallery.mp4"


def test_all_that_makes_another_film_makes_another_name():
    ways = list(
        product(
            ("a", "b"),
            ("MOVE Red", "TOUCH Red", "gallery"),
            ("right", "left"),
            (0, 1, 12),
            ("icub", "icub-erd"),
            ((False, None), (True, None), (True, "geometric"), (True, "camera")),
        )
    )
    names = {
        film_name(
            agent,
            what,
            start_area=area,
            trial_seed=seed,
            robot=robot,
            physics=physics,
            closed_loop=loop,
        )
        for agent, what, area, seed, robot, (physics, loop) in ways
    }
    assert len(names) == len(ways)
    assert "a-move-red-left-seed-12-icub-erd-camera.mp4" in names


def test_closed_loop_implies_physics():
    assert film_name("a", "MOVE Red", closed_loop="camera") == film_name(
        "a", "MOVE Red", physics=True, closed_loop="camera"
    )


@pytest.mark.slow
def test_the_command_names_its_film_after_the_trial(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    asked = ["with-ignore", "move red", "--start-area", "left", "--trial-seed", "2"]  # over in seven seconds
    assert main(["port", *asked, "--quality", "draft"]) == 0
    film = tmp_path / "videos" / "with-ignore-move-red-left-seed-2.mp4"
    assert capsys.readouterr().out.splitlines()[-1] == str(film.relative_to(tmp_path))
    assert film.stat().st_size > 10_000


def test_a_folder_is_not_taken_for_a_film(tmp_path, capsys):
    (tmp_path / "film.mp4").mkdir()
    assert main(["port", "best-generaliser", "move red", "--output", str(tmp_path / "film.mp4")]) == 2
    assert "film.mp4 is a folder; choose another name" in capsys.readouterr().err


def test_without_an_encoder_port_says_so_and_makes_no_folder(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("IMAGEIO_FFMPEG_EXE", "/bin/echo")
    for command in (["port", "best-generaliser", "move red"], ["port", "best-generaliser", "all"]):
        assert main(command) == 2
        said = capsys.readouterr().err
        assert said == (
            "wordarm: /bin/echo cannot write H.264 (it has no libx264); `wordarm doctor` says what to do\n"
        )
    assert not any(tmp_path.iterdir())


def test_a_film_shows_the_words_that_its_agent_knows():
    """MOVE Blue is an instruction of both conditions; the third action is not."""
    for name, third in (("with-ignore", "ignore"), ("best-generaliser", "indicate")):
        record = record_instruction(find_agent(name), Instruction.parse("move blue"), "right", 0)
        assert task_heard(record).third == third
