"""How long the rewards are right that a model imagines, by what it sees of a half-cheetah.

    python -m scripts.imagined_rewards out=imagined_rewards.json

Models learn from episodes of the package's policy with noise: of all observations, of positions and
the last k of them (`core.history`), or of these with a memory (`models/recurrent.py`). In episodes
that they did not learn from they roll on by the recorded actions. Numbers: R^2 of the reward of the
1st, 2nd, ... imagined decision; every list is over seeds.
"""

import json
from functools import partial
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.cli.arguments import Argument, numbers, output, read, whole
from hybrid_rl.core import history
from hybrid_rl.learners.model import ModelLearner
from hybrid_rl.models.ensemble import Ensemble
from hybrid_rl.models.gaussian import Gaussian
from hybrid_rl.models.recurrent import Recurrent
from hybrid_rl.rewards.network import RewardNetwork
from hybrid_rl.types import Batch, Params, Spec
from scripts.hidden_velocities import ACTIONS, DT, POSITIONS, Lived, Robot, seen

ARGUMENTS = (
    Argument("seeds", [0, 1, 2], "independent", numbers(whole(0))),
    Argument("episodes", 80, "a fifth tests", whole(5)),
    Argument("updates", 2000, "of each model", whole()),
    Argument("batch", 128, "of each member", whole()),
    Argument("out", "", "JSON", needed="out=FILE.json"),
)
SEES = {"all": 0, **{f"history={k}": k for k in (3, 16)}}
SEES |= {f"recurrent, history={k}": k for k in (16, 32)}
AFTER, FIRST, EVERY = (1, 2, 5, 10, 20), 40, 10  # imagined decisions; starts in an episode


def learner(sees: str, batch: int) -> tuple[ModelLearner, Spec]:
    """What learns a model of what `sees` sees, and its sizes."""
    k = SEES[sees]
    sizes = Spec(obs=2 * POSITIONS + 1, act=ACTIONS, dt=DT)
    spec = history.seen(sizes._replace(obs=POSITIONS), k) if k else sizes
    member: Any = Gaussian((200, 200), "silu")
    model: Any = Ensemble(member, 2)
    model = Recurrent(model, k) if sees.startswith("recurrent") else model
    own = ModelLearner(model, RewardNetwork(), 1e-3, batch, max_grad_norm=10.0)
    return own, spec


def learned(own: ModelLearner, spec: Spec, s: Array, data: Lived, updates: int, key: Array) -> Any:
    """Parameters after `updates` on episodes, of which s [E, T, n] is seen. The key is consumed."""
    first, key = jax.random.split(key)

    def flat(leaf: Array, begin: int = 0) -> Array:
        """Rows of all decisions but the last of each episode, or of those after them."""
        cut = leaf[:, begin : begin + leaf.shape[1] - 1]
        return cut.reshape(-1, *leaf.shape[2:])

    rows = flat(s), flat(data.u), flat(data.reward), flat(s, 1), flat(data.u, 1)

    def update(state: Any, key: Array) -> tuple[Any, None]:
        i = jax.random.randint(key, (own.batch_size * own.batches,), 0, len(rows[0]))
        obs, u, reward, after, then = (leaf[i] for leaf in rows)
        none = jnp.zeros(len(i))
        batch = Batch(obs, u, reward, none, none, after, then)
        return own.update(state, Params(decisions=jnp.int32(0)), batch, key)[0], None

    begun = own.init(first, spec)
    return jax.jit(partial(jax.lax.scan, update))(begun, jax.random.split(key, updates))[0]


def right(own: ModelLearner, state: Any, s: Array, data: Lived) -> list[float]:
    """R^2 of the rewards after AFTER imagined decisions in episodes of which s is seen."""
    params, model, reward = Params(**own.params(state)), own.model, own.reward
    assert reward is not None

    def imagined(s: Array, us: Array) -> Array:
        def onward(x: Array, u: Array) -> tuple[Array, Array]:
            after = model.step(params.model, x, u)
            return after, reward.outcome(params, x, u, after)[0]

        return jax.lax.scan(onward, model.lift(params.model, s), us)[1]

    starts = jnp.arange(FIRST, s.shape[1] - max(AFTER), EVERY)
    along = starts[:, None] + jnp.arange(max(AFTER))[None]
    both = jax.vmap(jax.vmap(imagined))
    errors = jax.jit(both)(s[:, starts], data.u[:, along]) - data.reward[:, along]
    explained = 1 - jnp.square(errors).mean((0, 1)) / data.reward[:, along].var((0, 1))
    return [round(float(explained[j - 1]), 3) for j in AFTER]


def main() -> None:
    """The command."""
    given: Any = read(__doc__, ARGUMENTS)[0]
    out, robot, found = output("out", given["out"], (".json",)), Robot(), {}
    for seed in given["seeds"]:
        key_lived, *keys = jax.random.split(jax.random.key(seed), 1 + len(SEES))
        data = robot.lived(robot.expert, None, 0, given["episodes"], key_lived, 1.0)
        tests = given["episodes"] // 5
        kept, test = (
            jax.tree.map(lambda a, c=c: a[c], data) for c in (slice(tests, None), slice(tests))
        )
        for key, (sees, k) in zip(keys, SEES.items(), strict=True):
            own, spec = learner(sees, given["batch"])
            s, s_test = (jax.vmap(partial(seen, k))(each.obs, each.u) for each in (kept, test))
            state = learned(own, spec, s, kept, given["updates"], key)
            values = right(own, state, s_test, test)
            print(seed, sees, dict(zip(AFTER, values, strict=True)), flush=True)
            for j, value in zip(AFTER, values, strict=True):
                found.setdefault(sees, {}).setdefault(str(j), []).append(value)
        values = {"seeds": given["seeds"], "rewards": found}
        Path(out).write_text(json.dumps(values, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
