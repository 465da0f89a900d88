"""The runs of one program: one, or those of a sweep in numbers alone, sweep.KEY=[A,B,C].

Several keys make every combination of their values. The folder of a sweep holds a run folder 0, 1,
... for each, which `evaluate`, `render`, `run=DIR` and figures take as they take any other, and
sweep.json: key -> the value in each of the runs. Its learners are those of all seeds.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product
from math import isfinite
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
from omegaconf import DictConfig, OmegaConf

from hybrid_rl.envs.adapters.external import External
from hybrid_rl.envs.adapters.robot import Outside, Robot
from hybrid_rl.errors import UsageError
from hybrid_rl.outside.host_loop import HostLoop
from hybrid_rl.outside.robot_loop import RobotLoop
from hybrid_rl.run import folder, start
from hybrid_rl.run.logs.records import flatten_keys
from hybrid_rl.settings import build as configuration
from hybrid_rl.settings import words as overrides
from hybrid_rl.settings.build import Run
from hybrid_rl.settings.complete import found, require
from hybrid_rl.settings.words import plain
from hybrid_rl.training.agent import Agent
from hybrid_rl.training.loop import Axis, DifferError, Loop


@dataclass(frozen=True)
class Member:
    """A run of a program: its resolved configuration, and what sets it apart from the others."""

    config: DictConfig
    values: Mapping[str, float] = field(default_factory=dict)  # key -> value


def load(texts: Sequence[str] | DictConfig, config_dir: str | Path | None = None) -> list[Member]:
    """The runs of overrides, or of a resolved configuration."""
    if isinstance(texts, DictConfig):
        return [Member(texts)]
    words = start.add_recipe(texts, config_dir)
    return expand_sweep(configuration.compose_raw(words, config_dir), words)


def expand_sweep(config: DictConfig, texts: Sequence[str]) -> list[Member]:
    """A run for each combination of the values of the keys below `sweep`; one if there is none.

    config: composed from the overrides `texts`, with its interpolations.
    """
    texts, raw = [text for text in texts if not overrides.is_swept(text)], plain(config)
    lists, config = flatten_keys(raw.pop("sweep") or {}), config.copy()
    config.sweep = {}
    for key, values in lists.items():
        require(raw, key, prefix="sweep.")
        numbers = values if isinstance(values, list) else []
        finite = all(type(x) in (int, float) and isfinite(x) for x in numbers)
        if not numbers or not finite or len({*numbers}) < len(numbers):
            line = "must be a list of different numbers, such as [0.99,0.995]"
            raise UsageError(f"sweep.{key}={values}: {line}")
    if any(len(lists.get(f"episode.{key}", ())) > 1 for key in ("delay", "jitter")):
        times = ("delay", "jitter", "lag", "longest")  # each in episodes ready for all
        each = [lists.get(f"episode.{key}", [config.episode[key]]) for key in times]
        most = [max(x if type(x) in (int, float) else 0 for x in values) for values in each]
        config.episode.longest = max(most[0] + most[1], *most[2:])
        texts.append(f"episode.longest={config.episode.longest}")
    members = []
    for values in product(*lists.values()):
        chosen = dict(zip(lists, values, strict=True))
        typed = [f"{key}={value}" for key, value in chosen.items()]
        own = config.copy()
        for key, value in chosen.items():
            OmegaConf.update(own, found(raw, key)[0], value)
        members.append(Member(configuration.resolve(own, [*texts, *typed]), chosen))
    return members


def axis_of(values: Sequence[Mapping[str, float]], runs: Sequence[Run]) -> Axis:
    """The numbers in which the runs of a program differ; values: key -> value, of each."""
    trees = [{"agent": run.agent, "controllers": run.controllers} for run in runs]
    try:
        axis = Axis.of(trees, tuple(map(folder.words, values)))
    except DifferError as error:
        raise _refused(values, str(error)) from error
    for key in values[0]:
        rest = values[0].items() - {(key, values[0][key])}
        same = [tree for tree, own in zip(trees, values, strict=True) if rest <= own.items()]
        if len(same) > 1 and not Axis.of(same).numbers:
            raise _refused(values, key, "it is no number of a learner or a controller")
    if axis.numbers:
        loop = loop_of(runs[0].agent, runs[0].seeds * axis.count, 1, axis=axis)
        try:
            one = jax.tree.map(lambda x: jax.ShapeDtypeStruct(x.shape[1:], x.dtype), loop.shapes())
            jax.eval_shape(loop.step, one, jnp.int32(0))  # nothing is compiled
        except jax.errors.JAXTypeError as error:
            raise _refused(values, "") from error
    return axis


def _refused(
    values: Sequence[Mapping[str, float]], path: str, why: str = "they decide what is compiled"
) -> UsageError:
    """The error of a key whose values change what is at `path`."""
    last = path.rpartition(".")[2]
    keys = [key for key in values[0] if key.rpartition(".")[2] == last] or [*values[0]]
    words = [
        f"{key}={','.join(map(str, dict.fromkeys(own[key] for own in values)))}" for key in keys
    ]
    line = f"one program cannot have several, as {why}; use -m {' '.join(words)}"
    return UsageError(f"sweep.{words[0]}: {line}")


def joined(folders: Sequence[Path], summaries: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """The summary of a run; of a sweep what its runs are together, and "runs", each of them."""
    if len(summaries) == 1:
        return summaries[0]
    lists = {
        key: [value for summary in summaries for value in summary[key]]
        for key in ("seeds", "final_return", "final_eval", "diverged")
    }
    same = ("task", "algo", "total_steps", "finished", "wall_s", "compile_s", "signal")
    kept = {key: summaries[0][key] for key in same}
    return kept | lists | {"run_dir": str(folders[0].parent), "runs": [*summaries]}


def loop_of(
    agent: Agent,
    seeds: tuple[int, ...],
    stride: int,
    folder: Path = Path(),
    axis: Axis | None = None,
) -> Loop:
    """The loop that trains an agent: on the device, on the host, or on a robot.

    folder: of the run, in which the files of a robot are. axis: of `Loop`.
    """
    env = agent.episode.env
    if isinstance(env, Robot):
        return RobotLoop(agent, seeds, stride, folder=folder / "robot")
    if isinstance(env, Outside):
        raise UsageError("task=online: is for a loop of yours; use hybrid_rl.OnlineLearner")
    kind = HostLoop if isinstance(env, External) else Loop
    return kind(agent, seeds, stride, axis=Axis() if axis is None else axis)
