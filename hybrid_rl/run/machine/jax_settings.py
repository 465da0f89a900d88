"""Settings of JAX for a process: compilation cache, precision, threads."""

import os
from pathlib import Path

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
        return  # where it cannot be written, JAX warns, and compiles again each time
    cache = Path(str(config.compile_cache)).expanduser() / OURS
    jax.config.update("jax_compilation_cache_dir", str(cache))
    jax.config.update("jax_compilation_cache_max_size", CACHE_BYTES)
    jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.1)
