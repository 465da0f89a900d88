"""Runs that differ in numbers alone, in one program: sweep.KEY=[A,B,C].

Several keys make every combination of their values. The folder of the sweep holds a run folder 0,
1, ... for each, which `evaluate`, `render`, `run=DIR` and figures take as they take any other, and
sweep.json: key -> the value in each of the runs. Its learners are those of all seeds.
"""

import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import partial
from itertools import product
from math import isfinite
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
from omegaconf import DictConfig, OmegaConf, open_dict

from hybrid_rl.envs.adapters.external import External
from hybrid_rl.errors import UsageError
from hybrid_rl.outside.loops import loop_of
from hybrid_rl.run import folder, inherited
from hybrid_rl.run.files.integrity import write_text
from hybrid_rl.run.folder import SWEEP
from hybrid_rl.run.logs.records import flatten_keys
from hybrid_rl.settings import build as configuration
from hybrid_rl.settings import words as overrides
from hybrid_rl.settings.build import Run
from hybrid_rl.settings.complete import LACKING, refusal, select, source
from hybrid_rl.settings.words import raw_values
from hybrid_rl.training.axis import Axis, DifferError
from hybrid_rl.training.loop import Loop
from hybrid_rl.training.rollout import act, advance, begin

Values = Mapping[str, float]  # key -> value


@dataclass(frozen=True)
class Member:
    """A run of a sweep: its resolved configuration, and what sets it apart."""

    config: DictConfig
    values: Values


def load(texts: Sequence[str] | DictConfig, config_dir: str | Path | None = None) -> list[Member]:
    """The runs of these overrides, or what is resolved; errors of `inherited`, `expand_sweep`."""
    if isinstance(texts, DictConfig):
        return [Member(texts, {})]
    refused = isinstance(texts, str | Mapping)
    words = texts if refused else inherited.add_recipe(texts, config_dir)
    return expand_sweep(configuration.compose_raw(words, config_dir), words)


def expand_sweep(config: DictConfig, texts: Sequence[str]) -> list[Member]:
    """A run for each combination of the values of the keys below `sweep`; one if there is none.

    config: composed from the overrides `texts`, with its interpolations.
    """
    texts, raw = [text for text in texts if not overrides.is_swept(text)], raw_values(config)
    lists, config = flatten_keys(raw.pop("sweep") or {}), config.copy()
    config.sweep = {}
    given = overrides.typed_values(texts)
    for key, values in lists.items():
        _check_values(config, raw, key, values)
        if key in given:
            raise UsageError(f"{key}={given[key]}: sweep.{key} gives its values; leave one out")
    if lists and config.get("distributed"):
        raise UsageError("distributed=true: trains no sweep; use -m, or one process")
    members = []
    for values in product(*lists.values()):
        chosen = dict(zip(lists, values, strict=True))
        typed = [f"{key}={value}" for key, value in chosen.items()]
        own = config.copy()
        for key, value in chosen.items():
            OmegaConf.update(own, source(raw, key), value)
        members.append(Member(configuration.resolve(own, [*texts, *typed]), chosen))
    if len(members) > 1 and config.get("resume") is not None:
        before = [*folder.members(Path(str(config.resume))).values()]
        if before != [each.values for each in members]:
            has = ", ".join(map(folder.words, before)) or "no sweep"
            raise UsageError(f"sweep: resume={config.resume} has {has}; leave sweep.KEY out")
    return members


def _check_values(config: DictConfig, raw: dict[str, Any], key: str, values: Any) -> None:
    """Raise UsageError for a key that does not exist, or for what is no list of numbers."""
    typed = f"sweep.{key}"
    if select(raw, key) is LACKING:
        raise UsageError(f"sweep.{refusal(key, [raw])}")
    each = values if isinstance(values, list) else []
    if not each or any(type(one) not in (int, float) or not isfinite(one) for one in each):
        raise UsageError(f"{typed}={values}: must be a list of numbers, such as [0.99,0.995]")
    if len(set(each)) < len(each):
        raise UsageError(f"{typed}={values}: has one of them twice")


