"""Compiled code is run as it lies there: whose folder it is, and what becomes of damaged files."""

import importlib.util
import os
import resource
import shutil
import stat
import subprocess
import sys
import tempfile
import time
import warnings
from pathlib import Path

import pytest

from arm2d import compiling
from arm2d.cache import CacheWarning, cache_folder, damaged_files, find_place, lack_of_room, sealed, unsealed
from arm2d.compiling import _SealedFile, _tell_once

AS_ROOT = pytest.mark.skipif(os.geteuid() != 0, reason="only root can take another user's part")
SOMEBODY = 54321


@pytest.fixture
def places(tmp_path, monkeypatch):
    """The user's cache folder, and the folder of temporary files."""
    user, temporary = tmp_path / "user", tmp_path / "temporary"
    user.mkdir(mode=0o755)
    temporary.mkdir()
    temporary.chmod(0o1777)
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(user))
    monkeypatch.setattr(tempfile, "tempdir", str(temporary))
    return user, temporary


@pytest.fixture
def fresh(tmp_path, monkeypatch):
    """A function as a process meets it that finds what others compiled; and where that is kept."""
    folder = tmp_path / "cache"
    folder.mkdir()
    monkeypatch.setattr(compiling, "cache_folder", lambda: str(folder))
    source = tmp_path / "doubling.py"
    source.write_text("def twice(x):\n    return 2.0 * x\n")

    def load(source=source):
        spec = importlib.util.spec_from_file_location("doubling", source)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        return compiling.compiled(module.twice)

    return load, folder


def found(function):
    """Whether compiled code of a function was found, once it has given what it should."""
    assert function(21.0) == 42.0
    return sum(function.stats.cache_hits.values()) == 1


def mode(path):
    return stat.S_IMODE(path.stat().st_mode)


def test_folders_are_the_users_alone_whatever_the_umask(places):
    before = os.umask(0o002)
    try:
        place = find_place()
    finally:
        os.umask(before)
    assert place.folder is not None
    assert place.folder.parent == places[0] / "wordarm"
    assert mode(place.folder) == mode(place.folder.parent) == 0o700
    assert place.note == ""


def test_what_other_versions_compiled_is_forgotten_a_month_after_its_last_use(places):
    base = places[0] / "wordarm"
    day = 86_400
    for name, days in (("kernel-old", 31), ("kernel-recent", 29), ("mine", 400)):
        (base / name).mkdir(parents=True)
        (base / name / "code").write_bytes(b"compiled")
        os.utime(base / name, (time.time() - days * day,) * 2)
    base.chmod(0o700)
    ours = find_place().folder
    assert {each.name for each in base.iterdir()} == {"kernel-recent", "mine", ours.name}
    os.utime(ours, (time.time() - 400 * day,) * 2)
    assert find_place().folder == ours  # being used, it is dated anew
    assert time.time() - ours.stat().st_mtime < day


def test_a_folder_that_others_can_read_is_closed(places):
    own = places[0] / "wordarm"
    own.mkdir(mode=0o755)
    assert find_place().folder.parent == own
    assert mode(own) == 0o700


def refused(places, *words):
    """That the user's folder is refused for a reason, and one among temporary files taken."""
    place = find_place()
    assert place.folder is not None
    assert place.folder.parent == places[1] / f"wordarm-{os.geteuid()}"
    for word in words:
        assert word in place.note
    assert place.note.endswith(f"; it is kept in {place.folder}")


def test_a_folder_that_others_could_write_to_is_refused(places):
    (places[0] / "wordarm").mkdir()
    (places[0] / "wordarm").chmod(0o777)
    refused(places, f"{places[0] / 'wordarm'} is not used, since others could write to it; remove it")


def test_a_folder_in_which_others_can_put_theirs_in_its_place_is_refused(places):
    places[0].chmod(0o777)
    refused(places, f"since others can change {places[0]}")


def test_a_folder_for_everybodys_use_in_which_all_keep_their_own_is_fine(places):
    places[0].chmod(0o1777)
    assert find_place().folder.parent == places[0] / "wordarm"


