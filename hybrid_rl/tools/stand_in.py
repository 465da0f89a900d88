"""A stand-in for a robot, in wall-clock time, for tests and before the robot is there.

    python -m hybrid_rl.stand_in robot=halfcheetah port=7000
    python -m hybrid_rl.stand_in robot=cartpole port=7001 latency_s=0.02 jitter_s=0.005 lost=0.01

The physics do not wait: at each of their steps the newest action that has arrived acts, so that a
late one acts late. Datagrams may be delayed and lost, and `unplug` makes both sides deaf.

It ends with the program that started it, after `seconds`, or by Ctrl-C, and then says how well it
kept its own time. Drivers: hybrid_rl.envs.adapters.stand_in.
"""

import math
import os
import signal
import socket
import time
from collections import deque
from contextlib import suppress
from typing import Any

import gymnasium
import numpy as np

from hybrid_rl import UsageError, arguments, command
from hybrid_rl.envs.adapters.stand_in import (
    ACTION,
    MOVED,
    OBSERVED,
    RESET,
    UNPLUG,
    Cartpole,
    HalfCheetah,
    StandIn,
)

DEAF_S = 0.25  # [s] without an action, after which the stand-in lets go
DEAF_MOST_S = 60.0  # [s] of one `unplug`
POLL_S = 1e-3  # [s] between looks at the observations on their way
BEHIND = 20  # steps behind the clock, after which it begins again
KINDS: dict[str, type[StandIn]] = {"halfcheetah": HalfCheetah, "cartpole": Cartpole}  # physics
ARGUMENTS = (
    arguments.Argument("robot", "halfcheetah", " or ".join(KINDS), arguments.one_of(*KINDS)),
    arguments.Argument("port", 7000, "on this machine", arguments.whole()),
    arguments.Argument(
        "latency_s", 0.0, "[s] of a datagram in each direction", arguments.number(0.0)
    ),
    arguments.Argument("jitter_s", 0.0, "[s] more, on average", arguments.number(0.0)),
    arguments.Argument("lost", 0.0, "share of the datagrams that are lost", arguments.number(0.0)),
    arguments.Argument(
        "faulty", 0.0, "share that is lost, late, doubled or cut", arguments.number(0.0)
    ),
    arguments.Argument("seconds", math.inf, "until it ends", arguments.number(0.0)),
)


