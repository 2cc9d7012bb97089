"""The whole examination, and its report in plain lines."""

from __future__ import annotations

import platform
from importlib.metadata import PackageNotFoundError, version
from itertools import groupby
from typing import Final

from mujoco_port.doctor.drawing import examine_drawing
from mujoco_port.doctor.findings import Finding, State
from mujoco_port.doctor.machine import examine_machine
from mujoco_port.doctor.packages import PROJECT, TOPIC, needed_packages, overlays

MARGIN: Final = 2


def examine() -> list[Finding]:
    """Look at packages, drawing and machine; some ten seconds, all of it in child processes."""
    try:
        packages = needed_packages()
    except PackageNotFoundError:
        text = f"{PROJECT} itself is not installed, so what it needs is unknown"
        return [Finding(TOPIC, PROJECT, State.MISSING, text, "pip install -e . in the folder of its sources")]
    findings = [each.finding() for each in packages]
    mujoco_works = any(each.requirement.name == "mujoco" and each.works for each in packages)
    return [*findings, *overlays(), *examine_drawing(mujoco_works), *examine_machine()]


def report(findings: list[Finding]) -> str:
    """Everything that was found, by topic, and after it one next move for each thing that asks for one."""
    width = max(len(each.name) for each in findings)
    lines = [heading()]
    for topic, group in groupby(findings, key=lambda each: each.topic):
        lines += ["", topic]
        lines += [f"{each.state.value:>9}  {each.name:<{width}}  {each.text}" for each in group]
    moves = [each for each in findings if each.next_move]
    lines += ["", "What to do" if moves else "Nothing to do: everything that is needed works."]
    lines += [f"{MARGIN * ' '}{each.name}: {each.next_move}" for each in moves]
    return "\n".join(lines)


def heading() -> str:
    """Who is examined, on what."""
    try:
        own = version(PROJECT)
    except PackageNotFoundError:
        own = "(not installed)"
    system = f"{platform.system()} {platform.release()} {platform.machine()}"
    return (
        f"{PROJECT} {own}, Python {platform.python_version()}, {system}, {platform.libc_ver()[0]} "
        + (platform.libc_ver()[1])
    )
