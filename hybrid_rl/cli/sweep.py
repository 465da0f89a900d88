"""A sweep: all jobs are checked before the first one runs, all run, and a table is printed.

Hydra's basic sweeper ends a sweep at the first job that fails, and prints nothing of jobs that run
in other processes. Here a failed job is a result like any other; the exit code of the command is
the highest one of its jobs. `jobs.json` in the sweep's folder holds what the table shows.
"""

import json
import math
import shutil
import signal
import sys
import time
import traceback
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from hydra._internal.core_plugins.basic_sweeper import BasicSweeper
from hydra.core.hydra_config import HydraConfig
from hydra.core.override_parser.overrides_parser import OverridesParser
from hydra.core.plugins import Plugins
from hydra.core.singleton import Singleton
from omegaconf import DictConfig, OmegaConf

from hybrid_rl.cli import command, interrupt
from hybrid_rl.errors import UsageError, relative
from hybrid_rl.files.atomic import write_text
from hybrid_rl.run.checkpoints import checkpoint
from hybrid_rl.run.folder import members, new_folder, remove_empty
from hybrid_rl.run.launch import built
from hybrid_rl.run.logs.records import result_line
from hybrid_rl.run.members import expand_sweep
from hybrid_rl.settings import build as configuration
from hybrid_rl.settings import words
from hybrid_rl.settings.compose import UNCOMPOSED, explain
from hybrid_rl.settings.words import forced, quoted, typed

Result = dict[str, Any]  # of a job: code, line
POLL = 0.5  # [s] between two checks of the jobs
PATIENCE = 60.0  # [s] for the jobs to end, once the sweep is interrupted
ACCELERATED = ("auto", "mjx", "warp")  # physics that may need a GPU to build a world


class Task:
    """A job of a sweep as Hydra calls it; its errors become its result."""

    def __init__(self, job: Callable[[DictConfig], Any]) -> None:
        self.job = job
        self.results: dict[int, Result] = {}  # number of a job -> its result
        self.labels: dict[int, str] = {}  # the overrides in which the jobs differ

    def __call__(self, config: DictConfig) -> Result:
        """Run one job."""
        hydra = HydraConfig.get()
        number = int(hydra.job.num)
        name = f"job {number}"
        print(f"{name}: {self.labels[number]}", flush=True)
        result: Result = {"code": 0, "line": "done"}
        self.results[number] = result
        try:
            result["line"] = result_line(self.job(config) or {})
        except (SystemExit, KeyboardInterrupt) as end:
            code = end.code if isinstance(end, SystemExit) else 130
            result |= {"code": code, "line": "stopped"}
            if here(hydra):  # all of the sweep is stopped
                raise
        except Exception as error:
            code, line = command.diagnosis(error) or (1, traceback.format_exc().strip())
            print(f"hybrid_rl: {name}: {line}", file=sys.stderr, flush=True)
            result |= {"code": code, "line": line.splitlines()[-1]}
        return result


def here(hydra: Any) -> bool:
    """Whether jobs run in this process."""
    return str(hydra.launcher._target_).endswith("BasicLauncher")


class Sweeper:
    """Checks, runs and reports every combination of the given values."""

    def __init__(
        self, params: Any, *, hydra_context: Any, task_function: Any, config: DictConfig
    ) -> None:
        """Get from Hydra what to run and how; params: values to sweep where no others are given."""
        self.params, self.hydra_context, self.config = params or {}, hydra_context, config
        self.task = Task(task_function)
        self.launcher = Plugins.instance().instantiate_launcher(hydra_context, self.task, config)

    def sweep(self, arguments: list[str]) -> Any:
        """Run all jobs; end the process with the highest exit code if one failed."""
        launcher = self.config.hydra.runtime.choices["hydra/launcher"]
        if launcher == "submitit_slurm" and not shutil.which("srun"):
            line = "no srun here; start it where Slurm is, or try hydra/launcher=submitit_local"
            raise UsageError(f"hydra/launcher={launcher}: {line}")
        parser = OverridesParser.create(config_loader=self.hydra_context.config_loader)
        given = [*(f"{k}={v}" for k, v in self.params.items()), *typed(arguments)]
        parsed = parser.parse_overrides(given)
        for each in (each for each in parsed if each.is_sweep_override()):
            if each.is_interval_sweep() or not [*each.sweep_string_iterator()]:
                raise UsageError(f"{each.input_line}: gives no values; list them")
        jobs = BasicSweeper.split_arguments([*parsed], None)[0]
        configs = self._checked(jobs)
        folder = Path(str(self.config.hydra.sweep.dir))
        folder.mkdir(parents=True, exist_ok=True)
        jobs, folders = zip(*_folders(jobs, configs), strict=True)
        write_text(folder / "multirun.yaml", OmegaConf.to_yaml(self.config))
        print(f"sweep of {len(jobs)} jobs: {folder}", flush=True)
        results, given = self.task.results, [*map(self._forced, jobs)]
        try:
            if here(self.config.hydra):
                self.launcher.launch(given, 0)
            else:
                launch(self.launcher, given, results)
        finally:
            _report(folder, self.task.labels, folders, results)
        worst = max(result["code"] for result in results.values())
        if worst:
            sys.exit(worst)

    def _forced(self, job: Sequence[str]) -> list[str]:
        """The overrides of a job as Hydra takes them."""
        options = self.hydra_context.config_loader.get_group_options
        names = {words.name(text).partition("@")[0] for text in job}
        return forced(job, {each for each in names if options(each, None)})  # or folders of them

    def _checked(self, jobs: Sequence[Sequence[str]]) -> list[DictConfig]:
        """What the runs of the jobs read, after all checks that need no compilation."""
        common = set.intersection(*map(set, jobs))
        own = ([text for text in overrides if text not in common] for overrides in jobs)
        self.task.labels = {number: " ".join(texts) for number, texts in enumerate(own)}
        configs, loader = [], self.hydra_context.config_loader
        for number, job in enumerate(jobs):
            with self._naming(number):
                composed = loader.load_sweep_config(self.config, self._forced(job))
                configs.append(configuration.read(composed, composed.hydra))
        for number, (job, config) in enumerate(zip(jobs, configs, strict=True)):
            with self._naming(number):
                self._check(job, config.copy())
        return configs

    @contextmanager
    def _naming(self, number: int) -> Iterator[None]:
        """Name the job in errors of the block."""
        try:
            yield
        except (UsageError, *UNCOMPOSED) as error:
            line = error if isinstance(error, UsageError) else explain(error)
            label = f"job {number}: {self.task.labels[number]}"
            raise UsageError(f"{line} ({label.removesuffix(': ')})") from error

    def _check(self, job: Sequence[str], config: DictConfig) -> None:
        """Raise UsageError if a job cannot run, alone or with those that share its program.

        One that runs elsewhere is built with the physics that needs no GPU here.
        """
        if not here(self.config.hydra) and config.physics in ACCELERATED:
            config.physics = "native"
        swept = expand_sweep(config, job)
        if config.resume is None:
            built(swept)


