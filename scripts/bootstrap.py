"""Make .venv: the locked dependencies, hashes checked, and this project, editable.

`make` runs it; it needs nothing but the standard library. Where Python came without
pip (Debian's python3 does), the pip that the lock names is fetched from the index.
What has to be built is built with the locked tools: pip fetches none of its own.
A set-up that was interrupted starts over; of two at the same time, one waits for the other.
"""

import fcntl
import hashlib
import html
import os
import re
import subprocess
import sys
import urllib.parse
import urllib.request
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
LOCK, PROJECT, VENV = ROOT / "requirements.lock", ROOT / "pyproject.toml", ROOT / ".venv"
PYTHON, STAMP, UNFINISHED = VENV / "bin/python", VENV / ".installed", VENV / ".unfinished"


def works(*command: object) -> bool:
    """Whether a command can be run, and ends well."""
    try:
        return subprocess.run(list(map(str, command)), capture_output=True).returncode == 0
    except OSError:
        return False


def make_venv() -> None:
    """An empty environment, with pip where this Python can."""
    command = [sys.executable, "-m", "venv", "--clear"]
    if not works(*command, VENV):
        subprocess.run([*command, "--without-pip", str(VENV)], check=True)


def locked(name: str) -> str:
    """What the lock says about one package: NAME==VERSION and its hashes."""
    [lines] = re.findall(rf"^{name}==\S+(?: \\\n +--hash=\S+)+", LOCK.read_text(), re.M)
    return lines


def fetch_pip() -> Path:
    """The locked pip, as a wheel; it runs without being installed."""
    hashes = locked("pip")
    version = hashes.split()[0].removeprefix("pip==")
    wheel = VENV / f"pip-{version}-py3-none-any.whl"
    index = os.environ.get("PIP_INDEX_URL", "https://pypi.org/simple").rstrip("/") + "/pip/"
    page = urllib.request.urlopen(index).read().decode()
    link = re.findall(rf'href="([^"]*{re.escape(wheel.name)})[#"]', page)[0]
    data = urllib.request.urlopen(urllib.parse.urljoin(index, html.unescape(link))).read()
    if hashlib.sha256(data).hexdigest() not in hashes:
        sys.exit(f"{wheel.name} from {index} is not the one that {LOCK.name} names")
    wheel.write_bytes(data)
    return wheel


def install() -> None:
    """Put the locked dependencies and this project into .venv; if it is unfinished, a fresh one."""
    supported = "import sys; sys.exit(not (3, 11) <= sys.version_info < (3, 14))"
    if UNFINISHED.exists() or not works(PYTHON, "-c", supported):
        make_venv()
    UNFINISHED.touch()
    pip = ["-m", "pip"] if works(PYTHON, "-m", "pip", "--version") else [f"{fetch_pip()}/pip"]
    command = [str(PYTHON), *pip, "install", "-qq", "--disable-pip-version-check"]
    command += ["--no-build-isolation"]  # else pip fetches build tools without a hash
    tools = VENV / "tools.txt"
    tools.write_text(locked("setuptools"))
    for lock in (tools, LOCK):
        subprocess.run([*command, "--require-hashes", "-r", str(lock)], check=True)
    subprocess.run([*command, "--no-deps", "-e", str(ROOT)], check=True)
    STAMP.touch()
    UNFINISHED.unlink()


def main() -> None:
    """Bring .venv up to date with the lock."""
    newest = max(path.stat().st_mtime for path in (LOCK, PROJECT, Path(__file__)))
    with ROOT.joinpath(".venv.lock").open("w") as guard:
        fcntl.flock(guard, fcntl.LOCK_EX)
        if STAMP.exists() and STAMP.stat().st_mtime >= newest:
            return
        print("Setting up .venv from requirements.lock: 1.8 GB, a minute or two ...", flush=True)
        install()


if __name__ == "__main__":
    try:
        main()
    except (KeyboardInterrupt, OSError, subprocess.CalledProcessError) as error:
        sys.exit(f"set-up did not finish ({error or 'interrupted'}); make starts it again")
