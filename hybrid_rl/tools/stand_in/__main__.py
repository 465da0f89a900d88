"""A stand-in for a robot, in wall-clock time, for tests and before the robot is there.

    python -m hybrid_rl.stand_in robot=halfcheetah port=7000
    python -m hybrid_rl.stand_in robot=cartpole port=7001 latency_s=0.02 jitter_s=0.005 lost=0.01

It ends with the program that started it, after `seconds`, or by Ctrl-C, and then says how well it
kept its own time. Drivers: hybrid_rl.tools.stand_in.
"""

import math
import signal
from contextlib import suppress
from typing import Any

from hybrid_rl import UsageError, arguments, command
from hybrid_rl.tools.stand_in import KINDS, Physics

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
