"""What Python calls: `make` an environment, `train` a run, `load` what was trained."""

import re
import signal
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from omegaconf import DictConfig, OmegaConf

from hybrid_rl.cli import interrupt
from hybrid_rl.envs.adapters.external import check_world
from hybrid_rl.errors import UsageError
from hybrid_rl.files.reading import yaml_file
from hybrid_rl.run import launch, members
from hybrid_rl.run.checkpoints import checkpoint
from hybrid_rl.run.launch import Output
from hybrid_rl.run.machine.jax_settings import prepare
from hybrid_rl.settings import build as config
from hybrid_rl.settings.build import Run
from hybrid_rl.settings.groups import CONF
from hybrid_rl.settings.values import SECTIONS, whole
from hybrid_rl.settings.words import typed_values
from hybrid_rl.training.agent import Agent
from hybrid_rl.training.episode import Episode

if TYPE_CHECKING:
    from hybrid_rl.analysis.curves import Curve
    from hybrid_rl.run.saved import Trained

DEFAULTS = ("compile_cache", "precision")  # those of conf/train.yaml
OnRow = Callable[[dict[str, Any]], Any]


def make(task: str, overrides: Sequence[str] = (), config_dir: str | Path | None = None) -> Episode:
    """The episodes of a task: `spec`, `reset(key)`, `step(state, action)`, `auto_reset`.

        episode = make("halfcheetah", ["physics=mjx", "episode.steps=200"])
        state = episode.reset(jax.random.key(0))
        state = jax.jit(episode.step)(state, jnp.zeros(episode.spec.act))

    They are pure functions, for `jit`, `vmap` and `scan`. `python -m hybrid_rl.list` prints the
    tasks. The environment alone, without a time limit, is `episode.env`.

    Args:
        task: its name.
        overrides: of `physics`, `env.KEY` and `episode.KEY`, as of the command.
        config_dir: a folder with tasks of the user, as for `--config-dir`.

    Raises:
        UsageError: for a task or a key that does not exist, or a value out of range.
    """
    return config.episodes(config.load([f"task={task}", "algo=sac", *overrides], config_dir))


def load(run: str | Path, key: str = "") -> "Trained":
    """A run folder, a policy that comes with the package, or a policy's file NAME.npz, read back.

        policy = load("halfcheetah").policy()
        policy.reset()  # at the start of every episode
        action = policy(obs)  # [o] -> [m] in [-1, 1]; [N, o] -> [N, m]

    key: the argument of a command that named it, run or policy.

    Raises:
        UsageError: if there is no such thing, or it is damaged.
        CheckpointError: if none of a run's checkpoints is sound.
    """
    from hybrid_rl.run import saved as trained

    name = str(run)
    if key == "run" or (not key and Path(run).is_dir()):
        return trained.load(run)
    if key or name.endswith(".npz") or name in trained.names():
        return trained.read(name)
    known = ", ".join(trained.names())
    raise UsageError(f"load({name!r}): no run folder, and no policy; choose a file, or {known}")


class Result(dict[str, Any]):
    """The contents of summary.json, with the run's folder, its curves and its learners."""

    def __init__(self, summary: Mapping[str, Any], run: Run | None = None) -> None:
        super().__init__(summary)
        self._run = run  # of an agent; None: config.yaml has the parts
        self.folder = Path(self["run_dir"]).absolute()  # holds after the working folder changes

    def curves(self, metric: str = "eval/return") -> "list[Curve]":
        """The curve of a metric, with arrays; see hybrid_rl.curves."""
        from hybrid_rl.analysis.curves import curves

        return curves(self.folder, metric)

    def load(self) -> "Trained":
        """The learners at the newest checkpoint; `.policy(seed)` maps observations to actions."""
        if self._run is None:
            return load(self.folder)
        from hybrid_rl.run import saved as trained

        return trained.of(self._run, self.folder)


