"""A stand-in for a robot: MuJoCo in a process of its own, in wall-clock time, behind a socket.

    python -m hybrid_rl.stand_in robot=halfcheetah port=7000
    python -m hybrid_rl.train task=robot env.make=hybrid_rl.tools.stand_in:HalfCheetah

The physics do not wait: at each of their steps the newest action that has arrived acts, so that a
late one acts late. Datagrams may be delayed and lost, and `unplug` makes both sides deaf.

`HalfCheetah`, `Cartpole` and `FastCartpole` are drivers as a user writes them for a robot,
`Physics` is the robot.
"""

import os
import socket
import struct
import time
from collections import deque
from contextlib import suppress
from typing import Any, ClassVar

import gymnasium
import numpy as np

OBSERVED, MOVED = struct.Struct("<qqdf"), struct.Struct("<cq")
ACTION, RESET, UNPLUG = b"a", b"r", b"u"
DEAF_S = 0.25  # [s] without an action, after which the stand-in lets go
DEAF_MOST_S = 60.0  # [s] of one `unplug`
BEHIND = 20  # steps behind the clock, after which it begins again


class StandIn:
    """The driver of a stand-in."""

    id: ClassVar[str]
    dt: ClassVar[float]
    step_s: ClassVar[float]  # [s] of the physics
    low: ClassVar[list[float]]
    high: ClassVar[list[float]]
    obs: ClassVar[int]

    def __init__(self, port: int = 7000) -> None:
        """Connect with the stand-in at a port of this machine."""
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.setblocking(False)
        self._socket.connect(("127.0.0.1", port))
        self._newest: tuple[int, int, float, np.ndarray] | None = None

    def reset(self) -> None:
        """Begin an episode.

        Raises:
            ConnectionError: if the stand-in does not answer within two seconds.
        """
        wanted, until = time.monotonic_ns(), time.monotonic() + 2
        while time.monotonic() < until:
            self._send(MOVED.pack(RESET, wanted))
            time.sleep(0.02)
            self._receive()
            if self._newest is not None and self._newest[0] == wanted:
                return
        raise ConnectionError("the stand-in does not answer")

    def observe(self) -> tuple[np.ndarray, float]:
        """The newest observation [o], and its time.

        Raises:
            ConnectionError: if there has been none.
        """
        self._receive()
        if self._newest is None:
            raise ConnectionError("no observation from the stand-in")
        return self._newest[3], self._newest[2]

    def apply(self, action: np.ndarray) -> None:
        """Send an action [m]."""
        self._send(MOVED.pack(ACTION, time.monotonic_ns()) + np.asarray(action, "<f4").tobytes())

    def stop(self) -> None:
        """Send the safe action, more than once, as datagrams may be lost."""
        for _ in range(5):
            self.apply(np.zeros(len(self.low)))

    def unplug(self, seconds: float) -> None:
        """Let the stand-in hear and say nothing for so long."""
        self._send(MOVED.pack(UNPLUG, int(1e3 * seconds)))

    def _send(self, data: bytes) -> None:
        with suppress(ConnectionRefusedError):  # no stand-in runs; `stop` must not raise
            self._socket.send(data)

    def _receive(self) -> None:
        while True:
            try:
                data = self._socket.recv(4096)
            except (BlockingIOError, ConnectionRefusedError):
                return  # nothing has arrived, or no stand-in runs
            if len(data) != OBSERVED.size + 4 * self.obs:
                continue  # cut
            episode, k, stamp, _ = OBSERVED.unpack_from(data)
            if self._newest is None or (episode, k) > self._newest[:2]:
                self._newest = episode, k, stamp, np.frombuffer(data, "<f4", -1, OBSERVED.size)


class HalfCheetah(StandIn):
    """Gymnasium's HalfCheetah-v5, 20 decisions a second; physics at 100 Hz."""

    id, dt, step_s, obs = "HalfCheetah-v5", 0.05, 0.01, 17
    low, high = [-1.0] * 6, [1.0] * 6

    def reward(self, obs: np.ndarray, action: np.ndarray, next_obs: np.ndarray) -> float:
        """Gymnasium's, with the speed at the end of the decision."""
        return float(next_obs[8] - 0.1 * np.square(action).sum())


class Cartpole(StandIn):
    """Gymnasium's InvertedPendulum-v5, 50 decisions a second; physics at 200 Hz."""

    id, dt, step_s, obs = "InvertedPendulum-v5", 0.02, 0.005, 4
    low, high = [-3.0], [3.0]

    def reward(self, obs: np.ndarray, action: np.ndarray, next_obs: np.ndarray) -> float:
        """1 while the pole is up."""
        return 1.0

    def terminated(self, obs: np.ndarray) -> bool:
        """Whether the pole has fallen, or the cart has come near the end of its rail."""
        return bool(abs(obs[1]) > 0.2 or abs(obs[0]) > 0.95)


class FastCartpole(Cartpole):
    """The cartpole with 100 decisions a second."""

    dt = 0.01


KINDS: dict[str, type[StandIn]] = {"halfcheetah": HalfCheetah, "cartpole": Cartpole}  # physics


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
                time.sleep(max(left - 3e-4, 0))
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
        """Send the observation, and those that are due."""
        now, obs = time.monotonic(), np.asarray(self.env._get_obs(), "<f4")
        head = OBSERVED.pack(self.episode, k, now, self.late[-1])
        self._sent(self.outbox, head + obs.tobytes())
        ready = [each for each in self.outbox if each[0] <= now]
        self.outbox = deque(each for each in self.outbox if each[0] > now)
        if self.driver is not None:
            for _, data in ready:
                self.socket.sendto(data, self.driver)
