"""Which back ends of OpenGL draw without a screen, and why the others do not."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from mujoco_port.doctor.children import Attempt, attempt
from mujoco_port.doctor.findings import Finding, State
from mujoco_port.film.gl import BACK_ENDS, PACKAGES, PROBE, VARIABLE, hindrances, probe_environment, works

TOPIC: Final = "drawing without a screen"
LOAD: Final = "import ctypes, sys; ctypes.CDLL(sys.argv[1])"
# Who draws: llvmpipe on the processor, or the name of a graphics card.
DESCRIBE: Final = """
    from OpenGL.GL import GL_RENDERER, GL_VERSION, glGetString
    print(glGetString(GL_RENDERER).decode() + ", OpenGL " + glGetString(GL_VERSION).decode())
"""
UNTRIED: Final = "its libraries load; whether it draws shows only with mujoco"
SOFTWARE: Final = ("llvmpipe", "softpipe", "swrast", "software")
VENDOR_FOLDERS: Final = ("/etc/glvnd/egl_vendor.d", "/usr/share/glvnd/egl_vendor.d")
VENDOR_VARIABLES: Final = ("__EGL_VENDOR_LIBRARY_FILENAMES", "__EGL_VENDOR_LIBRARY_DIRS")


@dataclass(frozen=True)
class BackEnd:
    """One back end: how the user calls it, and the libraries without which it cannot draw.

    Attributes:
        title: Its usual spelling.
        libraries: Names the loader knows; of each group one has to load.
    """

    title: str
    libraries: tuple[tuple[str, ...], ...]


KNOWN: Final = {
    "egl": BackEnd("EGL", (("libEGL.so.1",), ("libOpenGL.so.0", "libGL.so.1"))),
    "osmesa": BackEnd("OSMesa", (("libOSMesa.so.8", "libOSMesa.so.6"),)),
}


def examine_drawing(mujoco_works: bool) -> list[Finding]:
    """Try every back end; one that works is enough.

    Args:
        mujoco_works: Whether MuJoCo can be imported; without it only the libraries are tried.
    """
    tried = {name: try_back_end(name, mujoco_works) for name in BACK_ENDS}
    enough = any(each.works for each in tried.values())
    findings = [describe(name, each, enough) for name, each in tried.items()]
    chosen = os.environ.get(VARIABLE)
    if chosen and mujoco_works and not works(chosen):
        text = f"{VARIABLE}={chosen} is set, but {chosen} cannot draw without a screen here"
        findings.append(Finding(TOPIC, VARIABLE, State.MISSING, text, f"unset {VARIABLE}"))
    return findings


def try_back_end(name: str, mujoco_works: bool) -> Attempt:
    """Load a back end's libraries, then let MuJoCo draw with it; who drew is the first line."""
    for group in KNOWN[name].libraries:
        loaded = first_that_works(attempt(LOAD, library) for library in group)
        if not loaded.works:
            return Attempt(False, (), loaded.reason.removeprefix("OSError: "))
    if not mujoco_works:
        return Attempt(False, (), UNTRIED)
    return attempt(PROBE + DESCRIBE, environment=probe_environment(name))


def first_that_works(attempts: Iterable[Attempt]) -> Attempt:
    """The first attempt that works; if none does, the first one whose library is there but broken."""
    failed = []
    for tried in attempts:
        if tried.works:
            return tried
        failed.append(tried)
    broken = [each for each in failed if "No such file" not in each.reason]
    return (broken or failed)[0]


def describe(name: str, tried: Attempt, enough: bool) -> Finding:
    """Put one back end into words; if none works, the first one is what is missing."""
    title, first = KNOWN[name].title, BACK_ENDS[0]
    if tried.works:
        drawn_by = tried.lines[0] if tried.lines else ""
        how = " (in software)" if drawn_by.lower().startswith(SOFTWARE) else ""
        return Finding(TOPIC, title, State.WORKS, drawn_by + how)
    reason = tried.reason.split(". ")[0]
    if enough:
        return Finding(TOPIC, title, State.NOTE, f"{reason}; not needed, another one works")
    if name != first:
        return Finding(TOPIC, title, State.NOTE, f"{reason}; not needed once {KNOWN[first].title} works")
    return Finding(TOPIC, title, State.MISSING, reason, next_move(reason))


def next_move(reason: str) -> str:
    """What makes EGL work, after the reason why it does not."""
    if reason == UNTRIED:
        return "install mujoco as said above, then ask again"
    if "No such file" in reason:
        return f"apt-get install {PACKAGES}"
    path = reason.split(":")[0]
    return broken_library(Path(path)) if path.startswith("/") else driver_of_egl()


def broken_library(path: Path) -> str:
    """What to do about a library that is there and cannot be loaded."""
    if str(path.parent) in os.environ.get("LD_LIBRARY_PATH", "").split(":"):
        return f"{path} is broken: take {path.parent} out of LD_LIBRARY_PATH"
    return f"{path} is broken: install the package it comes from again (dpkg -S {path} names it)"


def driver_of_egl() -> str:
    """What to do if EGL's loader is there and finds no driver that draws."""
    if names := hindrances():
        given = " and ".join(f"{name}={os.environ[name]}" for name in names)
        return f"EGL draws without {given}: unset {' '.join(names)}"
    for variable in VENDOR_VARIABLES:
        if variable in os.environ:
            return f"EGL looks for drivers where {variable} says, and none there draws: unset {variable}"
    if not any(each for folder in VENDOR_FOLDERS for each in Path(folder).glob("*.json")):
        return f"EGL has no driver: apt-get install {PACKAGES}"
    return f"EGL's driver does not draw: apt-get install --reinstall {PACKAGES}"


def main() -> int:
    """Say in one sentence why nothing can be drawn, and what to do; 0 and no word if something can."""
    if any(works(name) for name in BACK_ENDS):
        return 0
    first = BACK_ENDS[0]
    found = describe(first, try_back_end(first, mujoco_works=True), enough=False)
    print(f"wordarm: the robot cannot be drawn here: {found.text}; {found.next_move}", file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main())