def train(
    method: Sequence[str] | DictConfig | Agent = (),
    *,
    config_dir: str | Path | None = None,
    on_row: OnRow | None = None,
    progress: bool = True,
    **settings: Any,
) -> Result:
    """Train `method` to its end; returns what summary.json holds.

        train(["task=pendulum", "algo=sac", "num_seeds=2"], on_row=print)
        train(["resume=runs/pendulum/sac/TIME", "total_steps=20000"])
        train(Agent(...), total_steps=10_000, num_seeds=5, run_dir="runs/mine")

    A signal, such as SIGTERM, ends it with a checkpoint, and then has its effect on the program.

    Args:
        method: what follows the command, as a list; a configuration of `compose`; or an agent,
            which continues where run_dir holds its checkpoints.
        config_dir: of a list, a folder as for `--config-dir`.
        on_row: called with each new row of metrics.jsonl, a dictionary. Once it returns False, or
            raises, the run ends with a checkpoint, and "finished" of the result is False.
        progress: False prints nothing.
        settings: of an agent alone, total_steps, seed, num_seeds, run_dir, ... (run_of).

    Raises:
        KeyboardInterrupt: after Ctrl-C and a checkpoint.
        UsageError: if the configuration makes no run.
        DivergenceError: if every learner reached NaN or infinity.
        CheckpointError: if a checkpoint could not be written or read.
    """
    output = Output(on_row or (lambda row: None), progress, interrupt.as_call)
    if isinstance(method, Agent):
        run = run_of(method, **settings)
        result = Result(launch.train_built(run, output), run)
    else:
        given = {} if isinstance(method, DictConfig) else typed_values(method)
        if settings:
            texts = ", ".join(f'"{key}={value}"' for key, value in settings.items())
            raise UsageError(f"train: keywords are for an agent; write train([{texts}, ...])")
        runs = members.load(method, config_dir)
        result = Result(launch.train(runs, given, output))
    if result["signal"] is not None:
        signal.raise_signal(result["signal"])
    if output.problem is not None:
        raise output.problem
    return result


def run_of(
    agent: Agent,
    *,
    total_steps: int,
    seed: int = 0,
    num_seeds: int = 1,
    run_dir: str | Path | None = None,
    name: str | None = None,
    log_every: int | None = None,
    eval_every: int | None = None,
    eval_episodes: int = 10,
    checkpoint_every: int | None = None,
) -> Run:
    """The run of `agent` with these values of the configuration; None is explained below.

    Its folder has the usual form, but config.yaml holds the agent as text, of which no command can
    build it again: `evaluate`, `render` and `resume=` refuse it, and figures draw it.

    run_dir: None is runs/ENV/NAME/TIME; a folder that holds checkpoints is continued. name: of the
    method, in figures; None is the classes of the learners. log_every: None is the default.
    eval_every: None evaluates nothing. checkpoint_every: None saves at the end alone.
    """
    defaults: Any = OmegaConf.load(CONF / "train.yaml")
    counts = {"total_steps": total_steps, "num_seeds": num_seeds, "eval_episodes": eval_episodes}
    counts["log_every"] = defaults.log_every if log_every is None else log_every
    every = {"eval_every": eval_every, "checkpoint_every": checkpoint_every}
    counts |= {key: total_steps if value is None else value for key, value in every.items()}
    counts = {key: whole(key, value) for key, value in counts.items()}
    counts["seed"] = whole("seed", seed, 0)
    config = OmegaConf.create(
        _described(agent, name)
        | counts
        | {key: defaults[key] for key in DEFAULTS}
        | {"eval_modes": [] if eval_every is None else ["full"]}
        | {"run_dir": None if run_dir is None else str(run_dir), "resume": None, "logger": None}
    )
    prepare(config)  # first: a check of the user's world initialises JAX's devices
    check_world(agent.episode.env)
    rounds = -(-counts["total_steps"] // agent.num_envs)
    agent.check()
    sized = replace(agent, replay=agent.replay.within(rounds, agent.num_envs))
    run = Run(config, sized, {"full": agent.controller.greedy()})
    if run_dir is not None and checkpoint.steps(Path(run_dir) / "checkpoints"):
        run = replace(run, notes=_check_same(run, Path(run_dir)))
        config.resume = str(run_dir)
    return run


def _described(agent: Agent, name: str | None) -> dict[str, Any]:
    """The keys of a configuration that follow from an agent."""
    env = agent.episode.env
    classes = [type(part).__name__ for part in agent.learners.values() or [agent.controller]]
    physics = getattr(env, "physics", None)
    physics = physics if isinstance(physics, str) else None
    return {
        "task": type(env).__name__.lower(),
        "algo": name or "_".join(classes).lower(),
        "agent": repr(agent),
        "num_envs": agent.num_envs,
        "random_steps": agent.random_steps,
        "checkpoint_replay": True,
        "physics": physics,
        **{section: {} for section in SECTIONS},
        "replay": {"capacity": agent.replay.capacity},  # before the run bounds it
        "env": {"physics": physics},
        "controllers": {"full": None},
    }


def _check_same(run: Run, folder: Path) -> tuple[str, ...]:
    """A note if the agent is not the one that config.yaml describes."""
    path, flaw = folder / "config.yaml", ""
    config = yaml_file(path) if path.exists() else {}
    made = max(checkpoint.steps(folder / "checkpoints"))
    if "agent" not in config:
        flaw = f'holds the run of a configuration; continue it by train(["resume={folder}"])'
    elif run.config.total_steps < made:
        flaw = f"has {made} steps; total_steps={run.config.total_steps} can be raised, not lowered"
    if flaw:
        raise UsageError(f"run_dir={folder}: {flaw}")
    then, now = (re.sub(" at 0x[0-9a-f]+", "", each["agent"]) for each in (config, run.config))
    return ("goes on with another agent than before",) if then != now else ()
