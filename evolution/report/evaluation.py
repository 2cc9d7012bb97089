"""Evaluations as text: a table for people, CSV and JSON for programs."""

from __future__ import annotations

import csv
import io
import json
from typing import Any

from rich.table import Table

from evolution.runs.sources import Source
from evolution.search.evaluation import Evaluation


def rows_of(evaluation: Evaluation, agent: int = 0) -> list[dict[str, Any]]:
    """What one agent made of each instruction: one plain record per instruction."""
    right, left = evaluation.successes[agent].T
    return [
        {
            "instruction": str(instruction),
            "experienced": bool(evaluation.experienced[i]),
            "trials": evaluation.trials,
            "successes": int(right[i] + left[i]),
            "successes_right": int(right[i]),
            "successes_left": int(left[i]),
            "fitness": float(evaluation.fitness[agent, i]),
            "f1": float(evaluation.f1[agent, i]),
            "f2": float(evaluation.f2[agent, i]),
            "f3": float(evaluation.f3[agent, i]),
            "steps": float(evaluation.steps[agent, i]),
        }
        for i, instruction in enumerate(evaluation.condition.instructions)
    ]


def terminal_table(evaluation: Evaluation, title: str) -> Table:
    """The same for a terminal; instructions never met are marked."""
    table = Table(title=title, title_justify="left", caption="* never met during evolution")
    table.add_column("instruction")
    for heading in ("success", "from the right", "from the left", "fitness", "steps"):
        table.add_column(heading, justify="right")
    for row in rows_of(evaluation):
        half = row["trials"] // 2
        table.add_row(
            row["instruction"] + ("" if row["experienced"] else " *"),
            f"{100 * row['successes'] / row['trials']:.0f} %",
            f"{row['successes_right']} of {half}",
            f"{row['successes_left']} of {half}",
            f"{row['fitness']:.3f}",
            f"{row['steps']:.0f}",
            style="" if row["experienced"] else "bold cyan",
        )
    return table


def to_csv(evaluation: Evaluation) -> str:
    """One line per instruction."""
    rows, text = rows_of(evaluation), io.StringIO()
    writer = csv.DictWriter(text, rows[0].keys(), lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


def to_json(evaluation: Evaluation, source: Source) -> str:
    """The same with where the genotype comes from and what it was asked."""
    content = {
        "origin": source.origin,
        "condition": str(evaluation.condition),
        "readings": source.readings.to_mapping(),
        "trial_seed": evaluation.trial_seed,
        "instructions": rows_of(evaluation),
    }
    return json.dumps(content, indent=2) + "\n"
