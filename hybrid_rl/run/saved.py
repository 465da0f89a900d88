"""A trained run or policy, read back.

    policy = load("runs/hopper/sac/TIME").policy(seed=0)
    policy.reset()  # at the start of every episode
    action = policy(obs)  # [m] in [-1, 1]; within the bounds of a Gymnasium environment or a robot

`load` reads the folder of a run, `read` a file of hybrid_rl.data.trained: one of policies/, which
come with the package, or the user's. The `about` of a file is JSON with the world, the episode, the
policy and, if there are such, the reward and the constraint, as in config.yaml of the run, and with
the command, the seed and the evaluation.
"""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any

import jax
import numpy as np
from omegaconf import DictConfig, OmegaConf

from hybrid_rl.controllers.policy import PolicyController
from hybrid_rl.core.lifting import lifted_spec
from hybrid_rl.data import archive
from hybrid_rl.data.trained import part
from hybrid_rl.envs.adapters.robot import Robot
from hybrid_rl.envs.mujoco.physics import resolve
from hybrid_rl.errors import UsageError, printable
from hybrid_rl.files import targets as parts
from hybrid_rl.outside.acting import TrainedPolicy
from hybrid_rl.outside.lag import known_lag
from hybrid_rl.protocols import Controller
from hybrid_rl.run import folder as run_folder
from hybrid_rl.run.checkpoints.store import read_parts
from hybrid_rl.run.logs.progress import say
from hybrid_rl.run.machine.jax_settings import prepare
from hybrid_rl.settings import build as configuration
from hybrid_rl.settings.build import Run
from hybrid_rl.settings.values import one_of
from hybrid_rl.training.agent import Agent, AgentState
from hybrid_rl.training.ahead import ahead
from hybrid_rl.training.contract import needs_world
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.wrappers import whole
from hybrid_rl.types import Params

DESCRIBED = ("env", "episode", "policy", "seed", "step")  # keys of every `about`
OBJECTIVES = ("objective", "model_objective")  # with a critic, and without
ACTING = ("episode", "policy", "model", "reward_model", *OBJECTIVES)  # of `about`, to plan with
UNFIT = (TypeError, AttributeError, LookupError, ArithmeticError, AssertionError, RecursionError)


@dataclass(frozen=True)
class Trained:
    """A run, read back."""

    task: str
    episode: Episode
    controllers: dict[str, Controller]  # mode -> controller without exploration
    params: Params = field(repr=False)  # [S, ...]
    seeds: tuple[int, ...]
    step: int  # decisions of each learner
    notes: tuple[str, ...]  # on how it was made
    config: DictConfig = field(default_factory=OmegaConf.create, repr=False)  # has env, episode
    agent: Agent | None = field(default=None, repr=False)  # of the run; None: of a policy's file

    def policy(self, seed: int | None = None, mode: str = "full", key: int = 0) -> "TrainedPolicy":
        """Observations to actions, as the learner of `seed` acts; None is the first.

        key: seed of the planner's random numbers.

        Raises:
            UsageError: for a seed or a mode that the run does not have.
        """
        flat = getattr(self.episode.env, "flat", None)
        return TrainedPolicy(self.episode.spec, *self.learner(seed, mode), key, self.span, flat)

    @property
    def span(self) -> tuple[np.ndarray, np.ndarray] | None:
        """Middle [m] and half the width [m] of the actions' bounds; None: they are -1 and 1.

        A Gymnasium environment and a robot have bounds of their own.
        """
        low, high = getattr(self.episode.env, "bounds", (np.float32(-1), np.float32(1)))
        if (low == -1).all() and (high == 1).all():
            return None
        return np.float32(low / 2 + high / 2), np.float32(high / 2 - low / 2)

    def learner(
        self, seed: int | None = None, mode: str = "full", world: bool = False
    ) -> tuple[Controller, Params]:
        """The controller of `mode` and the parameters of the learner of `seed`; None: the first.

        world: whether the caller can give it the state of the world, and not only observations.

        Raises:
            UsageError: for a seed or a mode that the run does not have, or a mode that needs more
                than observations.
        """
        seed = self.seeds[0] if seed is None else seed
        one_of("seed", seed, self.seeds)
        one_of("mode", mode, self.controllers)
        if not world and needs_world(self.controllers[mode]):
            raise UsageError(
                f"mode={mode}: plans from the state of the world (model=world), which observations "
                "do not give; use evaluate or render, in a loop of yours hybrid_rl.sampling.plan"
            )
        params: Any = jax.tree.map(lambda leaf: leaf[self.seeds.index(seed)], self.params)
        return self.controllers[mode], params


def load(folder: Path | str, key: str = "run") -> Trained:
    """The learners of the run in `folder`, at its newest sound checkpoint.

    A line is printed for each checkpoint that is skipped. key: the argument that named the folder.
    """
    folder = Path(folder)
    config = run_folder.read_trained(folder, key)
    with run_folder.blame_config(folder):
        prepare(config)
        trained = of(build_run(config), folder)
    for note in trained.notes:
        say(note)
    return replace(trained, config=config, notes=())


