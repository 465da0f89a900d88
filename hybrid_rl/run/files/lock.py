"""A run folder belongs to one process at a time.

While a process trains, the folder holds the file `lock`, which the operating system locks (flock)
and which names the process. The system releases the lock when the process ends, however it ends,
so a file that a killed process left behind locks nothing.
"""

import errno
import fcntl
import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from hybrid_rl.errors import UsageError
from hybrid_rl.files.atomic import own_file

LOCK = "lock"
NO_LOCKS = (errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP, errno.EINVAL)  # of some network disks


@contextmanager
def lock(folder: Path, key: str) -> Iterator[Path]:
    """`folder`, made if it does not exist and locked by this process until the end of the block.

    key: the argument that named the folder.
    """
    path = folder / LOCK
    handle = _open(path, key)
    try:
        with suppress(OSError):  # on a full disk the file stays empty
            os.ftruncate(handle, 0)
            os.write(handle, f"process {os.getpid()} on {socket.gethostname()}\n".encode())
        yield folder
    finally:
        with suppress(OSError):
            if os.path.samestat(os.fstat(handle), path.stat()):  # the folder may have been moved
                path.unlink()
        os.close(handle)


def _open(path: Path, key: str) -> int:
    """A handle of the lock file at `path`, locked."""
    while True:
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            handle = own_file(path, os.O_RDWR | os.O_CREAT)
        except (OSError, ValueError) as error:  # ValueError: of a name that no file has
            if isinstance(error, UsageError):
                raise
            why = getattr(error, "strerror", error)
            raise UsageError(f"{key}={path.parent}: cannot be written to ({why})") from error
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if os.path.samestat(os.fstat(handle), path.stat()):
                return handle
        except FileNotFoundError:  # the previous holder has just deleted it
            pass
        except BlockingIOError:
            holder = os.read(handle, 200).decode(errors="replace").strip() or "another process"
            os.close(handle)
            raise UsageError(
                f"{key}={path.parent}: is being written by {holder}; wait for it, or stop it"
            ) from None
        except OSError as error:
            if error.errno not in NO_LOCKS:
                os.close(handle)
                error.filename = str(path)
                raise
            print(f"{path.parent}: this disk has no locks; let no other process write there")
            return handle
        os.close(handle)
