"""Folders in which others may write: no link leads us elsewhere, no pipe holds us up, no name is foretold."""

import fcntl
import os
import stat
from pathlib import Path

import pytest

from arm2d.files import (
    LinkError,
    NoFileError,
    final_name,
    handle_of_new,
    handle_to_append,
    handle_to_overwrite,
    is_temporary,
    opened_folder,
    read_file,
    write_whole,
)

WRITERS = [handle_to_append, handle_to_overwrite, lambda path: write_whole(path, b"ours")]
DEAD, ALIVE = ".file.0123456789abcdef.tmp", ".file.fedcba9876543210.tmp"


@pytest.fixture
def thesis(tmp_path):
    path = tmp_path / "thesis"
    path.write_text("three years of work")
    return path


@pytest.fixture
def shared(tmp_path):
    path = tmp_path / "shared"
    path.mkdir()
    return path


@pytest.mark.parametrize("writer", [handle_to_append, handle_to_overwrite, handle_of_new])
def test_a_file_that_is_a_link_is_never_written_to(writer, shared, thesis):
    (shared / "log").symlink_to(thesis)
    with pytest.raises(
        OSError, match=r"log is a symbolic link, which is not followed; remove it|File exists"
    ):
        writer(shared / "log")
    assert thesis.read_text() == "three years of work"
    assert (shared / "log").is_symlink()


def test_a_link_in_the_place_of_a_whole_file_is_replaced_not_followed(shared, thesis):
    (shared / "file").symlink_to(thesis)
    write_whole(shared / "file", b"ours")
    assert thesis.read_text() == "three years of work"
    assert (shared / "file").read_bytes() == b"ours"
    assert not (shared / "file").is_symlink()


@pytest.mark.parametrize("writer", [handle_to_append, handle_to_overwrite])
def test_a_pipe_in_the_place_of_a_file_is_refused_at_once(writer, shared):
    os.mkfifo(shared / "log")
    with pytest.raises(LinkError, match="log is no file; remove it"):
        writer(shared / "log")


def test_a_link_of_our_own_is_entered(shared, tmp_path):
    (tmp_path / "scratch").symlink_to("shared")
    for writer in WRITERS:
        if handle := writer(tmp_path / "scratch" / "file"):
            os.close(handle)
    assert (shared / "file").read_bytes() == b"ours"


@pytest.mark.parametrize("writer", WRITERS)
@pytest.mark.parametrize("below", [(), ("deeper",), ("deeper", "still")])
def test_a_link_of_somebody_else_is_not_entered_wherever_it_stands(
    writer, below, shared, tmp_path, other_user
):
    home = tmp_path / "home"
    home.joinpath(*below).mkdir(parents=True)
    (shared / "parts").symlink_to(home)
    os.lchown(shared / "parts", other_user, other_user)
    with pytest.raises(LinkError, match=r"'parts' .* symbolic link that belongs to another user"):
        writer(shared.joinpath("parts", *below, "file"))
    assert [each for each in home.rglob("*") if each.is_file()] == []


def test_no_folder_is_made_behind_a_link_of_somebody_else(shared, tmp_path, other_user):
    (shared / "with-indicate").symlink_to(tmp_path)
    os.lchown(shared / "with-indicate", other_user, other_user)
    with pytest.raises(LinkError), opened_folder(shared / "with-indicate" / "seed-0001", make=True):
        pass
    assert not (tmp_path / "seed-0001").exists()


def test_links_that_lead_to_each_other_end(shared):
    (shared / "a").symlink_to("b")
    (shared / "b").symlink_to("a")
    with pytest.raises(LinkError, match="leads nowhere"):
        write_whole(shared / "a" / "file", b"")


def test_folders_are_made_and_named_in_any_way(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    there = Path("one/two/../three")
    for _ in range(2):
        with opened_folder(there, make=True) as folder:
            assert os.path.samestat(os.fstat(folder), (tmp_path / "one" / "three").stat())
    write_whole(Path("here"), b"here")
    assert (tmp_path / "here").read_bytes() == b"here"
    with pytest.raises(NotADirectoryError), opened_folder(tmp_path / "here" / "below", make=True):
        pass
    with pytest.raises(FileNotFoundError, match="nowhere"), opened_folder(tmp_path / "nowhere" / "below"):
        pass


def test_a_temporary_name_cannot_be_taken_beforehand(shared, thesis, monkeypatch):
    (shared / ".file.tmp").symlink_to(thesis)
    seen, flush = [], os.fsync

    def look(handle):
        seen.append({each for each in os.listdir(shared) if is_temporary(each)} - {".file.tmp"})
        flush(handle)

    monkeypatch.setattr(os, "fsync", look)
    write_whole(shared / "file", b"one")
    write_whole(shared / "file", b"two")
    first, _, second, _ = seen
    assert len(first | second) == 2
    assert {final_name(each) for each in first | second} == {"file"}
    assert thesis.read_text() == "three years of work"


def test_what_a_dead_writer_left_is_removed_and_what_a_living_one_writes_is_not(shared):
    (shared / DEAD).write_bytes(b"half")
    (shared / ".other.0123456789abcdef.tmp").write_bytes(b"another file's")
    with (shared / ALIVE).open("wb") as living:
        fcntl.flock(living, fcntl.LOCK_EX)
        write_whole(shared / "file", b"whole")
        assert sorted(os.listdir(shared)) == sorted([ALIVE, ".other.0123456789abcdef.tmp", "file"])
    write_whole(shared / "file", b"whole")
    assert not (shared / ALIVE).exists()


def test_a_writer_taken_for_dead_begins_again(shared, monkeypatch):
    taken, flush = [], os.fsync

    def take(handle):
        if not taken:
            taken.extend(each for each in os.listdir(shared) if is_temporary(each))
            (shared / taken[0]).unlink()
        flush(handle)

    monkeypatch.setattr(os, "fsync", take)
    write_whole(shared / "file", b"whole")
    assert taken
    assert os.listdir(shared) == ["file"]
    assert (shared / "file").read_bytes() == b"whole"


def test_the_umask_says_who_may_read_a_file(shared):
    before = os.umask(0o027)
    try:
        write_whole(shared / "file", b"")
        os.close(handle_to_append(shared / "log"))
    finally:
        os.umask(before)
    assert {stat.S_IMODE(each.stat().st_mode) for each in shared.iterdir()} == {0o640}


def test_no_more_is_read_than_is_allowed_and_nothing_but_files(shared):
    (shared / "file").write_bytes(b"12345")
    assert read_file(shared / "file", 5) == b"12345"
    with pytest.raises(NoFileError, match="larger than 4 bytes"):
        read_file(shared / "file", 4)
    os.mkfifo(shared / "pipe")
    for path in (shared / "pipe", shared, Path("/dev/zero")):
        with pytest.raises(NoFileError, match="no regular file"):
            read_file(path, 5)


def test_a_link_is_read_only_where_it_may_be(shared, thesis):
    (shared / "drawing").symlink_to(thesis)
    assert read_file(shared / "drawing", 100) == b"three years of work"
    with pytest.raises(LinkError):
        read_file(shared / "drawing", 100, links=False)


def test_where_a_link_leads_nothing_is_made(shared):
    (shared / "link").symlink_to("nowhere")
    with pytest.raises(FileNotFoundError), opened_folder(shared / "link" / "run", make=True):
        pass
    assert not (shared / "nowhere").exists()
    (shared / "real").mkdir()
    (shared / "to").symlink_to("real")
    with opened_folder(shared / "to" / "run", make=True):
        assert (shared / "real" / "run").is_dir()
