"""What an examination finds: one record for each thing looked at."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class State(Enum):
    """How a thing stands: it works; it does not, but nothing needs it; it does not and is needed."""

    WORKS = "ok"
    NOTE = "note"
    MISSING = "missing"


@dataclass(frozen=True)
class Finding:
    """One thing that was looked at.

    Attributes:
        topic: Heading it belongs under.
        name: What was looked at.
        state: How it stands.
        text: What was found.
        next_move: What to do about it; empty where nothing has to be done.
    """

    topic: str
    name: str
    state: State
    text: str
    next_move: str = ""


def lacks(findings: list[Finding]) -> bool:
    """Say whether anything that is needed is missing."""
    return any(each.state is State.MISSING for each in findings)
