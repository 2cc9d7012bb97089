"""An experiment file: which runs, as one TOML file (docs/experiments.md).

Any setting and any reading may be a list of values; the experiment is then every combination of them.
`sector_centres`, itself a list, becomes a grid as a list of lists. A [[variant]] has a name; if there are
any, each of them is a grid of its own, on top of what the whole file sets.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields
from itertools import product
from math import prod
from pathlib import Path
from typing import Any, Final

from arm2d import Condition, Readings
from arm2d.tasks.task import AnyTask, as_paper, papers_condition, read_task
from evolution.experiments.spec import ExperimentSpec, check_size, read_seeds
from evolution.experiments.variants import Variant, check_name, value_name
from evolution.search.settings import Settings
from evolution.search.toml import check_keys, one_of_kind, read_toml, table_of

KEYS: Final = (
    "output", "jobs", "conditions", "task", "seeds", "preset", "post_evaluate", "settings", "readings",
    "variant",
)  # fmt: skip
VARIANT_KEYS: Final = ("name", "settings", "readings")
LARGEST_FILE: Final = 1_000_000  # [bytes]
MOST_VARIANTS: Final = 10_000
LARGEST_WHOLE: Final = 10**300


def read_experiment(path: Path | str) -> ExperimentSpec:
    """What an experiment file asks for.

    Raises:
        ValueError: With one sentence, if the file cannot be read, is no TOML, has an unknown key, a value of
            the wrong kind, an empty grid, or the same thing twice.
    """
    path = Path(path)
    try:
        values = read_toml(_text_of(path), LARGEST_FILE)
        return experiment_from_mapping(values, Path("runs") / path.stem)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def experiment_from_mapping(values: Mapping[str, Any], output: Path) -> ExperimentSpec:
    """What plain values ask for, as read from a file; `output` is used if they name none.

    Raises:
        ValueError: As `read_experiment`.
    """
    check_keys("key", values, KEYS)
    conditions = _conditions(values.get("conditions", ["with-indicate"]))
    tasks = _tasks(conditions, table_of("task", values.get("task", {})))
    if values.get("post_evaluate") is True:
        for task in tasks:
            papers_condition(task, "post_evaluate = true")
    spec = ExperimentSpec(
        _output(values.get("output"), output),
        tasks,
        read_seeds(values.get("seeds", 1)),
        dict(_variants(values)),
        one_of_kind("post_evaluate", values.get("post_evaluate", False), bool),
        one_of_kind("jobs", values["jobs"], int) if "jobs" in values else None,
    )
    check_size(spec)
    return spec


def _text_of(path: Path) -> str:
    """The text of a file of reasonable size."""
    if not path.is_file():
        raise ValueError("there is no such file; give an experiment file, such as docs/experiments.md shows")
    if path.stat().st_size > LARGEST_FILE:
        raise ValueError(f"the file is larger than {LARGEST_FILE:,} bytes; an experiment file is short")
    try:
        return path.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        raise ValueError("the file is not text in UTF-8") from None


def _output(value: Any, default: Path) -> Path:
    """The folder of the experiment, below where the command is given."""
    if value is None:
        return default
    path = Path(one_of_kind("output", value, str))
    if path.is_absolute() or ".." in path.parts or not path.parts or "\0" in value:
        raise ValueError(
            f"output = {value!r} must be a folder below the current one, such as 'runs/geometry'; "
            "for another place give --output"
        )
    return path


def _conditions(value: Any) -> list[str]:
    """One condition or several, by name."""
    given = [value] if isinstance(value, str) else value
    if not isinstance(given, list) or not given or not all(isinstance(each, str) for each in given):
        raise ValueError(
            f"conditions = {value!r} must be a list of {' and '.join(map(str, Condition))}, or one of them"
        )
    _refuse_twice("conditions", [str(as_paper(each)) for each in given])
    return given


def _tasks(conditions: Sequence[str], table: Mapping[str, Any]) -> tuple[AnyTask, ...]:
    """Every combination of conditions and of what [task] says of each; a list in a list is a grid."""
    grids = {name: _task_options(name, value) for name, value in table.items()}
    if prod(map(len, grids.values())) > MOST_VARIANTS:
        raise ValueError(f"[task] has more than {MOST_VARIANTS:,} combinations")
    tasks = [
        read_task(condition, dict(zip(grids, chosen, strict=True)))
        for chosen in product(*grids.values())
        for condition in conditions
    ]
    _refuse_twice("[task]", [str(each) for each in tasks])
    return tuple(tasks)


def _task_options(name: str, value: Any) -> list[Any]:
    """The values of one part of a task. For `held_out` and `codes` one is a list already."""
    is_grid = isinstance(value, list)
    if name in ("held_out", "codes"):
        is_grid = is_grid and bool(value) and all(isinstance(each, list) for each in value)
    if is_grid and not value:
        raise ValueError(f"{name} = [] is an empty grid; give at least one value, or leave it out")
    return value if is_grid else [value]


def _variants(values: Mapping[str, Any]) -> Iterator[tuple[Variant, str | None]]:
    """Every variant once, with its name if it has one."""
    base = Readings.preset(one_of_kind("preset", values.get("preset", "default"), str))
    tables = values.get("variant", [{}])
    if not isinstance(tables, list) or not tables or not all(isinstance(each, Mapping) for each in tables):
        raise ValueError("variant must be tables, each headed [[variant]]")
    names: dict[Variant, str | None] = {}
    for table in tables:
        for variant, name in _grid(values, table, base, named="variant" in values):
            if variant in names:
                told = name or variant.name()
                raise ValueError(f"variant {told!r} is the same as {names[variant] or told!r}; leave one out")
            names[variant] = name
            yield variant, name


def _grid(
    values: Mapping[str, Any], table: Mapping[str, Any], base: Readings, named: bool
) -> Iterator[tuple[Variant, str | None]]:
    """Every combination of the values in a [[variant]], which go before those of the whole file."""
    check_keys("key", table, VARIANT_KEYS, " in [[variant]]")
    if named and "name" not in table:
        raise ValueError("a [[variant]] has no name; give it one, such as name = 'wide'")
    name = check_name(table["name"]) if named else None
    settings = {**_table(values, "settings", Settings), **_table(table, "settings", Settings)}
    readings = {**_table(values, "readings", Readings), **_table(table, "readings", Readings)}
    if (size := prod(map(len, [*settings.values(), *readings.values()]))) > MOST_VARIANTS:
        raise ValueError(f"this grid has {size:,} variants; at most {MOST_VARIANTS:,} can be told apart")
    for chosen in product(*settings.values(), *readings.values()):
        own = dict(zip([*settings, *readings], chosen, strict=True))
        variant = Variant(
            base.with_values({key: own[key] for key in readings}),
            Settings.from_mapping({key: own[key] for key in settings}),
        )
        varied = [each for each, options in {**readings, **settings}.items() if len(options) > 1]
        parts = [value_name(each, own[each]) for each in varied]
        yield variant, "+".join([name, *parts]) if name else None


def _table(values: Mapping[str, Any], key: str, record: type) -> dict[str, list[Any]]:
    """A table's values, each as a list of those to be combined."""
    table = table_of(key, values.get(key, {}))
    check_keys(key.removesuffix("s"), table, [each.name for each in fields(record)], f" in [{key}]")
    return {name: _options(name, value, getattr(record, name)) for name, value in table.items()}


