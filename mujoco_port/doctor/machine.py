"""The machine itself: cores, disk, the folder of compiled code, the video encoder, the robots."""

from __future__ import annotations

import os
import shutil
from pathlib import Path
from typing import Final

from models.robots import ROBOTS
from models.urdf import RobotNotInstalledError, find_urdf
from mujoco_port.doctor.children import attempt
from mujoco_port.doctor.findings import Finding, State

TOPIC: Final = "machine"
CGROUP_LIMIT: Final = Path("/sys/fs/cgroup/cpu.max")
SCARCE_BYTES, TOO_LITTLE_BYTES = 1e9, 5e7  # the paper's twenty runs take 0.4 GB, a video some MB
CACHE: Final = """
from arm2d.cache import damaged_files, find_place, lack_of_room
place = find_place()
print("; ".join(place.refusals))
print(place.folder or "")
print(len(damaged_files(place.folder)) if place.folder else 0)
print(lack_of_room(place.folder) if place.folder else "")
import arm2d.running
"""
CACHE_MOVE: Final = (
    "export NUMBA_CACHE_DIR=... to a folder of your own on a disk with room, that nobody else can change"
)
ENCODER: Final = """
import sys
from arm2d.films import NoEncoderError, find_encoder
try:
    print(find_encoder())
except NoEncoderError as error:
    sys.exit(str(error).split(";")[0])
import imageio_ffmpeg
print(imageio_ffmpeg.get_ffmpeg_version())
"""


def examine_machine() -> list[Finding]:
    """Everything but packages and drawing."""
    return [cores(), cache(), disk(Path.cwd()), encoder(), *robots()]


def cores() -> Finding:
    """Cores that may be used, and a container's share of them."""
    usable = len(os.sched_getaffinity(0))
    text = f"{usable} of {os.cpu_count()} may be used; runs are made side by side on all of them"
    share = container_share()
    if share is not None and share < usable:
        text += f", but the container may use the time of {share:.1f} only"
        move = f"give the container more, or run `wordarm reproduce --jobs {max(1, int(share))}`"
        return Finding(TOPIC, "cores", State.NOTE, text, move)
    return Finding(TOPIC, "cores", State.WORKS, text)


def container_share(limit: Path = CGROUP_LIMIT) -> float | None:
    """How many cores' time a container may use; None without a limit."""
    try:
        quota, period = limit.read_text().split()
    except (OSError, ValueError):
        return None
    return None if quota == "max" else float(quota) / float(period)


def cache() -> Finding:
    """The folder of compiled code."""
    asked = attempt(CACHE)
    if not asked.works:
        return Finding(
            TOPIC, "compiled code", State.MISSING, asked.reason, "mend the packages named above first"
        )
    refusals, folder, damaged, lack = asked.lines[-4:]
    if not folder:
        text = f"{refusals}, so every process compiles anew, some 10 s each"
        return Finding(TOPIC, "compiled code", State.NOTE, text, CACHE_MOVE)
    warm = any(Path(folder).rglob("*.nbi"))
    state = "filled" if warm else "empty, the first command compiles for some 10 s"
    if damaged != "0":
        state += f", {damaged} damaged, to be compiled again when needed"
    if lack:
        text = f"{folder} ({state}) takes no more: {lack}; what is missing there is compiled by every process"
        return Finding(TOPIC, "compiled code", State.NOTE, text, "make room there, or " + CACHE_MOVE)
    if refusals:
        text = f"{refusals}; {folder} takes its place ({state})"
        return Finding(TOPIC, "compiled code", State.NOTE, text, CACHE_MOVE)
    return Finding(TOPIC, "compiled code", State.WORKS, f"{folder} ({state})")


def disk(folder: Path) -> Finding:
    """Room and the right to write where the user stands."""
    free = shutil.disk_usage(folder).free
    text = f"{free / 1e9:.1f} GB free in {folder}"
    if not os.access(folder, os.W_OK):
        return Finding(
            TOPIC, "disk", State.NOTE, f"{folder} cannot be written to", "name another folder with --output"
        )
    if free < SCARCE_BYTES:
        state = State.MISSING if free < TOO_LITTLE_BYTES else State.NOTE
        return Finding(TOPIC, "disk", state, text, "make room; the paper's twenty runs take 0.4 GB")
    return Finding(TOPIC, "disk", State.WORKS, text)


def encoder() -> Finding:
    """The program that writes videos."""
    asked = attempt(ENCODER)
    if asked.works:
        program, version = asked.lines[-2:]
        return Finding(TOPIC, "ffmpeg", State.WORKS, f"{version} {program}")
    set_by_hand = "IMAGEIO_FFMPEG_EXE" in os.environ
    move = "unset IMAGEIO_FFMPEG_EXE" if set_by_hand else "pip install --force-reinstall imageio-ffmpeg"
    return Finding(TOPIC, "ffmpeg", State.MISSING, asked.reason, move)


def robots() -> list[Finding]:
    """The descriptions of the robots."""
    findings = []
    for robot in ROBOTS.values():
        try:
            findings.append(Finding(TOPIC, f"robot {robot.name}", State.WORKS, str(find_urdf(robot))))
        except RobotNotInstalledError as error:
            text, _, move = str(error).rpartition("; run: ")
            findings.append(Finding(TOPIC, f"robot {robot.name}", State.MISSING, text, move))
    return findings
