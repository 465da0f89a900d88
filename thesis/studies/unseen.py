"""Data of a known world that no run has seen, a model fitted to them, and information under it.

box       uniform observations and actions of BOX
swing-up  episodes of the same planner with the exact model
loss      mean over the entries of (predicted - true change)^2 / variance of the change
"""

from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.flatten_util import ravel_pytree

from hybrid_rl.core import fisher
from hybrid_rl.networks import mean_weights, precision
from hybrid_rl.settings.build import Run, build, load
from hybrid_rl.training.rollout import rollout_with_actions
from hybrid_rl.types import Batch, Params

BOX = np.array([[-1.0, 7.3], [-2.0, 2.0], [-10.0, 10.0], [-5.0, 5.0]])  # th, x, th', x'
EXACT = ("+model@known_model=exact", "shooting_planner.model=${known_model}")
ROWS = 256  # transitions of an Adam step
CHUNK = 256  # transitions whose derivatives are computed together


class Unseen(NamedTuple):
    """Transitions, and the costs of the exact model."""

    box: Batch  # [B]
    swing_up: Batch  # [B]
    cost: np.ndarray  # [E] cost per decision of the exact model's episodes
    upright: np.ndarray  # [E, L] cos th after each decision


def transitions(obs: Array, action: Array, after: Array) -> Batch:
    """A batch [B] in which no episode ends and no reward is known."""
    no = jnp.zeros(len(obs))
    return Batch(obs, action, no, no, no, after)


def collect(experiment: str, size: int, episodes: int, seed: int) -> Unseen:
    """`size` transitions of the box, and `episodes` of the exact model with known_mpc's planner."""
    run = build(load([f"experiment={experiment}", "algo=known_mpc", *EXACT]))
    world: Any = run.agent.episode.env
    for_obs, for_action, keys = jax.random.split(jax.random.key(seed), 3)
    low, high = jnp.asarray(BOX, jnp.float32).T
    obs = jax.random.uniform(for_obs, (size, len(BOX)), minval=low, maxval=high)
    u = jax.random.uniform(for_action, (size, run.agent.spec.act), minval=-1, maxval=1)
    box = transitions(obs, u, jax.jit(jax.vmap(world.dynamics))(obs, u))
    length = run.agent.episode.steps
    one = partial(rollout_with_actions, run.agent.episode, run.controllers["full"])
    fly = jax.jit(jax.vmap(lambda key: one(Params(model=()), key, length)))
    actions, states = fly(jax.random.split(keys, episodes))
    x, o = states.obs, states.obs.shape[-1]
    flat = (x[:, :-1].reshape(-1, o), actions.reshape(-1, u.shape[-1]), x[:, 1:].reshape(-1, o))
    cost = -np.asarray(states.reward[:, 1:]).mean(1)
    return Unseen(box, transitions(*flat), cost, np.cos(x[:, 1:, 0]))


def loss(model: Any, params: Any, data: Batch) -> Array:
    """The loss [] (see the module) of a model with `params` on data [B]."""
    predicted = jax.vmap(model.step, (None, 0, 0))(params, data.obs, data.action)
    variance = jnp.var(data.next_obs - data.obs, axis=0)
    return jnp.mean((predicted - data.next_obs) ** 2 / variance[None])


def fitted(run: Run, data: Batch, updates: int, key: Array) -> Any:
    """The parameters of `run`'s kind of model after Adam steps on data [B]. The key is consumed."""
    learner: Any = run.agent.learners["model"]
    first, drawing = jax.random.split(key)

    def one(state: Any, key: Array) -> tuple[Any, None]:
        rows = jax.random.randint(key, (ROWS,), 0, len(data.obs))
        batch = jax.tree.map(lambda x: x[rows], data)
        return learner.update(state, Params(), batch, key)[0], None

    start = learner.init(first, run.agent.spec)
    return jax.lax.scan(one, start, jax.random.split(drawing, updates))[0].model


def derivatives(model: Any, params: Any, sigma: float, obs: Any, action: Any) -> np.ndarray:
    """F / sigma [B, n, P] of the reference model at transitions [B]."""
    theta = mean_weights.of(params)

    @jax.jit
    def chunk(x: Array, u: Array) -> Array:
        def one(x: Array, u: Array) -> Array:
            def f(theta: Any) -> Array:
                return model.step(mean_weights.replaced(params, theta), x, u)

            noise = mean_weights.noise(model, params, x, sigma)
            with precision.using("float32"):
                return fisher.jacobian(f, theta) / noise[:, None]

        return jax.vmap(one)(x, u)

    size = ravel_pytree(theta)[0].size
    result = np.empty((len(obs), obs.shape[-1], size), np.float32)
    for i in range(0, len(obs), CHUNK):
        result[i : i + CHUNK] = chunk(obs[i : i + CHUNK], action[i : i + CHUNK])
    return result


def information(F: np.ndarray, ends: np.ndarray, floor: float) -> dict[str, np.ndarray]:
    """log det, diagonal and full, and trace of I [G] at the ends [G] of F / sigma [T, n, P]."""
    P = F.shape[-1]
    total, begin, rows = floor * np.eye(P), 0, []
    for end in ends:
        part = F[begin:end].reshape(-1, P).astype(float)
        total, begin = total + part.T @ part, end
        diagonal = np.diag(total)
        rows.append((np.log(diagonal).sum(), np.linalg.slogdet(total)[1], diagonal.sum()))
    names = ("log_det_diagonal", "log_det", "trace")
    return dict(zip(names, np.array(rows).T, strict=True))
