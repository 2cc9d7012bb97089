"""A Dask scheduler that somebody started, known by its address."""

from __future__ import annotations

from pathlib import Path

from distributed import Client
from distributed.comm.addressing import parse_address
from distributed.comm.registry import backends

from evolution.experiments.cluster.connection import Connection


def connected(address: str, folder: Path) -> Connection:
    """A connection to it, not yet opened.

    Args:
        address: Such as tls://10.0.0.1:8786, with keys from Dask's configuration; tcp:// lets in everybody
            who reaches it.
        folder: Of the experiment, shared by all machines.

    Raises:
        ValueError: If this is no address.
    """
    try:
        scheme, location = parse_address(address)
    except ValueError:
        scheme, location = "", ""
    if scheme not in backends or ":" not in location:
        raise ValueError(
            f"{address!r} is not the address of a scheduler; give one such as tls://10.0.0.1:8786"
        )
    return Connection(
        lambda seconds: Client(address, timeout=seconds, set_as_default=False),
        address,
        folder,
        f"start some with: dask worker {address}",
    )
