"""Which OpenGL back end draws without a screen: EGL or OSMesa.

MuJoCo reads MUJOCO_GL when it is imported, and a back end that does not work may end the whole process:
so each is tried in a child process, before `import mujoco`. EGL comes first, since Mesa has given up
OSMesa from 25.1 on.
"""

from __future__ import annotations

import os
import subprocess
import sys
from functools import cache
from typing import Final

VARIABLE: Final = "MUJOCO_GL"
BACK_ENDS: Final = ("egl", "osmesa")
PACKAGES: Final = "libegl1 libgl1 libgl1-mesa-dri"  # Debian's, for EGL in software
PROBE_TIMEOUT_S: Final = 60.0
PROBE: Final = """
import mujoco
model = mujoco.MjModel.from_xml_string('<mujoco><worldbody><light pos="0 0 1"/></worldbody></mujoco>')
with mujoco.Renderer(model, 8, 8) as renderer:
    renderer.update_scene(mujoco.MjData(model))
    assert renderer.render().shape == (8, 8, 3)
"""


class NoRenderingError(OSError):
    """Nothing on this machine can draw without a screen."""


def choose_back_end() -> str:
    """Choose a back end that works and set MUJOCO_GL to it; a value that is set already is kept.

    Call it before anything imports mujoco.

    Raises:
        NoRenderingError: If none works, the chosen one does not, or mujoco was imported too early.
    """
    chosen = os.environ.get(VARIABLE)
    if chosen:
        if not works(chosen):
            raise NoRenderingError(
                f"{VARIABLE}={chosen} cannot draw without a screen here; unset {VARIABLE} to let "
                f"{' or '.join(BACK_ENDS)} be chosen"
            )
        return chosen
    if "mujoco" in sys.modules:
        raise NoRenderingError(
            f"mujoco was imported before a back end was chosen; set {VARIABLE}=egl before starting Python"
        )
    for name in BACK_ENDS:
        if works(name):
            os.environ[VARIABLE] = name
            return name
    raise NoRenderingError(
        "neither EGL nor OSMesa can draw here without a screen; "
        f"run: apt-get install {PACKAGES}, or `wordarm doctor` to see why"
    )


@cache
def works(back_end: str) -> bool:
    """Whether a back end draws a picture, tried in a process of its own."""
    try:
        probe = subprocess.run(  # noqa: S603 - our own interpreter and text
            # -P: what lies in the current folder must not be taken for a library.
            [sys.executable, "-P", "-c", PROBE],
            env={**os.environ, **probe_environment(back_end)},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=PROBE_TIMEOUT_S,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return False
    return probe.returncode == 0


def probe_environment(back_end: str) -> dict[str, str]:
    """The variables that make MuJoCo use a back end."""
    platform = {"PYOPENGL_PLATFORM": back_end} if back_end in BACK_ENDS else {}
    return {VARIABLE: back_end, **platform}
