"""A live window on a robot in the browser: change its goal and its body, push it.

    python -m hybrid_rl.view policy=halfcheetah
    python -m hybrid_rl.view policy=halfcheetah reward=speed reward.target=2
    python -m hybrid_rl.view run=DIR [mode=full] [seed=]
    python -m hybrid_rl.view task=panda_stack

It prints a link; open it in a browser. Only its key lets a page in. For a machine elsewhere, `ssh
-L 8080:localhost:8080 MACHINE` makes it the same link here. Ctrl-C ends it.

Policy, planner or both move the robot. Lines are what they imagine for its torso or hand, orange
the plan that acts. Sliders change the reward, the body and the disturbances; drag the robot to push
it, with at most its own weight. Another mode, reward or body needs other programs, and the robot
goes on as before until they are compiled: a planner takes a minute or two the first time.

A run that is training is followed by its newest checkpoint. With task=T the task's scripted expert
acts. reward, constraint, planner, env.KEY and episode.KEY are as with `evaluate`.
"""

if __name__ == "__main__":
    from hybrid_rl import command

    command.install()

import contextlib
import errno
import io
import socket
import threading
from collections.abc import Callable, Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

from hybrid_rl import UsageError, arguments, command, load, names


def port(name: str, given: str) -> int:
    """A number of a TCP port."""
    if (number := arguments.whole()(name, given)) > 65535:
        raise UsageError(f"{name}={given}: must be a whole number, 1 to 65535")
    return number


INSTALL = 'pip install "hybrid_rl[view]"'
CHANGES = arguments.ROBOT_CHANGES
ARGUMENTS = (
    *arguments.ROBOT,
    arguments.Argument("port", 8080, "of the link, or the next one that is free", port),
    arguments.Argument("host", "127.0.0.1", "who may see it: this machine; 0.0.0.0: everybody"),
)


def open_session(given: Mapping[str, Any], changes: Mapping[str, str], server: Any) -> Any:
    """The session that the arguments name.

    server: makes a viser.ViserServer, after all that can be wrong with the arguments.
    """
    from hybrid_rl.envs.adapters.external import External
    from hybrid_rl.tools.view.following import Follower
    from hybrid_rl.tools.view.panel import Wishes
    from hybrid_rl.tools.view.player import Choice, Player
    from hybrid_rl.tools.view.session import Session
    from hybrid_rl.tools.view.subject import Source, learner

    named = "run" if given["run"] else "policy"
    trained = None if given["task"] else load(given[named], named)
    source = Source(given, changes, trained)
    if trained is not None and isinstance(trained.episode.env, External):
        raise UsageError("a Gymnasium environment draws itself; use render")
    choice = Choice(given["mode"], given["reward"])
    seed = given["seed"] or 0 if trained is None else given["seed"] or trained.seeds[0]
    player = Player(source, learner(trained, given["seed"]), choice, seed)
    folder = Path(given["run"]) if given["run"] else None
    follower = Follower(folder, trained, given["seed"]) if folder and trained else None
    rewards = names("reward") if source.plans else []
    name = given["task"] or (trained.task if trained else "")
    step = trained.step if trained else None
    return Session(server(), name, player, Wishes(player.wanted, seed), rewards, step, follower)


def check_address(host: str, port: int) -> None:
    """Raise UsageError for an address that this machine cannot serve.

    viser would wait for it without end; a port that is in use is not wrong, as it takes the next.
    """
    try:
        family, kind, _, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
        with socket.socket(family, kind) as probe:
            probe.bind(address)
    except OSError as error:
        if error.errno != errno.EADDRINUSE:
            raise UsageError(f"host={host} port={port}: cannot be used ({error})") from error


def serve(given: Mapping[str, Any]) -> tuple[Any, str]:
    """A server at the address, and the link that lets a page in."""
    viser: Any = import_viser()
    from hybrid_rl.tools.view.door import Door

    door = Door(given["host"])
    with door.hung(), contextlib.redirect_stdout(io.StringIO()):  # its own lines about the address
        server = viser.ViserServer(host=given["host"], port=given["port"], verbose=False)
    door.controls = server.gui._gui_input_handle_from_uuid
    return server, f"http://{given['host']}:{server.get_port()}/{door.key}"


def import_viser() -> Any:
    """The module viser."""
    try:
        import_module("mjviser")
        return import_module("viser")
    except ImportError as error:
        raise UsageError(f"view: needs viser and mjviser; {INSTALL}") from error


def show(
    given: Mapping[str, Any], changes: Mapping[str, str], opened: Callable[[str], Any] | None = None
) -> None:
    """Serve the window until Ctrl-C; opened: called with its address."""
    print("compiling the first programs", flush=True)
    served: list[tuple[Any, str]] = []

    def server() -> Any:
        served.append(serve(given))
        return served[0][0]

    session = open_session(given, changes, server)
    link = served[0][1]
    print(f"open {link} in a browser; Ctrl-C ends it", flush=True)
    if opened:
        opened(link)
    try:
        session.run(threading.Event())
    finally:
        with contextlib.redirect_stdout(io.StringIO()):
            session.server.stop()


def main() -> None:
    """The command."""
    given, changes = arguments.read(__doc__, ARGUMENTS, CHANGES, ("run", "policy", "task"))
    arguments.robot(given, changes)
    check_address(given["host"], given["port"])
    import_viser()
    show(given, changes)


if __name__ == "__main__":
    command.run(main)
