"""`wordarm doctor` on machines that lack something; each is made of environment variables or links."""

import json
import os
import re
import shutil
import subprocess
import sys
import venv
from pathlib import Path

import pytest

from mujoco_port.doctor.children import attempt
from mujoco_port.doctor.findings import State
from mujoco_port.doctor.machine import container_share
from mujoco_port.doctor.packages import IMPORT, remedy

DRAWING = """
from mujoco_port.doctor.drawing import examine_drawing
for each in examine_drawing(mujoco_works={works}):
    print(each.state.value, each.name, each.text, each.next_move, sep="|")
"""
EGL_DRIVER_HIDDEN = {"__EGL_VENDOR_LIBRARY_DIRS": "/nowhere", "__EGL_VENDOR_LIBRARY_FILENAMES": ""}


def run(command, **environment):
    base = {
        name: value for name, value in os.environ.items() if name not in ("MUJOCO_GL", "PYOPENGL_PLATFORM")
    }
    return subprocess.run(
        [sys.executable, *command], env={**base, **environment}, capture_output=True, text=True, check=False
    )


def doctor(**environment):
    """(exit code, lines) of the whole command."""
    done = run(["-m", "evolution", "doctor"], **environment)
    assert done.stderr == ""
    return done.returncode, done.stdout.splitlines()


def drawing(works=True, **environment):
    """What is found about drawing: title -> (state, text, next move)."""
    done = run(["-c", DRAWING.format(works=works)], **environment)
    assert done.returncode == 0, done.stderr
    rows = [line.split("|") for line in done.stdout.splitlines()]
    return {name: (State(state), text, move) for state, name, text, move in rows}


def line_of(lines, name):
    """The line about a thing, and what to do about it."""
    found = [line for line in lines if name in line.split()]
    moves = [line.split(": ", 1)[1] for line in lines if line.startswith(f"  {name}: ")]
    return found[0], moves


@pytest.fixture
def broken_egl(tmp_path):
    """A folder with a libEGL that is none."""
    folder = tmp_path / "broken"
    folder.mkdir()
    (folder / "libEGL.so.1").write_text("not a library")
    return folder


@pytest.fixture
def thin_python(tmp_path):
    """An interpreter that sees all installed packages but those given by how their names begin."""
    ours = [Path(each) for each in dict.fromkeys(sys.path) if each.endswith("site-packages")]

    def make(*left_out):
        home = tmp_path / "thin"
        venv.create(home, with_pip=False, symlinks=True)
        theirs = next(home.glob("lib/python*/site-packages"))
        for entry in (each for folder in ours for each in folder.iterdir()):
            link = theirs / entry.name
            # What a .pth file leads to is linked itself, or left out.
            if not entry.name.lower().startswith(left_out) and entry.suffix != ".pth" and not link.exists():
                link.symlink_to(entry)
        return str(home / "bin" / "python")

    return make


def test_a_machine_with_everything_is_told_so_and_where_things_come_from():
    code, lines = doctor()
    assert code == 0, lines
    assert lines[0].startswith("wordarm ")
    for name in ("mujoco", "pin", "icub-models", "numba", "ffmpeg", "cores", "disk"):
        assert line_of(lines, name)[0].split()[0] in ("ok", "note"), name
    import pinocchio

    assert str(Path(pinocchio.__file__).parent) in line_of(lines, "pin")[0]


def test_a_broken_libegl_in_the_library_path_is_named_with_its_folder(broken_egl):
    state, text, move = drawing(LD_LIBRARY_PATH=str(broken_egl))["EGL"]
    assert state in (State.MISSING, State.NOTE)  # a note where OSMesa is installed
    assert f"{broken_egl}/libEGL.so.1: " in text
    if state is State.MISSING:
        assert move == f"{broken_egl}/libEGL.so.1 is broken: take {broken_egl} out of LD_LIBRARY_PATH"


