"""What can go wrong on a device, in one sentence."""

from __future__ import annotations

from arm2d.constants import N_INTER
from arm2d.network.genes import counted


class DeviceMemoryError(ValueError):
    """A device has too little memory for what it was asked."""

    def __init__(self, name: str) -> None:
        super().__init__(
            f"{name} has too little memory left for even one group of trials; let fewer processes share it "
            "(--jobs), or leave --device away to use the processor"
        )


class DeviceTaskError(ValueError):
    """A task that the device's kernel does not know."""

    def __init__(self, task: object) -> None:
        super().__init__(
            f"a device runs the paper's conditions, with-indicate and with-ignore, not {task}; "
            "leave --device away"
        )


class DeviceSizeError(ValueError):
    """Networks that the device's kernel does not know."""

    def __init__(self, n_inter: int) -> None:
        super().__init__(
            f"a device runs the paper's networks of {counted(N_INTER)}, not of {n_inter}; leave --device away"
        )


class DeviceLostError(ValueError):
    """A device no longer answers, or not with what was asked for."""

    def __init__(self, name: str, said: str) -> None:
        super().__init__(
            f"{name} was lost ({said}); nothing that was written is: repeat the command to go on, "
            "without --device if it does not come back"
        )
