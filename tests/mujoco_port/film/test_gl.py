"""Which back end of OpenGL draws; threads and forked processes; that program and doctor see the same."""

import multiprocessing
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import pytest

from mujoco_port.film.gl import NoRenderingError
from mujoco_port.film.port import port_picture

CHOOSE = "from mujoco_port.film.gl import choose_back_end; print(choose_back_end())"
# A context in this very process, as every picture of the robot needs one.
DRAW = (
    f"{CHOOSE}; from mujoco_port.film.gl import new_context; new_context(8, 8).make_current(); print('drawn')"
)
DOCTOR = """
from mujoco_port.doctor.drawing import examine_drawing
print("; ".join(f"{each.name} {each.state.value} {each.next_move}" for each in examine_drawing(True)))
"""
EGL_DRIVERS_HIDDEN = {"__EGL_VENDOR_LIBRARY_DIRS": "/nowhere", "__EGL_VENDOR_LIBRARY_FILENAMES": ""}


def _draw(record, path, step=0):
    return port_picture(record, step, path, quality="draft")


def run_gl(code, **environment):
    """Run Python with these variables; its (exit code, last line of output)."""
    base = {
        name: value for name, value in os.environ.items() if name not in ("MUJOCO_GL", "PYOPENGL_PLATFORM")
    }
    done = subprocess.run(
        [sys.executable, "-c", code], env={**base, **environment}, capture_output=True, text=True, check=False
    )
    return done.returncode, (done.stdout + done.stderr).strip().splitlines()[-1]


def test_a_back_end_that_works_is_chosen_by_itself():
    assert run_gl(CHOOSE) in [(0, "egl"), (0, "osmesa")]


def test_a_chosen_back_end_that_cannot_draw_is_named():
    code, line = run_gl(CHOOSE, MUJOCO_GL="glfw", DISPLAY="")
    assert code == 1
    assert "MUJOCO_GL=glfw cannot draw without a screen here; unset MUJOCO_GL" in line


def test_egl_whose_drivers_are_hidden_gives_way_or_names_what_hides_them():
    code, line = run_gl(CHOOSE, **EGL_DRIVERS_HIDDEN)
    given = "with __EGL_VENDOR_LIBRARY_FILENAMES= and __EGL_VENDOR_LIBRARY_DIRS=/nowhere EGL cannot draw here"
    assert (code, line) == (0, "osmesa") or given in line


def test_a_card_that_is_not_there_is_named_by_program_and_doctor():
    code, line = run_gl(CHOOSE, MUJOCO_EGL_DEVICE_ID="5")
    if (code, line) == (0, "osmesa"):
        pytest.skip("OSMesa takes over here")
    assert line.endswith("with MUJOCO_EGL_DEVICE_ID=5 EGL cannot draw here; run: unset MUJOCO_EGL_DEVICE_ID")
    code, line = run_gl(DOCTOR, MUJOCO_EGL_DEVICE_ID="5")
    assert "EGL missing EGL draws without MUJOCO_EGL_DEVICE_ID=5: unset MUJOCO_EGL_DEVICE_ID" in line


def test_a_platform_of_pyopengl_that_does_not_fit_hinders_neither_program_nor_doctor():
    name = run_gl(CHOOSE)[1]
    other = {"egl": "osmesa", "osmesa": "egl"}[name]
    assert run_gl(DRAW, PYOPENGL_PLATFORM="glx") == (0, "drawn")
    assert run_gl(DRAW, PYOPENGL_PLATFORM=other, MUJOCO_GL=name) == (0, "drawn")
    assert f"{name} ok" in run_gl(DOCTOR, PYOPENGL_PLATFORM=other)[1].lower()


def test_no_back_end_at_all_says_what_to_install():
    broken = "import mujoco_port.film.gl as gl; gl.works = lambda *name: False; gl.choose_back_end()"
    code, line = run_gl(broken)
    assert code == 1
    assert "neither EGL nor OSMesa can draw here without a screen; run: apt-get install libegl1" in line


def test_mujoco_may_be_imported_before_a_back_end_is_chosen():
    assert run_gl(f"import mujoco; {DRAW}") == (0, "drawn")


def test_mujoco_imported_too_early_for_its_own_renderer_is_named():
    renderer = "from mujoco_port.film.gl import refuse_other_renderer; refuse_other_renderer()"
    code, line = run_gl(f"import mujoco; {renderer}")
    assert code == 1
    assert "mujoco was imported before a back end was chosen; set MUJOCO_GL=" in line
    assert run_gl(f"{CHOOSE}; {renderer}")[0] == 0


def test_a_file_in_the_current_folder_is_not_taken_for_a_package(tmp_path, monkeypatch):
    (tmp_path / "mujoco.py").write_text("raise RuntimeError('a stray file was imported')")
    monkeypatch.chdir(tmp_path)
    code = "import sys; sys.path.remove(''); " + CHOOSE
    assert run_gl(code) in [(0, "egl"), (0, "osmesa")]


def test_pictures_drawn_in_several_threads_are_those_drawn_one_by_one(champion_records, tmp_path):
    records = champion_records[:2]
    alone = [_draw(record, tmp_path / f"alone-{k}.png", 3) for k, record in enumerate(records)]
    with ThreadPoolExecutor(2) as pool:
        together = pool.map(
            lambda k: _draw(records[k], tmp_path / f"together-{k}.png", 3), range(len(records))
        )
        for one, other in zip(alone, together, strict=True):
            assert one.read_bytes() == other.read_bytes()


def test_a_pool_forked_after_something_was_drawn_is_refused_and_a_spawned_one_draws(
    champion_records, tmp_path
):
    record, path = champion_records[0], tmp_path / "picture.png"
    drawn = _draw(record, path).read_bytes()
    with (
        multiprocessing.get_context("fork").Pool(1) as pool,
        pytest.raises(NoRenderingError, match=r"was forked from one that had drawn.*get_context\('spawn'\)"),
    ):
        pool.apply_async(_draw, (record, path)).get(timeout=120)
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        pool.apply_async(_draw, (record, path)).get(timeout=120)
    assert path.read_bytes() == drawn


def test_eyes_that_nobody_closes_are_closed_when_python_ends():
    code = (
        "from mujoco_port.film.gl import choose_back_end; choose_back_end()\n"
        "from arm2d import Readings\n"
        "from models.robots import get_robot\n"
        "from mujoco_port.acting.camera import CameraEyes\n"
        "from mujoco_port.acting.control import Body\n"
        "eyes = CameraEyes(Body(get_robot('icub')), Readings())\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "Exception ignored" not in done.stderr
