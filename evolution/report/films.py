"""Films that lie beside an experiment's runs, as its page shows them: a still of each, and where it is."""

from __future__ import annotations

import subprocess
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Final

from arm2d import ActionWord, ObjectWord
from arm2d.films import NoEncoderError, find_encoder
from arm2d.records import brief
from evolution.report.pictures import data_uri
from evolution.report.safety import link_to

# So long before its end, a film shows the hand where it is to be and the clock that is running [s].
BEFORE_THE_END_S: Final = 1.5
WIDTH: Final = 640  # of a still [px]
PATIENCE_S: Final = 20.0


@dataclass(frozen=True)
class Film:
    """One film.

    Attributes:
        name: What it shows.
        link: Its address, relative to the page; empty if it does not lie below the page's folder.
        still: The address of a picture of it; empty if none can be made.
    """

    name: str
    link: str
    still: str

    __repr__ = brief


def films_of(experiment: Path, home: Path) -> Iterator[Film]:
    """Every film beside the runs, for a page in the folder `home`; links and unfinished files are none."""
    for path in sorted([*experiment.glob("videos/[!.]*.mp4"), *experiment.glob("*/*/videos/[!.]*.mp4")]):
        if path.is_symlink() or path.parent.is_symlink() or not path.is_file():
            continue
        parts = [part for part in path.relative_to(experiment).parts[:-1] if part != "videos"]
        below = path.resolve().is_relative_to(home.resolve())
        yield Film(_caption(parts, path.stem), link_to(path, home) if below else "", _still(path))


def _caption(folders: Sequence[str], stem: str) -> str:
    """What a film shows: first its instruction, if its name tells one as `wordarm port` does."""
    words = stem.split("-")
    for place, (action, object_) in enumerate(pairwise(words)):
        if action.upper() in ActionWord.__members__ and object_.upper() in ObjectWord.__members__:
            how = " ".join(words[place + 2 :])
            told = f"{action.upper()} {object_.capitalize()}" + (f" ({how})" if how else "")
            return ", ".join(part for part in (told, *folders, " ".join(words[:place])) if part)
    return ", ".join([*folders, " ".join(words)])


def _still(film: Path) -> str:
    """A picture near the end of a film, as an address; empty if it cannot be had."""
    # Whatever the file says, it is read as MP4 and leads to no other file or machine.
    reading = ("-protocol_whitelist", "file", "-f", "mp4", "-sseof", str(-BEFORE_THE_END_S))
    drawing = ("-frames:v", "1", "-vf", f"scale={WIDTH}:-2", "-c:v", "mjpeg", "-q:v", "4", "-f", "image2pipe")
    try:
        found = subprocess.run(  # noqa: S603 - a program, no shell
            [find_encoder(), "-v", "error", *reading, "-i", str(film.absolute()), *drawing, "-"],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            check=True,
            timeout=PATIENCE_S,
        )
    except (NoEncoderError, OSError, subprocess.SubprocessError):
        return ""
    return data_uri("image/jpeg", found.stdout) if found.stdout else ""
