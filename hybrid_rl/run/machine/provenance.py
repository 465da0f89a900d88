"""Versions, commit and device, for summary.json."""

import os
import platform
import subprocess
from collections.abc import Iterable
from contextlib import suppress
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import jax

from hybrid_rl.version import __version__

PACKAGES = ("jax", "jaxlib", "mujoco", "mujoco-mjx", "flax", "optax")


def versions(packages: Iterable[str] = PACKAGES) -> dict[str, str | None]:
    """Versions of this library, Python and each package; None if it is not installed."""
    installed: dict[str, str | None] = {"hybrid_rl": __version__}
    installed["python"] = platform.python_version()
    for name in packages:
        try:
            installed[name] = version(name)
        except PackageNotFoundError:
            installed[name] = None
    return installed


def git_commit() -> str | None:
    """The commit of the checkout that this package runs from; None outside a checkout."""
    checkout = Path(__file__).resolve().parents[3]
    if not (checkout / ".git").exists():
        return None
    command = ["git", "-C", str(checkout), "rev-parse", "HEAD"]
    clean = {name: text for name, text in os.environ.items() if not name.startswith("GIT_")}
    try:
        done = subprocess.run(command, env=clean, capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return None
    return done.stdout.strip()


def device() -> str:
    """The device of JAX: "gpu: NVIDIA H100" or "cpu: AMD EPYC 7B13, 8 threads"."""
    devices = jax.devices()
    first = devices[0]
    if first.platform != "cpu":
        several = f"{len(devices)} x " if len(devices) > 1 else ""
        return f"{first.platform}: {several}{first.device_kind}"
    lines: list[str] = []
    with suppress(OSError):
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return f"cpu: {names[0] if names else platform.machine()}, {os.cpu_count()} threads"
