"""Which OpenGL back end draws without a screen, EGL or OSMesa; and one drawing at a time.

A back end that does not work may end the whole process: so each is tried in a child process first, with the
very variables that this process then gets. EGL comes first, since Mesa has given up OSMesa from 25.1 on.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from importlib import import_module
from threading import RLock
from typing import Any, Final

VARIABLE: Final = "MUJOCO_GL"
BACK_ENDS: Final = ("egl", "osmesa")
PACKAGES: Final = "libegl1 libgl1 libgl1-mesa-dri"  # Debian's, for EGL in software
# Which card and which drivers EGL may use: one that is not there leaves none.
RESTRICTIONS: Final = ("MUJOCO_EGL_DEVICE_ID", "__EGL_VENDOR_LIBRARY_FILENAMES", "__EGL_VENDOR_LIBRARY_DIRS")
PROBE_TIMEOUT_S: Final = 60.0
PROBE: Final = """
import mujoco
model = mujoco.MjModel.from_xml_string('<mujoco><worldbody><light pos="0 0 1"/></worldbody></mujoco>')
with mujoco.Renderer(model, 8, 8) as renderer:
    renderer.update_scene(mujoco.MjData(model))
    assert renderer.render().shape == (8, 8, 3)
"""


class NoRenderingError(OSError):
    """Nothing on this machine, or in this process, can draw without a screen."""


class _Drawing:
    """Who draws in this process."""

    def __init__(self) -> None:
        self.lock = RLock()
        self.began = False  # whether anything was drawn
        self.inherited = False  # whether the process that this one was forked from had drawn before


_drawing = _Drawing()


def _forked() -> None:
    """A forked process inherits OpenGL's memory but none of its threads: whatever draws then never ends."""
    _drawing.inherited, _drawing.lock = _drawing.inherited or _drawing.began, RLock()


os.register_at_fork(after_in_child=_forked)


@contextmanager
def drawing() -> Iterator[None]:
    """While open, no other thread draws: what is drawn side by side would get into each other's pictures.

    Raises:
        NoRenderingError: As `choose_back_end`.
    """
    _refuse_inherited()
    with _drawing.lock:
        choose_back_end()
        yield


def choose_back_end() -> str:
    """Choose a back end that works and set MUJOCO_GL to it; a value that is set already is kept.

    Call it before anything imports mujoco if `mujoco.Renderer` is to draw with it.

    Raises:
        NoRenderingError: If none works, the chosen one does not, or this process was forked after drawing.
    """
    _refuse_inherited()
    chosen = os.environ.get(VARIABLE, "").strip().lower()
    if chosen and not works(chosen):
        raise NoRenderingError(
            f"{VARIABLE}={chosen} cannot draw without a screen here; unset {VARIABLE} to let "
            f"{' or '.join(BACK_ENDS)} be chosen"
        )
    name = chosen or next((each for each in BACK_ENDS if works(each)), "")
    if not name:
        raise NoRenderingError(_why_none())
    os.environ.update(probe_environment(name))
    return name


@contextmanager
def without_drawing() -> Iterator[None]:
    """While open, mujoco can be imported, by child processes too, whatever MUJOCO_GL says: nothing draws."""
    before = os.environ.get(VARIABLE)
    os.environ[VARIABLE] = "disable"
    try:
        yield
    finally:
        del os.environ[VARIABLE]
        if before is not None:
            os.environ[VARIABLE] = before


def new_context(width_px: int, height_px: int) -> Any:
    """A context of OpenGL, of the chosen back end even if mujoco was imported before it was chosen.

    Raises:
        NoRenderingError: If none can be made in this process, or as `choose_back_end`.
    """
    name = choose_back_end()
    _drawing.began = True
    try:
        home = import_module(f"mujoco.{name}" if name in BACK_ENDS else "mujoco")
        return home.GLContext(width_px, height_px)
    except (ImportError, AttributeError, RuntimeError) as error:
        raise NoRenderingError(
            f"{name} draws in a process of its own, but not in this one ({error}); start Python anew, "
            "and let nothing use OpenGL before"
        ) from None


def refuse_other_renderer() -> None:
    """Refuse if `mujoco.Renderer` would not draw with the chosen back end.

    Raises:
        NoRenderingError: If mujoco was imported before it was chosen.
    """
    import mujoco

    name = choose_back_end()
    context = getattr(mujoco, "GLContext", None)  # there is none if it was imported without drawing
    if name in BACK_ENDS and (context is None or context.__module__ != f"mujoco.{name}"):
        raise NoRenderingError(
            f"mujoco was imported before a back end was chosen; set {VARIABLE}={name} before starting "
            "Python, or call mujoco_port.choose_back_end() first"
        )


@cache
def works(back_end: str, without: tuple[str, ...] = ()) -> bool:
    """Whether a back end draws a picture, tried in a process of its own.

    Args:
        back_end: Which.
        without: Variables that this process does not get.
    """
    variables = {name: value for name, value in os.environ.items() if name not in without}
    try:
        probe = subprocess.run(  # noqa: S603 - our own interpreter and text
            # -P: what lies in the current folder must not be taken for a library.
            [sys.executable, "-P", "-c", PROBE],
            env={**variables, **probe_environment(back_end)},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=PROBE_TIMEOUT_S,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return False
    return probe.returncode == 0


def probe_environment(back_end: str) -> dict[str, str]:
    """The variables that make MuJoCo use a back end, whatever stood in them."""
    platform = {"PYOPENGL_PLATFORM": back_end} if back_end in BACK_ENDS else {}
    return {VARIABLE: back_end, **platform}


def hindrances() -> tuple[str, ...]:
    """The variables without which EGL would draw, where it does not; none if they are not to blame."""
    given = tuple(name for name in RESTRICTIONS if name in os.environ)
    tries = [*((name,) for name in given), given]
    return next((names for names in tries if names and works(BACK_ENDS[0], names)), ())


def _refuse_inherited() -> None:
    """Refuse a process that was forked from one that had drawn."""
    if _drawing.inherited:
        raise NoRenderingError(
            "this process was forked from one that had drawn, where nothing more can be drawn; start "
            "processes with multiprocessing.get_context('spawn')"
        )


def _why_none() -> str:
    """Why nothing draws, and the next move."""
    if names := hindrances():
        given = " and ".join(f"{name}={os.environ[name]}" for name in names)
        return f"with {given} EGL cannot draw here; run: unset {' '.join(names)}"
    return (
        "neither EGL nor OSMesa can draw here without a screen; "
        f"run: apt-get install {PACKAGES}, or `wordarm doctor` to see why"
    )
