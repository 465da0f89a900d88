"""Settings of JAX for a process: compilation cache, precision, threads."""

import os
import sys
from pathlib import Path
from tempfile import TemporaryFile

from omegaconf import DictConfig

CACHE = "JAX_COMPILATION_CACHE_DIR"  # JAX's own variable, which overrides compile_cache
CACHE_BYTES = 4 * 2**30  # [bytes] at most
OURS = "programs"  # folder in compile_cache, as JAX deletes from its folder what it likes
THREADS = 8  # of XLA with MJX on a CPU, at least


def prepare(config: DictConfig) -> None:
    """Apply the settings in `config`. Call it before JAX initialises its devices.

    With MJX on a CPU, factorisations of many worlds run in parallel, and each holds one of XLA's
    threads while it waits for others (jaxlib 0.10). With two threads they deadlock, so there are
    at least THREADS.
    """
    import jax

    from hybrid_rl.envs.mujoco.native import cores
    from hybrid_rl.networks import precision

    if config.physics == "mjx" and cores() < THREADS:
        os.environ.setdefault("NPROC", str(THREADS))
    jax.config.update("jax_default_matmul_precision", "highest")  # of all but networks
    precision.choose(config.precision)
    if config.compile_cache is None or CACHE in os.environ:
        return
    if cache := cache_folder(str(config.compile_cache)):
        jax.config.update("jax_compilation_cache_dir", str(cache))
        jax.config.update("jax_compilation_cache_max_size", CACHE_BYTES)
        jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.1)


def cache_folder(compile_cache: str) -> Path | None:
    """The folder of compiled programs; None, after a line on stderr, if it cannot be written."""
    cache = Path(compile_cache).expanduser() / OURS
    try:
        cache.mkdir(parents=True, exist_ok=True)
        with TemporaryFile(dir=cache):
            pass
    except OSError as error:
        why = f"cannot be written to ({error.strerror}); programs are compiled again each time"
        print(f"hybrid_rl: compile_cache={compile_cache}: {why}", file=sys.stderr, flush=True)
        return None
    return cache
