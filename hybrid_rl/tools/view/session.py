"""The loop of a window: one thread owns JAX and the state of the world."""

import threading
import time
from collections.abc import Sequence
from math import ceil

import jax
import numpy as np
from viser import ViserServer

from hybrid_rl.tools.view import push
from hybrid_rl.tools.view.following import Follower
from hybrid_rl.tools.view.history import History
from hybrid_rl.tools.view.panel import AGAIN, Panel, Wishes
from hybrid_rl.tools.view.player import Player
from hybrid_rl.tools.view.scene import Scene

FASTEST = 30.0  # [1/s] pictures
REPORTED = 0.25  # [s] between two reports: plots and a line
IDLE = 0.02  # [s] between two looks at the wishes of a paused window


class Session:
    """A player, its picture and its panel on a server."""

    def __init__(
        self,
        server: ViserServer,
        name: str,
        player: Player,
        wishes: Wishes,
        rewards: Sequence[str] = (),
        step: int | None = None,
        follower: Follower | None = None,
    ) -> None:
        """step: decisions of the training; rewards: names that may be chosen."""
        self.server = server
        self._name, self.player, self.wishes = name, player, wishes
        self._step, self._follower, self._history = step, follower, History()
        self.decisions, self.episodes, self.pushes = 0, 0, 0
        self._ended, self._reported, self._counted, self._rate = "", 0.0, 0, 0.0
        self._took = 0.0  # [s] that a decision takes
        episode = player.cast.subject.episode
        self._dt, self._stride = episode.spec.dt, ceil(1 / episode.spec.dt / FASTEST)
        self._scene = Scene(server, episode.env, lambda pull: setattr(wishes, "pull", pull))
        self._panel = Panel(server, wishes, player.modes, rewards)
        self._panel.command(player.cast.subject.commands)
        self._panel.body(player.cast.subject.body)
        self._picture()

    def run(self, over: threading.Event) -> None:
        """Play until `over`, in the time of the world or slower."""
        due = time.monotonic()
        while not over.is_set():
            self._grant()
            self._report()
            wishes = self.wishes
            if wishes.paused and not wishes.steps:
                over.wait(IDLE)
                due = time.monotonic()
                continue
            wishes.steps = max(wishes.steps - 1, 0)
            began = time.monotonic()
            self._decide()
            self._took += 0.2 * (time.monotonic() - began - self._took)
            if wishes.paused or self.decisions % self._stride == 0:
                self._picture()
            due = max(due + self._dt / wishes.speed, time.monotonic())  # never catches up
            over.wait(due - time.monotonic())
        self.player.close()

    def _grant(self) -> None:
        """What changes between two decisions."""
        wishes, player = self.wishes, self.player
        if self._follower and (newest := self._follower.newest()):
            player.params, self._step = newest
        player.numbers, player.command = dict(wishes.numbers), dict(wishes.command)
        if wishes.choice != player.wanted:
            player.choose(wishes.choice)
        before = player.cast.choice.reward
        player.exchange()
        if player.cast.choice.reward != before:
            self._aim()
        if wishes.again:
            wishes.again, self.episodes = False, 0
            self._begin()

    def _aim(self) -> None:
        """Another reward: a new return, and a new episode where the robot has tipped over."""
        self._ended = ""
        if self._scene.tipped:
            self._begin()
        self.player.forget_return()
        self._history.clear()

    def _begin(self) -> None:
        """The next episode."""
        self.player.begin(self.wishes.seed, self.episodes)
        self._history.clear()
        self._picture()

    def _decide(self) -> None:
        """One decision, after a push; a new episode after the last one."""
        player, pull = self.player, self.wishes.pull
        total = float(player.state.clock.total)
        if bool(player.state.done) or not np.isfinite(total):  # a body that cannot be simulated
            self.episodes += 1
            self._ended = f"; the last one: {total:,.1f}"
            self._begin()
        if pull is not None and pull.fresh and push.possible(player.state):
            player.state = push.pushed(player.state, pull, self._dt)
            self.pushes += 1
        player.advance()
        self.decisions += 1
        assert player.decided is not None
        reward, metrics = jax.device_get((player.state.reward, player.decided.metrics))
        t = self._dt * int(player.state.clock.decision)
        self._history.add(t, float(reward), metrics)

    def _picture(self) -> None:
        """The robot and its imagined paths."""
        player, decided = self.player, self.player.decided
        self._scene.draw(np.asarray(player.cast.world.pose(player.state)))
        drawn = decided.drawn if decided and self.wishes.candidates else None
        if drawn is None or decided is None:
            self._scene.imagine(None)
        else:
            self._scene.imagine(np.asarray(drawn), int(decided.chosen))

    def _report(self) -> None:
        """Plots, sliders and a line, a few times a second."""
        now = time.monotonic()
        if now - self._reported < REPORTED:
            return
        rate = (self.decisions - self._counted) * self._dt / (now - self._reported)
        self._rate = 0.7 * self._rate + 0.3 * rate
        self._reported, self._counted = now, self.decisions
        player = self.player
        subject, mode = player.cast.subject, player.cast.choice.mode
        self._panel.show(player.modes, subject.plans(mode), subject.goals, self._line())
        self._panel.plot(self._history)

    def _line(self) -> str:
        """Who acts, how fast, and what is being made."""
        player, state = self.player, self.player.state
        choice, asked = player.cast.choice, player.wanted
        trained = "" if self._step is None else f", step {self._step:,}"
        t = self._dt * int(state.clock.decision)
        lines = [
            f"**{self._name}**{trained}, mode {choice.mode}{', quick' if choice.quick else ''}",
            f"{t:.1f} s, {self._rate:.2f} times real time",
            f"computed in {self._took:.3f} s, a decision of {self._dt:.3g} s",
            f"return {float(state.clock.total):,.1f}{self._ended}",
        ]
        if player.compiling:
            goal = f", reward {asked.reward}" if asked.reward else ""
            lines.append(f"*compiling mode {asked.mode}{goal}: a planner takes a minute or two*")
        if self._scene.tipped:
            lines.append(f"*tipped over: {AGAIN} sets it up*")
        if player.problem:
            lines.append(f"*{player.problem}*")
        return "  \n".join(lines)
