"""A sweep: all jobs are checked before the first one runs, all run, and a table is printed.

Hydra's basic sweeper ends a sweep at the first job that fails, and prints nothing of jobs that run
in other processes. Here a failed job is a result like any other; the exit code of the command is
the highest one of its jobs. `jobs.json` in the sweep's folder holds what the table shows.
"""

import json
import sys
import traceback
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from hydra.core.hydra_config import HydraConfig
from hydra.core.override_parser.overrides_parser import OverridesParser
from hydra.core.override_parser.types import Override
from hydra.core.plugins import Plugins
from hydra.errors import HydraException
from omegaconf import DictConfig, OmegaConf
from omegaconf.errors import OmegaConfBaseException

from hybrid_rl.cli import command
from hybrid_rl.cli.combinations import jobs_of, labels
from hybrid_rl.cli.submitted import Result, launch, require_slurm
from hybrid_rl.errors import UsageError
from hybrid_rl.run import members as program
from hybrid_rl.run.checkpoints import checkpoint
from hybrid_rl.run.files.integrity import write_text
from hybrid_rl.run.folder import members, new_folder
from hybrid_rl.run.machine.jax_settings import prepare
from hybrid_rl.run.start import build_new_run
from hybrid_rl.settings import build as configuration
from hybrid_rl.settings import words
from hybrid_rl.settings.complete import refusal
from hybrid_rl.settings.compose import explain
from hybrid_rl.settings.values import check
from hybrid_rl.settings.words import forced, parse, quoted, raw_values, typed

WHOLE = ("task", "algo", "settings", "experiment", "learning")  # choices that are no parts
ACCELERATED = ("auto", "mjx", "warp")  # physics that may need a GPU to build a world


class Task:
    """A job of a sweep as Hydra calls it; its errors become its result."""

    def __init__(self, job: Callable[[DictConfig], Any], called: str = "job") -> None:
        self.job, self.called = job, called
        self.results: dict[int, Result] = {}  # number of a job -> its result
        self.labels: dict[int, str] = {}  # the overrides in which the jobs differ

    def __call__(self, config: DictConfig) -> Result:
        """Run one job."""
        hydra = HydraConfig.get()
        number = int(hydra.job.num)
        name = f"{self.called} {number}"
        print(f"{name}: {self.labels[number]}", flush=True)
        result: Result = {"code": 0, "line": "done"}
        self.results[number] = result
        try:
            result |= _outcome(self.job(config))
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


def _outcome(summary: Any) -> Result:
    """The result of a finished run in the table."""
    if not isinstance(summary, dict):
        return {}
    for name, called in (("final_eval", "evaluation"), ("final_return", "training return")):
        known = [value for value in summary.get(name) or () if value is not None]
        if known:
            over = f" (mean of {len(known)} seeds)" if len(known) > 1 else ""
            return {"line": f"{called} {sum(known) / len(known):,.1f}{over}"}
    return {}


