"""What the belief of one learner was at each time of its first episode of training.

The recorded decisions go once more through the run's own learners, with the run's own keys, without
controller and world. Another device than that of the run rounds differently, which may change
single moves of particles. The world is replayed from the recorded actions, for rendering only.
"""

from collections.abc import Iterator
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.core import ergodic, poses
from hybrid_rl.errors import UsageError
from hybrid_rl.thesis.studies.belief_panel import HALF, View, level
from hybrid_rl.thesis.studies.recorded import Recorded
from hybrid_rl.types import Params

GRID = 64  # cells a side
PARTICLES, SHADED = 20, 100  # of which outlines and p(y = 1) are drawn
BRIGHTEST = 5.0  # density, of mean one, at the end of the colour map


class Trial(NamedTuple):
    """The first episode of one learner: T decisions."""

    recorded: Recorded
    seed: int
    made: Any  # Transition [T, ...]
    learner: Any  # of the belief
    theta: Array | None  # [3] the pose of the objects; None: as they are listed

    @property
    def s(self) -> np.ndarray:
        """Positions [T, 2] after each decision."""
        return np.asarray(self.learner.domain.of(self.made.next_obs))


def trial_of(recorded: Recorded, seed: int, key: str = "runs") -> Trial:
    """The first episode of the learner of `seed`, in a run that the argument `key` named."""
    run, prefix = recorded.run, f"{key}={recorded.folder.path}:"
    if seed not in run.seeds:
        raise UsageError(f"seed={seed}: the run has {', '.join(map(str, run.seeds))}")
    learner: Any = run.agent.learners.get("belief")
    if learner is None or learner.domain.size != 2:
        raise UsageError(f"{prefix} learns no belief over two coordinates, which could be drawn")
    index = run.seeds.index(seed)
    if int(recorded.memory.count[index]) > recorded.memory.rows.shape[1]:
        raise UsageError(f"{prefix} lost its first decisions; train with a larger replay.capacity")
    if not recorded.decisions:
        raise UsageError(f"{prefix} has made no decision")
    made = jax.tree.map(lambda a: a[index], recorded.made)
    ended = np.flatnonzero(made.terminated + made.truncated)
    length = int(ended[0]) + 1 if len(ended) else len(made.reward)
    made = jax.tree.map(lambda a: a[:length], made)
    metrics = jax.jit(run.agent.init)(jax.random.key(seed)).env.metrics
    axes = [metrics[f"pose_{axis}"][0] for axis in ("x", "y", "angle") if "pose_x" in metrics]
    return Trial(recorded, seed, made, learner, jnp.stack(axes) if axes else None)


def beliefs(trial: Trial, marks: list[int]) -> Iterator[Any]:
    """The belief after each of these numbers of decisions, in rising order."""
    agent, rows = trial.recorded.run.agent, jax.tree.map(jnp.asarray, trial.made)

    def learn(state: Any, begin: Array, end: Array) -> Any:
        def one(i: Array, state: Any) -> Any:
            new = jax.tree.map(lambda a: a[i][None], rows)
            seen = state.replace(memory=agent.replay.add(state.memory, new))
            return agent.learn(seen, i)[0]

        return jax.lax.fori_loop(begin, end, one, state)

    part = jax.jit(learn, donate_argnums=0)
    state = jax.jit(agent.init)(jax.random.key(trial.seed))
    for begin, end in zip([0, *marks], marks, strict=False):
        state = part(state, jnp.int32(begin), jnp.int32(end))
        yield jax.tree.map(jnp.array, agent.params(state).belief)  # a copy: `state` is donated


def scenes(trial: Trial) -> tuple[np.ndarray, float]:
    """qpos [T+1, nq] of the replayed world, and how far it may be from the record.

    A device that rounds differently replays other collisions. A world whose `pose` reads the
    observation is drawn where it was; otherwise the second number is that of the observations.
    """
    agent = trial.recorded.run.agent
    pose = jax.vmap(agent.episode.env.pose)

    def go(key: Array, made: Any) -> tuple[Array, ...]:
        start = agent.init(key).env  # [1, ...]: rounding depends on `vmap`, too

        def step(state: Any, one: Any) -> tuple[Any, tuple[Array, ...]]:
            state = jax.vmap(agent.episode.step)(state, one.action[None])
            recorded = pose(state.replace(obs=one.next_obs[None]))
            return state, (recorded[0], pose(state)[0], state.obs[0])

        _, (recorded, qpos, obs) = jax.lax.scan(step, start, made)
        return *(jnp.concatenate([pose(start), each]) for each in (recorded, qpos)), obs

    replayed = jax.jit(go)(jax.random.key(trial.seed), trial.made)
    recorded, qpos, obs = map(np.asarray, replayed)
    apart = float(np.abs(obs - trial.made.next_obs).max())
    return recorded, apart if np.array_equal(recorded, qpos) else 0.0


def points(low: Any, high: Any, cells: int = GRID) -> np.ndarray:
    """Positions [cells^2, 2] of a grid, the first index along x."""
    sides = [np.linspace(a, b, cells) for a, b in zip(low, high, strict=True)]
    return np.stack(np.meshgrid(*sides, indexing="ij"), -1).reshape(-1, 2).astype(np.float32)


