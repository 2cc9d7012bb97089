"""`wordarm analyse`: the paper's tables and figures from an experiment."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from tyro.conf import Positional


@dataclass(frozen=True)
class Analyse:
    """Write the paper's tables and figures from post-evaluated runs, published numbers beside ours."""

    experiment: Positional[Path]
    """Folder of an experiment: <condition>/seed-<seed> below it."""

    output: Path | None = None
    """Folder for the files. By default `results` in the experiment's folder."""

    def run(self) -> int:
        """Analyse, write and print."""
        from evolution.experiments.experiment import open_experiment
        from evolution.report.files import summary, write_results
        from evolution.results.analysis import analyse

        results = analyse(open_experiment(self.experiment))
        for path in write_results(results, self.output or self.experiment / "results"):
            print(path)
        print(summary(results))
        return 0
