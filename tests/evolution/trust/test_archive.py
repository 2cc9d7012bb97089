"""Archives of results: the same bytes each time, the first damaged file by name, nothing elsewhere."""

import gzip
import hashlib
import io
import shutil
import subprocess
import tarfile

import numpy as np
import pytest

from arm2d import Condition
from evolution.agents.postevaluation import post_evaluate
from evolution.agents.transitions import run_transition_test
from evolution.cli import main
from evolution.runs.folder import RunFolder
from evolution.runs.run import evolve
from evolution.runs.storage import DamagedFileError
from evolution.search.config import RunConfig
from evolution.search.settings import Settings
from evolution.trust.archive import SUMS, pack, read_archive, unpack

FILES = {
    "README.md": b"what this is\n",
    "agents/best.npz": np.random.default_rng(1).bytes(5000),
    "results/table-ii.csv": b"a,b\n1,2\n",
}


@pytest.fixture
def packed(tmp_path):
    path = tmp_path / "results.tar.gz"
    path.write_bytes(pack("results", FILES))
    return path


def archive_of(members, sums=None):
    """An archive of (name, content or member) pairs, with sums that fit unless others are given."""
    if sums is None:
        sums = "".join(
            f"{hashlib.sha256(data).hexdigest()}  {name.partition('/')[2]}\n"
            for name, data in members
            if isinstance(data, bytes)
        ).encode()
    buffer = io.BytesIO()
    with tarfile.open(fileobj=buffer, mode="w") as tar:
        for name, data in [(f"results/{SUMS}", sums), *members]:
            member = data if isinstance(data, tarfile.TarInfo) else tarfile.TarInfo(name)
            if isinstance(data, bytes):
                member.size = len(data)
            tar.addfile(member, io.BytesIO(data if isinstance(data, bytes) else b""))
    return gzip.compress(buffer.getvalue())


def test_the_same_files_are_the_same_bytes_whatever_their_order():
    assert pack("results", FILES) == pack("results", dict(reversed(FILES.items())))


def test_what_was_packed_is_read_back_sums_first(packed):
    files = read_archive(packed)
    assert next(iter(files)) == f"results/{SUMS}"
    assert {name: data for name, data in files.items() if not name.endswith(SUMS)} == {
        f"results/{name}": data for name, data in FILES.items()
    }


def test_unpacked_files_are_those_that_sha256sum_knows(packed, tmp_path):
    folder = unpack(read_archive(packed), tmp_path / "out")
    assert folder == tmp_path / "out" / "results"
    assert {p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.is_file()} == {SUMS, *FILES}
    subprocess.run(["sha256sum", "-c", "--quiet", SUMS], cwd=folder, check=True)


