"""The source files of packages, and a fingerprint that changes with every one of them."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from importlib.resources import files
from importlib.resources.abc import Traversable
from typing import Final

# What can change a number: code, and the descriptions of scenes. A template or a picture cannot.
SUFFIXES: Final = (".py", ".xml")


def sources_digest(*packages: str) -> str:
    """Twelve hexadecimal digits that change with every source file of these packages, wherever it lies."""
    digest = hashlib.sha256()
    for package in packages:
        for place, source in source_files(files(package), package):
            content = source.read_bytes()
            digest.update(f"{place} {len(content)}\n".encode())
            digest.update(content)
    return digest.hexdigest()[:12]


def source_files(folder: Traversable, place: str) -> Iterator[tuple[str, Traversable]]:
    """(place, file) of each source file in a folder and below it, in alphabetical order."""
    for each in sorted(folder.iterdir(), key=lambda each: each.name):
        name = f"{place}/{each.name}"
        if each.is_dir():
            yield from source_files(each, name)
        elif each.name.endswith(SUFFIXES):
            yield name, each