class Sweeper:
    """Checks, runs and reports every combination of the given values."""

    def __init__(self, max_batch_size: int | None = None, params: Any = None) -> None:
        self.max_batch_size, self.params = max_batch_size, params or {}

    def setup(self, *, hydra_context: Any, task_function: Any, config: DictConfig) -> None:
        """Get from Hydra what to run, and by which launcher."""
        self.task = Task(task_function)
        self.hydra_context, self.config = hydra_context, config
        self.launcher = Plugins.instance().instantiate_launcher(hydra_context, self.task, config)

    def sweep(self, arguments: list[str]) -> Any:
        """Run all jobs; end the process with the highest exit code if one failed."""
        arguments = typed(arguments)
        require_slurm(str(self.config.hydra.runtime.choices["hydra/launcher"]))
        jobs = jobs_of(self._parsed(arguments))
        self.task.labels = labels(jobs)
        fit, notes = self._fitting(jobs)
        jobs, configs = [*fit], [*fit.values()]
        self.task.labels = labels(jobs)
        self._check(jobs, configs)
        print(*notes, sep="", end="", flush=True)
        folder = Path(str(self.config.hydra.sweep.dir))
        folder.mkdir(parents=True, exist_ok=True)
        jobs = _folders(jobs, configs)
        write_text(folder / "multirun.yaml", OmegaConf.to_yaml(self.config))
        print(f"sweep of {len(jobs)} jobs: {folder}", flush=True)
        results, size = self.task.results, self.max_batch_size or len(jobs)
        try:
            for first in range(0, len(jobs), size):
                some = [self._forced(job) for job in jobs[first : first + size]]
                if here(self.config.hydra):
                    self.launcher.launch(some, first)
                else:
                    launch(self.launcher, some, first, results)
        finally:
            _report(folder, self.task.labels, jobs, results)
        worst = max(result["code"] for result in results.values())
        if worst:
            sys.exit(worst)

    def _parsed(self, arguments: Sequence[str]) -> list[Override]:
        """The overrides of the command line and of hydra.sweeper.params."""
        parser = OverridesParser.create(config_loader=self.hydra_context.config_loader)
        return parser.parse_overrides([*(f"{k}={v}" for k, v in self.params.items()), *arguments])

    def _fitting(
        self, jobs: Sequence[Sequence[str]]
    ) -> tuple[dict[tuple[str, ...], DictConfig], list[str]]:
        """The jobs without overrides of what only other jobs have, and lines about these.

        Jobs that are the same then are one. With each what its run reads.
        """
        lost: dict[str, UsageError] = {}  # override -> why some job cannot have it
        unread: dict[str, list[tuple[str, Any]]] = {}  # override -> keys and values of such jobs
        fit = {}
        for number, job in enumerate(jobs):
            try:
                config = self._composed(number, job)
            except UsageError:
                absent = self._absent(number, job)
                if not absent:
                    raise
                job, lost = [text for text in job if text not in absent], {**absent, **lost}
                config = self._composed(number, job)
            config, keys = configuration.read(config)
            for path, text in keys.items():
                unread.setdefault(text, []).append((path, raw_values(config)))
            fit[tuple(text for text in job if text not in keys.values())] = config
        notes = []
        for text in (*lost, *unread):
            those = [str(number) for number, job in enumerate(fit) if text in job]
            if not those and text in lost:
                raise lost[text]
            if not those:
                raise UsageError(refusal(unread[text][0][0], [raw for _, raw in unread[text]]))
            notes.append(f"{text}: for job {', '.join(those)} alone; the others have no such key\n")
        return fit, notes

    def _absent(self, number: int, job: Sequence[str]) -> dict[str, UsageError]:
        """The choices of parts that the method of a job does not have, with their errors."""
        forced = self._forced(job)
        choices = [text for text, own in zip(job, forced, strict=True) if text == own]
        choices = [text for text in choices if words.name(text) not in WHOLE]
        kept, absent = [text for text in job if text not in choices], {}
        for text in choices:
            try:
                self._composed(number, [*kept, text])
                kept.append(text)
            except UsageError as error:
                absent[text] = error
        return absent

    def _forced(self, job: Sequence[str]) -> list[str]:
        """The overrides of a job as Hydra takes them."""
        loader = self.hydra_context.config_loader
        names = {words.name(text).partition("@")[0] for text in job}
        return forced(job, {each for each in names if loader.get_group_options(each)})

    def _composed(self, number: int, overrides: Sequence[str]) -> DictConfig:
        """The configuration of a job, with Hydra's own; UsageError if there is none."""
        loader = self.hydra_context.config_loader
        try:
            return loader.load_sweep_config(self.config, self._forced(overrides))
        except HydraException as error:
            raise UsageError(f"{explain(error)} ({self._called(number)})") from error

    def _read(self, jobs: Sequence[Sequence[str]]) -> Sequence[DictConfig]:
        """What the runs of the jobs read, of which none is without a part of the others."""
        return configuration.read_only([self._composed(*job) for job in enumerate(jobs)])

    def _check(self, jobs: Sequence[Sequence[str]], configs: Sequence[DictConfig]) -> None:
        """All checks that need no compilation.

        Jobs that run elsewhere are built with the physics that needs no GPU here.
        """
        for number, (overrides, config) in enumerate(zip(jobs, configs, strict=True)):
            if not here(self.config.hydra) and config.physics in ACCELERATED:
                config = config.copy()
                config.physics = "native"
            try:
                _check(program.expand_sweep(config, overrides))
            except (UsageError, OmegaConfBaseException) as error:
                line = error if isinstance(error, UsageError) else explain(error)
                raise UsageError(f"{line} ({self._called(number)})") from error

    def _called(self, number: int) -> str:
        """What messages call a job."""
        return f"{self.task.called} {number}: {self.task.labels[number]}".removesuffix(": ")


