"""Environments and trained policies by name, from Python: `make` and `load`."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from hybrid_rl.errors import UsageError
from hybrid_rl.settings import build as config
from hybrid_rl.training.episode import Episode

if TYPE_CHECKING:
    from hybrid_rl.run.saved import Trained


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
    if isinstance(overrides, str):
        raise UsageError(f'make("{task}", "{overrides}"): give a list, ["{overrides}"]')
    return config.episodes(config.load([f"task={task}", "algo=sac", *overrides], config_dir))


def load(run: str | Path) -> "Trained":
    """A run folder, a policy that comes with the package, or a policy's file NAME.npz, read back.

        policy = load("halfcheetah").policy()
        policy.reset()  # at the start of every episode
        action = policy(obs)  # [o] -> [m] in [-1, 1]; [N, o] -> [N, m]

    Raises:
        UsageError: if there is no such thing, or it is damaged.
        CheckpointError: if none of a run's checkpoints is sound.
    """
    from hybrid_rl.run import saved as trained

    name = str(run)
    if not Path(run).is_dir() and (name.endswith(".npz") or name in trained.names()):
        return trained.read(name)
    if Path(run).is_dir():
        return trained.load(run)
    known = ", ".join(trained.names())
    raise UsageError(f"load({name!r}): no run folder, and no policy; choose a file, or {known}")
