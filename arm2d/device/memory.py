"""Where a device is asked for memory or for an answer, and what is said if it has none or gives none."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np
import warp as wp
from numpy.typing import NDArray

from arm2d.device.errors import DeviceLostError, DeviceMemoryError
from arm2d.device.opening import Device

T = TypeVar("T")


def placed(values: Any, dtype: Any, device: Device) -> wp.array:
    """Values as an array on the device; raises as `room`."""
    return _asked(lambda: wp.array(values, dtype=dtype, device=device.where), device)


def room(shape: int | tuple[int, ...], dtype: Any, device: Device) -> wp.array:
    """An array of zeros on the device.

    Raises:
        DeviceMemoryError: If it has too little memory left.
        DeviceLostError: If it does not answer.
    """
    return _asked(lambda: wp.zeros(shape, dtype=dtype, device=device.where), device)


def launched(kernel: Any, dim: int | tuple[int, int], inputs: list[Any], device: Device) -> None:
    """Start a kernel; raises as `room`."""
    _asked(lambda: wp.launch(kernel, dim=dim, inputs=inputs, device=device.where, block_dim=BLOCK), device)


def fetched(array: wp.array, device: Device) -> NDArray:
    """What an array holds once all kernels have ended; raises as `room`."""

    def fetch() -> NDArray:
        wp.synchronize_device(device.where)
        return np.array(array.numpy())

    return _asked(fetch, device)


# Threads in a block: few registers are left for more where a thread carries a whole trial.
BLOCK = 128


def _asked(ask: Callable[[], T], device: Device) -> T:
    """Ask, and tell too little memory from a device that is gone."""
    try:
        return ask()
    except (RuntimeError, MemoryError) as error:
        said = " ".join(str(error).split())
        if isinstance(error, MemoryError) or "allocate" in said or "out of memory" in said:
            raise DeviceMemoryError(device.name) from error
        raise DeviceLostError(device.name, said) from error
