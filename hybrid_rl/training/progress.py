"""How a run is doing, on the terminal: a live bar, or plain lines in a file."""

import sys
import time
from collections import deque
from types import TracebackType
from typing import Self

from rich.console import Console, Group
from rich.live import Live
from rich.progress import BarColumn, Task, TextColumn
from rich.progress import Progress as Bar
from rich.text import Text

WINDOW = 30.0  # [s] over which the speed is measured
PAUSE = 5.0  # [s] between two plain lines, at first
PATIENCE = 0.01  # and later this share of the time gone by
LONGEST = 60.0  # [s] but never more than this
SHOWN = {  # scalar -> how it reads
    "train/return": "return {:,.1f}",
    "eval/return": "eval {:,.1f}",
    "eval/success": "success {:.0%}",
    "perf/env_steps_per_s": "{:,.0f} steps/s",
}


class Progress:
    """Steps done of `total` [decisions], the latest scalars, speed, time left.

    with Progress(total, start, "halfcheetah sac") as progress:
        progress.note("compiling ...")
        progress.update(step, {"train/return": 12.0})
    """

    def __init__(self, total: int, start: int = 0, label: str = "", unit: str = "steps") -> None:
        self.total, self.step, self.label, self.unit = total, start, label, unit
        self._scalars: dict[str, float] = {}
        self._clock: deque[tuple[float, int]] = deque()  # ([s], step), the last WINDOW
        self._began = self._spoke = 0.0  # [s] start, and latest plain line
        self._unsaid = False
        self._live: Live | None = None

    def __enter__(self) -> Self:
        self._began = time.monotonic()
        console = Console()
        if sys.stdout.isatty() and not console.is_dumb_terminal:
            self._bar = Bar(
                TextColumn("{task.description}", style="bold"),
                BarColumn(bar_width=None),
                _Count("{task.completed}"),
                console=console,
                expand=True,
            )
            self._task = self._bar.add_task(self.label, total=self.total, completed=self.step)
            self._live = Live(get_renderable=self._picture, console=console, refresh_per_second=4)
            self._live.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        problem: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._live is not None:
            self._live.stop()
            self._live = None
        elif self._unsaid:
            self._say()

    def update(self, step: int, scalars: dict[str, float]) -> None:
        """Tells where the run is; a scalar that is not given keeps its latest value."""
        now = time.monotonic()
        self.step = step
        self._scalars |= scalars
        self._clock.append((now, step))
        while len(self._clock) > 2 and self._clock[1][0] < now - WINDOW:
            self._clock.popleft()
        if self._live is not None:
            self._bar.update(self._task, completed=step)
            return
        pause = min(max(PAUSE, PATIENCE * (now - self._began)), LONGEST)
        self._unsaid = True
        if not self._spoke or now - self._spoke >= pause or step >= self.total:
            self._say()

    def note(self, text: str) -> None:
        """A line that stays."""
        if self._live is not None:
            self._live.console.print(text, markup=False, highlight=False)
        else:
            print(text, flush=True)

    def seconds_left(self) -> float | None:
        """[s] to go at the present speed; None before there is one."""
        if len(self._clock) < 2:
            return None
        (then, before), (now, step) = self._clock[0], self._clock[-1]
        return (self.total - step) * (now - then) / (step - before) if step > before else None

    def _say(self) -> None:
        """One plain line."""
        share = self.step / self.total if self.total else 1.0
        count = f"{self.step:,}/{self.total:,} ({share:.0%})"
        print("  ".join([self.label, count, *self._numbers()]).strip(), flush=True)
        self._spoke, self._unsaid = time.monotonic(), False

    def _numbers(self) -> list[str]:
        """The latest of everything, in words."""
        known = [
            text.format(self._scalars[name])
            for name, text in SHOWN.items()
            if name in self._scalars
        ]
        left = self.seconds_left()
        if left is None:
            return known
        if "perf/env_steps_per_s" not in self._scalars and left > 0:
            known.append(f"{(self.total - self.step) / left:,.0f} {self.unit}/s")
        return [*known, f"{clock(left)} left"]

    def _picture(self) -> Group:
        """The live display: the bar, and the numbers below it."""
        return Group(self._bar, Text("  ".join(self._numbers()) or " ", style="cyan"))


class _Count(TextColumn):
    """The steps: 1,000/2,000."""

    def render(self, task: Task) -> Text:
        return Text(f"{int(task.completed):,}/{int(task.total or 0):,}", style="green")


def clock(seconds: float) -> str:
    """A duration as h:mm:ss."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{rest:02}"
