"""What positions and past actions say of a robot's velocities, and of what to do.

    python -m scripts.hidden_velocities out=hidden_velocities.json

The package's half-cheetah sees positions and velocities. Students see positions alone, the last k
of them and the actions between (`core.history`), or all of an episode by a GRU; they learn to act
as it does, in the end where they themselves acted (DAgger; Ross et al. 2011). `returns`: of 1,000
decisions without noise. `random`, `student`: R^2 in episodes that were not learned from, of the
`forward` velocity of the root, of the `others` (mean), and of the mean forward speed in the `next`
decision, from what is seen and the action; `rmse` [m/s]: of the forward velocity. The episodes,
with noise: uniform actions, and the student of three observations, whose actions depend on nothing
that it did not see. Every list is over seeds.
"""

import json
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import optax
from flax import linen as nn
from jax import Array

from hybrid_rl.cli.arguments import Argument, numbers, output, read, whole
from hybrid_rl.core import history
from hybrid_rl.networks import MLP
from hybrid_rl.run import saved

ARGUMENTS = (
    Argument("seeds", [0, 1, 2], "independent", numbers(whole(0))),
    Argument(
        "episodes", 240, "of each kind; a sixth tests, a fifth of the rest validates", whole(8)
    ),
    Argument("updates", 2000, "of each network", whole(80)),
    Argument("out", "", "JSON", needed="out=FILE.json"),
)
SEES = {"all": 0, "positions": 1, **{f"history={k}": k for k in (2, 3, 8, 16)}, "GRU": 2}
STUDENTS = ("all", "positions", "history=3", "history=8", "GRU")
LENGTH, BATCH, CHECKS, ROUNDS, NOISE = 250, 4, 20, 8, 0.3
POSITIONS, ACTIONS, DT = 8, 6, 0.05
CELL, STILL = nn.GRUCell(128), jnp.zeros(128)
Act = Callable[..., tuple[Array, Array]]  # parameters, hidden, x, key -> next hidden, action


class Lived(NamedTuple):
    """Of each decision: what is observed, the action, and what follows."""

    obs: Array  # [17]
    u: Array  # [6]
    speed: Array  # [] [m/s]
    reward: Array  # []


def first(k: int, obs: Array) -> Array:
    """x [d] at the first observation, of k positions and the actions between; k = 0: all."""
    size = k * (POSITIONS + ACTIONS) - ACTIONS
    return history.first(obs[:POSITIONS], size) if k else obs


def onward(k: int, x: Array, u: Array, obs: Array) -> Array:
    """x after action u at x led to obs."""
    return history.shifted(x, u, obs[:POSITIONS], DT) if k else obs


def seen(k: int, obs: Array, u: Array) -> Array:
    """x [T, d] in an episode."""

    def then(x: Array, now: tuple[Array, Array]) -> tuple[Array, Array]:
        return (x := onward(k, x, *now)), x

    x = first(k, obs[0])
    return jnp.concatenate((x[None], jax.lax.scan(then, x, (u[:-1], obs[1:]))[1]))


def network(params: Any, hidden: Array, x: Array) -> tuple[Array, Array]:
    """The next hidden state [128] and y [T, q] for x [T, d]."""
    x, (mean, scale) = (x - params["x"][0]) / params["x"][1], params["y"]
    if params["cell"] is not None:
        cell: Any = partial(CELL.apply, params["cell"])
        hidden, x = jax.lax.scan(cell, hidden, x)
    y: Any = MLP((256, 256), mean.size, "silu").apply(params["out"], x)
    return hidden, mean + scale * y


def weights(x: Array, q: int, recurrent: bool, key: Array) -> Any:
    """Initial ones for x [d] and q outputs. The key is consumed."""
    key_cell, key_out = jax.random.split(key)
    cell = CELL.init(key_cell, STILL, x) if recurrent else None
    return {"cell": cell, "out": MLP((256, 256), q).init(key_out, STILL if recurrent else x)}


