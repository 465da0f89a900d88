"""One run over several processes or hosts: each trains its share of the learners.

    srun --ntasks=4 python -m hybrid_rl.train distributed=true num_seeds=32 run_dir=runs/many ...

`jax.distributed` counts the processes. Under Slurm, Open MPI and Kubernetes it finds them;
elsewhere JAX_COORDINATOR_ADDRESS (host:port of process 0), JAX_NUM_PROCESSES and JAX_PROCESS_ID
name them.
Learners exchange nothing, so the processes are independent once they are counted: process K writes
an ordinary run of its seeds to RUN_DIR/process_K, and none waits for another.
`resume=RUN_DIR distributed=true` continues all of them.
"""

import os
from functools import cache
from pathlib import Path

from omegaconf import DictConfig

from hybrid_rl.errors import UsageError

NUMBERS = ("JAX_NUM_PROCESSES", "JAX_PROCESS_ID")
HOW = (
    "start it by Slurm, Open MPI or Kubernetes, or set JAX_COORDINATOR_ADDRESS (host:port), "
    + " and ".join(NUMBERS)
)


def share(config: DictConfig) -> DictConfig:
    """The run of this process: its seeds, its folder."""
    key, flaw = "run_dir" if config.resume is None else "resume", ""
    if config[key] is None:
        raise UsageError("run_dir=null: distributed=true needs one folder for all processes")
    index, count = processes()
    parent, own = Path(str(config[key])), config.copy()
    own.distributed = False
    own[key] = str(parent / f"process_{index}")
    if config.resume is None:
        least, more = divmod(config.num_seeds, count)
        own.seed = config.seed + index * least + min(index, more)
        own.num_seeds = least + (index < more)
        if not least:
            flaw = f"num_seeds={config.num_seeds}: must be {count} or more, one a process"
    elif (there := len([*parent.glob("process_*")])) != count:
        flaw = f"resume={parent}: holds {there} shares, and there are {count} processes"
    if flaw:
        raise UsageError(flaw)
    return own


@cache  # a process joins once, also in a sweep
def processes() -> tuple[int, int]:
    """The number of this process, from 0, and how many there are."""
    import jax
    from jax._src.distributed import global_state  # its public counts create a backend of all hosts

    try:
        total, index = (int(os.environ[name]) if name in os.environ else None for name in NUMBERS)
        jax.distributed.initialize(num_processes=total, process_id=index)
    except (ValueError, TypeError) as error:
        reason = str(error).rstrip(".")
        raise UsageError(f"distributed=true: no processes found ({reason}); {HOW}") from error
    process = global_state.process_id, global_state.num_processes
    jax.distributed.shutdown()
    global_state.process_id, global_state.num_processes = 0, 1  # independent from here on
    return process
