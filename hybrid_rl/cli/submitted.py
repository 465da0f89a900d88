"""Progress of jobs that Submitit runs in other processes, on this machine or by Slurm."""

import math
import shutil
import signal
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from hydra.core.utils import JobReturn, JobStatus

from hybrid_rl.cli import interrupt
from hybrid_rl.composition import SLURM
from hybrid_rl.errors import UsageError, relative

Result = dict[str, Any]  # of a job: code, line
POLL = 0.5  # [s] between two checks of the jobs
PATIENCE = 60.0  # [s] for the jobs to end, once the sweep is interrupted


def require_slurm(launcher: str) -> None:
    """Raise UsageError for a launcher that needs Slurm's commands where there are none."""
    if launcher == SLURM and not (shutil.which("sbatch") and shutil.which("srun")):
        raise UsageError(
            f"hydra/launcher={SLURM}: no sbatch and srun here; start it where Slurm is, "
            "or try hydra/launcher=submitit_local"
        )


@contextmanager
def watch(results: dict[int, Result]) -> Iterator[None]:
    """Print a line when a job of Submitit is sent, begins and ends.

    A lost job, whose process was killed, for example, counts as failed.
    """
    import submitit
    from submitit.core.utils import FailedJobError

    send = submitit.AutoExecutor.map_array

    def map_array(executor: Any, function: Any, *lists: Sequence[Any]) -> list[_Ended]:
        try:
            sent = send(executor, function, *lists)
        except FailedJobError as error:
            reason = str(error).strip().replace("\n", "; ")
            key = f"hydra/launcher=submitit_{executor.cluster}"
            raise UsageError(f"{key}: the jobs could not be sent: {reason}") from error
        jobs = dict(zip(lists[2], sent, strict=True))
        for number, job in jobs.items():
            print(f"job {number} sent: {executor.cluster} {job.job_id}", flush=True)
        with interrupt.as_exception(PATIENCE + 5):
            try:
                _wait(jobs, results)
            except BaseException:
                if interrupt.cause() == signal.SIGHUP:  # jobs elsewhere need no terminal
                    raise
                for job in jobs.values():
                    job.cancel(check=False)
                _wait(jobs, results, PATIENCE)
                raise
        return [_Ended(results[number]) for number in jobs]

    submitit.AutoExecutor.map_array = map_array
    try:
        yield
    finally:
        submitit.AutoExecutor.map_array = send


class _Ended:
    """A job of Submitit's that has ended."""

    def __init__(self, result: Result) -> None:
        self.result = result

    def results(self) -> list[JobReturn]:
        """The result in the form that Hydra's launcher expects."""
        return [JobReturn(_return_value=self.result, status=JobStatus.COMPLETED)]


def _wait(jobs: dict[int, Any], results: dict[int, Result], most: float = math.inf) -> None:
    """Wait for the end of all jobs, at most `most` [s], and print when each begins and ends."""
    began, running = time.monotonic(), set()
    while len(results.keys() & jobs.keys()) < len(jobs) and time.monotonic() - began < most:
        for number, job in jobs.items():
            if number in results:
                continue
            if number not in running and job.paths.stdout.exists():
                running.add(number)
                print(f"job {number} begins: log {relative(job.paths.stdout)}", flush=True)
            if job.done():
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
