"""The report's configuration: settings, readings, versions, as rows of text."""

from __future__ import annotations

from dataclasses import fields

from arm2d import Readings
from evolution.results.records import Results
from evolution.runs import meta
from evolution.runs.folder import META


def settings_rows(results: Results) -> list[tuple[str, str]]:
    """Settings of the algorithm, with all values that occur."""
    found: dict[str, set[str]] = {}
    for run in results.experiment.all_runs:
        for name, value in run.config.settings.to_mapping().items():
            found.setdefault(name, set()).add(str(value))
    return [(name, ", ".join(sorted(values))) for name, values in found.items()]


def readings_rows(readings: Readings) -> list[tuple[str, str, bool]]:
    """(name, value, whether it is the default) of every reading."""
    default, values = Readings().to_mapping(), readings.to_mapping()
    return [
        (field.name, _plain(values[field.name]), values[field.name] == default[field.name])
        for field in fields(Readings)
    ]


def _plain(value: object) -> str:
    return ", ".join(f"{number:g}" for number in value) if isinstance(value, list) else str(value)


def versions_rows(results: Results) -> list[tuple[str, str]]:
    """With what runs were computed and this page was written; all values that occur."""
    found: dict[str, set[str]] = {}
    for run in results.experiment.all_runs:
        for start in meta.read_meta(run.path / META)["starts"]:
            own = {
                **start.get("versions", {}),
                "revision": start.get("revision", "unknown"),
                **start.get("machine", {}),
            }
            for name, value in own.items():
                found.setdefault(name, set()).add(str(value))
    rows = [(name, ", ".join(sorted(values))) for name, values in found.items()]
    return [*rows, ("this page", f"wordarm {meta.versions()['wordarm']}, revision {meta.revision()}")]