def axis_of(members: Sequence[Member], runs: Sequence[Run]) -> Axis:
    """The numbers in which the runs of a sweep differ."""
    trees = [{"agent": run.agent, "controllers": run.controllers} for run in runs]
    try:
        axis = Axis.of(trees, tuple(folder.words(each.values) for each in members))
    except DifferError as error:
        raise _refused(members, error.path) from error
    for path in axis.numbers:
        if path.startswith("agent.episode."):
            raise _refused(members, path, "all learners have the same world")
    for key in members[0].values:
        rest = members[0].values.items() - {(key, members[0].values[key])}
        same = [tree for tree, m in zip(trees, members, strict=True) if rest <= m.values.items()]
        if len(same) > 1 and not Axis.of(same).numbers:
            raise _refused(members, key, "it is no number of a learner or a controller")
    if axis.numbers:
        _check_traced(axis, members, runs[0])
    return axis


def _check_traced(axis: Axis, members: Sequence[Member], run: Run) -> None:
    """Raise UsageError if a number decides what the program is; nothing is compiled."""

    def trace(axis: Axis) -> None:
        loop = loop_of(run.agent, run.seeds * axis.count, 1, axis=axis)
        state = loop.shapes()
        one = jax.tree.map(lambda leaf: jax.ShapeDtypeStruct(leaf.shape[1:], leaf.dtype), state)
        jax.eval_shape(loop.step, one, jnp.int32(0))
        for mode, controller in run.controllers.items():
            jax.eval_shape(partial(_episode, loop, controller, f"controllers.{mode}"), one)

    try:
        trace(axis)
    except UsageError:
        raise
    except Exception:  # whatever a part does with a number that is not known
        for path in axis.numbers:
            try:
                trace(axis.alone(path))
            except Exception as error:
                raise _refused(members, path) from error
        raise


def _episode(loop: Loop, controller: Any, path: str, state: Any) -> Any:
    """A decision of an evaluation."""
    episode, params = loop.agent.episode, loop.agent.params(state)
    controller = loop.axis.put(controller, path, state.numbers)
    carry = begin(episode, controller, state.key[None])
    if isinstance(episode.env, External):  # JAX does not step it
        return act(controller, params, carry[1], carry[0], carry[2])
    return advance(episode, controller, params, carry, jnp.int32(1))


def _refused(members: Sequence[Member], path: str, why: str = "") -> UsageError:
    """The error of a key whose values change what is at `path`."""
    keys = list(members[0].values)
    last = path.rpartition(".")[2]
    keys = [key for key in keys if key.rpartition(".")[2] == last] or keys
    listed = [",".join(map(str, dict.fromkeys(m.values[key] for m in members))) for key in keys]
    pairs = list(zip(keys, listed, strict=True))
    why = why or "they decide what is compiled"
    typed = ", ".join(f"sweep.{key}=[{values}]" for key, values in pairs)
    instead = " ".join(f"{key}={values}" for key, values in pairs)
    return UsageError(f"{typed}: one program cannot have several, as {why}; use -m {instead}")


@contextmanager
def claim_folders(members: Sequence[Member]) -> Iterator[list[Path]]:
    """Folders for the runs of a sweep, as `folder.claim_folder`, and sweep.json beside them."""
    config = members[0].config
    given = config.run_dir is not None
    parent = Path(str(config.run_dir)) if given else folder.new_folder(config)
    for name in (SWEEP, "config.yaml"):
        if (parent / name).exists():
            line = f"run_dir={parent}: holds a run already; choose another"
            raise UsageError(f"{line}, or resume={parent}" if name == SWEEP else line)
    new = not given or not parent.exists()
    try:
        with ExitStack() as stack:
            each = []
            for number, member in enumerate(members):
                with open_dict(member.config):
                    member.config.run_dir = str(parent / str(number))
                each.append(stack.enter_context(folder.claim_folder(member.config)))
            columns = {key: [one.values[key] for one in members] for key in members[0].values}
            write_text(parent / SWEEP, json.dumps(columns, indent=1) + "\n")
            yield each
    except BaseException:
        if not any((parent / str(number)).exists() for number in range(len(members))):
            (parent / SWEEP).unlink(missing_ok=True)
            if new and parent.exists() and not any(parent.iterdir()):
                parent.rmdir()
        raise


def summary(parent: Path, each: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """What the runs of a sweep are together; "runs": summary.json of each."""
    first, joined = each[0], ("seeds", "final_return", "final_eval", "diverged")
    same = ("task", "algo", "total_steps", "finished", "wall_s", "compile_s", "signal")
    lists = {key: [value for one in each for value in one[key]] for key in joined}
    return {key: first[key] for key in same} | lists | {"run_dir": str(parent), "runs": [*each]}