def test_a_link_is_refused(places, tmp_path):
    (tmp_path / "elsewhere").mkdir(mode=0o700)
    (places[0] / "wordarm").symlink_to(tmp_path / "elsewhere")
    refused(places, "since it is no folder but a link")


@AS_ROOT
def test_a_folder_that_somebody_else_made_is_refused(places):
    places[0].chmod(0o1777)
    (places[0] / "wordarm").mkdir(mode=0o700)
    os.chown(places[0] / "wordarm", SOMEBODY, SOMEBODY)
    refused(places, f"since it belongs to another user (number {SOMEBODY})")


@AS_ROOT
def test_where_every_place_is_somebody_elses_nothing_is_kept(places):
    for path in (places[0] / "wordarm", places[1] / f"wordarm-{os.geteuid()}"):
        path.mkdir(mode=0o700)
        os.chown(path, SOMEBODY, SOMEBODY)
    place = find_place()
    assert place.folder is None
    assert place.note.endswith("every process compiles anew, which takes some 10 s")


def test_what_is_no_folder_is_named_and_told_once(places):
    (places[0] / "wordarm").write_text("no folder")
    refused(places, f"{places[0] / 'wordarm'} cannot be used (File exists)")
    cache_folder.cache_clear()
    try:
        with pytest.warns(CacheWarning, match="cannot be used"):
            assert cache_folder() is not None
    finally:
        cache_folder.cache_clear()


def test_without_a_home_there_is_a_place_among_temporary_files(places, monkeypatch):
    monkeypatch.delenv("NUMBA_CACHE_DIR")
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.setattr(os.path, "expanduser", lambda path: path)  # as for an unknown user without HOME
    refused(places, "no home folder is known, nor NUMBA_CACHE_DIR set")


def test_a_full_disk_is_told_and_what_it_holds_still_used(places):
    folder, limit = find_place().folder, resource.getrlimit(resource.RLIMIT_FSIZE)
    assert lack_of_room(folder) == ""
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, limit[1]))
    try:
        assert lack_of_room(folder) == "File too large"
        assert find_place().folder == folder
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limit)


def test_a_seal_shows_every_damage(tmp_path):
    path = tmp_path / "x.nbc"
    path.write_bytes(sealed(b"machine code"))
    assert unsealed(path) == b"machine code"
    whole = path.read_bytes()
    for i in range(len(whole)):
        path.write_bytes(whole[:i] + bytes([whole[i] ^ 1]) + whole[i + 1 :])
        assert unsealed(path) is None
        path.write_bytes(whole[:i])
        assert unsealed(path) is None
    assert unsealed(tmp_path / "none") is None


def test_compiled_code_is_kept_and_found(fresh):
    load, folder = fresh
    assert not found(load())
    assert found(load())
    assert damaged_files(folder) == []


def test_another_clone_finds_it_and_other_content_does_not(fresh, tmp_path):
    load, _ = fresh
    assert not found(load())
    (clone := tmp_path / "clone").mkdir()
    assert found(load(shutil.copy(tmp_path / "doubling.py", clone)))
    for factor in (3.0, 4.0):  # the same byte code
        (other := tmp_path / f"times-{factor}").mkdir()
        source = other / "doubling.py"
        source.write_text(f"FACTOR = {factor}\ndef twice(x):\n    return FACTOR * x\n")
        assert load(source)(21.0) == factor * 21.0
    assert found(load())


def emptied(data):
    return b""