def _folders(
    jobs: Sequence[Sequence[str]], configs: Sequence[DictConfig]
) -> Iterator[tuple[list[str], str]]:
    """The overrides of each job, with a run folder of its own, and that folder.

    Jobs with the same run_dir=X write into X/0, X/1, ...; jobs without one into
    runs/TASK/ALGO/TIME_0, ..., which are created here, so that no other sweep uses them. One whose
    run_dir holds a checkpoint goes on from it; `resume` refuses other settings.
    """
    given = [config.run_dir for config in configs]
    for number, (overrides, config) in enumerate(zip(jobs, configs, strict=True)):
        mine = [text for text in overrides if not text.startswith("run_dir=")]
        if config.resume is not None:
            yield [*overrides], str(config.resume)
            continue
        if config.run_dir is None:
            folder = new_folder(configuration.resolve(config, overrides), f"_{number}")
        else:
            same = given.count(config.run_dir) > 1
            folder = Path(str(config.run_dir), str(number) if same else "")
        begun = any(checkpoint.steps(run / "checkpoints") for run in members(folder) or [folder])
        own = f"{'resume' if begun else 'run_dir'}={quoted(str(folder))}"
        yield [*mine, own], str(folder)


def _report(
    folder: Path,
    labels: Mapping[int, str],
    folders: Sequence[str],
    results: dict[int, Result],
) -> None:
    """Print the table of a sweep, and write it to jobs.json."""
    rows = []
    for number, run_dir in enumerate(folders):
        result = results.get(number, {"code": None, "line": "not run"})
        if result["code"] != 0:
            remove_empty(Path(run_dir))
        rows.append({"job": number, "overrides": labels[number], "run_dir": run_dir, **result})
    write_text(folder / "jobs.json", json.dumps(rows, indent=1) + "\n")
    cells = [("job", "overrides", "run folder", "result")]
    for row in rows:
        line = f"failed ({row['code']}): {row['line']}" if row["code"] else row["line"]
        cells.append((str(row["job"]), row["overrides"], row["run_dir"], line))
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    print()
    for row in cells:
        print("  ".join(f"{text:{w}}" for text, w in zip(row, widths, strict=True)).rstrip())
    failed = [str(row["job"]) for row in rows if row["code"] != 0]
    which = f"; not {', '.join(failed)}" if failed else ""
    print(f"{len(rows) - len(failed)} of {len(rows)} jobs done{which}", flush=True)


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
            if interrupt.cause() != signal.SIGHUP:  # jobs elsewhere need no terminal
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
    most = f"{cluster}_max_num_timeout"
    made = {most: given.pop(most)} if most in given else {}
    executor = submitit.AutoExecutor(given.pop("submitit_folder"), cluster=cluster, **made)
    executor.update_parameters(**given)
    return executor


def _wait(jobs: dict[int, Any], results: dict[int, Result], most: float = math.inf) -> None:
    """Wait for the end of all jobs, at most `most` [s], and print when each ends."""
    began = time.monotonic()
    while len(results.keys() & jobs.keys()) < len(jobs) and time.monotonic() - began < most:
        for number, job in jobs.items():
            if number not in results and job.done():
                try:
                    results[number] = job.results()[0].return_value
                except Exception as error:
                    line = f"lost: {str(error).strip().splitlines()[0]}"
                    line += f"; see {relative(job.paths.stderr)}"
                    results[number] = {"code": 1, "line": line}
                print(f"job {number} ends: {results[number]['line']}", flush=True)
        time.sleep(POLL)
