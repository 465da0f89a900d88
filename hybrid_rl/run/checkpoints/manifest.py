"""Complete folders of files: a manifest, fsync, and rename.

`write` lists every file below a folder with its size and SHA-256 in MANIFEST and
forces all of it to the disk. `verify` compares the folder with that list and names the
first difference. A folder without a manifest was never completed.
"""

import hashlib
import json
from pathlib import Path

from hybrid_rl.files.atomic import sync

MANIFEST = "manifest.json"


def write(folder: Path) -> None:
    """List all files below `folder`, then force files and folders to the disk."""
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    listed = {
        path.relative_to(folder).as_posix(): {"bytes": path.stat().st_size, "sha256": digest(path)}
        for path in files
    }
    manifest = folder / MANIFEST
    manifest.write_text(json.dumps({"files": listed}, indent=1) + "\n", encoding="ascii")
    below = [path for path in folder.rglob("*") if path.is_dir()]
    for path in [*files, manifest, *below, folder]:
        sync(path)


def verify(folder: Path, contents: bool = True) -> str | None:
    """The first difference of `folder` from its manifest; None if there is none.

    contents: read every byte, not only sizes.
    """
    try:
        listed = json.loads((folder / MANIFEST).read_text(encoding="ascii"))["files"]
        files = [(name, entry["bytes"], entry["sha256"]) for name, entry in listed.items()]
    except FileNotFoundError:
        return f"it has no {MANIFEST}, so its writing was cut off"
    except (OSError, ValueError, LookupError, TypeError, AttributeError, RecursionError) as problem:
        return f"its {MANIFEST} cannot be read ({type(problem).__name__})"
    for name, size, sha256 in files:
        try:
            if not (folder / name).is_file():  # a pipe or a device might have no end
                return f"{name} is missing, or no plain file"
            if (size_now := (folder / name).stat().st_size) != size:
                return f"{name} has {size_now} bytes instead of {size}"
            if contents and digest(folder / name) != sha256:
                return f"{name} has changed since it was written (SHA-256 differs)"
        except OSError as problem:
            return f"{name} cannot be read ({problem.strerror})"
    return None


def digest(path: Path) -> str:
    """SHA-256 of a file, in hexadecimal."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
