"""`wordarm compare`: the key numbers of several experiments beside the published ones."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from tyro.conf import Positional

if TYPE_CHECKING:
    from rich.table import Table

    from evolution.results.records import Results


@dataclass(frozen=True)
class Compare:
    """Put experiments, such as two readings, side by side: plateaus, sub-tasks, generalisers, transitions."""

    experiments: Positional[tuple[Path, ...]]
    """Folders of two or more experiments that were post-evaluated; they are named after their folders."""

    output: Path = Path("comparison")
    """Folder for comparison.csv and the figure."""

    def run(self) -> int:
        """Analyse each, write and print."""
        from rich.console import Console

        from evolution.experiments.experiment import open_experiment
        from evolution.figures.compare import compare_figure
        from evolution.figures.page import save_figure
        from evolution.report.comparison import comparison_table
        from evolution.results.analysis import analyse
        from evolution.results.key_numbers import departures
        from evolution.runs.storage import make_folder, write_atomically

        console = Console(soft_wrap=True, highlight=False)
        found = {name: open_experiment(path) for name, path in _named(self.experiments).items()}
        results = {name: analyse(each) for name, each in found.items()}
        make_folder(self.output)
        write_atomically(self.output / "comparison.csv", comparison_table(results).to_csv().encode())
        print(self.output / "comparison.csv")
        for path in save_figure(compare_figure(results), self.output / "comparison"):
            print(path)
        console.print(_table(results))
        for name, each in results.items():
            console.print(f"{name}: {departures(each.experiment.readings)}")
            for sentence in each.missing:
                console.print(f"{name}: {sentence}")
        return 0


def _named(paths: tuple[Path, ...]) -> dict[str, Path]:
    """Each experiment by the shortest end of its path that tells it from the others."""
    if len(paths) < 2:
        raise ValueError(f"asked to compare {len(paths)} experiment; give at least two folders")
    whole = [path.resolve() for path in paths]
    if len(set(whole)) < len(whole):
        twice = next(path for path, full in zip(paths, whole, strict=True) if whole.count(full) > 1)
        raise ValueError(f"{twice} is given twice; give different experiments")
    for length in range(1, max(len(path.parts) for path in whole) + 1):
        names = ["/".join(path.parts[-length:]) for path in whole]
        if len(set(names)) == len(names):
            break
    return dict(zip(names, paths, strict=True))


def _table(results: dict[str, Results]) -> Table:
    """The same as comparison.csv, for people."""
    from rich.table import Table

    from evolution.results.key_numbers import AT_LIMIT, PLATEAU, SOLVED, WITH_FULL, by_condition
    from evolution.results.wording import TITLES, of, percent

    table = Table("condition", "number", "published", *results)
    plain = {AT_LIMIT, SOLVED, WITH_FULL}

    def text(name: str, value: float | None, n: int) -> str:
        if value is None or value != value:
            return "-"
        if name == PLATEAU:
            return f"{value:.3f}"
        return of(int(value), n) if name in plain else percent(value)

    for condition, by_name in by_condition(results).items():
        for place, number in enumerate(next(iter(by_name.values()))):
            ours = [
                text(number.name, by_name[each][place].ours, by_name[each][place].of)
                if each in by_name
                else "-"
                for each in results
            ]
            table.add_row(TITLES[condition], number.name, text(number.name, number.published, 10), *ours)
    return table
