"""What is asked of SLURM, and the script that asks it."""

import builtins
import subprocess

import pytest

from evolution.cli import main, parse
from evolution.commands import cluster_flags
from evolution.experiments.cluster.slurm import SlurmOptions, job_script, read_options

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
    assert f"{tmp_path}/runs/two/with-indicate/seed-0002  10 generations" in output
    assert "#SBATCH -J wordarm" in output
    assert [each.name for each in tmp_path.iterdir()] == ["two.toml"]


def test_the_script_is_one_that_a_shell_understands():
    script = job_script(SlurmOptions(prologue=("module() { :; }", "module load python")))
    subprocess.run(["bash", "-n"], input=script, text=True, check=True)


def test_flags_go_before_the_file_and_the_file_before_the_defaults(tmp_path):
    file = tmp_path / "cluster.toml"
    file.write_text("[slurm]\nqueue = 'long'\ncores = 4\ndirectives = ['nice=5']\ntls = false\n")
    command = parse([*DRY, f"--slurm.file={file}", "--slurm.cores=2"])
    options = command.cluster.slurm_options.options()
    assert options == SlurmOptions(queue="long", cores=2, directives=("nice=5",), tls=False)


def test_memory_is_enough_for_as_many_runs_as_cores_unless_given():
    assert SlurmOptions(cores=10).memory_of_a_job == "3500MB"
    assert SlurmOptions(cores=10, memory="64GB").memory_of_a_job == "64GB"


@pytest.mark.parametrize(
    ("table", "sentence"),
    [
        ("cores = 0", "slurm cores = 0 must be a whole number from 1 to 10000"),
        ("jobs = 1.5", "slurm jobs = 1.5 must be a whole number"),
        ("walltime = 'soon'", "slurm walltime = 'soon' must be like 04:00:00"),
        ("memory = 'much'", "slurm memory = 'much' must be like 8GB"),
        ("queue = 'a b'", "slurm queue = 'a b' must be one word"),
        ("account = 3", "slurm account = 3 must be text"),
        ("directives = ['x y']", "slurm directive 'x y' must be an option of sbatch"),
        ("directives = 'nice=1'", "slurm directives = 'nice=1' must be a list of single lines"),
        ('prologue = ["a\\nb"]', "must be a list of single lines"),
        ("tls = 'no'", "slurm tls = 'no' must be true or false"),
        ("partition = 'short'", "unknown slurm option 'partition'; there are jobs, cores"),
    ],
)
def test_impossible_options_get_one_sentence_with_the_file(table, sentence, tmp_path):
    file = tmp_path / "cluster.toml"
    file.write_text(f"[slurm]\n{table}\n")
    with pytest.raises(ValueError) as error:  # noqa: PT011 - the sentence is compared
        read_options(file)
    assert str(error.value).startswith(f"{file}: ")
    assert sentence in str(error.value)


@pytest.mark.parametrize("text", ["", "[cluster]\ncores = 1", "slurm = 3", "[slurm", "\x00"])
def test_a_file_without_the_table_is_refused(text, tmp_path):
    file = tmp_path / "cluster.toml"
    file.write_text(text)
    with pytest.raises(ValueError, match=r"has no table \[slurm\]|is not TOML"):
        read_options(file)


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
