"""How exactly learned models predict a block that Sawyer pushes, by what they observe.

    python thesis/scripts/contact_error.py --out docs/results/sawyer_model.json

Every model learns from the same recorded episodes and is tested on others. In a third of the
episodes the scripted expert acts, with noise; in the others correlated noise and a pull towards the
block. Errors are those of the block's position [mm]: after one decision that moved it by more than
0.5 mm (contact), after one that did not (free), and after 10 and 20 decisions of the recorded
actions in which it moved by more than 1 cm and the rod stayed inside the workspace.
"""

import argparse
import json
from pathlib import Path
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.envs.experts.push import PushController
from hybrid_rl.envs.sawyer_push import EXTRA, Extra, SawyerPush
from hybrid_rl.learners.model import ModelLearner
from hybrid_rl.models.ensemble import Ensemble
from hybrid_rl.models.gaussian import Gaussian
from hybrid_rl.models.turned import Turned
from hybrid_rl.types import Batch, Params

DECISIONS = 6_000  # that models learn from
EPISODES, LENGTH = 90, 100
STEPS, BATCH = 6_000, 256  # gradient steps, and transitions of each member in a step
AHEAD = (10, 20)
ALL = SawyerPush("native", reward="code", extra=tuple(EXTRA))
COLUMNS = {"command": (4, 5), "turn": (6, 7), "motion": (8, 9, 10), "tip": (11, 12)}


class Case(NamedTuple):
    """What a model observes and what its networks see."""

    name: str
    extra: tuple[Extra, ...] = ()
    target: bool = True  # the networks see where the target is
    frame: bool = False  # of the block


CASES = (
    Case("the thesis' four numbers"),
    Case("command", ("command",)),
    Case("command, turn", ("command", "turn")),
    Case("all", tuple(EXTRA)),
    Case("command, without the target", ("command",), target=False),
    Case("command, turn, without the target", ("command", "turn"), target=False),
    Case("command, turn, in the block's frame", ("command", "turn"), target=False, frame=True),
    Case(
        "command, turn, motion, in the block's frame",
        ("command", "turn", "motion"),
        target=False,
        frame=True,
    ),
)


class Episodes(NamedTuple):
    """N recorded episodes of T decisions."""

    obs: Array  # [N, T, 13]
    action: Array  # [N, T, 2]
    after: Array  # [N, T, 13]
    over: Array  # [N, T] bool: the episode had ended before


def record(key: Array, count: int) -> Episodes:
    """`count` episodes. The key is consumed."""
    expert = PushController()

    def episode(key: Array) -> Any:
        resetting, choosing, acting = jax.random.split(key, 3)
        state = ALL.reset(resetting)
        by_expert = jax.random.uniform(choosing) < 1 / 3

        def decide(carry: Any, key: Array) -> Any:
            state, e = carry
            e = 0.9 * e + jnp.sqrt(1 - 0.81) * jax.random.normal(key, (2,))
            taught = expert.act(Params(), state.info["velocity"], state.obs[:4], key)[0]
            pull = state.obs[:2] / (jnp.linalg.norm(state.obs[:2]) + 1e-6)
            u = jnp.where(by_expert, taught + 0.5 * e, 0.3 * pull + 0.8 * e)
            u = jnp.clip(u, -1, 1)
            after = ALL.step(state, u)
            row = Episodes(state.obs, u, after.obs, state.done)
            held = jax.tree.map(lambda old, new: jnp.where(state.done, old, new), state, after)
            return (held, e), row

        keys = jax.random.split(acting, LENGTH)
        return jax.lax.scan(decide, (state, jnp.zeros(2)), keys)[1]

    return jax.jit(jax.vmap(episode))(jax.random.split(key, count))


def seen(case: Case, data: Episodes) -> Episodes:
    """The episodes with the entries that the case observes."""
    columns = jnp.array([*range(4), *(i for name in case.extra for i in COLUMNS[name])])
    return data._replace(obs=data.obs[..., columns], after=data.after[..., columns])