@partial(jax.jit, static_argnums=3)
def fitted(begin: Any, x: Array, y: Array, updates: int, key: Array) -> Any:
    """Parameters for y [E, T, q] of x [E, T, d], from weights `begin`; the best on a fifth of E."""
    key_order, key = jax.random.split(key)
    order, learned = jax.random.permutation(key_order, len(x)), len(x) * 4 // 5
    x, y, adam = x[order], y[order], optax.adam(optax.cosine_decay_schedule(1e-3, updates))
    scales = {
        n: (a.mean((0, 1))[None], a.std((0, 1))[None] + 1e-6) for n, a in (("x", x), ("y", y))
    }

    def error(weights: Any, x: Array, y: Array) -> Array:
        guess = jax.vmap(lambda x: network(scales | weights, STILL, x)[1])(x)
        return jnp.square((guess - y) / scales["y"][1][None]).mean()

    def update(state: Any, key: Array) -> tuple[Any, None]:
        i = jax.random.randint(key, (BATCH,), 0, learned)
        step, adam_state = adam.update(jax.grad(error)(state[0], x[i], y[i]), state[1])
        return (optax.apply_updates(state[0], step), adam_state), None

    def check(carry: Any, keys: Array) -> tuple[Any, None]:
        state, best, least = carry
        state, _ = jax.lax.scan(update, state, keys)
        now = error(state[0], x[learned:], y[learned:])
        best = jax.tree.map(lambda old, new: jnp.where(now < least, new, old), best, state[0])
        return (state, best, jnp.minimum(least, now)), None

    keys = jax.random.split(key, (CHECKS, updates // CHECKS))
    start = (begin, adam.init(begin)), begin, jnp.inf
    return scales | jax.lax.scan(check, start, keys)[0][1]


def student(params: Any, hidden: Array, x: Array, key: Array) -> tuple[Array, Array]:
    """Act by a network."""
    hidden, u = network(params, hidden, x[None])
    return hidden, u[0]


def anything(params: Any, hidden: Array, x: Array, key: Array) -> tuple[Array, Array]:
    """A uniform action."""
    return hidden, jax.random.uniform(key, (ACTIONS,), minval=-1, maxval=1)


class Robot:
    """The half-cheetah of the package."""

    def __init__(self) -> None:
        trained = saved.read("halfcheetah")
        self.episode, (controller, params) = trained.episode, trained.learner(None, "policy")
        still = jax.random.key(0)  # the policy draws nothing
        self.policy = lambda obs: controller.act(params, (), obs, still)[0]
        one = jax.vmap(self._lived, (None, None, None, None, 0, 0))
        self._lived_each = jax.jit(one, static_argnums=(0, 2, 3))

    def expert(self, params: Any, hidden: Array, x: Array, key: Array) -> tuple[Array, Array]:
        """Act by the policy, of all that is observed."""
        return hidden, self.policy(x)

    def lived(
        self, act: Act, params: Any, k: int, count: int, key: Array, most: float = NOISE
    ) -> Lived:
        """Episodes [count, T], each with noise of a level up to `most`; 0: whole ones.

        k: what `act` sees. The key is consumed.
        """
        key_noise, key = jax.random.split(key)
        noise = jax.random.uniform(key_noise, (count,), maxval=most)
        length = LENGTH if most else self.episode.steps
        return self._lived_each(act, params, k, length, noise, jax.random.split(key, count))

    def _lived(self, act: Act, params: Any, k: int, length: int, noise: Array, key: Array) -> Lived:
        def decide(carry: Any, key: Array) -> tuple[Any, Lived]:
            (state, x, hidden), (key_act, key_noise) = carry, jax.random.split(key)
            hidden, u = act(params, hidden, x, key_act)
            u = jnp.clip(u + noise * jax.random.normal(key_noise, u.shape), -1, 1)
            after = self.episode.step(state, u)
            row = Lived(state.obs, u, after.metrics["speed"], after.reward)
            return (after, onward(k, x, u, after.obs), hidden), row

        key_reset, key = jax.random.split(key)
        state = self.episode.reset(key_reset)
        start = state, first(k, state.obs), STILL
        return jax.lax.scan(decide, start, jax.random.split(key, length))[1]

    def taught(self, sees: str, count: int, updates: int, key: Array) -> Any:
        """Parameters of a student, of `count` episodes, in the end seven eighths its own."""
        key_lived, key_weights, key = jax.random.split(key, 3)
        k, part = SEES[sees], count // ROUNDS
        data, params = self.lived(self.expert, None, 0, count, key_lived), None
        begin = weights(first(k, data.obs[0, 0]), ACTIONS, sees == "GRU", key_weights)
        for i, key_round in enumerate(jax.random.split(key, ROUNDS)):
            key_lived, key_fit = jax.random.split(key_round)
            if i:
                new, own = self.lived(student, params, k, part, key_lived), i * part
                data = jax.tree.map(lambda a, b, i=own: a.at[i : i + part].set(b), data, new)
            x = jax.vmap(partial(seen, k))(data.obs, data.u)
            wanted = jax.vmap(jax.vmap(self.policy))(data.obs)
            params = fitted(begin, x, wanted, updates // 4, key_fit)
            begin = {name: params[name] for name in begin}
        return params


def explained(data: Lived, sees: str, updates: int, key: Array) -> dict[str, float]:
    """R^2 of what is not seen, and the error of the forward velocity. The key is consumed."""
    key_weights, key = jax.random.split(key)
    x = jax.vmap(partial(seen, SEES[sees]))(data.obs, data.u)
    x = jnp.concatenate((x, data.u), 2)
    y = jnp.concatenate((data.obs[..., POSITIONS:], data.speed[..., None]), 2)
    learned, begin = len(x) * 5 // 6, weights(x[0, 0], y.shape[2], sees == "GRU", key_weights)
    params = fitted(begin, x[:learned], y[:learned], updates, key)
    guess = jax.vmap(lambda x: network(params, STILL, x)[1])(x[learned:])
    error = jnp.square(guess - y[learned:]).mean((0, 1))
    r2 = 1 - error / y[learned:].var((0, 1))
    found = {"forward": r2[0], "others": r2[1:-1].mean(), "next": r2[-1], "rmse": error[0] ** 0.5}
    return {name: round(float(value), 4) for name, value in found.items()}


def main() -> None:
    """The command."""
    given: Any = read(__doc__, ARGUMENTS)[0]
    out, robot = output("out", given["out"], (".json",)), Robot()
    count, updates = given["episodes"], given["updates"]
    found: Any = {"seeds": given["seeds"], "returns": {}, "random": {}, "student": {}}
    for seed in given["seeds"]:
        keys = iter(jax.random.split(jax.random.key(seed), 40))
        acting: dict[str, Any] = {"random": (anything, None, 0)}
        for sees in STUDENTS:
            params = robot.taught(sees, count, updates, next(keys))
            lived = robot.lived(student, params, SEES[sees], 10, next(keys), 0.0)
            paid = round(float(lived.reward.sum(1).mean()), 1)
            found["returns"].setdefault(sees, []).append(paid)
            print(seed, sees, paid, flush=True)
            if sees == "history=3":
                acting["student"] = student, params, SEES[sees]
        for kind, (act, params, k) in acting.items():
            data = robot.lived(act, params, k, count, next(keys))
            for sees in SEES:
                values = explained(data, sees, updates, next(keys))
                for name, value in values.items():
                    found[kind].setdefault(sees, {}).setdefault(name, []).append(value)
                print(seed, kind, sees, values, flush=True)
        Path(out).write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