def truth(trial: Trial) -> list[np.ndarray]:
    """Where the robot's middle is in contact, as lines [k, 2]; none in a world without objects."""
    world: Any = trial.recorded.run.agent.episode.env
    if not hasattr(world, "distance"):
        return []
    domain = trial.learner.domain
    middle = (jnp.array(world.low) + jnp.array(world.high)) / 2

    def distance(s: Array) -> Array:
        s = s if trial.theta is None else poses.to_map(trial.theta, s, middle)
        return world.distance(s)

    fine = points(domain.low, domain.high, 4 * GRID)
    d = np.asarray(jax.jit(jax.vmap(distance))(fine)).reshape(4 * GRID, -1)
    return level(d, domain.low, domain.high, world.radius)


class Drawn:
    """What a panel shows of the beliefs of a trial.

    shading: "predicted", the mean of the belief's prediction, a probability of contact where it
    measures information; or "target", the density of the method's target, of mean one, over
    BRIGHTEST.
    """

    def __init__(self, trial: Trial, cells: int = GRID, shading: str = "predicted") -> None:
        self.trial, self.belief = trial, trial.learner.belief
        self.low, self.high = trial.learner.domain.low, trial.learner.domain.high
        self.binary = hasattr(self.belief, "informed")
        self._map: Any = getattr(self.belief, "map", None)
        self._edges = self._outline() if self._map is not None else []
        grid, of = jnp.asarray(points(self.low, self.high, cells)), self._predicted
        if shading == "target":
            of, share = self._target()

        def values(belief: Any) -> Array:
            if shading == "target":
                log_p = jax.lax.map(lambda s: of(belief, s), grid, batch_size=512)
                return len(log_p) * jnp.exp(ergodic.log_weights(log_p, share)) / BRIGHTEST
            if self._map is not None:
                drawn = poses.systematic(belief.log_w, SHADED, jnp.float32(0.5))
                belief = belief._replace(theta=belief.theta[drawn], log_w=jnp.zeros(SHADED))
            return jax.lax.map(lambda s: of(belief, s), grid, batch_size=512)

        self._values = jax.jit(values)
        self._cells, self._is_target = cells, shading == "target"

    @property
    def outlines(self) -> str:
        """What the lines of the belief are; empty without any."""
        names = HALF if self._map is None else f"{PARTICLES} particles"
        return names if self.binary else ""

    def limits(self, views: list[View]) -> tuple[float, float]:
        """The values at the ends of the colour map: probabilities, or those of all views."""
        if self.binary or self._is_target:
            return 0.0, 1.0
        values = [view.values for view in views if view.values is not None]
        return float(np.min(values)), float(np.max(values))

    def _predicted(self, belief: Any, s: Array) -> Array:
        return self.belief.predict(belief, s)[0]

    def _target(self) -> tuple[Any, float]:
        """log phi(belief, s) of the method's target, and the share of the uniform density."""
        recorded = self.trial.recorded
        part: Any = recorded.run.agent.controller
        part = getattr(part, "controller", part)  # inside its guard
        part = getattr(part, "objective", part)
        if not hasattr(part, "target"):
            raise UsageError(f"algo={recorded.config.algo}: has no target that could be drawn")
        density = part.target.log_density
        return lambda belief, s: density(Params(belief=belief), s), getattr(part, "share", 0.0)

    def _outline(self) -> list[np.ndarray]:
        """Lines [k, 2] of p = 1/2 in the frame of the belief's map."""
        middle = np.array(self._map.middle)
        half = (np.array(self.high) - np.array(self.low)) / 2
        low, high = middle - half, middle + half
        p = jax.jit(jax.vmap(self._map.chance))(points(low, high, 2 * GRID))
        return level(np.asarray(p).reshape(2 * GRID, -1), low, high, 0.5)

    def view(self, belief: Any, mark: int) -> View:
        """What to draw of the belief after `mark` decisions."""
        values = np.asarray(self._values(belief)).reshape(self._cells, -1)
        trial = self.trial
        first = np.asarray(trial.learner.domain.of(trial.made.obs[:1]))
        path = np.concatenate([first, trial.s[:mark]])
        contacts = trial.s[:mark][trial.made.reward[:mark] > 0.5] if self.binary else first[:0]
        return View(values, self._lines(belief, values), path, contacts)

    def _lines(self, belief: Any, values: np.ndarray) -> list[np.ndarray]:
        """The outlines [k, 2] of PARTICLES particles, or that of p = 1/2."""
        if self._map is None:
            return level(values, self.low, self.high, 0.5) if self.binary else []
        drawn = poses.systematic(belief.log_w, PARTICLES, jnp.float32(0.5))
        middle = np.array(self._map.middle)
        result = []
        for x, y, angle in np.asarray(belief.theta[drawn]):
            turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
            result += [(edge - middle) @ turn + np.array([x, y]) for edge in self._edges]
        return result
