"""An analysed experiment as files to be kept: results, agents, configs, licence, and what they are."""

from __future__ import annotations

import tempfile
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path
from typing import Final

from arm2d.files import read_file
from evolution.report.files import summary, write_results
from evolution.results.notable import notable_agents, ship
from evolution.results.records import Results
from evolution.runs.folder import CONFIG
from evolution.runs.meta import revision, versions

LARGEST_FILE: Final = 2**26  # [bytes]
LICENCE: Final = "LICENSE"
ARTICLE: Final = """\
E. Tuci, T. Ferrauto, A. Zeschel, G. Massera, S. Nolfi, "An Experiment on Behavior Generalization and the
Emergence of Linguistic Compositionality in Evolving Robots", IEEE Transactions on Autonomous Mental
Development 3(2), 176-189, 2011, doi:10.1109/TAMD.2011.2114659"""


def bundle(results: Results) -> dict[str, bytes]:
    """All files of an archive of these results, by their path in it.

    Raises:
        ValueError: If no run can be analysed, or the licence is not found.
        OSError: If a file cannot be written or read.
    """
    files = {}
    with tempfile.TemporaryDirectory() as scratch:
        home = Path(scratch)
        write_results(results, home / "results")
        ship(notable_agents(results), home / "agents")
        for path in sorted(home.rglob("*")):
            if path.is_file():
                files[path.relative_to(home).as_posix()] = read_file(path, LARGEST_FILE)
    for run in results.analysed_runs:
        folder = results.conditions[run.condition].runs[run.index].path
        name = f"runs/{run.condition}/seed-{run.seed:04d}/{CONFIG}"
        if name in files:
            raise ValueError(
                f"{folder} is another run of {run.condition} with seed {run.seed}, whose settings differ; an "
                "archive holds one of them: move the others out of the experiment"
            )
        files[name] = read_file(folder / CONFIG, LARGEST_FILE)
    return {**files, "README.md": read_me(results).encode(), LICENCE: licence()}


def licence() -> bytes:
    """The licence that came with the package, or lies beside its sources.

    Raises:
        ValueError: If there is none.
    """
    try:
        text = distribution("wordarm").read_text(f"licenses/{LICENCE}")
    except PackageNotFoundError:
        text = None
    beside = Path(__file__).resolve().parents[2] / LICENCE
    if text is None and beside.is_file():
        text = beside.read_text(encoding="utf-8")
    if text is None:
        raise ValueError("the licence is not installed with wordarm; install it again: pip install wordarm")
    return text.encode()


def read_me(results: Results) -> str:
    """What is in the archive, in the words of its reader."""
    runs = "\n".join(
        f"- {condition}: seeds {', '.join(str(seed) for seed in found.seeds)}"
        for condition, found in results.conditions.items()
        if len(found.runs)
    )
    return f"""\
# Results of an experiment with wordarm

Networks evolved to obey two-word instructions with an arm; a reproduction of

{ARTICLE}

Made by wordarm {versions()["wordarm"]}, revision {revision()}, from these runs:

{runs}

{summary(results)}

| what | where |
| --- | --- |
| tables (CSV), figures (PNG, SVG), the numbers behind them (`results.npz`, NumPy) | `results/` |
| best generaliser, best specialist, best With-Ignore agent, with the config of their runs | `agents/` |
| what every run was asked for, from which it comes again bit by bit | `runs/` |
| SHA-256 of every file, for `sha256sum -c SHA256SUMS` | `SHA256SUMS` |

`wordarm verify ARCHIVE.tar.gz` checks all of it at once, and `wordarm evaluate agents/best-generaliser.npz`
lets an agent carry out the nine instructions. A run again, in Python:

    config = evolution.RunConfig.from_toml(open("runs/.../config.toml").read())
    evolution.evolve("again", config)

What the tables mean stands in docs/file-formats.md of wordarm's sources.

Code and data are under the Apache License 2.0 (`LICENSE`). Please cite the article and the software.
"""
