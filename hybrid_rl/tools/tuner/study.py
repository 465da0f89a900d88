"""A study: which values to try next, which runs to end early, and what all of them gave.

Optuna's tree-structured Parzen estimator proposes values (Bergstra et al. 2011, Algorithms for
Hyper-Parameter Optimization), its median rule prunes (Golovin et al. 2017, Google Vizier). All is
in study.db, from which a study goes on as if it had not stopped: the random numbers of a proposal
follow from the seed and the number of trials before it.
"""

import warnings
from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from hydra.core.override_parser.types import Override

from hybrid_rl import UsageError, part
from hybrid_rl.fields import Count, Natural
from hybrid_rl.files.atomic import refuse_link
from hybrid_rl.run.logs.records import Row
from hybrid_rl.run.session import RETURNS

if TYPE_CHECKING:
    from optuna.distributions import BaseDistribution
    from optuna.trial import FrozenTrial, Trial

FILE, RESULT = "study.db", "final_eval"
ANSWER = "line"  # attribute of the trials that have an answer
GOLDEN = 0.618  # no whole number is so far between two of them
DISTINCT = 2  # results, from which importances follow
SAFE = 2  # evaluations, before the last of which no run is pruned


@part
class Settings:
    """Keys of hydra.sweeper; conf/hydra/sweeper/tuned.yaml says what they are."""

    trials: Count
    seed: Natural
    startup: Count
    prune: Literal[True, False]
    metric: str


def distribution(override: Override) -> "BaseDistribution":
    """The values of a swept override: those that are listed are names, as they are typed.

    interval(1,4) has all numbers between, int(interval(1,4)) the whole ones.
    """
    from optuna import distributions

    if not override.is_interval_sweep():
        return distributions.CategoricalDistribution(
            [*dict.fromkeys(override.sweep_string_iterator())]
        )
    sweep: Any = override.value()
    kind: Any = distributions.FloatDistribution
    if isinstance(sweep.start, int) and isinstance(sweep.end, int):
        kind = distributions.IntDistribution
    try:
        return kind(sweep.start, sweep.end, log="log" in sweep.tags)
    except (ValueError, TypeError) as error:
        raise UsageError(f"{override.input_line}: {error}") from error


def ends(values: "BaseDistribution") -> list[Any]:
    """The listed values; or the least one, the greatest one, and of fractions one between."""
    given: Any = values
    if hasattr(given, "choices"):
        return list(given.choices)
    between = [] if isinstance(given.low, int) else [given.low + GOLDEN * (given.high - given.low)]
    return [given.low, *between, given.high]


class Watch:
    """Called with the rows of a run: reports each evaluation of all its seeds to the study.

    It returns False, which ends the run, where the study prunes the trial; not at the run's end.
    """

    def __init__(self, trial: "Trial", metric: str, seeds: int, steps: int) -> None:
        self._trial, self._metric, self._seeds, self._steps = trial, metric, seeds, steps
        self._values: dict[int, dict[int, Any]] = {}  # step -> seed -> value
        self.pruned = False
        self.misled = False  # the evaluations do not have the metric

    def __call__(self, row: Row) -> bool | None:
        """Take a row; False ends the run."""
        known = [name for name in RETURNS if name in row]
        if not known:
            return None
        name = known[0] if self._metric == RESULT else self._metric
        if name not in row:
            has = ", ".join(each for each in row if each.startswith("eval/"))
            self.misled = True
            raise UsageError(f"hydra.sweeper.metric={name}: the evaluations have {has}")
        step = int(row["step"])
        values = self._values.setdefault(step, {})
        values[int(row["seed"])] = row[name]
        if len(values) < self._seeds or None in values.values():
            return None
        self._trial.report(float(np.mean([*values.values()])), step)
        if step >= self._steps or not self._trial.should_prune():
            return None
        self.pruned = True
        return False


