"""The host's side of a run: decide, log, evaluate, save, until the end or a signal.

Strides end at the multiples of `log_every`, `eval_every` and `checkpoint_every`, and there
alone a signal is heard: a run that was stopped and resumed has the rows of one that was not.
"""

import signal
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from time import monotonic, perf_counter
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.training import checkpoint, provenance, rows
from hybrid_rl.training.evaluate import evaluation_keys, outcomes
from hybrid_rl.training.log import RunLog
from hybrid_rl.training.loop import SEEDS, Loop
from hybrid_rl.training.progress import Progress
from hybrid_rl.types import Controller, Params

EVALUATED = {  # mode -> what its outcomes' names begin with
    "full": "eval/",
    "policy": "eval/policy_",
    "planner": "eval/planner_",
}


@dataclass(frozen=True)
class Schedule:
    """What happens when, in decisions of each learner."""

    total_steps: int
    log_every: int
    eval_every: int
    eval_episodes: int
    eval_modes: tuple[str, ...]
    checkpoint_every: int
    checkpoint_replay: bool


@dataclass
class Session:
    """One run on its way."""

    loop: Loop
    controllers: Mapping[str, Controller]  # mode -> controller without exploration
    schedule: Schedule
    log: RunLog
    progress: Progress
    state: Any = None  # AgentState [S, ...], once begun
    step: int = 0  # decisions of each learner
    before_s: float = 0.0  # [s] in earlier sessions
    began: float = field(default_factory=monotonic)
    returns: list[list[tuple[int, float]]] = field(default_factory=list)  # per seed: (step, return)
    latest: dict[str, float] = field(default_factory=dict)  # for the display
    evaluators: dict[str, Any] = field(default_factory=dict)  # mode -> compiled
    stop: int | None = None  # the signal that asked for an end
    known: set[int] = field(default_factory=set)  # checkpoints that this session may delete

    @property
    def wall_s(self) -> float:
        """[s] over all sessions of the run."""
        return self.before_s + monotonic() - self.began

    @property
    def _checkpoints(self) -> Path:
        return self.log.run_dir / "checkpoints"

    def begin(self) -> None:
        """Start from the first state."""
        self.state = self.loop.init()
        self.returns = [[] for _ in self.loop.seeds]

    def resume(self) -> None:
        """Start from the newest sound checkpoint.

        Raises:
            CheckpointError: where there is none, or it is of another run.
        """
        self.known = set(checkpoint.steps(self._checkpoints))
        like = jax.eval_shape(self.loop.init).replace(memory=None)
        found = checkpoint.restore(self._checkpoints, like, part=True)
        self.step, self.state, meta, notes = found
        if self.schedule.checkpoint_replay:
            self.state = self.state.replace(memory=self._remembered(meta["capacity"]))
        else:
            self.loop.agent = replace(self.loop.agent, first_update=self.step)
            self.state = self.state.replace(memory=self.loop.init().memory)
            notes = [*notes, "no replay memory in checkpoints: it goes on, but not bit for bit"]
        for note in [*notes, *self.log.rewind(meta["metrics_bytes"], self.step)]:
            self.progress.note(note)
        self.state = self.loop.place(self.state)
        self.before_s = meta["wall_s"]
        self.returns = [[(at, value) for at, value in pairs] for pairs in meta["returns"]]
        self.progress.note(f"going on from step {self.step:,}")

    def _remembered(self, capacity: int) -> Any:
        """The checkpoint's replay memory, which held `capacity`, in the size that it has now.

        A longer run has a larger one. What was bounded by the run's length has not come round
        yet, so that new rows at its end are all that it takes.
        """
        agent = self.loop.agent
        then = replace(agent, replay=replace(agent.replay, capacity=capacity))
        like = jax.eval_shape(replace(self.loop, agent=then).init)
        alone = like.replace(env=None, control=None, learners=None, key=None)
        memory = checkpoint.restore(self._checkpoints, alone, self.step, part=True)[1].memory

        def grown(old: jax.Array, now: Any) -> jax.Array:
            ends = zip(old.shape, now.shape, strict=True)
            return jnp.pad(old, [(0, size - filled) for filled, size in ends])

        return jax.tree.map(grown, memory, jax.eval_shape(self.loop.init).memory)

    def run(self) -> None:
        """Advance to the end or to a signal; the last state is always saved.

        Raises:
            DivergenceError: where a learner reached NaN or infinity.
            CheckpointError: where a checkpoint could not be written.
            MemoryError: where a device has too little memory for the learners.
        """
        if self.step >= self.schedule.total_steps:
            return
        with self._signals():
            self.progress.note(f"compiling on {provenance.device()} ...{self._idle()}")
            program = self.loop.compile(self.state)
            self.progress.note(f"compiled in {self.loop.compile_s:.1f} s")
            self._check_memory(program)
            saved = None
            while self.step < self.schedule.total_steps and self.stop is None:
                self._stride(program)
                if self.stop is not None:
                    self.progress.note("stopping, with a checkpoint ...")
                if self._due(self.schedule.eval_every):
                    self._evaluate()
                if self._due(self.schedule.checkpoint_every):
                    self._save()
                    saved = self.step
            if saved != self.step:
                self._save()

    def _check_memory(self, program: Any) -> None:
        """Raise MemoryError, with how many learners would fit, where these do not."""
        need, have = self.loop.memory(program), provenance.memory()
        if need > have:
            learners = len(self.loop.seeds)
            raise MemoryError(
                f"num_seeds={learners}: the program would take {need / 1e9:,.1f} GB of a device "
                f"and there are {have / 1e9:,.1f} GB; about {int(learners * have / need)} would fit"
            )

    def _idle(self) -> str:
        """What to say where the learners do not divide among the devices."""
        used, there = self.loop.mesh.size, jax.local_device_count()
        if used == there:
            return ""
        learners = len(self.loop.seeds)
        return f" {learners} learners divide evenly over {used} of its {there} devices only"

    def _due(self, every: int) -> bool:
        """Whether a multiple of `every`, or the end, lies in the last round."""
        before = self.step - self.loop.agent.num_envs
        return self.step // every > before // every or self.step >= self.schedule.total_steps

    @contextmanager
    def _signals(self) -> Iterator[None]:
        """Ctrl-C and SIGTERM ask for an end at the next row; a second Ctrl-C ends at once."""

        def ask(number: int, frame: Any) -> None:
            if self.stop == number == signal.SIGINT:
                raise KeyboardInterrupt
            self.stop = number

        old = {s: signal.signal(s, ask) for s in (signal.SIGINT, signal.SIGTERM)}
        try:
            yield
        finally:
            for number, handler in old.items():
                signal.signal(number, handler)

    def _stride(self, program: Any) -> None:
        """Decisions up to the next mark, and their rows."""
        plan, worlds, seeds = self.schedule, self.loop.agent.num_envs, self.loop.seeds
        start = self.step
        marks = [
            (start // every + 1) * every
            for every in (plan.log_every, plan.eval_every, plan.checkpoint_every)
        ]
        rounds = -(-(min(plan.total_steps, *marks) - start) // worlds)
        began = perf_counter()
        self.state, metrics = program(self.state, jnp.int32(start), jnp.int32(rounds))
        metrics = {name: np.asarray(m)[:rounds] for name, m in metrics.items()}
        speed = rounds * worlds * len(seeds) / (perf_counter() - began)
        rows.check(metrics, seeds, start, worlds)
        self.step += rounds * worlds
        episodes = rows.episodes(metrics, seeds, start, worlds)
        for row in episodes:
            pair = (row["step"], float(row["train/return"]))
            self.returns[seeds.index(row["seed"])].append(pair)
        means = rows.means(metrics, seeds, self.step)
        perf = {"perf/env_steps_per_s": speed, "perf/compile_s": self.loop.compile_s}
        self._write(episodes + [row | perf for row in means])
        newest = [pairs[-1][1] for pairs in self.returns if pairs]
        shown = {"train/return": float(np.mean(newest))} if newest else {}
        self._show(shown | {"perf/env_steps_per_s": speed})

    def _evaluate(self) -> None:
        """Outcomes of every evaluated mode, with keys of their own."""
        seeds, agent = self.loop.seeds, self.loop.agent
        params = jax.vmap(agent.params)(self.state)
        keys = jnp.stack([evaluation_keys(s, self.schedule.eval_episodes) for s in seeds])
        found = [{"step": self.step, "seed": seed} for seed in seeds]
        for mode in self.schedule.eval_modes:
            for name, got in self._evaluator(mode, params, keys)(params, keys).items():
                means = np.asarray(got).mean(-1)
                for row, value in zip(found, means, strict=True):
                    row[EVALUATED[mode] + name] = value
                self._show({EVALUATED[mode] + name: float(means.mean())})
        self._write(found)

    def _evaluator(self, mode: str, params: Params, keys: jax.Array) -> Any:
        """The compiled program (params, keys) -> outcomes [S, N] of `mode`."""
        if mode not in self.evaluators:
            began = perf_counter()
            one = partial(outcomes, self.loop.agent.episode, self.controllers[mode])
            program = self.loop.spread(jax.vmap(one), SEEDS, SEEDS)
            self.evaluators[mode] = program.lower(params, keys).compile()
            self.loop.compile_s += perf_counter() - began
        return self.evaluators[mode]

    def _save(self) -> None:
        """A checkpoint of all that the run needs to go on."""
        self._check_learned()
        kept = self.schedule.checkpoint_replay
        meta = {
            "step": self.step,
            "wall_s": self.wall_s,
            "metrics_bytes": self.log.flush(),
            "returns": self.returns,
            "capacity": self.loop.agent.replay.capacity,
        }
        state = self.state if kept else self.state.replace(memory=None)
        checkpoint.save(self._checkpoints, self.step, state, meta, known=self.known)
        self.known.add(self.step)

    def _check_learned(self) -> None:
        """Raise DivergenceError where a learned number is not finite."""
        for path, leaf in jax.tree_util.tree_leaves_with_path(self.state.learners):
            if jnp.issubdtype(leaf.dtype, jnp.floating):
                numbers = np.asarray(leaf).reshape(len(self.loop.seeds), -1)
                for s in np.flatnonzero(~np.isfinite(numbers).all(1))[:1]:
                    name = jax.tree_util.keystr(path, simple=True, separator=".")
                    raise rows.DivergenceError(
                        f"seed {self.loop.seeds[s]}, step {self.step}: {name} is not finite"
                    )

    def _write(self, found: list[dict[str, Any]]) -> None:
        self.log.write([{**row, "wall_s": self.wall_s} for row in found])

    def _show(self, scalars: dict[str, float]) -> None:
        self.latest |= scalars
        self.progress.update(self.step, self.latest)

    def final_returns(self) -> list[float | None]:
        """Per seed the mean training return over the last tenth of the run."""
        tail = self.step - 0.1 * self.schedule.total_steps
        found = []
        for pairs in self.returns:
            values = [value for at, value in pairs if at > tail] or [v for _, v in pairs[-1:]]
            found.append(float(np.mean(values)) if values else None)
        return found
