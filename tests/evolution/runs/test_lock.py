"""Who holds a run, and what the holder says of it."""

import math
import os

import pytest

from evolution.runs.folder import LOCK
from evolution.runs.lock import Word, last_word, locked
from evolution.runs.run import Watcher, evolve
from tests.evolution.small_runs import SMALL


def test_the_holder_says_who_it_is_and_how_far_it_has_come(tmp_path):
    with locked(tmp_path) as hold:
        assert last_word(tmp_path) == Word(os.getpid(), 0, last_word(tmp_path).best)
        assert math.isnan(last_word(tmp_path).best)
        hold.tell(1234, 2.1034512)
        assert last_word(tmp_path) == Word(os.getpid(), 1234, 2.103451)
        hold.tell(7, 0.5)  # shorter than before: nothing of the old word is left
        assert last_word(tmp_path) == Word(os.getpid(), 7, 0.5)


def test_a_run_at_work_tells_the_first_generation_at_once(tmp_path):
    scored, told = [], []

    def stop_after_the_first():
        told.append(last_word(tmp_path))
        return bool(scored)

    evolve(tmp_path, SMALL, Watcher(on_generation=scored.append, wants_stop=stop_after_the_first))
    assert told[0].generations == 0
    assert told[1] == Word(os.getpid(), 1, pytest.approx(scored[0].best, abs=1e-6))


@pytest.mark.parametrize(
    "content", ["", "x", "4711", "4711\n12\n", "4711\n12 nan\n", "-1\n", "4711\n1 2.000000\nmore\n"]
)
def test_what_nobody_can_have_said_is_not_believed(content, tmp_path):
    assert last_word(tmp_path) == Word(0, 0, last_word(tmp_path).best)
    (tmp_path / LOCK).write_text(content)
    assert last_word(tmp_path).process == 0


def test_a_lock_that_is_a_link_is_not_followed(tmp_path):
    (tmp_path / "thesis.txt").write_text("a year's work")
    (tmp_path / "run").mkdir()
    (tmp_path / "run" / LOCK).symlink_to(tmp_path / "thesis.txt")
    refusal = "is a symbolic link, which is not followed; remove it"
    with pytest.raises(OSError, match=refusal), locked(tmp_path / "run"):
        pass
    assert (tmp_path / "thesis.txt").read_text() == "a year's work"
    os.unlink(tmp_path / "run" / LOCK)
    os.mkfifo(tmp_path / "run" / LOCK)
    assert last_word(tmp_path / "run").process == 0
    with pytest.raises(OSError, match="is no file; remove it"), locked(tmp_path / "run"):
        pass
