"""Ctrl-C and the signals that end a process, from the start of a command to its end.

They are SIGTERM, SIGHUP of a terminal that was closed, and SIGUSR1, by which Slurm warns of its
time limit. A command calls `install` before it imports anything slow. From then on a thread handles
them, also while the main thread is importing, compiling or in compiled code:

* by default the process ends immediately, with one line on stderr and exit code 128 + number;
* within `as_exception` the main thread gets KeyboardInterrupt and a few seconds to clean up; a
  second signal ends the process immediately;
* within `as_call` the first signal calls a function; a second Ctrl-C ends the process immediately,
  and all others after the first have no effect.

Importing this module installs nothing. In a program that never calls `install`, such as a notebook,
only `as_call` has an effect: it sets Python's handlers until its block ends. SIGHUP stays ignored
where it is, as under nohup.
"""

import os
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, NoReturn

WORDS = {
    signal.SIGINT: "interrupted",
    signal.SIGTERM: "terminated",
    signal.SIGHUP: "terminated, as its terminal was closed (SIGHUP)",
    signal.SIGUSR1: "terminated by SIGUSR1",
}
PATIENCE = 3.0  # [s] for the clean-up after KeyboardInterrupt

Ask = Callable[[int], None]


class _State:
    """What a signal does now."""

    installed = False
    raises = False  # KeyboardInterrupt
    patience = PATIENCE
    ask: Ask | None = None
    heard: tuple[int, ...] = ()  # signals in the present state
    raised: int | None = None  # the signal that became KeyboardInterrupt
    leaving = threading.Lock()  # never released: the process ends in one thread alone


def install() -> None:
    """Handle the signals from now on; call it in the main thread of a command."""
    if _State.installed:
        return
    _State.installed = True
    # Importing mujoco loads GLFW by a Python child, which would print a traceback on Ctrl-C.
    os.environ.setdefault("MUJOCO_GL", "disable")  # envs/mujoco/offscreen chooses its own backend
    heard, written = os.pipe()
    os.set_blocking(written, False)
    signal.set_wakeup_fd(written, warn_on_full_buffer=False)
    for number in _heard():
        signal.signal(number, _in_the_main_thread)
    threading.Thread(target=_listen, args=(heard,), name="signals", daemon=True).start()


@contextmanager
def as_exception(patience: float = PATIENCE) -> Iterator[None]:
    """Let a signal raise KeyboardInterrupt in the main thread of a command, within the block.

    patience: [s] for its clean-up, after which the process ends.
    """
    _State.heard, _State.raises, _State.patience = (), True, patience
    try:
        yield
    finally:
        _State.raises = False


@contextmanager
def as_call(ask: Ask) -> Iterator[None]:
    """Let the first signal call ask(number), in another thread than the main one.

    Without `install` a second Ctrl-C raises KeyboardInterrupt.
    """
    if _State.installed:
        _State.heard, _State.ask = (), ask
        try:
            yield
        finally:
            _State.ask = None
    elif threading.current_thread() is threading.main_thread():
        handler = _asking(ask)
        old = {number: signal.signal(number, handler) for number in _heard()}
        try:
            yield
        finally:
            for number, handler in old.items():
                signal.signal(number, handler)
    else:
        yield


def leave(number: int | None = None) -> NoReturn:
    """End the process immediately, with one line and exit code 128 + number.

    number: None stands for the signal that became KeyboardInterrupt.
    """
    _State.leaving.acquire()
    number = number or _State.raised or signal.SIGINT
    newline = "\n" if os.isatty(2) else ""  # the cursor stands behind ^C
    try:
        os.write(2, f"{newline}hybrid_rl: {WORDS[signal.Signals(number)]}\n".encode())
    finally:
        os._exit(128 + number)


def installed() -> bool:
    """Whether this process is a command that called `install`."""
    return _State.installed


def _heard() -> list[int]:
    """The signals to handle: SIGHUP not where it is ignored."""
    return [n for n in WORDS if n != signal.SIGHUP or signal.getsignal(n) != signal.SIG_IGN]


def cause() -> int | None:
    """The signal that became KeyboardInterrupt."""
    return _State.raised


def _asking(ask: Ask) -> Callable[[int, Any], None]:
    """Python's handler for a program without `install`."""
    heard: list[int] = []

    def handler(number: int, frame: Any) -> None:
        heard.append(number)
        if heard.count(signal.SIGINT) > 1:
            raise KeyboardInterrupt
        if len(heard) == 1:
            threading.Thread(target=ask, args=(number,)).start()

    return handler


def _in_the_main_thread(number: int, frame: Any) -> None:
    """Python's handler: it runs when the main thread is back in Python."""
    if _State.raises:
        _State.raised = _State.raised or number
        raise KeyboardInterrupt


def _listen(heard: int) -> None:
    """Act on every signal."""
    while True:
        for number in os.read(heard, 1):
            _act(number)


def _act(number: int) -> None:
    before, _State.heard = _State.heard, (*_State.heard, number)
    if _State.ask is not None:
        if not before:
            _State.ask(number)
        elif number == signal.SIGINT and number in before:
            leave(number)
    elif _State.raises and not before:
        timer = threading.Timer(_State.patience, leave, (number,))
        timer.daemon = True
        timer.start()
    else:
        leave(number)
