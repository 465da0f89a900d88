"""Progress of jobs that Submitit runs in other processes, on this machine or by Slurm."""

import math
import shutil
import signal
import time
from collections.abc import Mapping, Sequence
from typing import Any

from hydra.core.singleton import Singleton

from hybrid_rl.cli import interrupt
from hybrid_rl.errors import UsageError, relative

Result = dict[str, Any]  # of a job: code, line
POLL = 0.5  # [s] between two checks of the jobs
PATIENCE = 60.0  # [s] for the jobs to end, once the sweep is interrupted


def require_slurm(launcher: str) -> None:
    """Raise UsageError for a launcher that needs Slurm's commands where there are none."""
    if launcher == "submitit_slurm" and not shutil.which("srun"):
        line = "no srun here; start it where Slurm is, or try hydra/launcher=submitit_local"
        raise UsageError(f"hydra/launcher={launcher}: {line}")


def launch(launcher: Any, jobs: Sequence[list[str]], results: dict[int, Result]) -> None:
    """Run `jobs`; print a line when one is sent and when it ends.

    launcher: one of Submitit's. A lost job, whose process was killed, for example, has failed.
    """
    from submitit.core.utils import FailedJobError

    state = Singleton.get_state()
    calls = [(job, "hydra.sweep.dir", n, f"{n}", state) for n, job in enumerate(jobs)]
    try:
        executor = _executor(launcher.params, launcher._EXECUTOR)
        sent = executor.map_array(launcher, *zip(*calls, strict=True))
    except FailedJobError as error:
        key = f"hydra/launcher=submitit_{launcher._EXECUTOR}"
        raise UsageError(f"{key}: the jobs could not be sent: {error}") from error
    running = dict(enumerate(sent))
    for number, job in running.items():
        log = relative(job.paths.stdout)
        print(f"job {number} sent: {executor.cluster} {job.job_id}, log {log}", flush=True)
    with interrupt.as_exception(PATIENCE + 5):
        try:
            _wait(running, results)
        except BaseException:
            if interrupt.cause() == signal.SIGHUP:  # jobs elsewhere need no terminal
                raise
            for job in running.values():
                job.cancel(check=False)
            _wait(running, results, PATIENCE)
            raise


def _executor(params: Mapping[str, Any], cluster: str) -> Any:
    """What sends jobs to `cluster`, with the settings of hydra.launcher."""
    import submitit
    from hydra_plugins.hydra_submitit_launcher.config import BaseQueueConf

    of_all = BaseQueueConf.__dataclass_fields__
    given = {key if key in of_all else f"{cluster}_{key}": value for key, value in params.items()}
    made = {key: given.pop(key) for key in (f"{cluster}_max_num_timeout",) if key in given}
    executor = submitit.AutoExecutor(given.pop("submitit_folder"), cluster=cluster, **made)
    executor.update_parameters(**given)
    return executor


def _wait(jobs: dict[int, Any], results: dict[int, Result], most: float = math.inf) -> None:
    """Wait for the end of all jobs, at most `most` [s], and print when each ends."""
    began = time.monotonic()
    while len(results.keys() & jobs.keys()) < len(jobs) and time.monotonic() - began < most:
        for number, job in jobs.items():
            if number not in results and job.done():
                results[number] = _result(job)
                print(f"job {number} ends: {results[number]['line']}", flush=True)
        time.sleep(POLL)


def _result(job: Any) -> Result:
    """The result of a job of Submitit's that has ended."""
    try:
        return job.results()[0].return_value
    except Exception as error:
        line = str(error).strip().splitlines()[0]
        return {"code": 1, "line": f"lost: {line}; see {relative(job.paths.stderr)}"}