def halved(data):
    return data[: len(data) // 2]


def flipped(data):
    return data[:-100] + bytes([data[-100] ^ 1]) + data[-99:]


def replaced(data):
    return b"cos\nsystem\n(S'touch planted'\ntR."  # what a plain reader of pickles would run


@pytest.mark.parametrize("suffix", [".nbi", ".nbc"])
@pytest.mark.parametrize("damage", [emptied, halved, flipped, replaced])
def test_a_damaged_file_is_compiled_again(fresh, suffix, damage, tmp_path, monkeypatch):
    load, folder = fresh
    monkeypatch.chdir(tmp_path)
    assert not found(load())
    (path,) = folder.rglob(f"*{suffix}")
    path.write_bytes(damage(path.read_bytes()))
    assert damaged_files(folder) == [path]
    assert not found(load())
    assert found(load())
    assert damaged_files(folder) == []
    assert not (tmp_path / "planted").exists()


def test_a_disk_that_fills_costs_the_cache_only(fresh):
    load, folder = fresh
    function, limit = load(), resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100, limit[1]))
    try:
        with pytest.warns(CacheWarning, match=r"cannot be written to \(File too large\)"):
            assert not found(function)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limit)
    assert damaged_files(folder) == []
    assert not found(load())
    assert found(load())


def test_a_folder_that_is_taken_away_costs_the_cache_only(fresh):
    load, folder = fresh
    function = load()
    shutil.rmtree(folder)
    folder.write_text("in the way")
    with pytest.warns(CacheWarning, match="cannot be written to"):
        assert not found(function)
    assert function.stats.cache_path.startswith(str(folder))
    folder.unlink()
    folder.mkdir()
    assert not found(load())


def test_code_compiled_elsewhere_at_the_same_time_is_not_taken_for_ours(tmp_path):
    class Elsewhere(_SealedFile):
        """Of a machine that looked into the index before we wrote ours, which replaced the one it wrote."""

        def _load_index(self):
            return {}

        def _save_index(self, overloads):
            pass

    ours, theirs = _SealedFile(str(tmp_path), "f", "stamp"), Elsewhere(str(tmp_path), "f", "stamp")
    ours.save("this processor", "our code")
    assert ours.load("this processor") == "our code"
    theirs.save("another processor", "their code")
    assert len(list(tmp_path.glob("*.nbc"))) == 1
    assert ours.load("this processor") is None
    ours.save("this processor", "our code")
    assert ours.load("this processor") == "our code"


def test_what_cannot_be_kept_is_told_once(tmp_path):
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")  # while Numba compiles, Python forgets what it has told
        for _ in range(3):
            _tell_once(f"{tmp_path} is full")
    assert [each.category for each in told] == [CacheWarning]


@AS_ROOT
@pytest.mark.slow
@pytest.mark.skipif(shutil.which("setpriv") is None, reason="no setpriv")
def test_a_user_without_a_home_evolves_and_evaluates_with_one_note():
    user = ["setpriv", f"--reuid={SOMEBODY}", f"--regid={SOMEBODY}", "--clear-groups"]
    if subprocess.run([*user, "test", "-r", __file__], check=False).returncode:
        pytest.skip("the checkout is in a folder of root's own, which no other user can read")
    named = {"HOME", "NUMBA_CACHE_DIR", "XDG_CACHE_HOME", "MPLCONFIGDIR"}
    environment = {name: value for name, value in os.environ.items() if name not in named}
    with tempfile.TemporaryDirectory() as place:  # where this user can go, unlike among the files of tests
        os.chmod(place, 0o777)
        _give_compiled_code(Path(place))
        run = f"{place}/run"
        for arguments in (
            ["evolve", "--population=10", "--elites=2", "--parents=5", "--generations=2", f"--output={run}"],
            ["evaluate", run, "--trials-per-area=1"],
        ):
            done = subprocess.run(
                [*user, sys.executable, "-m", "evolution", *arguments],
                capture_output=True,
                text=True,
                env={**environment, "TMPDIR": place},
            )
            assert done.returncode == 0, done.stderr
            assert done.stderr.startswith("wordarm: compiled code: no home folder is known")
            assert done.stderr.count("\n") == 1


def _give_compiled_code(place):
    """Spare a user without a home the time to compile, if that was done by now."""
    ours = find_place().folder
    if ours is not None:
        shutil.copytree(ours, place / f"wordarm-{SOMEBODY}" / ours.name)
        for path in (place, *place.rglob("*")):
            os.chown(path, SOMEBODY, SOMEBODY)
            path.chmod(0o700)
