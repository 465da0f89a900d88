"""Trajectories of a controller, and estimates of their time average."""

from typing import Any

import numpy as np

from hybrid_rl.settings.build import Run

GRID = 100  # cells a side of the unit square
VARIANCE = 0.005  # [m^2] of the Gaussians in the time average q


def trajectories(run: Run, seeds: int, steps: int) -> np.ndarray:
    """Trajectories [seeds, steps+1, v] of the search states, without learning."""
    import jax

    from hybrid_rl.training.rollout import rollout_with_actions
    from hybrid_rl.types import Params

    controller = run.controllers["full"]

    def one(key: Any) -> Any:
        return rollout_with_actions(run.agent.episode, controller, Params(), key, steps)[1].obs

    obs = jax.jit(jax.vmap(one))(jax.random.split(jax.random.key(run.config.seed), seeds))
    return np.asarray(objective(run).domain.of(obs))


def objective(run: Run) -> Any:
    """The objective of an explorer, which has a target and a domain."""
    controller: Any = run.agent.controller
    return controller.controller.objective  # inside its guard


def log_density(run: Run, s: Any) -> Any:
    """log p [N] of the run's target."""
    import jax

    from hybrid_rl.types import Params

    return jax.vmap(objective(run).target.log_density, (None, 0))(Params(), s)


def divergences(run: Run, x: np.ndarray, count: int = 2000) -> np.ndarray:
    """D(p || q) [T] [nat] after each step of x [T+1, v], at `count` points that do not change."""
    import jax
    import jax.numpy as jnp

    domain = objective(run).domain
    s = domain.sample(count, jax.random.key(0))
    log_p = jax.nn.log_softmax(log_density(run, s))
    sides = jnp.array(domain.high) - jnp.array(domain.low)
    squares = (s[:, None] - jnp.asarray(x)[None]) ** 2 / (VARIANCE * sides**2)[None, None]
    log_scale = 0.5 * jnp.sum(jnp.log(2 * jnp.pi * VARIANCE * sides**2))
    log_each = -0.5 * jnp.sum(squares, -1) - log_scale
    log_sum = jax.lax.cumlogsumexp(log_each, axis=1)
    log_q = jnp.logaddexp(log_sum - jnp.log(jnp.arange(1, len(x) + 1))[None], jnp.log(1e-6))
    relative = log_p + jnp.log(count / jnp.prod(sides))
    return np.asarray(jnp.exp(log_p) @ (relative[:, None] - log_q))[1:]


def averages(x: np.ndarray) -> dict[str, np.ndarray]:
    """Estimates [GRID, GRID] of the time average of x [M, 2], by name."""
    import jax.numpy as jnp

    from hybrid_rl.core import ergodic

    s, path, unit = jnp.asarray(grid()), jnp.asarray(x), ((0.0, 0.0), (1.0, 1.0))
    raw = np.histogram2d(x[:, 1], x[:, 0], bins=25, range=[[0, 1], [0, 1]])[0]
    c = ergodic.cosines(path, *unit, 20).mean(0)
    mean_square = jnp.mean(jnp.sum((s[:, None] - path[None]) ** 2, -1), 1)
    return {
        "raw: cells visited": np.kron(raw, np.ones((4, 4))) / raw.mean(),
        "Fourier, 20 cosines a side": on_grid(ergodic.cosines(s, *unit, 20) @ c),
        "sum of Gaussians (6.1)": on_grid(jnp.exp(ergodic.log_sum(s, path, jnp.full(2, VARIANCE)))),
        "Jensen's bound (6.17)": on_grid(jnp.exp(-0.5 * mean_square / VARIANCE)),
    }


def grid() -> np.ndarray:
    """Points [GRID^2, 2] of the unit square."""
    side = (np.arange(GRID) + 0.5) / GRID
    return np.stack(np.meshgrid(side, side, indexing="xy"), -1).reshape(-1, 2)


def on_grid(density: Any) -> np.ndarray:
    """A density on the grid [GRID^2] as [GRID, GRID], of mean one."""
    density = np.asarray(density).reshape(GRID, GRID)
    return density / np.abs(density).mean()


def histogram(
    values: np.ndarray, edges: np.ndarray, weights: np.ndarray | None = None
) -> np.ndarray:
    """Density [B] of values [N] in bins; values outside all bins do not count."""
    density = np.histogram(values, edges, weights=weights)[0]
    return density / max(density.sum() * (edges[1] - edges[0]), 1e-12)
