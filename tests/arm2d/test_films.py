"""Films and pictures are whole or not there, whatever happens while they are written."""

import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import imageio.v3 as imageio
import numpy as np
import pytest

from arm2d.films import NoEncoderError, find_encoder, write_mp4, write_png

OLD = b"an old film"
# Noise: 24 frames that take some 300 kB.
NOISE = """
import sys, numpy as np
from arm2d.films import write_mp4, write_png
def noise(n=24):
    rng = np.random.default_rng(0)
    for _ in range(n):
        yield rng.integers(0, 255, (64, 96, 3), dtype=np.uint8)
"""


def noise(n=24):
    rng = np.random.default_rng(0)
    return [rng.integers(0, 255, (64, 96, 3), dtype=np.uint8) for _ in range(n)]


def frames_of(path):
    return sum(1 for _ in imageio.imiter(path, plugin="FFMPEG"))


def child(code, *arguments, **environment):
    return subprocess.Popen(
        [sys.executable, "-u", "-c", NOISE + code, *map(str, arguments)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, **environment},
    )


def unfinished(folder):
    return [each.name for each in folder.iterdir() if each.name.startswith(".")]


def test_a_film_holds_all_its_frames_and_replaces_an_old_file(tmp_path):
    path = tmp_path / "film.mp4"
    path.write_bytes(OLD)
    assert write_mp4(noise(), path, 25) == path
    assert frames_of(path) == 24
    assert os.listdir(tmp_path) == ["film.mp4"]


def test_a_name_may_be_as_long_as_a_name_can_be(tmp_path):
    path = tmp_path / f"{'é' * 125}.mp4"  # 254 bytes
    write_mp4(noise(2), path, 25)
    assert os.listdir(tmp_path) == [path.name]


def test_files_get_the_rights_that_the_user_gives(tmp_path):
    before = os.umask(0o027)
    try:
        write_png(noise(1)[0], tmp_path / "picture.png")
        write_mp4(noise(2), tmp_path / "film.mp4", 25)
    finally:
        os.umask(before)
    assert {each.stat().st_mode & 0o777 for each in tmp_path.iterdir()} == {0o640}


def on_a_small_disk(folder, kilobytes, code):
    """Run code in a mount namespace of its own, in which `folder` is a disk of this size with old files."""
    if shutil.which("unshare") is None:
        pytest.skip("this machine has no unshare")
    script = f'mount -t tmpfs -o size={kilobytes}k none "$1" && shift && exec "$@"'
    prepare = "from pathlib import Path\nfor each in ('film.mp4', 'picture.png'):\n"
    prepare += f"    Path(sys.argv[1], each).write_bytes({OLD!r})\n"
    told = "\nimport os; print(*sorted(os.listdir(sys.argv[1])))"
    python = [sys.executable, "-c", NOISE + prepare + code + told, str(folder)]
    done = subprocess.run(
        ["unshare", "-rm", "sh", "-c", script, "sh", str(folder), *python],
        capture_output=True,
        text=True,
        check=False,
    )
    if "unshare" in done.stderr or "mount:" in done.stderr:
        pytest.skip("this machine allows no mount namespaces")
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


FILM = """
import imageio.v3 as imageio
path = Path(sys.argv[1], "film.mp4")
try:
    write_mp4(noise(), path, 25)
except OSError as error:
    print(error)
    print(path.read_bytes() == b"an old film")
else:
    print(sum(1 for _ in imageio.imiter(path, plugin="FFMPEG")))
"""


