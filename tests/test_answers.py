"""What a command answers when its output, its user or the machine is in the way: one line, one exit code."""

import os
import signal
import subprocess
import sys

import pytest

from evolution.answers import BAD_INPUT, BROKEN_PIPE, INTERRUPTED, answer

SMALL = ("--population=10", "--elites=2", "--parents=5", "--generations=3")


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    path = tmp_path_factory.mktemp("answers") / "run"
    assert wordarm("evolve", *SMALL, f"--output={path}").returncode == 0
    return path


def wordarm(*arguments, **how):
    """A command in a process of its own."""
    how = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE} | how
    return subprocess.run([sys.executable, "-m", "evolution", *map(str, arguments)], text=True, **how)


def closed_pipe():
    """The end to write to of a pipe that nobody reads."""
    reader, writer = os.pipe()
    os.close(reader)
    return writer


@pytest.mark.parametrize("command", ["verify", "evaluate", "status", "lineage", "--help", "evolve"])
def test_a_closed_pipe_has_one_exit_code_and_is_told(command, run, tmp_path):
    if command == "evolve":
        arguments = [command, *SMALL, f"--output={tmp_path / 'new'}"]
    else:
        arguments = [command] if command == "--help" else [command, run]
    done = wordarm(*arguments, stdout=closed_pipe())
    assert done.returncode == BROKEN_PIPE
    assert (
        done.stderr == "wordarm: nobody reads the output any more, so the command ended; repeat it to go on\n"
    )


def test_a_run_whose_reader_left_goes_on_with_the_same_command(run, tmp_path):
    assert wordarm("evolve", *SMALL, f"--output={tmp_path / 'new'}", stdout=closed_pipe()).returncode == 141
    assert wordarm("evolve", *SMALL, f"--output={tmp_path / 'new'}").returncode == 0
    assert (tmp_path / "new" / "champions.npz").read_bytes() == (run / "champions.npz").read_bytes()


def test_a_pipe_that_is_not_our_output_is_told_by_its_error():
    done = subprocess.run(
        [
            sys.executable,
            "-c",
            "import os\nfrom evolution.answers import answer\nreader, writer = os.pipe()\nos.close(reader)\n"
            "raise SystemExit(answer(lambda: os.write(writer, b'picture')))",
        ],
        capture_output=True,
        text=True,
    )
    assert (done.returncode, done.stderr) == (BAD_INPUT, "wordarm: [Errno 32] Broken pipe\n")


def test_nobody_listening_to_errors_changes_no_exit_code(tmp_path):
    assert wordarm("verify", tmp_path / "none", stderr=closed_pipe()).returncode == BAD_INPUT


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no device that is always full")
@pytest.mark.parametrize("command", ["verify", "--help"])
def test_an_output_that_takes_no_more_is_one_sentence(command, run):
    with open("/dev/full", "w") as full:
        done = wordarm(command, *([] if command == "--help" else [run]), stdout=full)
    assert done.returncode == BAD_INPUT
    assert done.stderr.startswith("wordarm: ")
    assert "No space left on device" in done.stderr
    assert done.stderr.count("\n") == 1


@pytest.mark.parametrize("command", ["evaluate", "lineage", "status", "--help"])
def test_what_the_output_cannot_encode_is_replaced(command, run):
    environment = {**os.environ, "PYTHONIOENCODING": "ascii"}
    done = wordarm(command, *([] if command == "--help" else [run]), env=environment)
    assert done.returncode == 0, done.stderr


def test_a_character_that_cannot_be_encoded_costs_only_itself():
    said = "'3 \u2022 \u03b1'"
    code = f"from evolution.answers import answer\nraise SystemExit(answer(lambda: print({said}) or 0))"
    environment = {**os.environ, "PYTHONIOENCODING": "latin-1"}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment)
    assert (done.returncode, done.stdout) == (0, "3 ? ?\n")


@pytest.mark.parametrize(
    "module",
    [
        "evolution.cli",
        "evolution.answers",
        "evolution.parsing",
        "tyro",
        "tyro._cli",
        "evolution.commands.agent",
        "numpy",
        "numpy.linalg",
        "numba",
        "numba.core.types",
        "llvmlite.binding",
        "arm2d.kernel.loop",
        "matplotlib",
        "rich.table",
    ],
)
def test_ctrl_c_while_something_is_imported_is_one_line(module, tmp_path):
    code = f"""
import signal, sys

class Finger:
    def find_spec(self, name, path=None, target=None):
        if name == {module!r}:
            print("pressed", flush=True)
            signal.raise_signal(signal.SIGINT)

sys.meta_path.insert(0, Finger())
sys.argv = ["wordarm", "evaluate", "best-generaliser", "--trials-per-area=1", "--output={tmp_path}"]
from evolution.__main__ import main
sys.exit(main())
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (INTERRUPTED, "wordarm: stopped by Ctrl-C\n")
    assert done.stdout == "pressed\n"


def test_ctrl_c_is_told_where_a_command_has_begun(capsys):
    assert answer(lambda: signal.raise_signal(signal.SIGINT) or 0) == INTERRUPTED
    assert capsys.readouterr().err == "wordarm: stopped by Ctrl-C\n"
