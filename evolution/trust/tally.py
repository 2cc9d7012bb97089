"""What was done to an experiment, counted."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import Final

WORKER: Final = "worker"
ORPHAN: Final = "orphaned worker"
PARENT: Final = "parent"
STARTER: Final = "process that forks workers"


@dataclass
class Tally:
    """What happened in a torture.

    Attributes:
        writes: Kills that left an unfinished file, by (who was killed, which kind of file).
        others: All other kills, by who was killed.
        starts: How often the parent was started.
        given_up: Jobs a parent gave up, after four deaths without progress; the next one took them up.
        damages: Files damaged, named and put right, by (how, which kind of file).
        refusals: Starts that had to fail, and failed with one sentence and nothing half-written.
        rounds: Experiments that ended with the bits of the undisturbed one.
    """

    writes: Counter[tuple[str, str]] = field(default_factory=Counter)
    others: Counter[str] = field(default_factory=Counter)
    starts: int = 0
    given_up: int = 0
    damages: Counter[tuple[str, str]] = field(default_factory=Counter)
    refusals: Counter[str] = field(default_factory=Counter)
    rounds: int = 0

    @property
    def kills(self) -> int:
        """All kills."""
        return self.writes.total() + self.others.total()

    def lines(self) -> list[str]:
        """The tally for people."""
        writes, others = self.writes, self.others
        return [
            f"{self.kills} kills in {self.rounds} experiments; {writes.total()} left a file half-written",
            *(f"  {who} killed while it wrote: {_counts(writes, who)}" for who in _firsts(writes)),
            f"  killed at other moments: {', '.join(f'{who} {n}' for who, n in others.most_common())}",
            f"{self.starts} starts of the parent; jobs given up and taken up again: {self.given_up}",
            f"{self.damages.total()} files damaged, each named and recomputed",
            *(f"  {how}: {_counts(self.damages, how)}" for how in _firsts(self.damages)),
            *(f"{n} times refused with one sentence, nothing half-written: {what}"
              for what, n in sorted(self.refusals.items())),
            f"{self.rounds} of {self.rounds} experiments ended with the bits of the undisturbed one",
        ]  # fmt: skip


def _firsts(counter: Counter[tuple[str, str]]) -> list[str]:
    return sorted({first for first, _ in counter})


def _counts(counter: Counter[tuple[str, str]], first: str) -> str:
    """Counts of one kind, the most frequent first."""
    parts = [f"{second} {n}" for (each, second), n in counter.most_common() if each == first]
    return ", ".join(parts)