class Physics:
    """The robot: steps in wall-clock time until its parent ends, or for `seconds`."""

    def __init__(
        self,
        kind: type[StandIn],
        port: int,
        latency_s: float = 0.0,
        jitter_s: float = 0.0,
        lost: float = 0.0,
        faulty: float = 0.0,
    ) -> None:
        """latency_s, jitter_s: of a datagram in each direction.

        lost: share of them. faulty: share that is lost, 0.3 s late, sent twice, or cut.
        """
        self.kind, self.latency_s, self.jitter_s, self.lost = kind, latency_s, jitter_s, lost
        self.faulty, self.faults, self.beyond = faulty, 0, 0
        env: Any = gymnasium.make(kind.id, disable_env_checker=True, max_episode_steps=-1)
        self.env = env.unwrapped
        self.env.model.opt.timestep = kind.step_s
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", port))
        self.socket.setblocking(False)
        self.random = np.random.default_rng(0)
        self.inbox: deque[tuple[float, bytes]] = deque()
        self.outbox: deque[tuple[float, bytes]] = deque()
        self.driver: Any = None  # address
        self.action, self.heard, self.newest = np.zeros(len(kind.low)), 0.0, -1
        self.episode, self.deaf_until = 0, 0.0
        self.late: list[float] = []  # [s] of each step behind its time
        self.begun = 0  # times that the clock began again

    def run(self, seconds: float) -> None:
        """Step until the time is over."""
        self.env.reset(seed=0)
        parent, began, first, k = os.getppid(), time.monotonic(), time.monotonic(), 0
        while time.monotonic() - first < seconds and os.getppid() == parent:
            due = began + k * self.kind.step_s
            while (left := due - time.monotonic()) > 0:
                self._deliver()
                time.sleep(min(max(left - 3e-4, 0), POLL_S))
            self.late.append(time.monotonic() - due)
            self._hear()
            self.env.do_simulation(self.action, 1)
            self._say(k)
            k += 1
            if self.late[-1] > BEHIND * self.kind.step_s:
                self.begun, began, k = self.begun + 1, time.monotonic() - k * self.kind.step_s, k

    def report(self) -> str:
        """How well it kept its own time."""
        late = np.array(self.late) if self.late else np.zeros(1)
        within = float((late < self.kind.step_s).mean())
        return (
            f"stand-in: {len(self.late):,} steps, {100 * within:.2f}% within their period, at most "
            f"{1e3 * late.max():.1f} ms late, {self.begun} times begun again; {self.faults:,} "
            f"faults, {self.beyond} actions beyond the bounds"
        )

    def _sent(self, box: deque[tuple[float, bytes]], data: bytes) -> None:
        """Put a datagram in a box, to be taken out when it is due."""
        now = time.monotonic()
        if now < self.deaf_until or self.random.uniform() < self.lost:
            return
        due = now + self.latency_s + self.jitter_s * float(self.random.exponential())
        if self.random.uniform() < self.faulty:
            self.faults += 1
            match self.random.integers(4):
                case 0:
                    return
                case 1:
                    due += 0.3
                case 2:
                    box.append((due, data))
                case _:
                    data = data[: self.random.integers(len(data))]
        box.append((due, data))

    def _hear(self) -> None:
        """Take what has arrived; the newest action acts, and none for long is the safe one."""
        while True:
            try:
                data, sender = self.socket.recvfrom(4096)
            except BlockingIOError:
                break
            self.driver = sender
            self._sent(self.inbox, data)
        now = time.monotonic()
        waiting = sorted(self.inbox, key=lambda each: each[0])
        self.inbox = deque(each for each in waiting if each[0] > now)
        for _, data in (each for each in waiting if each[0] <= now):
            self._take(data, now)
        if now - self.heard > DEAF_S:
            self.action = np.zeros(len(self.kind.low))

    def _take(self, data: bytes, now: float) -> None:
        if len(data) not in (MOVED.size, MOVED.size + 4 * len(self.kind.low)):
            return  # cut
        kind, number = MOVED.unpack_from(data)
        if number > time.monotonic_ns():
            return  # of no driver: they number by this machine's clock
        if kind == UNPLUG:
            self.deaf_until = now + min(number / 1e3, DEAF_MOST_S)
        elif kind == RESET and number > self.episode:
            self.episode, self.action = number, np.zeros(len(self.kind.low))
            self.env.reset()
        elif kind == ACTION and number > self.newest and len(data) > MOVED.size:
            self.newest, self.heard = number, now
            action = np.frombuffer(data, "<f4", -1, MOVED.size)
            within = (action >= self.kind.low) & (action <= self.kind.high)
            self.beyond += not within.all()
            self.action = np.clip(action, self.kind.low, self.kind.high)

    def _say(self, k: int) -> None:
        """Send the observation of the end of this step, and those that are due."""
        obs, then = np.asarray(self.env._get_obs(), "<f4"), time.monotonic() + self.kind.step_s
        head = OBSERVED.pack(self.episode, k, then, self.late[-1])
        self._sent(self.outbox, head + obs.tobytes())
        self._deliver()

    def _deliver(self) -> None:
        """Send the observations that are due."""
        now = time.monotonic()
        ready = [each for each in self.outbox if each[0] <= now]
        self.outbox = deque(each for each in self.outbox if each[0] > now)
        if self.driver is not None:
            for _, data in ready:
                self.socket.sendto(data, self.driver)


def main() -> None:
    """The command."""
    given: Any = arguments.read(__doc__, ARGUMENTS)[0]
    names = ("port", "latency_s", "jitter_s", "lost", "faulty")
    try:
        physics = Physics(KINDS[given["robot"]], *(given[name] for name in names))
    except OSError as error:
        raise UsageError(f"port={given['port']}: cannot be used ({error.strerror})") from error
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    with suppress(KeyboardInterrupt):
        print(f"{given['robot']} at port {given['port']}", flush=True)
        physics.run(given["seconds"])
    print(physics.report(), flush=True)


if __name__ == "__main__":
    command.run(main)
