"""Exit codes of the commands, and one line for each error; without JAX.

Exit codes: 0 done; 2 bad usage; 128 + number after a signal, as 130 after Ctrl-C and 143 after
SIGTERM; 1 any other failure.
"""

import inspect
import os
import select as polling
import sys
import traceback
from collections.abc import Callable
from types import ModuleType
from typing import Any, NoReturn

from hybrid_rl.cli import interrupt
from hybrid_rl.errors import DivergenceError, UsageError, printable, user_line

install = interrupt.install  # before what takes long to import: Ctrl-C ends it in one line


def report(error: BaseException) -> NoReturn:
    """End the process with one line and the right code, or with a traceback for a fault of ours."""
    if isinstance(error, BrokenPipeError):
        poll = polling.poll()
        poll.register(sys.stdout.fileno(), 0)
        if any(event & polling.POLLERR for _, event in poll.poll(0)):  # unread, as in `| head`
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, sys.stdout.fileno())  # for what Python writes at its end
            sys.exit(1)
    result = diagnosis(error)
    if result is None:
        traceback.print_exception(error)  # begins where it was caught, without Hydra's frames
        sys.exit(1)
    _fail(*result)


def diagnosis(error: BaseException) -> tuple[int, str] | None:
    """Exit code and line for what went wrong; None for a fault of ours."""
    if isinstance(error, UsageError):
        return 2, str(error)
    from hybrid_rl.fields import FieldError
    from hybrid_rl.settings.compose import UNCOMPOSED, explain

    if isinstance(error, FieldError):  # while a program is traced
        return 2, str(error)
    if isinstance(error, UNCOMPOSED):
        return 2, explain(error)
    if isinstance(error, (OSError, DivergenceError, MemoryError)):
        return 1, str(error)
    if str(error).startswith("RESOURCE_EXHAUSTED"):  # of XLA
        what = str(error).splitlines()[0]
        return 1, f"{what}; fewer num_seeds or num_envs, or a smaller replay.capacity, may fit"
    if line := user_line(error, ours=True):
        return 1, line
    return None


def _fail(code: int, line: str) -> NoReturn:
    print(f"hybrid_rl: {printable(' '.join(line.split()))}", file=sys.stderr, flush=True)
    sys.exit(code)


def make_callable(module: str, function: Callable[..., Any]) -> None:
    """Let a module be called as its function: hybrid_rl.train() is hybrid_rl.train.train()."""

    class Called(ModuleType):
        __call__ = staticmethod(function)
        __signature__ = inspect.signature(function)

    sys.modules[module].__class__ = Called


def run(job: Callable[[], None]) -> None:
    """Run `job`; what goes wrong becomes one line and an exit code, after it has cleaned up."""
    with interrupt.as_exception():
        reported(job)


def reported(job: Callable[[], None]) -> None:
    """Run `job`; what goes wrong becomes one line and an exit code."""
    try:
        job()
    except Exception as error:
        report(error)
    except SystemExit as end:
        if line := user_line(end, ours=True):  # it would end without a word
            _fail(1, line)
        raise
    except KeyboardInterrupt:
        if interrupt.installed():
            interrupt.leave()
        _fail(130, "interrupted")
