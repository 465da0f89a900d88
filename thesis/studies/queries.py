"""Clones that choose the states at which their teacher labels them: figure 4-2.

    share = score of the clone / score of the teacher, over the same first states

The score is the share of successes where the task has it, else the return. N demonstrations are
N times `dagger_learner.first` decisions after the first one, which the teacher drives; each has a
label. The printed schedule makes `steps` Adam steps a decision; a refit starts again from random
weights, with many steps on the same labels.
"""

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.analysis.curves import curves, improvement
from hybrid_rl.analysis.results import RunFolder, find
from hybrid_rl.errors import UsageError
from hybrid_rl.protocols import Controller
from hybrid_rl.run.folder import parse_config
from hybrid_rl.run.saved import build_run, restore
from hybrid_rl.settings.build import Run
from hybrid_rl.thesis.studies.numbers import band_of, banded
from hybrid_rl.thesis.studies.recorded import labels
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.rollout import evaluate_episodes, evaluation_keys
from hybrid_rl.types import Params

REACHED = 0.9  # of the teacher's score
TARGETS = {  # class of the target -> name
    "PolicyDisagreement": "disagreement",
    "PolicyResidual": "residual",
}
METRICS = ("eval/policy_success", "eval/policy_return")


class Row(NamedTuple):
    """One method: S seeds, G numbers of demonstrations."""

    label: str
    folder: Path
    config: Any
    N: np.ndarray  # [G]
    each: np.ndarray  # [S, G] score


def queries(pattern: str, refit: int, at: Sequence[int]) -> dict[str, Any]:
    """Shares over demonstrations, as trained and after a refit of `refit` steps at N in `at`."""
    folders = find(pattern)
    configs = [_config(folder) for folder in folders]
    tasks = sorted({config.task for config in configs})
    if len(tasks) > 1:
        raise UsageError(f"runs={pattern}: has runs of {' and '.join(tasks)}; give one")
    names = _names(folders, configs)
    metric = _metric(folders)
    rows = [_row(*each, metric) for each in zip(names, folders, configs, strict=True)]
    rows.sort(key=lambda row: row.label)
    name = metric.rpartition("_")[2]
    teacher = taught(rows[0].config, name)
    if not teacher > 0:
        raise UsageError(
            f"runs={pattern}: shares need a positive score; the teacher's is {teacher}"
        )
    numbers = {row.label: _printed(row, teacher) for row in rows}
    for row in rows if refit else ():
        shares = refitted(row, refit, at, name) / teacher
        numbers[row.label]["refit"] = _reported(np.array(at), shares)
    first = int(rows[0].config.learners.policy.first)
    made = {
        "task": tasks[0],
        "score": name,
        "teacher": teacher,
        "decisions_of_a_demonstration": first,
        "refit_steps": refit,
        "methods": numbers,
        "comparisons": compared(numbers),
    }
    return made


def _config(folder: Path) -> Any:
    """The configuration of a run whose clone asks a teacher."""
    config: Any = parse_config(folder)
    learner = config.learners.get("policy")
    if learner is None or "teacher" not in learner or not learner.first:
        raise UsageError(
            f"runs={folder}: needs algo=dagger or its kin, with dagger_learner.first above 0"
        )
    return config


def _names(folders: list[Path], configs: list[Any]) -> list[str]:
    """The name of each method; that of studies.recorded where two are equal."""
    names = [name_of(config) for config in configs]
    others = labels(folders)
    return [a if names.count(a) == 1 else f"{a}, {b}" for a, b in zip(names, others, strict=True)]


def name_of(config: Any) -> str:
    """The usual name of the rule by which a run chooses its queries."""
    learner, stages = config.learners.policy, config.controllers.full
    if stages.get("decisions", [0])[0] >= config.total_steps:
        return "behaviour cloning"
    if learner.oracle:
        return "oracle"
    if learner.target is None:
        return "RQ-DAgger" if learner.spread > 0 else "DAgger"
    if "criterion" in learner.target:
        return f"DAIL, {learner.target.criterion}"
    kind = learner.target._target_.rpartition(".")[2]
    return TARGETS.get(kind, kind)


def _metric(folders: list[Path]) -> str:
    """The metric that all runs have."""
    for metric in METRICS:
        if all(any(metric in row for row in RunFolder(path).rows) for path in folders):
            return metric
    raise UsageError(f"runs={folders[0]}: train with eval_modes=[policy]")


