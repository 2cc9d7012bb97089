"""`wordarm report`: one page with everything an experiment shows."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from tyro.conf import Positional


@dataclass(frozen=True)
class Report:
    """Write one self-contained HTML page: result, best agents alive, published numbers and ours, figures."""

    experiment: Positional[Path]
    """Folder of an experiment, or of one run; what is missing is named on the page."""

    output: Path | None = None
    """The page. By default `report.html` in the experiment's folder."""

    def run(self) -> int:
        """Analyse, write and print the path."""
        from evolution.experiments.experiment import open_experiment
        from evolution.report.page import write_report
        from evolution.results.analysis import analyse

        results = analyse(open_experiment(self.experiment))
        print(write_report(results, self.output or self.experiment / "report.html"))
        return 0
