"""Films beside the runs: linked where a page can reach them, with a still of their end."""

import io
import os
from base64 import b64decode

import numpy as np
import pytest
from PIL import Image

from arm2d.films import write_mp4
from evolution.report.films import WIDTH, films_of

BLUE, RED = (20, 60, 200), (200, 30, 20)


@pytest.fixture
def experiment(tmp_path):
    """A film of two seconds of blue, then two of red, beside a run; and what is no film."""
    videos = tmp_path / "experiment" / "with-ignore" / "seed-0001" / "videos"
    videos.mkdir(parents=True)
    frames = [np.full((90, 160, 3), colour, np.uint8) for colour in (BLUE, RED) for _ in range(20)]
    write_mp4(frames, videos / "champion-touch-red.mp4", 10)
    (videos / ".champion.mp4.0a1b.unfinished").touch()
    (videos / "elsewhere.mp4").symlink_to(videos / "champion-touch-red.mp4")
    return tmp_path / "experiment"


def test_a_film_is_shown_by_its_end_and_linked_from_a_page_above_it(experiment):
    (film,) = films_of(experiment, experiment)
    assert film.name == "TOUCH Red, with-ignore, seed-0001, champion"
    assert film.link == "./with-ignore/seed-0001/videos/champion-touch-red.mp4"
    kind, _, data = film.still.partition(",")
    assert kind == "data:image/jpeg;base64"
    with Image.open(io.BytesIO(b64decode(data))) as picture:
        assert picture.size == (WIDTH, WIDTH * 9 // 16)
        assert np.asarray(picture).reshape(-1, 3).mean(axis=0) == pytest.approx(RED, abs=12)


def test_a_page_that_does_not_lie_above_a_film_shows_its_still_only(experiment, tmp_path):
    (film,) = films_of(experiment, tmp_path / "elsewhere")
    assert (film.link, film.still[:16]) == ("", "data:image/jpeg;")


def test_what_a_films_name_tells_besides_is_told(experiment):
    (film,) = experiment.glob("*/*/videos/champion-*.mp4")
    film.rename(film.with_name("generation-004315-rank-1-move-blue-left-seed-3-physics.mp4"))
    (shown,) = films_of(experiment, experiment)
    assert shown.name == "MOVE Blue (left seed 3 physics), with-ignore, seed-0001, generation 004315 rank 1"
    (own,) = experiment.glob("*/*/videos/generation-*.mp4")
    own.rename(own.with_name("touch-green.mp4"))
    (shown,) = films_of(experiment, experiment)
    assert shown.name == "TOUCH Green, with-ignore, seed-0001"


@pytest.mark.parametrize("content", [b"", b"no film", b"#EXTM3U\nfile:///etc/passwd\n"])
def test_what_is_no_film_has_no_still(experiment, content):
    damaged = experiment / "videos" / "a #?%25.mp4"
    damaged.parent.mkdir()
    damaged.write_bytes(content)
    assert [(film.name, film.still) for film in films_of(experiment, experiment) if not film.still] == [
        ("a #?%25", "")
    ]


def test_without_ffmpeg_films_are_linked_all_the_same(experiment, monkeypatch):
    monkeypatch.setenv("IMAGEIO_FFMPEG_EXE", os.devnull)
    (film,) = films_of(experiment, experiment)
    assert film.link
    assert not film.still
