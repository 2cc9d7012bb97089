"""Everything that determines a run's result, as a record and as its config.toml."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from numbers import Integral
from reprlib import repr as shortened
from typing import Any, Final

import tomli_w

from arm2d import Condition, Readings, Task
from arm2d.readings import checked_readings
from arm2d.tasks.task import AnyTask, as_paper, papers_condition, read_task, task_of
from evolution.search.settings import Settings
from evolution.search.toml import read_toml, table_of

# Raised when an older reader could misunderstand the file.
FORMAT: Final = 1
HEADING: Final = "# Everything that determines the result of this run. Its files are bound to these bytes.\n"
SEED_LIMIT: Final = 2**63
KNOWN_KEYS: Final = ("format", "condition", "seed", "task", "settings", "readings")


@dataclass(frozen=True)
class RunConfig:
    """One run: which instructions, which chance, which algorithm, which world.

    Attributes:
        condition: Which third action is met; its name, such as "with-ignore", will do. Or a task of your own
            (`arm2d.Task`); one that is the paper's is kept as its condition.
        seed: All of the run's random numbers follow from it.
        settings: The genetic algorithm.
        readings: How the paper is understood.

    Raises:
        ValueError: If one of them is of another kind, or out of its bounds.
    """

    condition: AnyTask = Condition.WITH_INDICATE
    seed: int = 1
    settings: Settings = field(default_factory=Settings)
    readings: Readings = field(default_factory=Readings)

    def __post_init__(self) -> None:
        checked_readings(self.readings)
        if not isinstance(self.settings, Settings):
            raise ValueError(
                f"settings = {shortened(self.settings)} must be a record, such as Settings(population=20)"
            )
        object.__setattr__(self, "condition", as_paper(self.condition))
        whole = isinstance(self.seed, Integral) and not isinstance(self.seed, bool)
        if not whole or not 0 <= self.seed < SEED_LIMIT:
            raise ValueError(f"seed = {self.seed!r} must be a whole number from 0 to 2**63 - 1")
        object.__setattr__(self, "seed", int(self.seed))  # one of NumPy's is written alike

    @property
    def task(self) -> Task:
        """The condition as a task, or the task that stands in its place."""
        return task_of(self.condition)

    @property
    def papers_condition(self) -> Condition:
        """The condition, for what is made for the paper's two; raises `ValueError` of another task."""
        return papers_condition(self.condition, "this analysis")

    @classmethod
    def from_mapping(cls, values: Mapping[str, Any]) -> RunConfig:
        """A run from plain values, as read from its config.toml.

        Raises:
            ValueError: If a key is unknown, or a value is missing or impossible.
        """
        _check_keys(values)
        settings, readings = values.get("settings", {}), values.get("readings", {})
        if not isinstance(settings, Mapping) or not isinstance(readings, Mapping):
            raise ValueError("settings and readings must be tables, such as [settings]")
        if not isinstance(values["condition"], str):
            raise ValueError(f"condition = {values['condition']!r} must be one of {', '.join(Condition)}")
        return cls(
            read_task(values["condition"], table_of("task", values.get("task", {}))),
            values["seed"],
            Settings.from_mapping(settings),
            Readings.from_mapping(readings),
        )

    @classmethod
    def from_toml(cls, text: str) -> RunConfig:
        """A run from the text of its config.toml.

        Raises:
            ValueError: As `from_mapping`, and if the text is not TOML.
        """
        return cls.from_mapping(read_toml(text))

    def to_mapping(self) -> dict[str, Any]:
        """Every value in plain form."""
        return {
            "format": FORMAT,
            "condition": self.task.condition_name,
            "seed": self.seed,
            **({"task": special} if (special := self.task.to_mapping()) else {}),
            "settings": self.settings.to_mapping(),
            "readings": self.readings.to_mapping(),
        }

    def _all_values(self) -> dict[str, Any]:
        """Every value of every field, those included that files leave unsaid."""
        values = {**self.to_mapping(), "condition": str(self.condition), "settings": asdict(self.settings)}
        values.pop("task", None)  # the condition's name tells it
        return values

    def to_toml(self) -> str:
        """The text of config.toml; reading it back gives this record."""
        return HEADING + tomli_w.dumps(self.to_mapping())

    def differences(self, other: RunConfig) -> list[str]:
        """What is otherwise in `other`, such as "seed = 3, not 4"; empty if they are the same run."""
        mine, others = _flatten(self._all_values()), _flatten(other._all_values())
        return [f"{key} = {mine[key]}, not {others[key]}" for key in mine if mine[key] != others[key]]


def _check_keys(values: Mapping[str, Any]) -> None:
    """Refuse unknown and missing keys, and formats of the future."""
    for key in values:
        if key not in KNOWN_KEYS:
            raise ValueError(f"unknown key {key!r}; there are {', '.join(KNOWN_KEYS)}")
    for key in ("format", "condition", "seed"):
        if key not in values:
            raise ValueError(f"{key} is missing; a run needs format, condition and seed")
    if values["format"] != FORMAT or type(values["format"]) is not int:
        raise ValueError(f"format {values['format']!r} is not known here; this version reads format {FORMAT}")


def _flatten(values: Mapping[str, Any]) -> dict[str, Any]:
    """Values of a table of tables under dotted names."""
    flat = {}
    for key, value in values.items():
        if isinstance(value, Mapping):
            flat.update({f"{key}.{name}": part for name, part in value.items()})
        else:
            flat[key] = value
    return flat
