"""A sweep that searches: trials one after another, each with values that the study asks for.

    python -m hybrid_rl.train -m hydra/sweeper=tuned task=pendulum algo=sac \
      'policy_learner.discount=choice(0.95,0.99)' 'policy_learner.tau=tag(log,interval(1e-3,1e-1))'

The ends of all ranges are checked before the first trial. The folder, run_dir if it is given, holds
study.db, the runs 0, 1, ..., trials.json and trials.png; the same command with it goes on.
"""

import sys
from collections.abc import Sequence
from importlib import import_module
from itertools import cycle, islice
from pathlib import Path
from typing import Any

from hydra.core.override_parser.types import Override
from omegaconf import DictConfig, OmegaConf

from hybrid_rl import UsageError, figures
from hybrid_rl.cli import sweep
from hybrid_rl.cli.combinations import jobs_of, labels
from hybrid_rl.errors import install
from hybrid_rl.fields import FieldError
from hybrid_rl.files.atomic import refuse_link
from hybrid_rl.run.checkpoints import checkpoint
from hybrid_rl.run.files.integrity import write_text
from hybrid_rl.run.files.lock import lock
from hybrid_rl.settings import words as overrides
from hybrid_rl.settings.groups import options
from hybrid_rl.tools.tuner import study, tuning

INSTALL = f"hydra/sweeper=tuned: Optuna is not installed; {install('tune')}"
HINT = "write KEY=choice(A,B), KEY=interval(0.1,0.5), or KEY=tag(log,interval(1e-4,1e-2))"


