"""Progress of a run on the terminal: a live bar, or plain lines in a file."""

import os
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from datetime import timedelta
from typing import Self

from rich.console import Group
from rich.live import Live
from rich.progress import BarColumn, TextColumn
from rich.progress import Progress as Bar
from rich.text import Text

PERIOD = 60.0  # [s] over which the speed is measured
PAUSE = 8.0  # [s] between two plain lines; in a slow call it doubles
SHOWN = {  # scalar -> its format
    "train/return": "return {:,.1f}",
    "eval/return": "eval {:,.1f}",
    "eval/success": "success {:.0%}",
    "eval/violations": "violations {:,.1f}",
}


def say(text: str) -> None:
    """Print a line; it vanishes where the pipe or the terminal was closed.

    That ends no run, as its records are in its folder.
    """
    with ignore_closed_output():
        print(text, flush=True)


@contextmanager
def ignore_closed_output() -> Iterator[None]:
    """Drop what cannot be written to the output in the block, and all after it."""
    try:
        yield
    except OSError:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        with suppress(OSError):  # it may be no file, as in a notebook
            os.dup2(nowhere, sys.stdout.fileno())  # for what Python's buffer still holds, too
        os.close(nowhere)


class Progress:
    """Steps of `total`, the latest scalars, speed, time left; a line every PAUSE or less often.

    steady: the step from which the speed is representative; visible: false shows nothing.

    with Progress(total, "halfcheetah sac") as progress:
        with progress.doing("compiling"):
            ...
        progress.update(step, {"train/return": 12.0})
    """

    def __init__(self, total: int, label: str = "", steady: int = 0, visible: bool = True) -> None:
        self.steady, self.visible = steady, visible
        self._scalars: dict[str, float] = {}
        self._bar = Bar(
            TextColumn("{task.description}", style="bold"),
            BarColumn(bar_width=None),
            TextColumn("{task.completed:,.0f}/{task.total:,.0f}", style="green"),
            expand=True,
            speed_estimate_period=PERIOD,
            get_time=lambda: time.monotonic(),
        )
        self._bar.add_task(label, total=total)
        (self._task,) = self._bar.tasks
        self._printed: float | None = None  # [s] latest plain line
        self._pause = PAUSE  # [s] after it
        self._pending = False
        self._task_now: tuple[str, float] | None = None  # what is going on, since when [s]
        self._live: Live | None = None
        self._lock = threading.RLock()
        self._ended = threading.Event()

    def __enter__(self) -> Self:
        self._began, console = time.monotonic(), self._bar.console
        if self.visible and sys.stdout.isatty() and not console.is_dumb_terminal:
            self._live = Live(get_renderable=self._picture, console=console, refresh_per_second=4)
            self._live.start()
            console.show_cursor(True)  # nothing to restore if the process ends suddenly
        elif self.visible:
            threading.Thread(target=self._beat, daemon=True).start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ended.set()
        if self._live is not None:
            with ignore_closed_output():
                self._live.stop()
            self._live = None
        elif self._pending:
            self._print()

    def update(self, step: int, scalars: dict[str, float], say: bool | None = None) -> None:
        """Show the step and scalars; a scalar that is not given keeps its latest value.

        say: whether to print a plain line; None: if the last one was PAUSE ago.
        """
        self._scalars |= scalars
        change = self._bar.reset if step < self.steady else self._bar.update
        change(self._task.id, completed=step)
        if self._live is not None:
            return
        self._pending, self._pause, last = self.visible, PAUSE, self._printed
        if say or (say is None and (last is None or time.monotonic() - last >= PAUSE)):
            self._print()

    @contextmanager
    def doing(self, what: str) -> Iterator[None]:
        """Name the current activity in lines that are printed during the block."""
        self._task_now = what, time.monotonic()
        try:
            yield
        finally:
            self._task_now = None

    def note(self, text: str) -> None:
        """Print a line above the display."""
        if self._live is not None:
            with ignore_closed_output():
                self._live.console.print(text, markup=False, highlight=False)
        elif self.visible:
            with self._lock:
                say(text)

    def _beat(self) -> None:
        """Print a plain line after each pause, also during a slow call."""
        while not self._ended.wait(1.0):
            if time.monotonic() - (self._printed or self._began) >= self._pause:
                self._print()
                self._pause *= 2

    def _print(self) -> None:
        """Print a plain line."""
        if not self.visible:
            return
        task = self._task
        with self._lock:
            count = f"{task.completed:,.0f}/{task.total:,.0f} ({task.percentage:.0f}%)"
            say("  ".join([task.description, count, *self._numbers()]).strip())
            self._printed, self._pending = time.monotonic(), False

    def _numbers(self) -> list[str]:
        """The latest values as words."""
        values = self._scalars
        known = [text.format(values[name]) for name, text in SHOWN.items() if name in values]
        if (speed := values.get("perf/env_steps_per_s")) is not None:
            known.append(f"{rate(speed)} decisions/s")
        if left := self._task.time_remaining:
            known.append(f"{timedelta(seconds=round(left))} left")
        if self._task_now is not None:
            what, since = self._task_now
            known.append(f"{what} for {timedelta(seconds=round(time.monotonic() - since))}")
        return known

    def _picture(self) -> Group:
        """The live display: the bar, and the numbers below it."""
        return Group(self._bar, Text("  ".join(self._numbers()) or " ", style="cyan"))


def rate(value: float) -> str:
    """A speed: 52,000 or 3.7."""
    return f"{value:,.0f}" if value >= 9.95 else f"{value:.1f}"
