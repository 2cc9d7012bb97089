"""Keys for TLS between this command and its workers: made for one time, and gone after it.

They lie in a folder that only we can enter, which is locked and leased like a run: whoever finds one that
nobody holds, left by a command that was killed, removes it.
"""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

from distributed.security import Security

from arm2d.files import handle_of_new
from evolution.runs.folder import LOCK
from evolution.runs.lock import RunInUseError, locked

PREFIX: Final = "keys-"
# What a worker is told of, by Dask's names.
OF_WORKERS: Final = ("tls_ca_file", "tls_worker_cert", "tls_worker_key")


def own_keys(folder: Path) -> Security:
    """Keys that nobody else has; those of the workers are written into a folder.

    Raises:
        ValueError: If they cannot be made.
        OSError: If they cannot be written.
    """
    try:
        keys = Security.temporary()
    except ImportError:
        raise ValueError(
            "keys for TLS need the package cryptography; install it with: pip install 'wordarm[cluster]'"
        ) from None
    for name in OF_WORKERS:
        file = folder / f"{name}.pem"
        handle = handle_of_new(file)
        os.fchmod(handle, 0o600)
        with os.fdopen(handle, "w", encoding="ascii") as pem:
            pem.write(getattr(keys, name))
        setattr(keys, name, str(file))
    return keys


@contextmanager
def folder_for_keys(logs: Path) -> Iterator[Path]:
    """While open, a folder for keys that workers on other machines can read as us; older ones are cleared.

    Raises:
        OSError: If it cannot be made.
    """
    clear_keys(logs)
    folder = Path(tempfile.mkdtemp(prefix=PREFIX, dir=logs))  # for us alone, whatever the umask
    try:
        with locked(folder):
            yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def clear_keys(logs: Path) -> None:
    """Remove the folders of keys that nobody holds any more."""
    for folder in sorted(logs.glob(f"{PREFIX}*")):
        with suppress(OSError, RunInUseError):
            status = os.lstat(folder)
            if folder.is_symlink() or status.st_uid != os.geteuid() or not (folder / LOCK).exists():
                continue  # somebody else's, or none of ours
            with locked(folder):
                shutil.rmtree(folder, ignore_errors=True)
