"""How far the runs of an experiment have come, read from their files alone, and how long they still take.

Pace is told by the times at which finished parts were written, so it can be read at any time, by anyone.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise
from pathlib import Path
from statistics import median
from typing import Final

from evolution.agents.parts import late_spans
from evolution.agents.postevaluation import POST_EVALUATION
from evolution.agents.solving import FILE as SOLVED
from evolution.agents.transitions import TRANSITION_TEST
from evolution.runs.folder import CHAMPIONS, CONFIG, GENERATIONS_PER_PART, LOCK, RunFolder
from evolution.runs.lease import held_elsewhere
from evolution.runs.lock import Word, last_word
from evolution.runs.storage import DamagedFileError
from evolution.search.config import RunConfig
from evolution.search.settings import Settings

LOCK_TABLE: Final = Path("/proc/locks")
TESTS: Final = (POST_EVALUATION, TRANSITION_TEST)
# Until parts have been tested: the time of 100 generations' tests, as a multiple of that of their
# evolution, measured with the plain readings.
TESTS_PER_EVOLUTION: Final = 2.5


@dataclass(frozen=True)
class Standing:
    """How far one run has come.

    Attributes:
        config: The run.
        generations: Scored: those in finished parts, or as many as the process at work tells.
        best: Best fitness in the last of them; NaN if there is none.
        tested: Parts of both tests that are there, of `to_test`.
        to_test: Twice the parts of the late generations.
        finished: Whether all generations are in finished parts.
        evolved: Whether evolution is over, champions included.
        done: Whether the tests are over too.
        at_work: Whether a process holds the run.
        damage: What is wrong with it, or nothing.
        variant: Of the experiment, if it has several.
    """

    config: RunConfig
    generations: int = 0
    best: float = float("nan")
    tested: int = 0
    to_test: int = 0
    finished: bool = False
    evolved: bool = False
    done: bool = False
    at_work: bool = False
    damage: str = ""
    variant: str = ""

    @property
    def name(self) -> str:
        """Variant, condition and seed."""
        return f"{self.variant}, {self.short_name}" if self.variant else self.short_name

    @property
    def short_name(self) -> str:
        """Condition and seed."""
        return f"{self.config.condition}, seed {self.config.seed}"

    @property
    def state(self) -> str:
        """One word for it."""
        if self.damage:
            return "damaged"
        if self.done:
            return "done"
        if not self.at_work:
            return "waiting"
        return "testing" if self.evolved else "evolving"


@dataclass(frozen=True)
class Pace:
    """What things take [s]: a generation of the paper's size, and a part of one test."""

    generation: float
    test: float

    def left(self, standing: Standing) -> float:
        """Time a run still takes [s]; NaN while that is unknown."""
        config, tests = standing.config, standing.to_test - standing.tested
        generations = config.settings.generations - standing.generations
        return generations * size_of(config) * self.generation + (tests * self.test if tests else 0.0)


def size_of(config: RunConfig) -> float:
    """Trials in a generation, as a multiple of the paper's."""
    settings, paper = config.settings, Settings()
    trials = settings.population * settings.trials_per_area
    return trials / (paper.population * paper.trials_per_area)


def standing_of(
    path: Path, config: RunConfig, *, variant: str = "", to_be_tested: bool | None = True
) -> Standing:
    """How far a run has come; one that was not started has come nowhere.

    Args:
        path: Its folder.
        config: The run.
        variant: Its variant, for people.
        to_be_tested: Whether the paper's tests belong to it; None if they do once they were begun.
    """
    run = RunFolder(path, config)
    try:
        late = late_spans(run)
        tested = sum(test.path(run, each).exists() for test in TESTS for each in late)
        to_be_tested = bool(tested) if to_be_tested is None else to_be_tested
        fresh = Standing(config, to_test=2 * len(late) if to_be_tested else 0, variant=variant)
        if not (path / CONFIG).exists():
            return fresh
        return _standing_of_started(run, replace(fresh, tested=tested if to_be_tested else 0))
    except OSError as error:
        return Standing(config, variant=variant, damage=f"{path} cannot be read: {error.strerror}")


def _standing_of_started(run: RunFolder, fresh: Standing) -> Standing:
    """The same of a run that was begun."""
    generations, best, damage, finished = _recorded(run)
    held = is_held(run.path)
    word = last_word(run.path) if held else Word()
    if word.generations > generations and not damage:
        generations, best = word.generations, word.best
    evolved = finished and (run.path / CHAMPIONS).exists()
    tested = fresh.tested == fresh.to_test and (
        not fresh.to_test or (run.path / POST_EVALUATION.folder / SOLVED).exists()
    )
    return replace(
        fresh,
        generations=generations,
        best=best,
        finished=finished,
        evolved=evolved,
        done=evolved and tested,
        at_work=held,
        damage=damage,
    )


def _recorded(run: RunFolder) -> tuple[int, float, str, bool]:
    """What finished parts hold: generations, best fitness of the last, damage, and whether that is all."""
    try:
        spans = run.finished_spans()
    except DamagedFileError as error:
        return 0, float("nan"), str(error), False
    if not spans:
        return 0, float("nan"), "", False
    best, damage = float("nan"), ""
    try:
        best = _best_of_part(run, spans[-1])
    except DamagedFileError as error:
        damage = str(error)
    return spans[-1].stop, best, damage, len(spans) == len(run.spans)


def is_held(path: Path) -> bool:
    """Whether a process works on a run, of whatever machine; asked without touching its lock."""
    if held_elsewhere(path):
        return True
    try:
        inode = (path / LOCK).stat().st_ino
        locks = LOCK_TABLE.read_text(encoding="utf-8").splitlines()
    except OSError:
        return False
    return any("FLOCK" in line and f":{inode} " in line and "->" not in line for line in locks)


def pace_of(runs: Iterable[RunFolder]) -> Pace:
    """What a generation and a test's part take, the median over all runs; NaN where nothing tells."""
    generations, evaluations, transitions = [], [], []
    for run in runs:
        size = size_of(run.config)
        generations += [each / size for each in _intervals([run.part_path(each) for each in run.spans])]
        evaluations += _intervals([POST_EVALUATION.path(run, span) for span in late_spans(run)])
        transitions += _intervals([TRANSITION_TEST.path(run, span) for span in late_spans(run)])
    part = median(generations) if generations else float("nan")
    default = TESTS_PER_EVOLUTION * part / 2
    tests = [median(each) if each else default for each in (evaluations, transitions)]
    return Pace(part / GENERATIONS_PER_PART, sum(tests) / 2)


def time_left(standings: Sequence[Standing], pace: Pace, at_once: int) -> float:
    """Time until all runs are done [s]: what is left, shared by so many processes; at least the longest."""
    left = [pace.left(each) for each in standings if not each.done and not each.damage]
    return max([sum(left) / max(at_once, 1), *left], default=0.0)


def _intervals(paths: Sequence[Path]) -> list[float]:
    """Times between the writing of one part and the next [s]."""
    written = []
    for path in paths:
        try:
            written.append(path.stat().st_mtime)
        except OSError:
            break
    return [later - earlier for earlier, later in pairwise(written) if later > earlier]


@lru_cache(maxsize=4096)
def _best_of_part(run: RunFolder, span: range) -> float:
    """Best fitness in the last generation of a part, which never changes."""
    return float(run.read_part(span).best[-1])
