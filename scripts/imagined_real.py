"""What the policy of a run earns in its model and in its world, from the same states.

    python -m scripts.imagined_real run=DIR out=FILE

For each learner, along an episode of its policy without noise: the model's error of one decision,
and its bias, over the standard deviation of the change there, of each entry of the observation; and
the mean reward a decision over the next 5, 20 and 40, imagined and real, from a hundred states.
"""

import json
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.cli.arguments import Argument, read
from hybrid_rl.envs.adapters.external import External
from hybrid_rl.outside.host_loop import copies_of
from hybrid_rl.run.saved import Trained, load
from hybrid_rl.types import EnvState, Params

STEPS, AHEAD = 600, (5, 20, 40)  # decisions
ARGUMENTS = (
    Argument("run", "", "folder of a run with a learned model", needed="run=DIR"),
    Argument("out", "imagined_real.json", "the numbers"),
)


def lived(trained: Trained, params: Params, key: Array) -> tuple[Array, Array, Array, Array]:
    """x [T, n], u [T, m], x' [T, n], r [T] of an episode without noise. The key is consumed."""
    assert trained.agent is not None
    policy, episode = trained.agent.learners["policy"].policy, trained.episode
    if isinstance(episode.env, External):
        world, act, rows = copies_of(episode, trained.seeds[:1]), jax.jit(policy.mean), []
        x = world.reset()
        for _ in range(min(STEPS, episode.steps)):
            got = world.step(u := np.asarray(act(params.policy, x)))
            rows.append((x[0], u[0], got.obs[0], got.reward[0]))
            x = got.obs
        world.close()
        return tuple(map(jnp.asarray, zip(*rows, strict=True)))

    def one(state: EnvState, _: None) -> tuple[EnvState, tuple[Array, ...]]:
        u = policy.mean(params.policy, state.obs)
        now = episode.step(state, u)
        return now, (state.obs, u, now.obs, now.reward)

    return jax.jit(lambda s: jax.lax.scan(one, s, None, length=STEPS)[1])(episode.reset(key))


def compared(trained: Trained, params: Params, key: Array) -> dict[str, Any]:
    """The numbers of one learner. The key is consumed."""
    assert trained.agent is not None
    learner, (x, u, after, paid) = trained.agent.learners["policy"], lived(trained, params, key)
    policy, model, reward = learner.policy, learner.model, learner.reward

    def imagined(x: Array, _: None) -> tuple[Array, Array]:
        u = policy.mean(params.policy, x)
        after = model.step(params.model, x, u)
        return after, reward.outcome(params, x, u, after)[0]

    error = jax.vmap(model.step, (None, 0, 0))(params.model, x, u) - after
    spread = (after - x).std(0)
    starts = jnp.linspace(0, len(x) - AHEAD[-1] - 1, 100).astype(int)
    ahead = jax.jit(jax.vmap(lambda x: jax.lax.scan(imagined, x, None, length=AHEAD[-1])[1]))
    rewards = ahead(x[starts])
    paid = paid[starts[:, None] + jnp.arange(AHEAD[-1])]
    found: dict[str, Any] = {"error": error.std(0) / spread, "bias": error.mean(0) / spread}
    found |= {f"imagined {n}": rewards[:, :n].mean() for n in AHEAD}
    return found | {f"real {n}": paid[:, :n].mean() for n in AHEAD}


def main() -> None:
    """The command."""
    given, _ = read(__doc__, ARGUMENTS)
    trained = load(given["run"], "run")
    rows = []
    for i, seed in enumerate(trained.seeds):
        params = jax.tree.map(lambda leaf, i=i: leaf[i], trained.params)
        found = compared(trained, params, jax.random.key(seed))
        rows.append({k: np.asarray(v, float).round(3).tolist() for k, v in found.items()})
        print(seed, {k: v for k, v in rows[-1].items() if k not in ("error", "bias")}, flush=True)
    table = {"run": str(given["run"]), "step": trained.step, "seeds": list(trained.seeds)}
    Path(given["out"]).write_text(json.dumps({**table, "rows": rows}, indent=1) + "\n")


if __name__ == "__main__":
    main()