def with_lag(trained: Trained, folder: Path) -> Trained:
    """`trained`, with the lag that was found last if it is a robot's."""
    env = trained.episode.env
    if not isinstance(env, Robot):
        return trained
    lag = float(whole((known_lag(env, folder / "robot") or 0.0) / env.spec.dt))
    acting = {
        mode: ahead(each, trained.episode.spec, lag) for mode, each in trained.controllers.items()
    }
    return replace(trained, controllers=acting)


def of(run: Run, folder: Path) -> Trained:
    """The learners of a run that is built, at its newest sound checkpoint; errors as `restore`."""
    name, agent, seeds = run.config.task, run.agent, run.seeds
    step, state, notes = restore(folder, run)
    params = jax.vmap(agent.params, axis_size=len(seeds))(state)  # state may be empty
    made = agent.episode, run.controllers, params, seeds, step, (*notes,)
    return with_lag(Trained(name, *made, agent=agent), folder)


def build_run(config: DictConfig, part: str = "learners") -> Run:
    """The run of `config`, without demonstrations that `restore` of `part` does not need."""
    config = config.copy()
    holders = list(config.learners.values())
    if part != "memory":
        config.pretrain = 0
        holders.append(config.replay)
    for holder in holders:
        if holder is not None and "demonstrations" in holder:
            holder.demonstrations = None
    return configuration.build(config)


def restore(folder: Path, run: Run, part: str = "learners") -> tuple[int, AgentState, list[str]]:
    """(step, state [S, ...], notes) of the newest sound checkpoint of `run` in `folder`.

    part: the field of the state that is read; the others are None.
    """
    step, state, _, notes = read_parts(folder / "checkpoints", run.agent, run.seeds, [part])
    return step, state, notes


def names() -> list[str]:
    """The policies that come with the package."""
    return sorted(path.stem for each in archive.PARENTS for path in each.glob("policies/*.npz"))


def load_named(given: Mapping[str, Any]) -> Trained:
    """The run or policy that the arguments run=DIR or policy=NAME name."""
    return read(given["policy"]) if given["policy"] else load(Path(given["run"]))


def read(name: str) -> Trained:
    """The policy NAME of the package, or that in a file whose name ends in .npz."""
    file = Path(name) if name.endswith(".npz") else Path("policies", f"{name}.npz")
    prefix, known = f"policy={name}:", f"choose a file, or one of {', '.join(names())}"
    try:
        arrays = archive.read(prefix, file, hint=known)
        about = json.loads(str(arrays.get(archive.ABOUT, "{}")))
        if lacking := [key for key in DESCRIBED if key not in about]:
            raise ValueError(f"its description lacks {', '.join(lacking)}")
        parts.check({**about, "command": ""}, archive.find(file))  # the command is only shown
        prepare(configuration.load([]))
        return _trained(prefix, str(file), str(arrays["task"]), about)
    except (ValueError, *UNFIT) as error:
        line = f"its description fits no policy ({printable(error)})"
        line = str(error) if isinstance(error, ValueError) else line
        raise UsageError(f"{prefix} {line.removeprefix(prefix).lstrip()}") from error


def _trained(prefix: str, file: str, task: str, about: dict[str, Any]) -> Trained:
    """The policy that a description names, with the parameters in `file`."""
    env = about["env"]
    if isinstance(env.get("physics"), str):
        env = env | {"physics": resolve(env["physics"], 1)}  # of this machine
    env = part(prefix, file, env)
    paid = {name: part(prefix, file, about[name]) for name in configuration.PAID if name in about}
    policy, params = _parameters(prefix, file, task, env, about)
    controller = PolicyController(policy, explore=False)
    kept = {name: about[name] for name in (*ACTING, *configuration.PAID) if name in about}
    kept |= {"task": task, "num_seeds": 1, "num_envs": 1, "env": about["env"]}
    notes = [f"trained by: {printable(about['command'])}"] if about.get("command") else []
    if evaluation := about.get("evaluation"):
        count = len(evaluation["returns"])
        notes.append(f"evaluated then: {evaluation['mean']:,.1f} (mean of {count} episodes)")
    return Trained(
        task,
        Episode(env, **about["episode"], **paid),
        {"full": controller, "policy": controller},
        jax.tree.map(lambda leaf: leaf[None], params),
        (about["seed"],),
        about["step"],
        tuple(notes),
        OmegaConf.create(kept),
    )


def _parameters(
    prefix: str, file: str, task: str, env: Any, about: dict[str, Any]
) -> tuple[Any, Params]:
    """The policy that a description names, and the parameters in `file` to act and to plan with."""
    plans = {"model", "reward_model"} <= set(about)
    names = ("policy", *(("model", "reward_model", "critic") if plans else ()))
    made = {name: part(prefix, file, about[name]) for name in names if name in about}
    lifted = lifted_spec(made["model"], env.spec) if plans else env.spec
    found = {}
    for name, each in made.items():
        spec = env.spec if name in ("policy", "model") else lifted
        shapes = jax.eval_shape(partial(each.init, jax.random.key(0), spec))
        found[name] = archive.policy(file, shapes, task, env, about["episode"], name)
    return made["policy"], Params(reward=found.pop("reward_model", None), **found)
