"""An expert's decisions, or a trained policy, as a file to learn from.

    python -m hybrid_rl.demonstrate task=panda_stack episodes=20
    python -m hybrid_rl.demonstrate task=quadcopter_se3 expert=babble env.twist=2
    python -m hybrid_rl.demonstrate run=DIR mode=policy out=demonstrations/ant.npz
    python -m hybrid_rl.demonstrate run=DIR policy=policies/mine.npz

The file is demonstrations/T.npz by default. The expert is the task's scripted one, or another of
conf/expert, such as babble (random actions); in the task with its defaults or with env.KEY=VALUE,
episode.KEY=VALUE, expert.KEY=VALUE. With run=DIR it is the trained controller (mode: full, policy
or planner; the first seed), without exploration. Episode i starts from key i of `seed`.

With policy=FILE it writes no episodes but the parameters of the run's policy (learner: its seed, or
else the first), which expert=trained, policy=trained and policy=started read, and `evaluate`,
`render` and `export` with policy=FILE. It holds command=TEXT and what `evaluate run=DIR
mode=policy` wrote.
"""

if __name__ == "__main__":
    from hybrid_rl.cli import interrupt

    interrupt.install()

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import jax
import numpy as np
from omegaconf import OmegaConf

from hybrid_rl.analysis.results import RunFolder
from hybrid_rl.cli import command
from hybrid_rl.cli.arguments import CONFIG_DIR, MODE, Argument, flag, output, read, whole
from hybrid_rl.controllers.policy import PolicyController
from hybrid_rl.core.lifting import is_identity
from hybrid_rl.data.demonstrations import save
from hybrid_rl.data.trained import save as save_policy
from hybrid_rl.envs.adapters.unstepped import Unstepped
from hybrid_rl.errors import UsageError
from hybrid_rl.protocols import Controller
from hybrid_rl.run.files.reading import json_file
from hybrid_rl.run.machine.jax_settings import prepare
from hybrid_rl.run.saved import OBJECTIVES, Trained, load
from hybrid_rl.settings import build as configuration
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.rollout import rollout_with_actions
from hybrid_rl.types import Params, Transition

ARGUMENTS = (
    Argument("task", "", "a task with a scripted expert"),
    Argument("expert", "", "with task=T: another of conf/expert, such as babble"),
    CONFIG_DIR,
    Argument("run", "", "instead: folder of a trained run"),
    Argument("mode", "full", "of run=DIR: full, policy or planner", MODE),
    Argument("policy", "", "with run=DIR: the file for its policy's parameters"),
    Argument("models", False, "with policy=FILE: also model, reward, critic, to plan with", flag),
    Argument("learner", None, "with policy=FILE: its seed; empty: the first", whole(least=0)),
    Argument("command", "", "with policy=FILE: how it was trained, kept in the file"),
    Argument("episodes", 10, "how many", whole()),
    Argument("seed", 0, "of the first states", whole(least=0)),
    Argument("out", "", "the file; empty: demonstrations/TASK.npz"),
)
GROUPS = {name: f"with task=T: a key of its {name}" for name in ("env", "episode", "expert")}


@dataclass(frozen=True)
class Recording:
    """The decisions of an expert: N decisions, of M episodes."""

    decisions: Transition  # [N, ...]
    episode: np.ndarray  # [N] 0, 0, ..., M - 1
    returns: np.ndarray  # [M]
    success: np.ndarray | None  # [M] 1 if it succeeded at the end; None: the task has no measure


def record(
    episode: Episode, controller: Controller, params: Params, episodes: int, seed: int = 0
) -> Recording:
    """`episodes` episodes of a controller with `params`, whose rewards no violation reduces."""
    episode = replace(episode, constraint=None)
    keys = jax.random.split(jax.random.key(seed), episodes)
    one = partial(rollout_with_actions, episode, controller, params, steps=episode.steps)
    actions, states = jax.tree.map(np.asarray, jax.jit(jax.vmap(one))(keys))
    before, after = (jax.tree.map(lambda a, s=s: a[:, s], states) for s in np.s_[:-1, 1:])
    flags = after.reward, after.terminated, after.truncated
    rows = Transition(before.obs, actions, *flags, after.obs)
    lived = ~before.done  # [M, T]
    success = states.metrics.get("success")
    return Recording(
        Transition(*(row[lived] for row in rows)),
        np.nonzero(lived)[0],
        states.clock.total[:, -1],
        None if success is None else success[:, -1],
    )


def scripted_expert(
    given: Mapping[str, Any], changes: Mapping[str, str]
) -> tuple[Episode, Controller, Params]:
    """A task, as `changes` make it, and its scripted expert, which has no parameters.

    given: task, expert and config_dir, of the command line.
    """
    named = {key: given[key] for key in ("task", "expert") if given[key]}
    values = [f"{key}={value}" for key, value in {**named, **changes}.items()]
    config = configuration.load(["algo=sac", *values], given["config_dir"] or None)
    prepare(config)
    expert = configuration.expert(config)
    return configuration.build(config).agent.episode, expert, Params()


def _expert(
    given: dict[str, Any], changes: dict[str, str]
) -> tuple[str, Episode, Controller, Params]:
    """(task, episode, controller, parameters) that the arguments name."""
    _check(given, changes)
    if given["task"]:
        return given["task"], *scripted_expert(given, changes)
    run = load(Path(given["run"]))
    if isinstance(run.episode.env, Unstepped):
        raise UsageError(f"run={given['run']}: its world steps outside JAX, where none is recorded")
    return run.task, run.episode, *run.learner(mode=given["mode"], world=True)


