"""What is asked of SLURM, and the script that asks it."""

import builtins
import json
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from distributed.security import Security

from evolution.cli import main, parse
from evolution.commands import cluster_flags
from evolution.experiments.cluster.options import SlurmOptions, read_options
from evolution.experiments.cluster.slurm import QuotedJob, job_script

DRY = ["reproduce", "--slurm", "--dry-run"]


def test_a_dry_run_shows_the_script_and_does_nothing(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    flags = ["--slurm.queue=short", "--slurm.account=arm", "--slurm.cores=8", "--slurm.walltime=01:00:00"]
    assert main([*DRY, *flags, "--slurm.directives", "constraint=rome", "nice=100"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "#!/usr/bin/env bash"
    assert {
        "#SBATCH -p short", "#SBATCH -A arm", "#SBATCH --cpus-per-task=8", "#SBATCH -t 01:00:00",
        "#SBATCH --mem=3G", "#SBATCH --constraint=rome", "#SBATCH --nice=100",
    } <= set(lines)  # fmt: skip
    assert "distributed.cli.dask_worker tls://ADDRESS" in lines[-1]
    assert "--nthreads 8" in lines[-1]
    assert list(tmp_path.iterdir()) == []


def test_a_dry_run_of_an_experiment_shows_its_runs_and_the_script(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "two.toml").write_text("seeds = '1-2'\n[settings]\ngenerations = 10\n")
    assert main(["experiment", "two.toml", "--slurm", "--dry-run"]) == 0
    output = capsys.readouterr().out
    assert f"{tmp_path}/runs/two: 2 runs, 1 variant x 1 condition x 2 seeds\n" in output
    assert "#SBATCH -J wordarm" in output
    assert [each.name for each in tmp_path.iterdir()] == ["two.toml"]


HOSTILE = "x;touch P;$(touch Q) & `touch R` y"
TELL = """#!{python}
import json, os, sys
print(json.dumps([sys.argv[1:], os.environ.get("LOADED")]))
"""


@pytest.fixture
def hostile(tmp_path, monkeypatch):
    """A folder whose name is a program, current, with a Python in it that tells how it is called."""
    folder = tmp_path / HOSTILE
    folder.mkdir()
    program = folder / "python"
    program.write_text(TELL.format(python=sys.executable))
    program.chmod(0o755)
    monkeypatch.setattr(sys, "executable", str(program))
    monkeypatch.chdir(folder)
    return folder


def told_by(script):
    """What the worker's Python was called with by a script, which must be sound and do nothing else."""
    subprocess.run(["sh", "-n"], input=script, text=True, check=True)
    before = sorted(Path().rglob("*"))
    done = subprocess.run(["sh"], input=script, capture_output=True, text=True, check=True)
    assert sorted(Path().rglob("*")) == before
    return json.loads(done.stdout)


def test_a_script_runs_as_it_is_meant_whatever_its_folders_are_called(hostile):
    options = SlurmOptions(cores=3, prologue=("export LOADED=yes",)).complete()
    words, loaded = told_by(job_script(options, hostile))
    assert words[:5] == ["-P", words[1], "-m", "distributed.cli.dask_worker", "tls://ADDRESS"]
    assert Path(words[1]).name == "child.py"
    assert words[words.index("--nthreads") + 1] == "3"
    assert loaded == "yes"


def test_the_files_of_keys_are_words_of_their_own(hostile):
    keys = {name: str(hostile / name) for name in ("tls_ca_file", "tls_worker_key", "tls_worker_cert")}
    job = QuotedJob(
        "tls://ADDRESS", name="one", cores=1, memory="1GB", python=shlex.quote(sys.executable),
        security=Security(require_encryption=True, **keys),
    )  # fmt: skip
    words, _ = told_by(job.job_script())
    assert words[words.index("--tls-ca-file") + 1] == keys["tls_ca_file"]
    assert words[words.index("--tls-key") + 1] == keys["tls_worker_key"]


def test_output_of_the_jobs_goes_into_the_folder_whatever_it_is_called(tmp_path):
    lines = job_script(SlurmOptions().complete(), tmp_path / "100 % $(x)").splitlines()
    (line,) = (each for each in lines if each.startswith("#SBATCH --output="))
    assert shlex.split(line.removeprefix("#SBATCH ")) == [
        f"--output={tmp_path}/100 %% $(x)/logs/slurm/wordarm-%J.out"
    ]


@pytest.mark.parametrize("name", ["it's", 'a"b', "back\\slash", "line\nbreak"])
def test_a_folder_that_no_script_can_name_is_refused_before_anything_is_submitted(
    name, tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("shutil.which", lambda name: f"/usr/bin/{name}")
    for more in ([], ["--dry-run"]):
        path = tmp_path / name
        with pytest.raises(ValueError, match="cannot be named in a job script; choose an --output without"):
            job_script(SlurmOptions().complete(), path)
        if "\n" not in name:
            assert main(["reproduce", "--slurm", f"--output={path}", *more]) == 2
            assert "cannot be named in a job script" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_flags_go_before_the_file_and_the_file_before_the_defaults(tmp_path):
    file = tmp_path / "cluster.toml"
    file.write_text("[slurm]\nqueue = 'long'\ncores = 4\ndirectives = ['nice=5']\ntls = false\n")
    command = parse([*DRY, f"--slurm.file={file}", "--slurm.cores=2"])
    options = command.cluster.slurm_options.complete(command.cluster.slurm_file)
    assert options == SlurmOptions(
        jobs=1, cores=2, memory="1100MB", walltime="04:00:00", queue="long", interface="lo",
        directives=("nice=5",), prologue=(), tls=False,
    )  # fmt: skip


def test_memory_is_enough_for_as_many_runs_as_cores_unless_given():
    assert SlurmOptions(cores=10).complete().memory == "3500MB"
    assert SlurmOptions(cores=10, memory="64GB").complete().memory == "64GB"


@pytest.mark.parametrize(
    ("table", "sentence"),
    [
        ("cores = 0", "slurm cores = 0 must be a whole number from 1 to 10000"),
        ("jobs = 1.5", "slurm jobs = 1.5 must be a whole number"),
        ("walltime = 'soon'", "slurm walltime = 'soon' must be like 04:00:00"),
        ("memory = 'much'", "slurm memory = 'much' must be like 8GB"),
        ("memory = '1e400GB'", "slurm memory = '1e400GB' must be like 8GB"),
        ("memory = 8", "slurm memory = 8 must be like 8GB"),
        ('interface = "ib0\\nrm -r *"', "slurm interface = 'ib0\\nrm -r *' must be the name of a network"),
        ("interface = 'ib0;ls'", "slurm interface = 'ib0;ls' must be the name of a network"),
        ("interface = 'abcdefghijklmnop'", "must be the name of a network interface"),
        ("tls = 1", "slurm tls = 1 must be true or false"),
        ("queue = 'a b'", "slurm queue = 'a b' must be one word"),
        ("account = 3", "slurm account = 3 must be one word"),
        ("cores = true", "slurm cores = True must be a whole number"),
        ("directives = ['x y']", "slurm directive 'x y' must be an option of sbatch"),
        ("directives = 'nice=1'", "slurm directives = 'nice=1' must be a list of single lines"),
        ('prologue = ["a\\nb"]', "must be a list of single lines"),
        ("tls = 'no'", "slurm tls = 'no' must be true or false"),
        ("partition = 'short'", "unknown slurm option 'partition'; there are jobs, cores"),
        ("que = 'short'", "unknown slurm option 'que'; did you mean queue?"),
    ],
)
def test_impossible_options_get_one_sentence_with_the_file(table, sentence, tmp_path):
    file = tmp_path / "cluster.toml"
    file.write_text(f"[slurm]\n{table}\n")
    with pytest.raises(ValueError) as error:  # noqa: PT011 - the sentence is compared
        read_options(file)
    assert str(error.value).startswith(f"{file}: ")
    assert sentence in str(error.value)


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (b"", "there is no table [slurm]; its keys may be jobs, cores"),
        (b"[cluster]\ncores = 1", "there is no table [slurm]"),
        (b"slurm = 3", "slurm = 3 must be a table, such as [slurm]"),
        (b"[slurm", "this is not TOML"),
        (b"\x00", "this is not TOML"),
        (b"\xff\xfe", "it is not text in UTF-8"),
        (b"a = " + 200_000 * b"[", "it is larger than 131,072 bytes"),
        (b"a = " + 20_000 * b"[", "nested deeper than"),
        (b"a" + 10_000 * b".a" + b" = 1", "a line has more than 2,000 points"),
    ],
    ids=range(9),
)
def test_a_file_that_cannot_be_understood_is_refused_in_one_sentence(content, sentence, tmp_path):
    file = tmp_path / "cluster.toml"
    file.write_bytes(content)
    with pytest.raises(ValueError) as error:  # noqa: PT011 - the sentence is compared
        read_options(file)
    assert str(error.value).startswith(f"{file}: ")
    assert sentence in str(error.value)


def test_a_file_that_is_not_there_is_named(tmp_path):
    with pytest.raises(ValueError, match="none is not a file; give a TOML file with a table"):
        read_options(tmp_path / "none")


@pytest.mark.parametrize(
    ("flags", "sentence"),
    [
        (["--slurm", "--scheduler=tcp://a:1"], "--scheduler and --slurm are two ways to get workers"),
        (["--dry-run"], "--dry-run shows what SLURM would be given; it needs --slurm"),
        (["--slurm.cores=3"], "--slurm.* need --slurm; give it too, or leave them out"),
        (["--slurm", "--slurm.interface=ib77"], "slurm interface 'ib77' is not here; there are lo"),
    ],
)
def test_flags_that_make_no_sense_are_refused_before_anything_is_written(
    flags, sentence, tmp_path, monkeypatch, capsys
):
    monkeypatch.setattr("shutil.which", lambda name: f"/usr/bin/{name}")
    assert main(["reproduce", f"--output={tmp_path / 'new'}", *flags]) == 2
    assert sentence in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_without_slurm_or_without_dask_it_says_what_is_missing(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("shutil.which", lambda name: None)
    assert main(["reproduce", f"--output={tmp_path / 'new'}", "--slurm"]) == 2
    assert "there is no sbatch on this machine" in capsys.readouterr().err
    monkeypatch.setattr(cluster_flags, "find_spec", lambda name: None)
    assert main(["reproduce", f"--output={tmp_path / 'new'}", "--slurm"]) == 2
    assert "pip install 'wordarm[cluster]'" in capsys.readouterr().err


def test_without_a_cluster_dask_is_not_imported(monkeypatch):
    real = builtins.__import__

    def without_dask(name, *arguments, **options):
        assert not name.startswith(("dask", "distributed"))
        return real(name, *arguments, **options)

    monkeypatch.setattr(builtins, "__import__", without_dask)
    assert parse(["reproduce", "--runs=3"]).cluster.given is False


def test_the_package_for_slurm_does_not_take_ctrl_c_from_us():
    code = (
        "import signal; before = signal.getsignal(signal.SIGINT); "
        "import evolution.experiments.cluster.slurm; assert signal.getsignal(signal.SIGINT) is before"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