def test_a_film_on_a_disk_that_gets_full_is_whole_or_the_old_one_stays(tmp_path):
    size = write_mp4(noise(), tmp_path / "film.mp4", 25).stat().st_size // 1024
    disk, seen = tmp_path / "disk", set()
    disk.mkdir()
    for kilobytes in (size // 2, size - 8, size, size + 12, 3 * size):
        *said, names = on_a_small_disk(disk, kilobytes, FILM)
        assert names == "film.mp4 picture.png"
        assert said == ["24"] or (
            "film.mp4 cannot be written: No space left on device; a file of that name is as it was" in said[0]
            and said[1] == "True"
        ), (kilobytes, said)
        seen.add(said[-1])
    assert seen == {"24", "True"}


def test_a_picture_on_a_full_disk_leaves_the_old_one(tmp_path):
    code = """
path = Path(sys.argv[1], "picture.png")
try:
    write_png(np.concatenate(list(noise(60))), path)
except OSError as error:
    print(error, path.read_bytes() == b"an old film", sep="|")
"""
    said, names = on_a_small_disk(tmp_path, 400, code)
    sentence, kept = said.split("|")
    assert "picture.png cannot be written: No space left on device; a file of that name" in sentence
    assert (kept, names) == ("True", "film.mp4 picture.png")


@pytest.mark.parametrize(
    "number", [signal.SIGTERM, signal.SIGHUP, signal.SIGINT, signal.SIGQUIT, signal.SIGXCPU]
)
def test_a_signal_in_the_middle_leaves_the_old_film_and_nothing_else(tmp_path, number):
    path = tmp_path / "film.mp4"
    path.write_bytes(OLD)
    endless = """
def pictures():
    yield from noise(50)
    print("drawing")
    while True:
        yield from noise(1)
write_mp4(pictures(), sys.argv[1], 25)
"""
    with child(endless, path) as process:
        assert process.stdout.readline() == "drawing\n"
        assert len(unfinished(tmp_path)) == 1
        assert not list(tmp_path.glob(".*.mp4"))
        process.send_signal(number)
        process.communicate()
    assert process.returncode == -number or number == signal.SIGINT
    assert path.read_bytes() == OLD
    assert os.listdir(tmp_path) == ["film.mp4"]


def test_two_at_once_write_one_film_each_whole(tmp_path):
    path = tmp_path / "film.mp4"
    code = "write_mp4(noise(), sys.argv[1], 25)"
    both = [child(code, path) for _ in range(2)]
    said = [each.communicate() for each in both]
    assert [each.returncode for each in both] == [0, 0], said
    assert frames_of(path) == 24
    assert os.listdir(tmp_path) == ["film.mp4"]


def test_an_encoder_that_dies_is_told_in_one_sentence(tmp_path):
    path = tmp_path / "film.mp4"
    path.write_bytes(OLD)

    def pictures():
        for k in range(200):
            if k == 3:
                for each in children():
                    os.kill(each, signal.SIGKILL)
            yield from noise(1)

    with pytest.raises(
        OSError, match=r"film.mp4 cannot be written: ffmpeg failed \(ended by SIGKILL\); a file"
    ):
        write_mp4(pictures(), path, 25)
    assert path.read_bytes() == OLD
    assert os.listdir(tmp_path) == ["film.mp4"]


def children():
    """Processes of ours: while a film is written, ffmpeg alone."""
    for task in Path("/proc/self/task").iterdir():
        yield from map(int, (task / "children").read_text().split())


def test_an_error_while_drawing_leaves_the_old_film(tmp_path):
    path = tmp_path / "film.mp4"
    path.write_bytes(OLD)

    def pictures():
        yield from noise(2)
        raise ValueError("no such step")

    with pytest.raises(ValueError, match="no such step"):
        write_mp4(pictures(), path, 25)
    assert path.read_bytes() == OLD
    assert os.listdir(tmp_path) == ["film.mp4"]


@pytest.mark.parametrize("name", ["run:1/x.mp4", "tcp:x.mp4", "a b/%d'x'.mp4", "-y.mp4"])
def test_whatever_a_path_is_called_it_is_a_path(tmp_path, monkeypatch, name):
    monkeypatch.chdir(tmp_path)
    Path(name).parent.mkdir(exist_ok=True)
    write_mp4(noise(2), name, 25)
    assert frames_of(tmp_path / name) == 2


def test_a_folder_that_is_not_there_is_named(tmp_path):
    with pytest.raises(
        OSError, match=r"no/x.mp4 cannot be written: No such file or directory; a file of that"
    ):
        write_mp4(noise(2), tmp_path / "no" / "x.mp4", 25)


def never_drawn():
    raise AssertionError("a frame was drawn")
    yield


@pytest.mark.parametrize(
    ("program", "sentence"),
    [
        (
            "/nowhere/ffmpeg",
            r"no ffmpeg can be run \(.*'/nowhere/ffmpeg'\); `wordarm doctor` says what to do",
        ),
        (
            "/bin/echo",
            r"/bin/echo cannot write H.264 \(it has no libx264\); `wordarm doctor` says what to do",
        ),
        ("/bin/false", r"no ffmpeg can be run \(.*exit status 1.*\); `wordarm doctor` says what to do"),
    ],
)
def test_without_an_encoder_nothing_is_drawn(tmp_path, monkeypatch, program, sentence):
    monkeypatch.setenv("IMAGEIO_FFMPEG_EXE", program)
    with pytest.raises(NoEncoderError, match=sentence):
        write_mp4(never_drawn(), tmp_path / "x.mp4", 25)
    assert not os.listdir(tmp_path)
    monkeypatch.delenv("IMAGEIO_FFMPEG_EXE")
    assert Path(find_encoder()).is_file()


def test_no_picture_is_written_behind_a_link_of_somebody_else(tmp_path, other_user):
    (tmp_path / "home").mkdir()
    (tmp_path / "videos").symlink_to("home")
    os.lchown(tmp_path / "videos", other_user, other_user)
    with pytest.raises(OSError, match="is a symbolic link that belongs to another user"):
        write_png(np.zeros((2, 2, 3), np.uint8), tmp_path / "videos" / "a.png")
    assert list((tmp_path / "home").iterdir()) == []