def test_egl_whose_driver_is_hidden_says_which_variable_hides_it():
    state, text, move = drawing(**EGL_DRIVER_HIDDEN)["EGL"]
    assert state in (State.MISSING, State.NOTE)
    assert "EGL" in text
    if state is State.MISSING:
        assert "unset __EGL_VENDOR_LIBRARY_FILENAMES" in move


def test_without_mujoco_the_libraries_are_tried_all_the_same(broken_egl):
    state, text, move = drawing(works=False)["EGL"]
    assert (state, move) == (State.MISSING, "install mujoco as said above, then ask again")
    assert text == "its libraries load; whether it draws shows only with mujoco"
    assert str(broken_egl) in drawing(works=False, LD_LIBRARY_PATH=str(broken_egl))["EGL"][1]


def test_a_chosen_back_end_that_does_not_draw_is_missing():
    found = drawing(MUJOCO_GL="glfw", DISPLAY="", WAYLAND_DISPLAY="")
    assert found["MUJOCO_GL"][0] is State.MISSING
    assert found["MUJOCO_GL"][2] == "unset MUJOCO_GL"


def test_a_back_end_that_does_not_exist_is_not_blamed_on_mujoco():
    code, lines = doctor(MUJOCO_GL="nonsense")
    assert code == 1
    assert line_of(lines, "mujoco")[0].split()[0] == "ok"
    assert line_of(lines, "MUJOCO_GL")[1] == ["unset MUJOCO_GL"]


def test_osmesa_alone_is_enough(tmp_path):
    """Where OSMesa is installed; WORDARM_TEST_OSMESA may name a folder that holds its library."""
    folder = os.environ.get("WORDARM_TEST_OSMESA", "")
    found = drawing(**EGL_DRIVER_HIDDEN, LD_LIBRARY_PATH=folder)
    if "No such file" in found["OSMesa"][1]:
        pytest.skip("no libOSMesa here: apt-get install libosmesa6")
    assert found["OSMesa"][0] is State.WORKS
    assert found["EGL"][0] is State.NOTE


def test_no_library_visible_says_what_to_install(tmp_path):
    """In a mount namespace of its own, empty folders lie over those that hold the libraries of OpenGL."""
    if shutil.which("unshare") is None or run_unshared("true").returncode != 0:
        pytest.skip("this machine allows no mount namespaces")
    code = DRAWING.format(works=True)
    hide = """
for file in $(ldconfig -p | grep -oE '/[^ ]*/lib(EGL|OSMesa)[^/]*$'); do
    mv_to=$(readlink -f "$file"); mount --bind /dev/null "$mv_to"
done
exec "$@"
"""
    done = run_unshared("sh", "-c", hide, "sh", sys.executable, "-c", code)
    assert done.returncode == 0, done.stderr
    egl = done.stdout.splitlines()[0].split("|")
    assert egl[:2] == ["missing", "EGL"]
    assert "libEGL" in egl[3]


def run_unshared(*command):
    return subprocess.run(["unshare", "-rm", *command], capture_output=True, text=True, check=False)


def test_packages_that_are_not_there_at_all_are_named_with_the_command_that_installs_them(thin_python):
    python = thin_python("mujoco", "pin-", "cmeel", "libpinocchio", "libcoal", "coal", "eigenpy")
    done = subprocess.run([python, "-m", "evolution", "doctor"], capture_output=True, text=True, check=False)
    lines = done.stdout.splitlines()
    assert (done.returncode, done.stderr) == (1, "")
    for name, command in (
        ("mujoco", "pip install 'mujoco!=4.0.0,<5,>=3.17'"),
        ("pin", "pip install 'pin>=4'"),
    ):
        line, moves = line_of(lines, name)
        assert line.split() == ["missing", name, "not", "installed"]
        assert moves == [command]
    assert line_of(lines, "EGL")[0].split()[0] == "missing"


