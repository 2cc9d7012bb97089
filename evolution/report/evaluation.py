"""Evaluations as text: a table for people, CSV and JSON for programs."""

from __future__ import annotations

import json

from rich.table import Table

from evolution.report.columns import PlainTable
from evolution.runs.sources import Agent
from evolution.search.evaluation import Evaluation


def instruction_table(evaluation: Evaluation, agent: int = 0) -> PlainTable[int]:
    """What one agent made of every instruction."""
    right, left = evaluation.successes[agent].T
    return PlainTable(
        {
            "instruction": lambda i: str(evaluation.condition.instructions[i]),
            "experienced": lambda i: bool(evaluation.experienced[i]),
            "trials": lambda i: evaluation.trials,
            "successes": lambda i: int(right[i] + left[i]),
            "successes_right": lambda i: int(right[i]),
            "successes_left": lambda i: int(left[i]),
            "fitness": lambda i: float(evaluation.fitness[agent, i]),
            "f1": lambda i: float(evaluation.f1[agent, i]),
            "f2": lambda i: float(evaluation.f2[agent, i]),
            "f3": lambda i: float(evaluation.f3[agent, i]),
            "steps": lambda i: float(evaluation.steps[agent, i]),
        },
        range(len(evaluation.condition.instructions)),
    )


def terminal_table(evaluation: Evaluation, title: str) -> Table:
    """The same for a terminal; instructions never met are marked."""
    table = Table(title=title, title_justify="left", caption="* never met during evolution")
    table.add_column("instruction")
    for heading in ("success", "from the right", "from the left", "fitness", "steps"):
        table.add_column(heading, justify="right")
    for row in instruction_table(evaluation).rows():
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


def to_json(evaluation: Evaluation, agent: Agent) -> str:
    """The table with where the genotype comes from and what it was asked."""
    content = {
        "origin": agent.origin,
        "condition": str(evaluation.condition),
        "readings": agent.readings.to_mapping(),
        "trial_seed": evaluation.trial_seed,
        "instructions": instruction_table(evaluation).rows(),
    }
    return json.dumps(content, indent=2) + "\n"
