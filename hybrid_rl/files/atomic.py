"""Files of runs: written whole, by a draft that replaces them, or opened; no link is followed.

A run folder may come from anybody. A link in it would lead a writer to a file of somebody else.
"""

import errno
import os
import secrets
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from hybrid_rl.errors import UsageError

NO_WAIT, NO_LINK = getattr(os, "O_NONBLOCK", 0), getattr(os, "O_NOFOLLOW", 0)


def own_file(file: Path, flags: int) -> int:
    """A handle of a file of a run; flags: as of `os.open`."""
    try:
        handle = os.open(file, flags | NO_LINK | NO_WAIT, 0o666)
        if stat.S_ISREG(os.fstat(handle).st_mode):
            return handle
        os.close(handle)
    except OSError as error:
        if error.errno not in (errno.ELOOP, errno.ENXIO):
            raise
    raise UsageError(f"{file}: is a link, or no plain file; a run has its own files")


def open_own(file: Path, mode: str = "ab", **how: Any) -> Any:
    """A file of a run, as `open`, but that no link is followed."""
    return open(file, mode, opener=lambda path, flags: own_file(Path(path), flags), **how)


def refuse_link(folder: Path) -> Path:
    """A folder in that of a run, which may not be there; UsageError for a link."""
    if folder.is_symlink():
        raise UsageError(f"{folder}: is a link; a run has its own folders")
    return folder


def own_folder(folder: Path) -> Path:
    """A folder in that of a run, made if there is none, but not its parents."""
    refuse_link(folder).mkdir(exist_ok=True)
    return folder


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """The path of a draft to write, which ends like `path` and replaces it afterwards.

    After an error, or Ctrl-C, the draft is gone and `path` is what it was.
    """
    draft = path.with_name(f".{secrets.token_hex(4)}.{path.name}")
    with naming(path):
        try:
            yield draft
            sync(draft)
            draft.replace(path)
        except BaseException:
            draft.unlink(missing_ok=True)
            raise
        sync(path.parent)


def write_text(path: Path, text: str) -> None:
    """Replace the text of a file; a reader sees the old or the new text, never a part."""
    with replacing(path) as draft, draft.open("x", encoding="utf-8") as file:
        file.write(text)


def sync(path: Path) -> None:
    """Force a file, or the entries of a folder, to the disk."""
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


@contextmanager
def naming(path: Path) -> Iterator[None]:
    """Add `path` to an OSError that names no file, such as that of a full disk."""
    try:
        yield
    except OSError as error:
        if error.filename is None and error.errno is not None:
            error.filename = str(path)
        raise