def _row(label: str, folder: Path, config: Any, metric: str) -> Row:
    """The scores of a run."""
    curve = curves([folder], metric)[0]
    first = config.learners.policy.first
    return Row(label, folder, config, curve.x / first - 1, curve.each)


@partial(jax.jit, static_argnums=(0, 1))
def _evaluated(episode: Episode, controller: Controller, params: Any, keys: Any) -> Any:
    """The scores [..., S, M] of policies with parameters [..., S, ...], for keys [S, M]."""

    def one(policy: Any, keys: Any) -> Any:
        return evaluate_episodes(episode, controller, Params(policy=policy), keys)

    return jax.vmap(jax.vmap(one), in_axes=(0, None))(params, keys)


def _keys(run: Run) -> Any:
    episodes = run.config.eval_episodes
    return jnp.stack([evaluation_keys(seed, episodes) for seed in run.seeds])


def taught(config: Any, score: str) -> float:
    """The mean score of the teacher over the episodes of an evaluation of all seeds."""
    run = build_run(config)
    learner: Any = run.agent.learners["policy"]
    teacher, episode = learner.teacher.greedy(), run.agent.episode

    @jax.jit
    def scores(keys: Any) -> Any:
        return evaluate_episodes(episode, teacher, Params(), keys)[score]

    return float(scores(_keys(run).reshape(-1)).mean())


def refitted(row: Row, steps: int, at: Sequence[int], score: str) -> np.ndarray:
    """[S, G] scores of clones that learn `steps` steps on the labels of the first N demonstrations.

    Raises:
        UsageError: if the run has fewer.
    """
    run, first = build_run(row.config), int(row.config.learners.policy.first)
    learner: Any = run.agent.learners["policy"]
    state = restore(row.folder, run)[1].learners["policy"]
    counts = first * (np.array(at) + 1)
    least = min(int(np.asarray(state.labels.count).min()), learner.capacity)
    if counts.max() > least:
        raise UsageError(f"at={','.join(map(str, at))}: {row.folder} has {least} labels")

    def fitted(state: Any, count: Any, seed: Any) -> Any:
        beginning, learning = jax.random.split(jax.random.key(seed))
        fresh = learner.init(beginning, run.agent.spec)
        policy = {**state.policy, "weights": fresh.policy["weights"]}
        known = state.labels.replace(count=count)
        state = state.replace(policy=policy, optimiser=fresh.optimiser, labels=known)
        return learner.fit(state, steps, learning).policy

    each = jax.vmap(fitted, in_axes=(0, None, 0))
    policies = jax.jit(jax.vmap(each, in_axes=(None, 0, None)))(
        state, jnp.asarray(counts), jnp.asarray(run.seeds)
    )
    scores = _evaluated(run.agent.episode, run.controllers["policy"], policies, _keys(run))
    return np.asarray(scores[score].mean(-1)).T


def _reported(N: np.ndarray, each: np.ndarray) -> dict[str, Any]:
    """Shares [S, G] at N [G]: interquartile means, bands, and the first N that reaches 90%."""
    shares = band_of(each)
    reached = N[shares["iqm"] >= REACHED]
    return {
        "N": N,
        "each": each,
        **shares,
        "reaches": float(reached[0]) if len(reached) else None,
        "over_90": (each >= REACHED).mean(0),
    }


def _printed(row: Row, teacher: float) -> dict[str, Any]:
    """The numbers of one method on the printed schedule; `area` is the mean over N above 0."""
    each = row.each / teacher
    area = each[:, row.N > 0.5].mean(1)
    return {
        **_reported(row.N, each),
        "area_each": area,
        "area": list(map(float, banded(area))),
        "seeds": len(each),
    }


def compared(methods: dict[str, Any]) -> dict[str, Any]:
    """Method -> P(its area exceeds that of RQ-DAgger), and the same for its last refit."""
    if "RQ-DAgger" not in methods:
        return {}
    base, result = methods["RQ-DAgger"], {}
    for label, one in methods.items():
        if label == "RQ-DAgger":
            continue
        chances = {}
        if len(one["N"]) == len(base["N"]):
            chances["area"] = improvement(one["area_each"], base["area_each"])
        if "refit" in one and "refit" in base:
            last = [each["refit"]["each"][:, -1] for each in (one, base)]
            chances["refit"] = improvement(*last)
        if chances:
            result[label] = chances
    return result