def learned(case: Case, data: Episodes, key: Array) -> tuple[Any, Any]:
    """A model of the case and its parameters. The key is consumed."""
    env: Any = SawyerPush("native", extra=case.extra)
    size = env.spec.obs
    inputs = None if case.target else tuple(i for i in range(size) if i not in (2, 3))
    one: Any = Gaussian((128, 128), "silu", inputs=inputs)
    model: Any = Ensemble(one, members=3)
    model = Turned(model, env) if case.frame else model
    learner = ModelLearner(model, learning_rate=1e-3, batch_size=BATCH)
    live = ~np.asarray(data.over)
    x, u, after = (jnp.asarray(np.asarray(a)[live][:DECISIONS]) for a in data[:3])
    starting, drawing = jax.random.split(key)

    def step(state: Any, key: Array) -> tuple[Any, None]:
        i = jax.random.randint(key, (model.members * BATCH,), 0, len(x))
        none = jnp.zeros(len(i))
        batch = Batch(x[i], u[i], none, none, none, after[i])
        return learner.update(state, Params(), batch, key)[0], None

    keys = jax.random.split(drawing, STEPS)
    state = jax.jit(lambda s: jax.lax.scan(step, s, keys)[0])(learner.init(starting, env.spec))
    return model, learner.params(state)["model"]


def errors(model: Any, params: Any, data: Episodes, inside: np.ndarray) -> dict[str, float]:
    """Mean errors [mm] of the block's position; inside [N, T]: the rod is in the workspace."""

    def ahead(x: Array, actions: Array) -> Array:
        return jax.lax.scan(lambda x, u: (model.step(params, x, u), None), x, actions)[0]

    def apart(a: Array, b: Array) -> np.ndarray:
        return 100 * np.linalg.norm(np.asarray(a - b)[..., 2:4], axis=-1)

    one = jax.jit(jax.vmap(jax.vmap(lambda x, u: model.step(params, x, u))))(data.obs, data.action)
    moved, live = apart(data.after, data.obs), ~np.asarray(data.over)
    wrong, contact = apart(one, data.after), moved > 0.5
    rows = {"contact": wrong[live & contact].mean(), "free": wrong[live & ~contact].mean()}
    for steps in AHEAD:
        starts = [
            (n, t)
            for n in range(len(live))
            for t in range(0, LENGTH - steps, 3)
            if live[n, t + steps - 1] and inside[n, t : t + steps].all()
        ]
        n, t = np.array(starts).T
        actions = jnp.stack([data.action[i, j : j + steps] for i, j in starts])
        last, first = data.after[n, t + steps - 1], data.obs[n, t]
        end = jax.jit(jax.vmap(ahead))(first, actions)
        far = apart(last, first) > 10
        rows[f"ahead_{steps}"] = apart(end, last)[far].mean()
        rows[f"moved_{steps}"] = apart(last, first)[far].mean()
    return {name: round(float(value), 3) for name, value in rows.items()}


def main() -> None:
    """Measure all cases and write the JSON."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--seeds", type=int, default=3)
    given = parser.parse_args()
    rows: dict[str, Any] = {case.name: [] for case in CASES}
    for seed in range(given.seeds):
        to_learn, to_test, learning = jax.random.split(jax.random.key(seed), 3)
        train, test = record(to_learn, EPISODES), record(to_test, EPISODES)
        inside = np.abs(np.asarray(test.after[..., 11:13])).max(-1) < 0.97
        for case in CASES:
            model, params = learned(case, seen(case, train), learning)
            rows[case.name].append(errors(model, params, seen(case, test), inside))
            print(seed, case.name, rows[case.name][-1], flush=True)
    given.out.write_text(json.dumps({"decisions": DECISIONS, "mm": rows}, indent=1) + "\n")


if __name__ == "__main__":
    main()
