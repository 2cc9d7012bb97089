"""Which device is meant by a name, or in one sentence why there is none.

Warp is imported no sooner than a device is opened.
"""

from __future__ import annotations

import ctypes
import re
from contextlib import suppress
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Final

from arm2d.cache import cache_folder

# What every machine has: the compiled kernel, without any of this folder.
PROCESSOR: Final = "cpu"
# The device's kernel on the processor: a check of its bits where there is no device, and slow.
CHECK: Final = "warp-cpu"
CUDA: Final = "cuda"
NUMBERED: Final = re.compile(r"cuda:(\d{1,3})")


@dataclass(frozen=True)
class Device:
    """A device that is open.

    Attributes:
        name: As the user calls it.
        where: As Warp calls it.
        model: What it is, for people.
    """

    name: str
    where: str
    model: str


def check_name(name: str) -> str:
    """A device's name, if it can be one.

    Raises:
        ValueError: If it cannot.
    """
    if name in (PROCESSOR, CHECK, CUDA) or NUMBERED.fullmatch(name):
        return name
    raise ValueError(f"unknown device {name!r}; give cpu, cuda, or one of several such as cuda:1")


def open_device(name: str) -> Device:
    """The device of a name other than `cpu`.

    Raises:
        ValueError: If the name means none, a package is missing, or the machine has no such device.
    """
    check_name(name)
    if name == CHECK:
        _warp()
        return Device(name, "cpu", "processor")
    n_devices = len(cuda_names())
    if n_devices == 0:
        raise ValueError(
            f"no CUDA device is found on this machine, so {name} is not there; leave --device away to use "
            "the processor, which gives the same bits"
        )
    number = int(name.partition(":")[2] or 0)
    if number >= n_devices:
        raise ValueError(f"{name} is not there; this machine has {', '.join(cuda_names())}")
    found = _warp().get_device(f"cuda:{number}")
    return Device(name, found.alias, found.name)


def cuda_names() -> list[str]:
    """The CUDA devices of this machine, such as `cuda:0`."""
    _require_package()
    if not _has_driver():  # of which Warp would tell in words of its own
        return []
    return [f"cuda:{number}" for number in range(_warp().get_cuda_device_count())]


def _require_package() -> None:
    """Refuse without the package of the extra `gpu`."""
    found = find_spec("warp")
    if found is None or found.origin is None:  # a folder of that name is no package
        raise ValueError("a device needs the package warp-lang; install it with: pip install 'wordarm[gpu]'")


def _has_driver() -> bool:
    """Whether the library is there by which programs speak with NVIDIA's driver."""
    for name in ("libcuda.so", "libcuda.so.1"):
        with suppress(OSError):
            ctypes.CDLL(name)
            return True
    return False


def _warp() -> Any:
    """The package, told to be quiet and to keep what it compiles where only the user can write.

    Raises:
        ValueError: If it is not installed.
    """
    _require_package()
    import warp

    warp.config.log_level = warp.LOG_ERROR
    if (folder := cache_folder()) is not None:
        warp.config.kernel_cache_dir = str(Path(folder).parent / "warp")
    warp.init()
    return warp