def _options(name: str, value: Any, default: Any) -> list[Any]:
    """The values of one field: a list of them, or one. For `sector_centres` one is a list already."""
    is_grid = isinstance(value, list)
    if isinstance(default, tuple):
        is_grid = is_grid and all(isinstance(each, list) for each in value)
    if not is_grid:
        return [_as_default(value, default)]
    if not value:
        raise ValueError(f"{name} = [] is an empty grid; give at least one value, or leave it out")
    options = [_as_default(each, default) for each in value]
    _refuse_twice(name, options)
    return options


def _as_default(value: Any, default: Any) -> Any:
    """A number as the kind of its field: 5 and 5.0 are the same radius."""
    if isinstance(value, list):
        return tuple(float(each) if _is_whole(each) else each for each in value)
    return float(value) if isinstance(default, float) and _is_whole(value) else value


def _is_whole(value: Any) -> bool:
    # A number too large for a float stays as it is: it is refused by name, as all impossible values are.
    return isinstance(value, int) and not isinstance(value, bool) and abs(value) < LARGEST_WHOLE


def _refuse_twice(name: str, values: Sequence[Any]) -> None:
    """Refuse a list in which something stands twice, or which is too long to be looked through."""
    if len(values) > MOST_VARIANTS:
        raise ValueError(f"{name} has {len(values):,} values; at most {MOST_VARIANTS:,} can be told apart")
    for i, value in enumerate(values):
        if value in values[:i]:
            raise ValueError(f"{name} has {value} twice; leave one out")