def test_the_first_damaged_file_is_named(tmp_path):
    path = tmp_path / "results.tar.gz"
    plain = bytearray(gzip.decompress(pack("results", FILES)))
    for content in (FILES["agents/best.npz"], FILES["results/table-ii.csv"]):
        plain[plain.index(content) + len(content) // 2] ^= 1
    path.write_bytes(gzip.compress(bytes(plain)))
    with pytest.raises(DamagedFileError, match=r"results/agents/best\.npz is not what was packed"):
        read_archive(path)


@pytest.mark.parametrize("share", [0.0, 0.01, 0.3, 0.7, 0.99])
def test_a_byte_that_is_cut_off_or_altered_anywhere_is_noticed(packed, share):
    whole = packed.read_bytes()
    place = int(share * len(whole))
    packed.write_bytes(whole[:place])
    with pytest.raises(DamagedFileError):
        read_archive(packed)
    # Bytes 4 to 9 are time, flags and system of a gzip header, which say nothing about the content.
    altered = bytearray(whole)
    altered[max(place, 10)] ^= 0x55
    packed.write_bytes(bytes(altered))
    with pytest.raises(DamagedFileError):
        read_archive(packed)


def test_a_file_that_is_missing_or_not_vouched_for_is_named(tmp_path):
    path = tmp_path / "results.tar.gz"
    sum_of = hashlib.sha256(b"x").hexdigest()
    path.write_bytes(archive_of([], f"{sum_of}  lost.csv\n".encode()))
    with pytest.raises(DamagedFileError, match=r"results/lost\.csv is missing"):
        read_archive(path)
    path.write_bytes(archive_of([("results/extra.csv", b"x")], b""))
    with pytest.raises(DamagedFileError, match=r"results/extra\.csv is not in its SHA256SUMS"):
        read_archive(path)


def link(name, target):
    member = tarfile.TarInfo(name)
    member.type, member.linkname = tarfile.SYMTYPE, target
    return name, member


@pytest.mark.parametrize(
    "member",
    [
        ("../outside", b"x"),
        ("/tmp/outside", b"x"),
        ("results/../../outside", b"x"),
        ("results/.hidden", b"x"),
        link("results/way", "/etc"),
    ],
    ids=lambda member: member[0],
)
def test_what_would_leave_the_folder_is_refused(member, tmp_path):
    path = tmp_path / "results.tar.gz"
    path.write_bytes(archive_of([member]))
    with pytest.raises(DamagedFileError, match=r"is no plain file below one folder|SHA256SUMS has the line"):
        read_archive(path)


def test_what_is_there_already_is_left_alone(packed, tmp_path):
    mine = tmp_path / "results" / "mine.txt"
    mine.parent.mkdir()
    mine.write_text("mine")
    with pytest.raises(ValueError, match="exists already; nothing was unpacked"):
        unpack(read_archive(packed), tmp_path)
    assert [each.name for each in mine.parent.iterdir()] == ["mine.txt"]


def test_nothing_half_written_stays_where_a_file_cannot_be_written(packed, tmp_path):
    files = read_archive(packed) | {"results/README.md/below": b"a file stands in the way"}
    with pytest.raises(OSError, match=r"it is a file|README"):
        unpack(files, tmp_path / "out")
    assert list((tmp_path / "out").iterdir()) == []


def test_verify_says_that_an_archive_is_whole_and_unpacks_it(packed, tmp_path, capsys):
    assert main(["verify", str(packed), f"--unpack={tmp_path / 'out'}"]) == 0
    assert capsys.readouterr().out.splitlines() == [
        f"{packed} is whole: 4 files are as they were packed",
        str(tmp_path / "out" / "results"),
    ]


def test_an_archive_of_another_name_is_known_by_its_first_bytes(packed, capsys):
    other = packed.rename(packed.with_name("results.tgz"))
    assert main(["verify", str(other)]) == 0
    assert "results.tgz is whole: " in capsys.readouterr().out


def test_verify_of_a_damaged_archive_ends_with_1_and_unpacks_nothing(packed, tmp_path, capsys):
    packed.write_bytes(packed.read_bytes()[:-30])
    assert main(["verify", str(packed), f"--unpack={tmp_path / 'out'}"]) == 1
    assert f"{packed} is damaged (" in capsys.readouterr().out
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("option", ["--repair", "--sample=3", "--generations=1"])
def test_options_about_runs_are_refused_for_archives(option, packed, capsys):
    assert main(["verify", str(packed), option]) == 2
    assert "are about runs; leave them out" in capsys.readouterr().err


def test_unpack_is_refused_for_a_run(finished_run, tmp_path, capsys):
    assert main(["verify", str(finished_run), f"--unpack={tmp_path}"]) == 2
    assert f"--unpack is about archives, which {finished_run} is not" in capsys.readouterr().err


@pytest.fixture(scope="module")
def experiment(tmp_path_factory):
    """A short run of either condition, tested."""
    home = tmp_path_factory.mktemp("experiment")
    for condition in Condition:
        path = home / condition / "seed-0001"
        evolve(path, RunConfig(condition, 1, Settings(population=10, elites=2, parents=5, generations=6)))
        post_evaluate(RunFolder.open(path))
        run_transition_test(RunFolder.open(path))
    return home


def test_two_runs_that_would_be_one_file_of_an_archive_are_refused(experiment, tmp_path, capsys):
    """Condition and seed are the same, the settings are not."""
    folder = tmp_path / "both"
    shutil.copytree(experiment, folder)
    other = folder / "other" / "seed-0001"
    settings = Settings(population=12, elites=2, parents=5, generations=6)
    evolve(other, RunConfig(Condition.WITH_INDICATE, 1, settings))
    post_evaluate(RunFolder.open(other))
    run_transition_test(RunFolder.open(other))
    path = tmp_path / "kept.tar.gz"
    assert main(["analyse", str(folder), f"--output={tmp_path / 'out'}", f"--archive={path}"]) == 2
    assert "another run of with-indicate with seed 1, whose settings differ" in capsys.readouterr().err
    assert not path.exists()


@pytest.mark.slow
def test_results_of_an_experiment_are_packed_whole_and_come_again(experiment, tmp_path, capsys):
    path = tmp_path / "kept" / "paper-2011.tar.gz"
    words = ["analyse", str(experiment), f"--output={tmp_path / 'results'}", f"--archive={path}"]
    assert main(words) == 0
    assert f"check it with: wordarm verify {path}" in capsys.readouterr().out
    first = path.read_bytes()
    assert main(words) == 0
    assert path.read_bytes() == first
    files = {name.partition("/")[2]: data for name, data in read_archive(path).items()}
    assert b"Apache License" in files["LICENSE"]
    assert b"seeds 1" in files["README.md"]
    assert files["agents/with-ignore.npz"]
    for made in (tmp_path / "results").iterdir():
        assert files[f"results/{made.name}"] == made.read_bytes()
    for condition in Condition:
        config = files[f"runs/{condition}/seed-0001/config.toml"].decode()
        assert RunConfig.from_toml(config).condition is condition


@pytest.mark.parametrize("name", ["results.zip", "results", ".tar.gz", "my results.tar.gz"])
def test_a_name_that_is_none_for_an_archive_is_refused_before_anything_is_done(name, tmp_path, capsys):
    assert main(["analyse", str(tmp_path / "nowhere"), f"--archive={tmp_path / name}"]) == 2
    assert "is no name for an archive; give such as results.tar.gz" in capsys.readouterr().err
