"""Progress of a run on the terminal: a live bar, or plain lines in a file."""

import os
import sys
import threading
import time
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Self

from rich.console import Console, Group
from rich.live import Live
from rich.progress import BarColumn, TextColumn
from rich.progress import Progress as Bar
from rich.text import Text

from hybrid_rl.run.logs import curve

WINDOW = 30.0  # [s] over which the speed is measured
PAUSE = 8.0  # [s] between two plain lines
DRAWN = "eval/return"  # whose latest values a terminal shows as a small curve
SHOWN = {  # scalar -> its format
    "train/return": "return {:,.1f}",
    "eval/return": "eval {:,.1f}",
    "eval/success": "success {:.0%}",
    "eval/violations": "violations {:,.1f}",
    "perf/env_steps_per_s": "{} decisions/s",
}


def say(text: str) -> None:
    """Print a line; it vanishes where the pipe or the terminal was closed.

    That ends no run, as its records are in its folder.
    """
    with ignore_closed_output():
        print(text, flush=True)


@contextmanager
def ignore_closed_output() -> Iterator[None]:
    """Within, output that cannot be written is dropped, and so is all after it."""
    try:
        yield
    except OSError:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        with suppress(OSError):  # it may be no file, as in a notebook
            os.dup2(nowhere, sys.stdout.fileno())  # for what Python's buffer still holds, too
        os.close(nowhere)


class Progress:
    """Steps of `total`, the latest scalars, speed, time left; a line at least every 10 s.

    unit: of a step; steady: the step from which the speed is representative; visible: false shows
    nothing.

    with Progress(total, "halfcheetah sac") as progress:
        with progress.doing("compiling"):
            ...
        progress.update(step, {"train/return": 12.0})
    """

    def __init__(
        self,
        total: int,
        label: str = "",
        unit: str = "steps",
        steady: int = 0,
        visible: bool = True,
    ) -> None:
        self.total, self.step, self.label = total, 0, label
        self.unit, self.steady, self.visible = unit, steady, visible
        self._scalars: dict[str, tuple[float, int]] = {}  # name -> value, step
        self._drawn: list[float] = []  # values of DRAWN
        self._clock: deque[tuple[float, int]] = deque()  # ([s], step), the last WINDOW
        self._printed: float | None = None  # [s] latest plain line, or the start
        self._pending = False
        self._task_now: tuple[str, float] | None = None  # what is going on, since when [s]
        self._live: Live | None = None
        self._lock = threading.RLock()
        self._ended = threading.Event()

    def __enter__(self) -> Self:
        self._began = time.monotonic()
        console = Console()
        if self.visible and sys.stdout.isatty() and not console.is_dumb_terminal:
            self._bar = Bar(
                TextColumn("{task.description}", style="bold"),
                BarColumn(bar_width=None),
                TextColumn("{task.completed:,.0f}/{task.total:,.0f}", style="green"),
                console=console,
                expand=True,
            )
            self._draws = console.encoding.startswith("utf")
            self._task = self._bar.add_task(self.label, total=self.total, completed=self.step)
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
        now = time.monotonic()
        self.step = step
        if DRAWN in scalars:
            self._drawn.append(scalars[DRAWN])
        self._scalars |= {name: (value, step) for name, value in scalars.items()}
        if step >= self.steady:
            self._clock.append((now, step))
        while len(self._clock) > 2 and self._clock[1][0] < now - WINDOW:
            self._clock.popleft()
        if self._live is not None:
            self._bar.update(self._task, completed=step)
            return
        self._pending = self.visible
        if say or (say is None and (self._printed is None or now - self._printed >= PAUSE)):
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

    def seconds_left(self) -> float | None:
        """Time left at the present speed [s]; None before the first update and at the end."""
        if len(self._clock) < 2 or self.step >= self.total:
            return None
        (then, before), (now, step) = self._clock[0], self._clock[-1]
        return (self.total - step) * (now - then) / (step - before) if step > before else None

    def _beat(self) -> None:
        """Print a plain line whenever the last one was PAUSE ago, also during a slow call."""
        while not self._ended.wait(1.0):
            if time.monotonic() - (self._printed or self._began) >= PAUSE:
                self._print()

    def _print(self) -> None:
        """Print a plain line."""
        if not self.visible:
            return
        with self._lock:
            share = self.step / self.total if self.total else 1.0
            count = f"{self.step:,}/{self.total:,} ({share:.0%})"
            say("  ".join([self.label, count, *self._numbers(False)]).strip())
            self._printed, self._pending = time.monotonic(), False

    def _numbers(self, old: bool) -> list[str]:
        """The latest values as words. old: include an evaluation of an earlier step."""
        known = []
        for name, text in SHOWN.items():
            value, at = self._scalars.get(name, (None, 0))
            now = at == self.step or not name.startswith("eval/")
            if value is not None and (now or old):
                shown = rate(value) if name.startswith("perf/") else value
                known.append(text.format(shown) + ("" if now else f" at {at:,}"))
        left = self.seconds_left()
        if left is not None:
            if "perf/env_steps_per_s" not in self._scalars and left > 0:
                known.append(f"{rate((self.total - self.step) / left)} {self.unit}/s")
            known.append(f"{clock(left)} left")
        if self._task_now is not None:
            what, since = self._task_now
            known.append(f"{what} for {clock(time.monotonic() - since)}")
        return known

    def _picture(self) -> Group:
        """The live display: the bar, the numbers below it, and a curve of the evaluations."""
        lines = [Text("  ".join(self._numbers(True)) or " ", style="cyan")]
        if self._draws and len(self._drawn) > 1:
            lines.append(Text(curve.small(self._drawn), style="green"))
        return Group(self._bar, *lines)


def rate(value: float) -> str:
    """A speed: 52,000 or 3.7."""
    return f"{value:,.0f}" if value >= 9.95 else f"{value:.1f}"


def clock(seconds: float) -> str:
    """A duration as h:mm:ss."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{rest:02}"