class Study:
    """The study in a folder; `ask` for a trial, `tell` what came of it."""

    def __init__(self, settings: Settings, study: Any, space: Mapping[str, Any]) -> None:
        from optuna.trial import TrialState

        self.settings, self._study, self._space, self._state = settings, study, space, TrialState
        for lost in study.get_trials(states=(TrialState.RUNNING,)):  # of a process that stopped
            study.tell(lost.number, state=TrialState.FAIL)
            seen = {str(step): value for step, value in lost.intermediate_values.items()}
            kept = {"run": run_of(lost), "seen": seen}
            study.enqueue_trial(lost.params, user_attrs=kept)

    @property
    def trials(self) -> "list[FrozenTrial]":
        """Those that have an answer."""
        every = self._study.get_trials(deepcopy=False)
        return [each for each in every if each.state.is_finished() and ANSWER in each.user_attrs]

    @property
    def open(self) -> bool:
        """Whether trials are left."""
        return len(self.trials) < self.settings.trials

    def ask(self) -> "Trial":
        """The next trial; one that was interrupted comes first, with its evaluations."""
        from optuna.samplers import TPESampler

        seed = np.random.SeedSequence([self.settings.seed, len(self.trials)]).generate_state(1)
        sampler = TPESampler(seed=int(seed[0]), n_startup_trials=self.settings.startup)
        self._study.sampler = sampler
        trial = self._study.ask(self._space)
        for step, value in trial.user_attrs.get("seen", {}).items():
            trial.report(value, int(step))
        trial.set_user_attr("run", run_of(trial))
        return trial

    def known(self, trial: "Trial") -> bool:
        """Whether a trial before had these values; then this one has its result and is not run."""
        states = self._state.COMPLETE, self._state.PRUNED
        for number, each in enumerate(self.trials):
            if each.state in states and each.params == trial.params:
                for step, value in each.intermediate_values.items():
                    trial.report(value, step)
                trial.set_user_attr("run", run_of(each))
                self._answer(trial, each.state, f"as trial {number}")
                return True
        return False

    def tell(self, trial: "Trial", code: int, line: str, pruned: bool) -> str:
        """Close a trial by the exit code and the last line of its run; returns its result.

        pruned: the study ended it.
        """
        seen = self._frozen(trial).intermediate_values
        if code:
            return self._answer(trial, self._state.FAIL, f"failed ({code}): {line}")
        if not seen:
            return self._answer(trial, self._state.FAIL, "failed: no evaluation of all seeds")
        step = max(seen)
        if pruned:
            line = f"pruned at {step:,} with {seen[step]:,.4g}"
            return self._answer(trial, self._state.PRUNED, line)
        return self._answer(trial, self._state.COMPLETE, f"{seen[step]:,.4g}")

    def _answer(self, trial: "Trial", state: Any, line: str) -> str:
        seen = self._frozen(trial).intermediate_values
        trial.set_user_attr(ANSWER, line)
        value = seen[max(seen)] if state == self._state.COMPLETE else None
        self._study.tell(trial.number, value, state=state)
        return line

    def _frozen(self, trial: "Trial") -> "FrozenTrial":
        return self._study.get_trials(deepcopy=False)[trial.number]

    def numbers(self) -> dict[str, Any]:
        """What trials.json holds: keys, trials, the best of them, and how much each key mattered.

        Importances are those of PED-ANOVA (Watanabe et al. 2023) over the finished trials; their
        sum is 1. There are none for fewer than two results.
        """
        trials = [_row(number, each) for number, each in enumerate(self.trials)]
        done = [row for row in trials if row["state"] == "complete"]
        return {
            "metric": self.settings.metric,
            "keys": {key: _kind(values) for key, values in self._space.items()},
            "trials": trials,
            "best": max(done, key=lambda row: row["result"])["trial"] if done else None,
            "importances": self._importances({row["result"] for row in done}),
        }

    def _importances(self, results: Collection[float]) -> dict[str, float]:
        from optuna.importance import PedAnovaImportanceEvaluator, get_param_importances

        if len(results) < DISTINCT:
            return {}
        with warnings.catch_warnings():  # of many that share the best result
            warnings.simplefilter("ignore", UserWarning)
            found = get_param_importances(self._study, evaluator=PedAnovaImportanceEvaluator())
        return {key: float(found.get(key, 0.0)) for key in self._space}


@contextmanager
def open_study(
    folder: Path, settings: Settings, space: Mapping[str, Any], typed: Iterable[str], every: int
) -> Iterator[Study]:
    """The study in `folder`, a new one if there is none.

    typed: the overrides of all trials; every: decisions between evaluations.
    """
    import optuna
    from sqlalchemy.exc import DatabaseError

    optuna.logging.set_verbosity(optuna.logging.ERROR)
    pruner: Any = optuna.pruners.NopPruner()
    if settings.prune:
        pruner = optuna.pruners.MedianPruner(settings.startup, n_warmup_steps=SAFE * every)
    for file in folder.glob(f"{FILE}*"):
        refuse_link(file)
    try:
        storage = optuna.storages.RDBStorage(f"sqlite:///{folder / FILE}")
    except (DatabaseError, RuntimeError) as error:
        raise UsageError(f"{folder / FILE}: is no study of Optuna {optuna.__version__}") from error
    try:
        study = optuna.create_study(
            storage=storage,
            study_name="study",
            direction="maximize",
            pruner=pruner,
            load_if_exists=True,
        )
        mine = sorted([*typed, f"metric={settings.metric}"])
        theirs = study.user_attrs.get("typed", mine)
        if theirs != mine:
            other = " ".join(text for text in theirs if text not in mine) or "fewer overrides"
            raise UsageError(f"{folder}: holds a study with {other}; choose another run_dir")
        study.set_user_attr("typed", mine)
        yield Study(settings, study, space)
    finally:
        storage.remove_session()
        storage.engine.dispose()


def run_of(trial: "FrozenTrial | Trial") -> int:
    """The number that names the folder of its run, which an earlier trial may have had."""
    run = trial.user_attrs.get("run")
    return run if isinstance(run, int) else trial.number


def text(value: Any) -> str:
    """A value as it is typed in an override."""
    return value if isinstance(value, str) else repr(value)


def short(values: Mapping[str, Any]) -> str:
    """Values as a reader has them."""
    return " ".join(
        f"{key}={value:.4g}" if isinstance(value, float) else f"{key}={value}"
        for key, value in values.items()
    )


def _kind(values: Any) -> str:
    """What the axis of a key is in a picture."""
    return "names" if hasattr(values, "choices") else "log" if values.log else "linear"


def _row(number: int, trial: "FrozenTrial") -> Row:
    """A trial in trials.json; those without an answer, which were interrupted, do not count."""
    seen = trial.intermediate_values
    return {
        "trial": number,
        "values": trial.params,
        "run": str(run_of(trial)),
        "state": trial.state.name.lower(),  # complete, pruned, fail
        "result": seen[max(seen)] if seen else None,  # of the last evaluation
        "step": max(seen) if seen else None,  # of it
        "line": trial.user_attrs[ANSWER],
    }
