"""A new run that begins with another one: its words, and what its learners know, by run=DIR.

config.yaml keeps the words that made a run as `recipe`. They are composed with the new ones, so
that what refers to another key follows it. The learners begin with all that they know there:
parameters, states of optimisers, statistics. The memory of decisions is kept only as far as it is
true in the new run, and imagined decisions only where nothing has changed.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
from omegaconf import DictConfig, open_dict

from hybrid_rl.core.batching import join
from hybrid_rl.core.branches import Branches
from hybrid_rl.errors import MisfitError, UsageError
from hybrid_rl.files import targets as parts
from hybrid_rl.run import folder
from hybrid_rl.run.checkpoints import checkpoint
from hybrid_rl.run.checkpoints.store import each_learner, read_parts
from hybrid_rl.run.logs.records import flatten_keys
from hybrid_rl.settings import build as configuration
from hybrid_rl.settings import words as overrides
from hybrid_rl.settings.build import Run
from hybrid_rl.settings.groups import search_path
from hybrid_rl.settings.words import name, plain
from hybrid_rl.training.agent import Agent, AgentState
from hybrid_rl.training.episode import Episode

OWN = ("random_steps", "pretrain", "run_dir", "freeze", "resume", "run")
FRESH = ("random_steps=0", "pretrain=null")  # the learners have begun
FOREIGN = re.compile(r"\$\{[^}]*:|^\+*(hydra|(?!demonstrations=)[\w@]+=[^=]*\.\.)")
WORLD = ("env", "episode", "constraint", "num_envs")  # keys on which what is remembered depends
PASSING = ("episode.steps", "env.physics")  # but not on these
PRETRAIN = 4000  # gradient steps on a memory with other rewards, before a policy for them acts


def add_recipe(texts: Sequence[str], config_dir: str | Path | None = None) -> list[str]:
    """The words of a command, with those of the run in run=DIR before them."""
    given = overrides.typed_values(texts)
    if given.get("run", "null") == "null":
        return [*texts]
    if given.get("resume", "null") != "null":
        raise UsageError(
            "run, resume: give one of them; run=DIR begins a new run with what DIR has learned, "
            "resume=DIR continues DIR itself"
        )
    source = Path(str(overrides.value_of(given["run"])))
    words = [text for text in (*_recipe(source, config_dir), *FRESH) if name(text) not in given]
    return [*words, *texts]


def _recipe(run_dir: Path, config_dir: str | Path | None) -> list[str]:
    """The words that made the run in a folder, which may come from anybody.

    config.yaml keeps their references as $(KEY).
    """
    config = folder.read(run_dir, "run")
    made_by, folders = config.get("recipe"), config_dir or config.get("config_dir")
    words = [re.sub(r"\$\(([^)]*)\)", r"${\1}", str(text)) for text in made_by or ()]
    kept = [text for text in words if name(text) not in OWN]
    if made_by is None or any(map(FOREIGN.search, kept)):
        line = "must be a list of KEY=VALUE; train it again"
        raise UsageError(f"{run_dir / 'config.yaml'}: recipe: {line}")
    made = plain(configuration.load(kept, folders))
    made.pop("recipe")
    parts.check(made, run_dir)
    chosen = {"task": config.task, "algo": config.algo}
    kept = [*(f"{k}={v}" for k, v in chosen.items() if k not in map(name, kept)), *kept]
    return [search_path(folders), *kept] if folders and not config_dir else kept


@dataclass(frozen=True)
class Start:
    """Knowledge with which the learners of a run begin."""

    learners: Any  # [S, ...]
    memory: Any  # [S, ...]; None: that of any new run
    line: str  # for the console

    def given(self, state: AgentState) -> AgentState:
        """The first state [S, ...] of the run with it."""
        memory = state.memory if self.memory is None else self.memory
        return state.replace(learners=self.learners, memory=memory)


def joined(starts: Sequence[Start | None]) -> Start | None:
    """The start of the runs of a sweep, all from the same run; None: from nothing."""
    known = [start for start in starts if start is not None]
    if not known:
        return None
    learners, memory = join(*((start.learners, start.memory) for start in known))
    return Start(learners, memory, known[0].line)


def build_new_run(config: DictConfig) -> tuple[Run, Start | None]:
    """The new run of a configuration, and what it begins with: that of the run in `run`.

    The configuration gets `begun`, from which the run can be built without that folder.
    """
    if config.get("run") is None:
        return configuration.build(config), None
    source = Path(str(config.run))
    then = folder.read_trained(source, "run")
    numbers = _numbers(config, then, source)
    unread = config.copy()
    unread.pretrain = 0
    run = configuration.build(unread)
    same = _flat(then, "reward") == _flat(config, "reward")
    lost = _lost(run.agent.episode, config, then, same)
    if config.pretrain is None:
        config.pretrain = 0 if same or lost else PRETRAIN
    try:
        seeds = range(then.seed, then.seed + then.num_seeds)
        wanted = ["learners"] if lost else ["learners", "memory"]
        step, state, _, notes = read_parts(source / "checkpoints", run.agent, seeds, wanted)
    except MisfitError as error:
        line = f"its parameters do not fit: {str(error).partition(': ')[2]}"
        raise UsageError(f"run={source}: {line}") from error
    demonstrated, remembered = run.agent.replay.num_demonstrated(run.agent.num_envs), 0
    memory = state.memory
    words = f"memory: {'the demonstrations alone' if demonstrated else 'empty'}, since {lost}"
    if memory is not None:
        filled = min(int(memory.count.min()), memory.rows.shape[1])
        remembered = max(filled - demonstrated, 0)
        words = f"memory: its last {filled * run.agent.num_envs:,} decisions"
        words += "" if same else ", with the rewards that they earn now"
    with open_dict(config):
        config.begun = {"step": step, "remembered": remembered, "memory": words}
    run = configuration.build(config)  # with room for what it remembers
    if memory is not None:
        memory = _rewritten(run.agent, memory, not same)
    if lost or not same:  # they imagined other rewards, or another world
        state = state.replace(learners=forgotten(state.learners))
    learners, memory = jax.tree.map(lambda leaf: leaf[numbers], (state.learners, memory))
    known = [name for learner in run.agent.learners.values() for name in learner.owns]
    line = f"begins with {_listed(known)} of {source} at step {step:,}; {words}"
    line += f"; {config.pretrain:,} gradient steps on it come first" if config.pretrain else ""
    line += f"; frozen: {_listed(run.agent.frozen)}" if run.agent.frozen else ""
    return run, Start(learners, memory, "\n".join([*notes, line]))


def _numbers(config: DictConfig, then: DictConfig, source: Path) -> Any:
    """[S] for each learner the number of that in `source` whose knowledge it gets."""
    ends = checkpoint.meta(source / "checkpoints").get("record", {}).get("ends", ())
    if ends or then.num_seeds not in (1, config.num_seeds):
        ended = f"its learner of seed {ends[0]['seed']} diverged" if ends else ""
        line = f"has {then.num_seeds} learners; num_seeds={config.num_seeds} must be as many"
        raise UsageError(f"run={source}: {ended or line}")
    return jnp.arange(config.num_seeds) % then.num_seeds


def _flat(config: DictConfig, *names: str) -> dict[str, Any]:
    """The values at these keys, by full keys; not of a part's own world."""
    values = plain(config)
    chosen = {key: values[key] for key in names if values.get(key) is not None}
    return {key: value for key, value in flatten_keys(chosen).items() if ".world." not in key}


