"""Faults that no test can notice, since they change nothing that anybody could ask for, each with its reason.

They stand in tests/mutants/equivalent.toml, so that a survivor is argued about once.
"""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Final

from scripts.trying_faults import ROOT, Row

FILE: Final = ROOT / "tests" / "mutants" / "equivalent.toml"
Key = tuple[str, str, str, str]


def key_of(row: Row) -> Key:
    """What names a fault in the file: its module, its kind, and its lines without their indentation."""
    return row.path, row.kind, row.before.strip(), row.after.strip()


def reasons(file: Path = FILE) -> dict[Key, str]:
    """Why each fault that is named in the file can have no test."""
    with file.open("rb") as opened:
        named = tomllib.load(opened)["equivalent"]
    return {(each["path"], each["kind"], each["before"], each["after"]): each["reason"] for each in named}