def _check(given: dict[str, Any], changes: dict[str, str]) -> None:
    """Raise UsageError unless the arguments name a task or a run, and fit it."""
    if bool(given["task"]) == bool(given["run"]):
        raise UsageError("task, run: give one of them; task=T has its own expert, run=DIR learned")
    if given["run"] and (changes or given["expert"]):
        raise UsageError("env, episode, expert: a run has its own; give them with task=T")


def _write_policy(given: dict[str, Any], changes: dict[str, str]) -> None:
    """Write the parameters of the policy of run=DIR to policy=FILE."""
    if not given["run"]:
        raise UsageError(f"policy={given['policy']}: writes a trained policy; give run=DIR")
    file = output("policy", given["policy"], (".npz",))
    _check(given, changes)
    folder = Path(given["run"])
    run = load(folder)
    seed = run.seeds[0] if given["learner"] is None else given["learner"]
    if seed not in run.seeds:
        raise UsageError(f"learner={seed}: the run has {', '.join(map(str, run.seeds))}")
    params: Any = jax.tree.map(lambda leaf: leaf[run.seeds.index(seed)], run.params)
    if not jax.tree.leaves(params.policy):
        raise UsageError(f"run={folder}: has no policy with parameters")
    try:
        about = description(folder, run, given["command"], seed)
        models = _models(folder, run, params, about) if given["models"] else {}
        save_policy(file, run.task, run.episode.spec, params.policy, about, models)
    except ValueError as error:
        raise UsageError(str(error)) from error
    count = sum(leaf.size for leaf in jax.tree.leaves((params.policy, models)))
    what = "policy and models" if models else "policy"
    print(f"{file}: the {what} of {given['run']}, {count:,} parameters, task {run.task}")


def _models(
    folder: Path, run: Trained, params: Params, about: dict[str, Any] | None
) -> dict[str, Any]:
    """The parameters to plan with, whose parts are added to `about`."""
    config: Any = run.config
    parts = {"model": params.model, "reward_model": params.reward}
    if about is None or any(value is None or not config.get(n) for n, value in parts.items()):
        raise UsageError(f"models=true: {folder} has no policy with a learned model and reward")
    known = [*parts]
    if params.critic is not None:
        parts["critic"] = params.critic
        known += ["critic", *(name for name in OBJECTIVES if name in config)]
    about |= {name: _anywhere(OmegaConf.to_container(config[name])) for name in known}
    return parts


def _anywhere(node: Any) -> Any:
    """`node` of a configuration, with the physics of whatever machine reads it."""
    if isinstance(node, list):
        return list(map(_anywhere, node))
    if not isinstance(node, dict):
        return node
    own = {"physics": "auto"} if isinstance(node.get("physics"), str) else {}
    return {key: _anywhere(value) for key, value in node.items()} | own


def description(folder: Path, trained: Trained, command: str, seed: int) -> dict[str, Any] | None:
    """`about` of the policy of the learner of `seed` of the run in `folder`.

    None if its controller `policy` is not a policy of observations alone.
    """
    config: Any = trained.config
    node = config.controllers.get("policy")
    controller: Any = trained.controllers.get("policy")
    if not isinstance(controller, PolicyController):
        return None
    model = trained.learner(mode="policy")[1].model
    if not is_identity(controller.model, model, trained.episode.spec.obs):
        return None
    parts: Any = {
        "env": _anywhere(OmegaConf.to_container(config.env)),
        "episode": OmegaConf.to_container(config.episode),
        "policy": OmegaConf.to_container(node.policy),
    }
    paid = {name: config[name] for name in configuration.PAID if config.get(name) is not None}
    parts |= {name: _anywhere(OmegaConf.to_container(part)) for name, part in paid.items()}
    number = trained.seeds.index(seed)
    about = {**parts, "algo": config.algo, "seed": seed, "step": trained.step}
    summary = RunFolder(folder).summary
    made = {key: summary.get(key) for key in ("device", "versions", "git_commit")}
    evaluation = _evaluation(folder, trained.step, number)
    return {**about, "command": command, "evaluation": evaluation, **made}


def _evaluation(folder: Path, step: int, number: int) -> dict[str, Any] | None:
    """Mean and returns of a seed in evaluation_policy.json of this step, if there are."""
    file = folder / "evaluation_policy.json"
    if not file.exists() or (values := json_file(file)).get("step") != step:
        return None
    try:
        mean, returns = values["mean"][number], values["returns"][number]
        return {"mean": float(mean), "returns": list(map(float, returns))}
    except (TypeError, ValueError, LookupError) as error:
        raise UsageError(f"{file}: is no evaluation that `evaluate` wrote") from error


def main() -> None:
    """The command."""
    given, changes = read(__doc__, ARGUMENTS, GROUPS)
    if given["policy"]:
        return _write_policy(given, changes)
    episodes, seed = given["episodes"], given["seed"]
    if given["out"]:
        output("out", given["out"], (".npz",))
    task, world, controller, params = _expert(given, changes)
    if not given["out"]:
        Path("demonstrations").mkdir(exist_ok=True)
    out = output("out", given["out"] or f"demonstrations/{task}.npz", (".npz",))
    recording = record(world, controller, params, episodes, seed)
    save(out, task, world.spec.dt, recording.decisions, recording.episode)
    line = f"{out}: {episodes} episodes, {len(recording.episode):,} decisions, seed {seed}, return "
    returns = recording.returns
    line += f"{returns.mean():,.1f} ({returns.min():,.1f} to {returns.max():,.1f})"
    if recording.success is not None:
        line += f", {int(recording.success.sum())} succeeded"
    print(line)


if __name__ == "__main__":
    command.run(main)
