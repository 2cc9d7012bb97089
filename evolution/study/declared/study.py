"""The declared parts by name: which runs each has, and what is written of those that are measured."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any, Final

from arm2d import Condition, Readings
from evolution.figures.page import save_figure
from evolution.report.columns import PlainTable
from evolution.runs.storage import make_folder, write_atomically
from evolution.study.declared.claim import answer_table, answers, averaged_over_worlds, verdict
from evolution.study.declared.claim_figure import claim_figure
from evolution.study.declared.confirmation.decision import WINNER, decision, judged
from evolution.study.declared.confirmation.figure import TITLES, draw_worlds
from evolution.study.declared.confirmation.less_one import cost_table, costs
from evolution.study.declared.confirmation.less_one_figure import less_one_figure
from evolution.study.declared.confirmation.verdict import (
    Verdict,
    decide,
    duel_table,
    world_table,
)
from evolution.study.declared.confirmation.worlds import (
    DEFAULT,
    LESS_ONE_SEEDS,
    PRINTED,
    PRINTED_WORLD,
    WHOLE_LENGTH,
    departures,
    fresh,
    fresh_worlds,
    hundred,
    less_one,
    runs_of_worlds,
)
from evolution.study.declared.nearest import spreads
from evolution.study.declared.parts import GENERATIONS, DeclaredPart, factorial
from evolution.study.declared.plan import RowFile
from evolution.study.declared.results import chosen_worlds, regressions, write_factorial
from evolution.study.declared.rows import MeasuredRun, write_rows

WORLDS: Final = "factorial worlds"
PARTS: Final = ("factorial", "fresh", "decision", "less-one", "hundred")
ROWS: Final = "rows.csv"
Written = tuple[list[Path], list[str]]  # files, and sentences


class DeclaredStudy:
    """The declared parts, each in a folder of one folder."""

    def __init__(self, folder: Path, *, generations: int | None = None, early: bool = False) -> None:
        """Nothing is read yet.

        Args:
            folder: Of the study.
            generations: Of every run, by default what each part declares.
            early: Go on from parts that are not measured to the end, as if they were.
        """
        self.folder = folder
        self._short = generations or GENERATIONS
        self._whole = generations or WHOLE_LENGTH
        self._early = early

    def part(self, name: str) -> DeclaredPart:
        """A part by name.

        Raises:
            ValueError: If what it is chosen from is not measured yet.
        """
        if name == "fresh":
            return fresh(self._chosen, self._whole)
        if name == "decision":
            return decision(self._decided[1], self._whole)
        if name == "less-one":
            return less_one(self._decided[1], self._whole)
        return hundred(Readings(), self._whole) if name == "hundred" else factorial(self._short)

    def rows(self, part: DeclaredPart) -> RowFile:
        """The file of a part's rows."""
        return RowFile(self.folder / part.name / ROWS, part)

    def write(self, part: DeclaredPart, runs: Sequence[MeasuredRun], results: Path) -> Written:
        """Write what these runs of a part say by now.

        Raises:
            ValueError: If what it is compared with is not measured yet.
            OSError: If a file cannot be written.
        """
        if part.name == "factorial":
            return write_factorial(runs, results)
        make_folder(results)
        rows = results / f"{part.name}.csv"
        write_rows(runs, rows)
        writer = {
            "fresh": self._write_fresh,
            "decision": self._write_decision,
            "less-one": self._write_less_one,
            "hundred": self._write_hundred,
        }
        paths, notes = writer[part.name](runs, results)
        return [rows, *paths], notes

    def _write_fresh(self, runs: Sequence[MeasuredRun], results: Path) -> Written:
        worlds = fresh_worlds(self._chosen)
        own = runs_of_worlds(runs, worlds)
        found = decide(own, spreads(self._factorial))
        tables = {
            "fresh-worlds": world_table(own, worlds, found.distances, found.beats),
            "fresh-duels": duel_table(found.duels),
        }
        pictures = draw_worlds(own, found.distances, TITLES["fresh"], results / "fresh-worlds")
        return [*_write(tables.items(), results), *pictures], [self._said("fresh", runs, found.sentence)]

    def _write_decision(self, runs: Sequence[MeasuredRun], results: Path) -> Written:
        winner = self._decided[1]
        own, found = judged(runs, winner, spreads(self._factorial))
        worlds = {WINNER: winner, PRINTED: PRINTED_WORLD}
        chosen = [WINNER] if found.is_default else []
        tables = {
            "decision-worlds": world_table(own, worlds, found.distances, chosen),
            "decision-duels": duel_table(found.duels),
        }
        pictures = draw_worlds(own, found.distances, TITLES["decision"], results / "decision-worlds")
        return [*_write(tables.items(), results), *pictures], [self._said("decision", runs, found.sentence)]

    def _said(self, name: str, runs: Sequence[MeasuredRun], sentence: str) -> str:
        """A sentence on a part, marked where not all of its runs are measured."""
        return sentence if len(runs) == len(self.part(name).configs) else f"so far: {sentence}"

    def _write_less_one(self, runs: Sequence[MeasuredRun], results: Path) -> Written:
        winner = self._decided[1]
        with_all = [run for run in self._runs_of("fresh") if run.config.readings == winner]
        without = {
            factor: [run for run in runs if run.config.readings == world]
            for factor, world in departures(winner).items()
        }
        notes = [
            f"without {factor}: {len(own)} of {len(LESS_ONE_SEEDS)} runs are measured"
            for factor, own in without.items()
            if len(own) < len(LESS_ONE_SEEDS)
        ]
        told = {factor: own for factor, own in without.items() if own}
        found = costs(_indicate(with_all), told)
        table = _write([("less-one-effects", cost_table(found))], results)
        if not found:
            return table, notes
        seeds = f"seeds {LESS_ONE_SEEDS[0]} to {LESS_ONE_SEEDS[-1]}"
        about = f"{len(runs)} runs With-Indicate, {seeds}, less the winner's run with the same seed"
        figure = less_one_figure(found, winner, "The winner less one departure at a time", about)
        return [*table, *save_figure(figure, results / "less-one-effects")], notes

    def _write_hundred(self, runs: Sequence[MeasuredRun], results: Path) -> Written:
        default = [run for run in runs if run.config.readings == Readings()]
        printed = [run for run in runs if run.config.readings == PRINTED_WORLD]
        found, notes = {DEFAULT: answers(default)}, []
        try:
            found[PRINTED] = answers(printed)
        except ValueError as error:
            notes.append(f"printed readings: {error}")
        about = f"{len(default)} runs under the default, {len(printed)} under the printed readings"
        try:
            found[WORLDS] = averaged_over_worlds(self._factorial)
        except ValueError as error:
            notes.append(f"no verdict yet, which asks for the worlds that both conditions met, too: {error}")
        else:
            about += ", and the worlds that both conditions met"
            told = verdict(found[DEFAULT][0], found[WORLDS][0].difference)
            notes.append(f"INDICATE fosters compositionality: {told}")
        figure = claim_figure(found, "Does INDICATE foster compositionality?", about)
        table = _write([("claim", answer_table(found.items()))], results)
        return [*table, *save_figure(figure, results / "claim")], notes

    @cached_property
    def _factorial(self) -> list[MeasuredRun]:
        return self._runs_of("factorial")

    @cached_property
    def _chosen(self) -> list[Readings]:
        """The worlds that the rule chooses, the nearest first."""
        runs = self._factorial
        return [world.readings for world in chosen_worlds(regressions(runs), runs)]

    @cached_property
    def _decided(self) -> tuple[Verdict, Readings]:
        """What the confirmation says, and the winner's readings."""
        worlds = fresh_worlds(self._chosen)
        found = decide(runs_of_worlds(self._runs_of("fresh"), worlds), spreads(self._factorial))
        return found, worlds[found.winner]

    def _runs_of(self, name: str) -> list[MeasuredRun]:
        """The runs of a part that others stand on.

        Raises:
            ValueError: If it is not measured to the end, unless that is asked for.
        """
        part = self.part(name)
        rows = self.rows(part)
        found = rows.read()
        if len(found) < len(part.configs) and not (self._early and found):
            raise ValueError(
                f"{len(found)} of {len(part.configs)} runs of the part {name} have a row in {rows.path}; go "
                f"on with: wordarm study readings --part {name}, or take those for all with --early"
            )
        return list(found.values())


def _indicate(runs: Iterable[MeasuredRun]) -> list[MeasuredRun]:
    return [run for run in runs if run.config.condition is Condition.WITH_INDICATE]


def _write(tables: Iterable[tuple[str, PlainTable[Any]]], folder: Path) -> list[Path]:
    """Write tables; their paths."""
    paths = []
    for name, table in tables:
        paths.append(folder / f"{name}.csv")
        write_atomically(paths[-1], table.to_csv().encode())
    return paths