class Tuner(sweep.Sweeper):
    """Asks a study for values, trains, and tells it the evaluations.

    settings: keys of hydra.sweeper.
    """

    def __init__(self, settings: dict[str, Any], params: Any) -> None:
        super().__init__(None, params)
        self._given = settings
        self._trial: Any = None  # that runs
        self._watched: study.Watch | None = None  # its rows

    def setup(self, *, hydra_context: Any, task_function: Any, config: DictConfig) -> None:
        """Get from Hydra what to run."""

        def watched(job: DictConfig) -> Any:
            return task_function(job, self._watch(job))

        super().setup(hydra_context=hydra_context, task_function=watched, config=config)
        self.task.called = "trial"

    def sweep(self, arguments: list[str]) -> Any:
        """Run all trials; end the process with the highest exit code of those that failed."""
        arguments = overrides.typed(arguments)
        settings = self._settings()
        parsed = self._parsed(arguments)
        fixed, space = self._split(parsed)
        corners = _corners(fixed, space)
        self.task.labels = labels(corners)
        configs = self._read(corners)
        self._check(corners, configs)
        config = configs[0]
        if not [mode for mode in config.eval_modes if mode in config.controllers]:
            raise UsageError("eval_modes=[]: a study needs evaluations")
        folder = Path(str(config.run_dir or self.config.hydra.sweep.dir))
        fixed = [each for each in fixed if not each.startswith("run_dir=")]
        kept = [each for each in arguments if not each.startswith("run_dir=")]
        self.config.hydra.sweep.dir = str(folder)
        with (
            lock(folder, "run_dir"),
            study.open_study(folder, settings, space, kept, config.eval_every) as opened,
        ):
            write_text(folder / "multirun.yaml", OmegaConf.to_yaml(self.config))
            print(f"study of {settings.trials} trials: {folder}", flush=True)
            try:
                while opened.open:
                    self._run(opened, folder, fixed)
            finally:
                self._report(opened, folder)
        if worst := max((each["code"] for each in self.task.results.values()), default=0):
            sys.exit(worst)

    def _settings(self) -> study.Settings:
        if not sweep.here(self.config.hydra):
            line = "hydra/sweeper=tuned: its trials run in this process"
            raise UsageError(f"{line}; leave hydra/launcher out")
        try:
            import_module("optuna")
        except ImportError as error:
            raise UsageError(INSTALL) from error
        try:
            settings = study.Settings(**self._given)
        except FieldError as error:
            raise UsageError(str(error.at("hydra.sweeper"))) from error
        metric = settings.metric
        if metric != study.RESULT and not str(metric).startswith("eval/"):
            line = f"hydra.sweeper.metric={metric}: must be {study.RESULT} or begin with eval/"
            raise UsageError(line)
        return settings

    def _split(self, parsed: Sequence[Override]) -> tuple[list[str], dict[str, Any]]:
        """The overrides that all trials have, and the values of the others by key."""
        space = {}
        for each in parsed:
            if overrides.is_swept(each.key_or_group):
                raise UsageError(f"{each.input_line}: not in a study, which chooses values itself")
            if each.key_or_group == "resume":
                raise UsageError(f"{each.input_line}: not in a study, which goes on by run_dir=DIR")
            if each.is_sweep_override() and each.key_or_group == "run_dir":
                raise UsageError(f"{each.input_line}: a study has one folder")
            if each.is_interval_sweep() and (names := options(each.key_or_group)):
                line = f"{each.input_line}: has names, such as {each.key_or_group}="
                raise UsageError(f"{line}choice({','.join(names[:2])})")
            if each.is_sweep_override():
                space[each.get_key_element()] = study.distribution(each)
        if not space:
            raise UsageError(f"hydra/sweeper=tuned: no key has several values; {HINT}")
        (fixed,) = jobs_of([each for each in parsed if not each.is_sweep_override()])
        return fixed, space

    def _watch(self, job: DictConfig) -> study.Watch:
        """What gets the rows of the trial that runs, whose configuration is `job`."""
        metric, seeds, steps = self._given["metric"], job.num_seeds, job.total_steps
        self._watched = study.Watch(self._trial, metric, seeds, steps)
        return self._watched

    def _run(self, opened: study.Study, folder: Path, fixed: list[str]) -> None:
        """Run the next trial."""
        trial = self._trial = opened.ask()
        if opened.known(trial):
            return
        number, run_dir = len(opened.trials), refuse_link(folder / str(study.run_of(trial)))
        values = [f"{key}={study.text(value)}" for key, value in trial.params.items()]
        if checkpoint.steps(run_dir / "checkpoints"):
            values.append(f"resume={overrides.quoted(str(run_dir))}")
        elif run_dir.exists():
            run_dir = folder / str(trial.number)
            trial.set_user_attr("run", trial.number)
        values.append(f"run_dir={overrides.quoted(str(run_dir))}")
        self.task.labels[number] = study.short(trial.params)
        self.launcher.launch([self._forced([*fixed, *values])], number)
        result, watched = self.task.results[number], self._watched
        if watched is not None and watched.misled:
            sys.exit(2)
        pruned = watched is not None and watched.pruned
        line = opened.tell(trial, result["code"], result["line"], pruned)
        print(f"trial {number}: {line}", flush=True)

    def _report(self, opened: study.Study, folder: Path) -> None:
        """Print the table, write trials.json and trials.png."""
        numbers = opened.numbers()
        rows = numbers["trials"]
        cells = [("trial", "values", "run folder", "result")]
        for row in rows:
            where = str(folder / row["run"])
            cells.append((str(row["trial"]), study.short(row["values"]), where, row["line"]))
        sweep.show(cells)
        states = [row["state"] for row in rows]
        counts = f"{states.count('complete')} done, {states.count('pruned')} pruned"
        print(f"{len(rows)} of {opened.settings.trials} trials: {counts}", flush=True)
        for row in rows:
            if row["trial"] == numbers["best"]:
                print(f"best, trial {row['trial']}: {study.short(row['values'])} {row['line']}")
        if opened.open:
            print(f"continue: the same command with run_dir={folder}", flush=True)
        if rows:
            figures.save(tuning.draw(numbers), numbers, folder / "trials.png")
            print(f"{folder / 'trials.png'} and trials.json", flush=True)


def _corners(fixed: Sequence[str], space: dict[str, Any]) -> list[list[str]]:
    """Overrides of a few jobs that have every listed value and both ends of every range."""
    values = {key: study.ends(each) for key, each in space.items()}
    most = max(map(len, values.values()))
    columns = [
        [f"{key}={study.text(value)}" for value in islice(cycle(each), most)]
        for key, each in values.items()
    ]
    return [[*fixed, *job] for job in zip(*columns, strict=True)]