def _lost(episode: Episode, config: DictConfig, then: DictConfig, same: bool) -> str:
    """Why the memory of a run is not true in the new one; "" if it is.

    same: whether both have the same reward.
    """
    before, now = (_flat(made, *WORLD) for made in (then, config))
    differ = [key for key in {**before, **now} if before.get(key) != now.get(key)]
    if differ := [key for key in differ if key not in PASSING]:
        return f"{_listed(differ[:3])} differ{'' if differ[1:] else 's'}"
    if not then.checkpoint_replay:
        return "checkpoints of that run hold none"
    return "" if same or _follows(episode) else "reward differs"


def _follows(episode: Episode) -> bool:
    """True if the rewards of the episodes follow from the decisions in a memory."""
    exact = not episode.late and not episode.action_noise and episode.sensor_noise == 0.0
    return exact and episode.relabels


def _rewritten(agent: Agent, memory: Any, relabelled: bool) -> Any:
    """The memory [S', ...] in the size of the new run, which goes on with another episode."""

    def one(memory: Any) -> Any:
        memory = agent.replay.interrupted(agent.replay.resized(memory), agent.spec)
        return agent.replay.relabelled(memory, agent.spec, agent.episode) if relabelled else memory

    return each_learner(one, memory)


def forgotten(learners: Any) -> Any:
    """States of learners whose branches start again, where they keep some.

    What they imagined in another world, or for another goal, is not what they begin with.
    """

    def one(node: Any) -> Any:
        return node.restarted() if isinstance(node, Branches) else node

    return jax.tree.map(one, learners, is_leaf=lambda node: isinstance(node, Branches))


def _listed(names: Any) -> str:
    """The names in a sentence."""
    *most, last = [*names] or ["nothing"]
    return f"{', '.join(most)} and {last}" if most else str(last)
