"""A run of an agent that was built in Python, without YAML, in a folder of the usual form.

The folder has metrics.jsonl, tensorboard/, checkpoints and summary.json. Its config.yaml holds the
schedule and the agent as text, of which no command can build the agent again: `evaluate`, `render`
and `resume=` refuse it, and figures draw it.
"""

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

from omegaconf import OmegaConf

from hybrid_rl.envs.adapters.external import check_world
from hybrid_rl.errors import UsageError
from hybrid_rl.files.reading import yaml_file
from hybrid_rl.run.checkpoints import checkpoint
from hybrid_rl.run.machine.jax_settings import prepare
from hybrid_rl.settings.build import Run
from hybrid_rl.settings.groups import CONF
from hybrid_rl.settings.values import SECTIONS, whole
from hybrid_rl.training.agent import Agent

DEFAULTS = ("compile_cache", "precision")  # those of conf/train.yaml


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
    agent.check(rounds * agent.num_envs)
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
    saved = tuple(checkpoint.meta(folder / "checkpoints").get("seeds", ()))
    if "agent" not in config:
        flaw = f'holds the run of a configuration; continue it by train(["resume={folder}"])'
    elif run.config.total_steps < made:
        flaw = f"has {made} steps; total_steps={run.config.total_steps} can be raised, not lowered"
    elif saved != run.seeds:
        flaw = f"holds the learners of seed {', '.join(map(str, saved))}; give these"
    if flaw:
        raise UsageError(f"run_dir={folder}: {flaw}")
    then, now = (re.sub(" at 0x[0-9a-f]+", "", each["agent"]) for each in (config, run.config))
    return ("goes on with another agent than before",) if then != now else ()
