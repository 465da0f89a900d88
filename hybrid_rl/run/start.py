"""What a new run begins with, from the newest checkpoint of another one: run=DIR.

The learners begin with all that they know there: parameters, states of optimisers, statistics. The
memory of decisions is kept only as far as it is true in the new run, and imagined decisions only
where nothing has changed.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
from omegaconf import DictConfig, OmegaConf, open_dict

from hybrid_rl.errors import MisfitError, UsageError
from hybrid_rl.run import folder
from hybrid_rl.run.checkpoints import checkpoint
from hybrid_rl.run.checkpoints.store import read_part, with_capacity
from hybrid_rl.run.logs.records import changes, flatten_keys
from hybrid_rl.settings import build as configuration
from hybrid_rl.settings.build import Run
from hybrid_rl.training.agent import Agent, AgentState
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.imagined import forgotten

WORLD = ("env", "episode", "constraint", "num_envs")  # keys on which what is remembered depends
PASSING = ("episode.steps", "env.physics")  # but not on these
RELABELLED = ", with the rewards that they earn now"


@dataclass(frozen=True)
class Start:
    """What the learners of a run begin with."""

    learners: Any  # [S, ...]
    memory: Any  # [S, ...]; None: that of any new run
    line: str  # for the console

    def given(self, state: AgentState) -> AgentState:
        """The first state [S, ...] of the run with it."""
        memory = state.memory if self.memory is None else self.memory
        return state.replace(learners=self.learners, memory=memory)


def joined(starts: Sequence[Start | None]) -> Start | None:
    """What the runs of a sweep begin with, all from the same run; None: nothing."""
    known = [start for start in starts if start is not None]
    if not known:
        return None
    have = [start.memory for start in known]
    each = [start.learners for start in known]
    memory = None if have[0] is None else concatenated(have)
    return Start(concatenated(each), memory, known[0].line)


def concatenated(states: Sequence[Any]) -> Any:
    """The trees [S, ...] of the learners of several runs as one."""
    return jax.tree.map(lambda *leaves: jnp.concatenate(leaves), *states)


def build_new_run(config: DictConfig) -> tuple[Run, Start | None]:
    """The new run of a checked configuration, and what it begins with; errors as `begun`."""
    if config.get("run") is None:
        return configuration.built(config), None
    with folder.blame_config(Path(str(config.run)), lacking=True):
        return begun(config)


def begun(config: DictConfig) -> tuple[Run, Start]:
    """The run of `config`, and what it begins with: that of the run in the folder `config.run`.

    The configuration gets `begun`, from which the run can be built without that folder.

    Raises:
        UsageError: if there is no such run, it has no checkpoint, or it does not fit.
        CheckpointError: if none of its checkpoints is sound.
    """
    source = Path(str(config.run))
    then = folder.read_trained(source, "run")
    if config.get("distributed"):
        raise UsageError("distributed=true: a run that begins with run=DIR has one process")
    if config.pretrain:
        raise UsageError(f"pretrain={config.pretrain}: what run={source} has learned is kept")
    numbers = _numbers(config, then, source)
    run = configuration.built(config)
    step, learners, notes = _learners(run, config, then, source)
    memory, why = _memory(run.agent, config, then, step, source)
    demonstrated, remembered = run.agent.replay.num_demonstrated(run.agent.num_envs), 0
    words = f"memory: {'the demonstrations alone' if demonstrated else 'empty'}, since {why}"
    if memory is not None:
        filled = min(int(memory.count.min()), memory.rows.shape[1])
        remembered = max(filled - demonstrated, 0)
        words = f"memory: its last {filled * run.agent.num_envs:,} decisions{why}"
    with open_dict(config):
        config.begun = {"step": step, "remembered": remembered, "memory": words}
    if memory is not None:
        run = configuration.built(config)  # with room for what it remembers
        memory = _rewritten(run.agent, memory, why == RELABELLED)
    if why:  # they imagined other rewards, or another world
        learners = forgotten(learners)
    learners, memory = jax.tree.map(lambda leaf: leaf[numbers], (learners, memory))
    known = [name for learner in run.agent.learners.values() for name in learner.owns]
    line = f"begins with {_listed(known)} of {source} at step {step:,}; {words}"
    made = f"; made at another commit, {commit}" if (commit := folder.other_commit(source)) else ""
    frozen = f"; frozen: {_listed(run.agent.frozen)}" if run.agent.frozen else ""
    return run, Start(learners, memory, "\n".join([*notes, line + frozen + made]))


def _numbers(config: DictConfig, then: DictConfig, source: Path) -> Any:
    """[S] for each learner the number of that in `source` whose knowledge it gets."""
    for end in checkpoint.meta(source / "checkpoints").get("record", {}).get("ends", ()):
        raise UsageError(f"run={source}: its learner of seed {end['seed']} diverged")
    if then.num_seeds not in (1, config.num_seeds):
        raise UsageError(
            f"num_seeds={config.num_seeds}: the run in run={source} has {then.num_seeds} learners; "
            "as many can begin with what they know"
        )
    return jnp.arange(config.num_seeds) % then.num_seeds


def _learners(
    run: Run, config: DictConfig, then: DictConfig, source: Path
) -> tuple[int, Any, list[str]]:
    """(step, learners [S', ...], notes) of the newest sound checkpoint in `source`."""
    try:
        path, seeds = source / "checkpoints", _seeds(then)
        step, state, notes = read_part(path, run.agent, seeds, "learners")
    except MisfitError as error:
        lines = changes(_values(then), _values(config))
        world = ("env.", "episode.", "reward.")
        own = [line for line in lines if "." in line.split()[0] and not line.startswith(world)]
        what, detail = ", ".join((own or lines)[:2]), str(error).partition("this run: ")[2]
        other = "" if what else folder.of_another_commit(source)
        raise UsageError(
            f"{what}: parameters of run={source} do not fit ({detail}){other}"
        ) from error
    return step, state.learners, notes


def _values(config: DictConfig) -> dict[str, Any]:
    """What shapes the parameters of a run, by full keys."""
    values: Any = OmegaConf.to_container(config)
    named = {key: value for key, value in values.items() if key not in ("begun", "expert")}
    return {
        key: value
        for key, value in flatten_keys(named).items()
        if "." in key or key in ("num_envs", "task", "algo", "total_steps")
    }


def _memory(
    agent: Agent, config: DictConfig, then: DictConfig, step: int, source: Path
) -> tuple[Any, str]:
    """The memory [S', ...] in checkpoint `step` if it is true in the new run, and a word on it."""
    before, now = (_world(each) for each in (then, config))
    if differ := [key for key in {**before, **now} if before.get(key) != now.get(key)]:
        return None, f"{_listed(differ[:3])} differ{'' if differ[1:] else 's'}"
    if not then.checkpoint_replay:
        return None, "checkpoints of that run hold none"
    same = _plain(then.get("reward")) == _plain(config.get("reward"))
    if not same and not _follows(agent.episode):
        return None, "reward differs"
    path = source / "checkpoints"
    sized = with_capacity(agent, checkpoint.meta(path)["capacity"])
    state = read_part(path, sized, _seeds(then), "memory", step)[1]
    return state.memory, "" if same else RELABELLED


def _seeds(config: DictConfig) -> tuple[int, ...]:
    """The seeds [S'] of the run that has this configuration."""
    return tuple(range(config.seed, config.seed + config.num_seeds))


def _world(config: DictConfig) -> dict[str, Any]:
    """What the decisions in a memory depend on, by full keys."""
    values: Any = OmegaConf.to_container(config)
    world = flatten_keys({key: values[key] for key in WORLD if key in values})
    return {key: value for key, value in world.items() if key not in PASSING}


def _plain(part: Any) -> Any:
    """The values of a part by full keys, without its copy of the world."""
    values: Any = OmegaConf.to_container(part) if isinstance(part, DictConfig) else {}
    flat = flatten_keys(values)
    return {key: value for key, value in flat.items() if not key.startswith("world.")}


def _follows(episode: Episode) -> bool:
    """Whether what the episodes pay follows from what a memory holds."""
    exact = not episode.delay and not episode.action_noise and episode.sensor_noise == 0.0
    return exact and episode.relabels


def _rewritten(agent: Agent, memory: Any, relabelled: bool) -> Any:
    """The memory [S', ...] in the size of the new run, which goes on with another episode."""

    def one(memory: Any) -> Any:
        memory = agent.replay.interrupted(agent.replay.resized(memory), agent.spec)
        if not relabelled:
            return memory
        return agent.replay.relabelled(memory, agent.spec, agent.episode)

    learners = range(len(memory.count))
    each = [one(jax.tree.map(lambda leaf, s=s: leaf[s], memory)) for s in learners]
    return jax.tree.map(lambda *leaves: jnp.stack(leaves), *each)


def _listed(names: Any) -> str:
    """The names in a sentence."""
    *most, last = [*names] or ["nothing"]
    return f"{', '.join(most)} and {last}" if most else str(last)
