"""Drivers of a stand-in for a robot, which is MuJoCo in a process of its own, behind a socket.

    python -m hybrid_rl.stand_in robot=halfcheetah port=7000
    python -m hybrid_rl.train task=robot env.make=hybrid_rl.envs.adapters.stand_in:HalfCheetah

`HalfCheetah` and `Cartpole` are drivers as a user writes them for a robot.
"""

import socket
import struct
import time
from contextlib import suppress
from typing import ClassVar

import numpy as np

OBSERVED, MOVED = struct.Struct("<qqdf"), struct.Struct("<cq")
ACTION, RESET, UNPLUG = b"a", b"r", b"u"


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
        """Begin an episode."""
        wanted, until = time.monotonic_ns(), time.monotonic() + 2
        while time.monotonic() < until:
            self._send(MOVED.pack(RESET, wanted))
            time.sleep(0.02)
            self._receive()
            if self._newest is not None and self._newest[0] == wanted:
                return
        raise ConnectionError("the stand-in does not answer")

    def observe(self) -> tuple[np.ndarray, float]:
        """The newest observation [o], and its time."""
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
