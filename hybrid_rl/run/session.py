"""The part of a run on the host: call the program, log, evaluate, save, until the end or a signal.

A row of means is written at the multiples of `log_every`, `eval_every` and `checkpoint_every`. One
call of the compiled program takes a second or two, and a run can stop between two calls: its
checkpoint holds the metrics' sums since the last row, so a resumed run logs the same rows as an
uninterrupted one. A learner that reaches NaN or infinity ends; the others of its program continue.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from time import monotonic, perf_counter
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.errors import DivergenceError, WorldError
from hybrid_rl.protocols import Controller
from hybrid_rl.run.checkpoints.store import End, Record, Shelf
from hybrid_rl.run.evaluations import EVALUATED, Evaluations
from hybrid_rl.run.logs import records
from hybrid_rl.run.logs.progress import Progress
from hybrid_rl.run.logs.records import Row
from hybrid_rl.run.machine import memory, provenance
from hybrid_rl.run.schedule import Pace, Schedule, Speed
from hybrid_rl.run.start import Start
from hybrid_rl.training.loop import Loop

Failures = Mapping[int, tuple[int, str]]  # learner -> (step, quantity that is not finite)
RETURNS = [f"{prefix}return" for prefix in EVALUATED.values()]  # the first of them is the result


@dataclass
class Session:
    """One run: `begin` or `resume`, then `compile`, then `run`."""

    loop: Loop
    controllers: Mapping[str, Controller]  # to evaluate: mode -> controller without exploration
    schedule: Schedule
    shelf: Shelf  # its folders
    progress: Progress
    state: Any = None  # AgentState [S, ...], once begun
    began: float = field(default_factory=monotonic)
    stop: int | None = None  # the signal that asked for an end; 0: the program did
    saved: tuple[int, bool] | None = None  # step and `unevaluated` of the newest checkpoint
    recent: Speed = field(default_factory=Speed)  # since then
    pace: Pace = field(default_factory=Pace)
    program: Any = None  # compiled
    compile_s: float = 0.0  # [s] that compiling took
    evaluations: Evaluations = field(init=False)  # compiled
    record: Record = field(init=False)
    sound: dict[int, Any] = field(default_factory=dict)  # states instead of those that diverged

    @property
    def step(self) -> int:
        """Decisions of each learner."""
        return self.record.step

    @property
    def left(self) -> int:
        """Learners that continue."""
        return len(self.loop.seeds) - len(self.record.ends)

    @property
    def wall_s(self) -> float:
        """[s] over all sessions of the run."""
        return self.record.wall_s + monotonic() - self.began

    @property
    def finished(self) -> bool:
        """True if all decisions are made, and evaluated."""
        return self.step >= self.schedule.total_steps and not self.record.unevaluated

    def begin(self, start: Start | None = None) -> None:
        """Start from the first state, or with what another run knows, which is evaluated first."""
        seeds = self.loop.seeds
        self.record = Record([[] for _ in seeds], [None for _ in seeds])
        with self.progress.doing("starting"):
            self.state = self.loop.init()
        if start is not None:
            self.progress.note(start.line)
            with self.progress.doing("pretraining"):
                self.state = self.loop.pretrained(self.loop.on_devices(start.given(self.state)))
            self.record.unevaluated = bool(self.controllers)

    def resume(self) -> None:
        """Start from the newest sound checkpoint."""
        self.state, self.record, notes = self.shelf.restore()
        self.progress.update(self.step, {}, say=False)
        if not self.shelf.replay:
            self.loop.agent = replace(self.loop.agent, first_update=self.step)
            notes += ["no replay memory in checkpoints: it continues, but not bit for bit"]
        self.saved = self.step, self.record.unevaluated
        for note in (*notes, *self.loop.notes, f"continuing from step {self.step:,}"):
            self.progress.note(note)

    def compile(self) -> None:
        """Compile all programs that `run` calls."""
        if self.finished:
            return
        self.progress.note(f"compiling on {provenance.device()} ...{self.loop.idle_note}")
        with self.progress.doing("compiling"):
            import orbax.checkpoint  # noqa: F401  # 1 s, too long for a checkpoint at a signal

            began = perf_counter()
            given = self.controllers, self.schedule.eval_episodes, self.loop.params(self.state)
            self.evaluations = Evaluations(self.loop, *given)
            self.program = self.loop.compile(self.state)
            memory.check(self.loop, self.program)
            self.evaluations.wait()
            self.compile_s = perf_counter() - began
        self.progress.note(f"compiled in {self.compile_s:.1f} s")

    def ask(self, number: int) -> None:
        """End the run after the current call, with a checkpoint; number: of the signal, or 0."""
        if self.stop is None:
            self.progress.note("stopping, with a checkpoint ...")
        self.stop = self.stop or number
        self.loop.cut_short()

    def run(self) -> None:
        """Advance to the end, or until `ask` was called; the last state is always saved."""
        plan, worlds = self.schedule, self.loop.agent.num_envs
        while not self.finished and self.stop is None:
            if not self.record.unevaluated:
                self._advance()
            if self.record.unevaluated:
                self._evaluate()
            if not self.record.unevaluated and plan.due(plan.checkpoint_every, self.step, worlds):
                self._save()
        if self.saved != (self.step, self.record.unevaluated):
            self._save()

    def _advance(self) -> None:
        """A call of the program, up to the next mark at most, and its rows."""
        plan, worlds, start = self.schedule, self.loop.agent.num_envs, self.step
        if plan.row_due(start, worlds):
            self.recent = Speed()
        changes = self.loop.agent.changes()
        rounds = self.pace.rounds(-(-(plan.until(start, changes) - start) // worlds))
        began = perf_counter()
        with jax.debug_nans(False):  # NaN marks a metric that does not apply, infinity a failure
            self.state, metrics = self.program(self.state, jnp.int32(start), jnp.int32(rounds))
        metrics = {name: np.asarray(m)[:rounds] for name, m in metrics.items()}
        took, rounds = perf_counter() - began, len(metrics["episode/done"])
        if not rounds:  # a robot gave none before a signal, or the world failed
            self.stop = self.stop or 0
            return
        self.record.step += rounds * worlds
        self.pace.took(rounds, took)
        if any(start < change <= self.step for change in changes):
            self.pace = Pace()
        if start >= max(changes):
            for speed in (self.recent, self.record.learning):
                speed.add(rounds * worlds * self.left, took)
        self._record(metrics, start)
        due = plan.due(plan.eval_every, self.step, worlds)
        self.record.unevaluated = bool(self.controllers) and due
        self._show({}, say=False if self.record.unevaluated else None)

    def _record(self, metrics: records.Metrics, start: int) -> None:
        """Write the rows that follow from the rounds after `start`."""
        worlds = self.loop.agent.num_envs
        infinite = records.infinite(metrics, start, worlds)
        if jax.config.jax_debug_nans:
            infinite = {**unsound(self.state.learners, self.step), **infinite}
        for row in self._write(records.episodes(metrics, start, worlds), infinite):
            pair = (row["step"], float(row["train/return"]))
            self.record.returns[row["learner"]].append(pair)
        self.record.sums = records.added(self.record.sums, metrics)
        if self.schedule.row_due(self.step, worlds):
            means = records.means(self.record.sums, len(self.loop.seeds), self.step)
            self.record.sums = {}
            perf = {"perf/compile_s": self.compile_s} | self._speed(len(self.shelf.logs))
            self._write([row | perf for row in means], {})

    def _speed(self, folders: int = 1) -> dict[str, float]:
        """Decisions of all learners per second since the last row; empty before they learn.

        folders: so many share them evenly.
        """
        speed = self.recent.rate
        return {} if speed is None else {"perf/env_steps_per_s": speed / folders}

    def _evaluate(self) -> None:
        """The outcomes of every evaluated mode, unless a signal comes."""
        with self.progress.doing("evaluating"):
            params = self.loop.params(self.state)
            try:
                outcomes = self.evaluations(params, lambda: self.stop is not None)
            except WorldError as fault:
                self.loop.fault, self.stop, outcomes = fault, self.stop or 0, None
        if outcomes is None:
            return
        self.record.unevaluated = False
        infinite = {
            s: (self.step, name)
            for s, outcome in enumerate(outcomes)
            for name in reversed(outcome)  # the first of them stays
            if not np.isfinite(outcome[name])
        }
        rows = [{"step": self.step, "learner": s} | each for s, each in enumerate(outcomes)]
        left = self._write(rows, infinite)
        result = next(key for key in RETURNS if key in outcomes[0])
        for row in left:
            self.record.final_eval[row["learner"]] = row[result]
        means = {name: float(np.mean([row[name] for row in left])) for name in outcomes[0]}
        self._show({**means, "eval/return": means[result]}, say=True)

    def _end(self, failures: Failures) -> list[Row]:
        """A row for each learner that diverged just now."""
        loop, rows = self.loop, []
        for s, (step, quantity) in sorted(failures.items()):
            if s in self.record.ends:
                continue
            end: End = {"seed": loop.seeds[s], "step": step, "quantity": quantity}
            if numbers := loop.axis.names[s * loop.axis.count // len(loop.seeds)]:
                end["of"] = numbers  # where there are others
            self.record.ends[s], self.record.final_eval[s] = end, None
            rows.append({"step": step, "learner": s, "diverged": quantity})
        for row in rows if self.left else ():  # else the error names it
            line = _words(self.record.ends[row["learner"]])
            self.progress.note(f"{line}; it ends here, the others continue")
        return rows

    def _write(self, rows: Sequence[Row], failures: Failures) -> list[Row]:
        """Write rows, of a learner that diverged only those before its end; returns these.

        Raises DivergenceError if no learner is left.
        """
        new, ends = self._end(failures), self.record.ends
        rows = [
            row
            for row in rows
            if row["learner"] not in ends or row["step"] < ends[row["learner"]]["step"]
        ]
        each = sorted([*rows, *new], key=lambda row: (row["step"], row["learner"]))
        self.shelf.write(each, self.wall_s)
        if not self.left:
            raise DivergenceError(failure_line([*ends.values()], 0, self.shelf.newest))
        if failures:
            self._repair()
        return rows

    def _repair(self) -> None:
        """Give the learners that have ended sound states.

        The program computes all learners together, so one that has ended is still computed, from
        the state of its last sound checkpoint, or its initial state.
        """
        for s in self.record.ends:
            if s not in self.sound:
                self.sound[s] = self.shelf.learner(s)
            self.state = self.loop.with_learner(self.state, s, self.sound[s])

    def _save(self) -> None:
        """Write a checkpoint."""
        self._write([], unsound(self.state.learners, self.step))
        self._repair()
        now = replace(self.record, wall_s=self.wall_s)
        with self.progress.doing("saving"):
            self.shelf.save(self.state, now)
        self.saved = self.step, self.record.unevaluated

    def _show(self, scalars: Mapping[str, float], say: bool | None) -> None:
        newest = [
            p[-1][1] for s, p in enumerate(self.record.returns) if p and s not in self.record.ends
        ]
        shown = {"train/return": float(np.mean(newest))} if newest else {}
        self.progress.update(self.step, {**shown, **self._speed(), **scalars}, say)

    def final_returns(self) -> list[float | None]:
        """Mean training return over the last tenth, per seed; None if it diverged."""
        tail = self.step - 0.1 * self.schedule.total_steps
        means = []
        for s, pairs in enumerate(self.record.returns):
            values = [value for at, value in pairs if at > tail] or [v for _, v in pairs[-1:]]
            known = values and s not in self.record.ends
            means.append(float(np.mean(values)) if known else None)
        return means


def unsound(learners: Any, step: int) -> Failures:
    """The learners with a learned number [S, ...] that is not finite at `step`."""
    failures: dict[int, tuple[int, str]] = {}
    for path, leaf in jax.tree_util.tree_leaves_with_path(learners):
        if jnp.issubdtype(leaf.dtype, jnp.floating):
            numbers = np.asarray(leaf)
            for s in np.flatnonzero(~np.isfinite(numbers.reshape(len(numbers), -1)).all(1)):
                name = jax.tree_util.keystr(path, simple=True, separator=".")
                failures.setdefault(int(s), (step, name))
    return failures


def failure_line(ends: Sequence[End], left: int, checkpoint: int | None) -> str:
    """The failure and what can be done, in one line.

    left: learners that reached the end; checkpoint: the step of the newest one.
    """
    words = "; ".join(map(_words, ends))
    if left:
        return f"{words}; the others went on to the end"
    if checkpoint is None:
        return f"{words}; there is no checkpoint"
    mend = "fix what fails and resume it, or begin again with a lower learning rate"
    return f"{words}; checkpoint {checkpoint} is intact: {mend}"


def _words(end: End) -> str:
    who = f"seed {end['seed']}" + (f" of {end['of']}" if "of" in end else "")
    return f"{who}, step {end['step']}: {end['quantity']} is not finite"
