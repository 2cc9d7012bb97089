"""What the study's pictures show of a variant: from measured runs, or read back from `<part>-runs.csv`.

R runs, 9 instructions, 2 start areas.
"""

from __future__ import annotations

import csv
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from arm2d import Condition
from arm2d.records import alike, brief
from evolution.agents.subtasks import AgentClass
from evolution.study.table import VariantMeasures

# Between the readings that a variant's name is made of, such as mutation-sd-0.03+tau-exponent-max-0.
AND = "+"


@dataclass(frozen=True)
class Drawn:
    """The runs of one variant in one condition.

    Attributes:
        name: Of the variant.
        condition: Of its runs.
        generations: Of each run.
        seeds: [R].
        plateaus: [R].
        solved: [R], whether one genotype ever carried out all its trials.
        top_shares: [R], share of late agents in category 10 of sub-task I.
        generalists: [R], whether some late agent is fully compositional.
        success: [R, 9, 2], share of successful trials of late agents.
    """

    name: str
    condition: Condition
    generations: int
    seeds: NDArray[np.int64]
    plateaus: NDArray[np.float64]
    solved: NDArray[np.bool_]
    top_shares: NDArray[np.float64]
    generalists: NDArray[np.bool_]
    success: NDArray[np.float64]

    __repr__ = brief
    __eq__ = alike

    def only(self, seeds: Iterable[int]) -> Drawn:
        """The runs with these seeds alone."""
        own = np.isin(self.seeds, list(seeds))
        return replace(
            self,
            seeds=self.seeds[own],
            plateaus=self.plateaus[own],
            solved=self.solved[own],
            top_shares=self.top_shares[own],
            generalists=self.generalists[own],
            success=self.success[own],
        )


def drawn(variant: VariantMeasures) -> Drawn:
    """A measured variant."""
    return Drawn(
        variant.name,
        variant.condition,
        variant.generations,
        np.array([run.config.seed for run in variant.runs]),
        variant.plateaus,
        variant.solved,
        variant.top_shares[:, 0],
        variant.class_shares(AgentClass.FULL) > 0,
        np.array([run.success_by_area for run in variant.runs]),
    )


def read_drawn(path: Path) -> list[Drawn]:
    """The variants of a table of runs, in its order; numbers have the table's digits.

    Raises:
        ValueError: If it is no such table.
        OSError: If it cannot be read.
    """
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    try:
        return [
            _from_rows(list(own))
            for _, own in groupby(
                rows, lambda row: (row["variant"], Condition(row["condition"]), row["generations"])
            )
        ]
    except (KeyError, ValueError) as error:
        raise ValueError(
            f"{path} is no table of a study's runs ({error}); give one that ends with -runs.csv"
        ) from None


def _from_rows(rows: Sequence[dict[str, str]]) -> Drawn:
    def column(name: str) -> NDArray[np.float64]:
        return np.array([float(row[name]) for row in rows])

    shares = [name for name in rows[0] if name.endswith((", right", ", left"))]
    return Drawn(
        rows[0]["variant"],
        Condition(rows[0]["condition"]),
        int(rows[0]["generations"]),
        column("seed").astype(np.int64),
        column("plateau"),
        np.array([row["first generation that solved all trials"] != "never" for row in rows]),
        column("sub-task I, category 10"),
        column(str(AgentClass.FULL)) > 0,
        np.stack([column(name) for name in shares], axis=-1).reshape(len(rows), 9, 2),
    )


def base_of(variants: Sequence[Drawn]) -> str | None:
    """The reading that more than half of all variants have in common, if there is one."""
    counts = Counter(reading for variant in variants for reading in variant.name.split(AND))
    name, count = counts.most_common(1)[0]
    return name if 2 * count > len(variants) and len(variants) > 1 else None


def base_among(candidates: Iterable[Drawn], variants: Sequence[Drawn]) -> Drawn | None:
    """What these variants stand on, evolved elsewhere for as long with the same seeds; None if it was not."""
    base, like = base_of(variants), variants[0]
    for candidate in candidates:
        if (candidate.name, candidate.condition, candidate.generations) == (
            base,
            like.condition,
            like.generations,
        ):
            same = candidate.only(like.seeds.tolist())
            return same if len(same.seeds) else None
    return None