def _check(members: Sequence[program.Member]) -> None:
    """Raise UsageError if a job cannot run, alone or with those that share its program."""
    runs = []
    for each in members:
        if each.config.resume is None:
            check(each.config)
            prepare(each.config)  # first: a check of the user's world initialises JAX
            runs.append(build_new_run(each.config)[0])
    if len(runs) > 1:
        program.axis_of([member.values for member in members], runs)


def _folders(jobs: Sequence[Sequence[str]], configs: Sequence[DictConfig]) -> list[list[str]]:
    """The overrides of each job, with a run folder of its own.

    Jobs with the same run_dir=X write into X/0, X/1, ...; jobs without one into
    runs/TASK/ALGO/TIME_0, ..., which are created here, so that no other sweep uses them. One whose
    run_dir holds a checkpoint goes on from it; `resume` refuses other settings.
    """
    given = [config.run_dir for config in configs]
    complete = []
    for number, (overrides, config) in enumerate(zip(jobs, configs, strict=True)):
        mine = [text for text in overrides if not text.startswith("run_dir=")]
        if config.resume is not None:
            complete.append(list(overrides))
            continue
        if config.run_dir is None:
            folder = new_folder(configuration.resolve(config, overrides), f"_{number}")
        else:
            same = given.count(config.run_dir) > 1
            folder = Path(str(config.run_dir), str(number) if same else "")
        begun = any(checkpoint.steps(run / "checkpoints") for run in members(folder) or [folder])
        complete.append([*mine, f"{'resume' if begun else 'run_dir'}={quoted(str(folder))}"])
    return complete


def _report(
    folder: Path,
    labels: Mapping[int, str],
    jobs: Sequence[Sequence[str]],
    results: dict[int, Result],
) -> None:
    """Print the table of a sweep, and write it to jobs.json."""
    rows = []
    for number, overrides in enumerate(jobs):
        given = [text for text in overrides if text.startswith(("run_dir=", "resume="))]
        run_dir = "".join(str(each.value()) for each in parse(given[:1]))
        result = results.get(number, {"code": None, "line": "not run"})
        if result["code"] != 0 and run_dir:
            with suppress(OSError):  # it holds something, or is not there
                Path(run_dir).rmdir()
        rows.append({"job": number, "overrides": labels[number], "run_dir": run_dir, **result})
    write_text(folder / "jobs.json", json.dumps(rows, indent=1) + "\n")
    cells = [("job", "overrides", "run folder", "result")]
    for row in rows:
        line = f"failed ({row['code']}): {row['line']}" if row["code"] else row["line"]
        cells.append((str(row["job"]), row["overrides"], row["run_dir"], line))
    show(cells)
    failed = [str(row["job"]) for row in rows if row["code"] != 0]
    which = f"; not {', '.join(failed)}" if failed else ""
    print(f"{len(rows) - len(failed)} of {len(rows)} jobs done{which}", flush=True)


def show(cells: Sequence[Sequence[str]]) -> None:
    """Print the rows of a table below an empty line, in columns."""
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    print()
    for row in cells:
        columns = [f"{text:{width}}" for text, width in zip(row, widths, strict=True)]
        print("  ".join(columns).rstrip())
