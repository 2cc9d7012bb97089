"""One process at a time at a file; the kernel lets go of it, however the process ends."""

from __future__ import annotations

import errno
import fcntl
from typing import Final

# What file systems answer that keep no locks.
NO_LOCKS: Final = (errno.ENOSYS, errno.ENOLCK, errno.ENOTSUP)


def lock_file(handle: int) -> bool:
    """Lock an open file without waiting; False if its file system keeps no locks.

    Raises:
        BlockingIOError: If another process holds it.
        OSError: If it cannot be locked for another reason.
    """
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        if error.errno not in NO_LOCKS:
            raise
        return False
    return True
