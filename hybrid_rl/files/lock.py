"""A run folder belongs to one process at a time.

While a process trains, the folder holds the file `lock`, which the operating system locks and which
names the process. The system releases it when the process ends, however it ends, so a file that a
killed process left behind locks nothing.
"""

import errno
import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from filelock import FileLock, Timeout

from hybrid_rl.errors import UsageError
from hybrid_rl.files.atomic import open_own, refuse_link

LOCK = "lock"
NO_LOCKS = (errno.ENOLCK, errno.EOPNOTSUPP, errno.EINVAL)  # of some network disks


@contextmanager
def lock(folder: Path, key: str) -> Iterator[Path]:
    """`folder`, made if it does not exist and locked by this process until the end of the block.

    key: the argument that named the folder.
    """
    path, flaw = folder / LOCK, ""
    held = FileLock(path, timeout=0)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        refuse_link(path)
        held.acquire()
        with suppress(OSError), open_own(path, "w") as file:  # on a full disk it stays empty
            file.write(f"process {os.getpid()} on {socket.gethostname()}\n")
    except Timeout:
        with suppress(OSError):  # which its holder has just deleted
            flaw = path.read_text(errors="replace").strip()
        flaw = f"is being written by {flaw or 'another process'}; wait for it, or stop it"
    except OSError as error:
        if error.errno not in NO_LOCKS:
            flaw = f"cannot be written to ({error.strerror})"
    if flaw:
        raise UsageError(f"{key}={folder}: {flaw}")
    if not held.is_locked:
        print(f"{folder}: this disk has no locks; let no other process write there")
    try:
        yield folder
    finally:
        if held.is_locked:
            path.unlink(missing_ok=True)  # the folder may have been moved
        held.release()