def test_a_pinocchio_of_a_ros_workspace_is_found_and_named(tmp_path):
    workspace = tmp_path / "install" / "site-packages"
    (workspace / "pinocchio").mkdir(parents=True)
    (workspace / "pinocchio" / "__init__.py").write_text('__version__ = "2.6.21"\n')
    code, lines = doctor(PYTHONPATH=str(workspace), ROS_DISTRO="jazzy")
    assert code == 1
    line, moves = line_of(lines, "pin")
    assert f"pinocchio comes from {workspace}/pinocchio/__init__.py, not from the package pin" in line
    assert moves == ["run it without that folder: env -u PYTHONPATH wordarm ..."]
    assert f"{workspace} (ROS jazzy), whose packages come before ours" in line_of(lines, "PYTHONPATH")[0]


def test_libraries_below_a_folder_with_a_blank_are_found(tmp_path):
    package = tmp_path / "an environment" / "thing"
    package.mkdir(parents=True)
    rows = [line.split(maxsplit=5) for line in Path("/proc/self/maps").read_text().splitlines()]
    some_library = next(row[5] for row in rows if re.search(r"/libm[.-][^/]*$", row[-1]))
    library = package / "libthing.so"
    shutil.copy(some_library, library)
    (package / "__init__.py").write_text(f"import ctypes; ctypes.CDLL({str(library)!r})")
    tried = attempt(IMPORT, "thing", environment={"PYTHONPATH": str(package.parent)})
    assert tried.works, tried.reason
    assert json.loads(tried.lines[1])[1] == [str(library)]


def test_a_library_that_the_system_lacks_is_not_blamed_on_the_package():
    """As a bare Debian says it of the wheel of Pinocchio."""
    reason = "ImportError: libgomp.so.1: cannot open shared object file: No such file or directory"
    assert remedy(reason, "pin>=4") == "apt-get install libgomp1"
    assert remedy("ImportError: bad magic number", "pin>=4") == "pip install --force-reinstall 'pin>=4'"


def test_ffmpeg_and_cache_that_cannot_be_used_are_named(tmp_path):
    (tmp_path / "file").write_text("no folder")
    code = """
from mujoco_port.doctor.machine import cache, encoder
for each in (cache(), encoder()):
    print(each.state.value, each.name, each.next_move, sep="|")
"""
    done = run(["-c", code], IMAGEIO_FFMPEG_EXE="/nowhere/ffmpeg", NUMBA_CACHE_DIR=str(tmp_path / "file"))
    compiled, ffmpeg = (line.split("|") for line in done.stdout.splitlines())
    assert compiled[:2] == ["note", "compiled code"]
    assert "export NUMBA_CACHE_DIR=" in compiled[2]
    assert ffmpeg == ["missing", "ffmpeg", "unset IMAGEIO_FFMPEG_EXE"]


def test_damaged_files_among_compiled_code_are_counted(tmp_path):
    code = "from mujoco_port.doctor.machine import cache\nprint(cache().state.value, cache().text)"
    told = run(["-c", code], NUMBA_CACHE_DIR=str(tmp_path)).stdout
    assert told.startswith(f"ok {tmp_path}")
    assert told.endswith(" (empty, the first command compiles for some 10 s)\n")
    folder = next((tmp_path / "wordarm").iterdir())
    (folder / "some.nbi").write_bytes(b"")
    (folder / "some.1.nbc").write_bytes(b"no machine code")
    told = run(["-c", code], NUMBA_CACHE_DIR=str(tmp_path)).stdout
    assert told == f"ok {folder} (filled, 2 damaged, to be compiled again when needed)\n"


@pytest.mark.parametrize(("text", "share"), [("max 100000\n", None), ("150000 100000\n", 1.5), ("", None)])
def test_a_containers_share_of_the_cores_is_read(tmp_path, text, share):
    (tmp_path / "cpu.max").write_text(text)
    assert container_share(tmp_path / "cpu.max") == share


def test_without_such_a_file_there_is_no_limit(tmp_path):
    assert container_share(tmp_path / "cpu.max") is None
