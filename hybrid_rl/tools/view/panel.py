"""The controls and the plots beside the robot. Callbacks only note wishes; a loop reads them."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from viser import ViserServer

from hybrid_rl.tools.view.history import PLOTS, History
from hybrid_rl.tools.view.player import Choice
from hybrid_rl.tools.view.push import Pull
from hybrid_rl.tools.view.scene import BRIGHT, PALE
from hybrid_rl.tools.view.subject import Slider

LAST_SEED = 2**32 - 1
STEP, AGAIN = "Step", "New episode"
LEGEND = '<div style="font-size: 12px; padding: 0 1em 0.5em">{}</div>'.format(
    " &nbsp; ".join(
        f'<b style="color: rgb{colour}">&#9473;</b> {name}'
        for name, colour in (("the plan that acts", BRIGHT), ("other candidates", PALE))
    )
)


@dataclass
class Wishes:
    """What the user wants."""

    choice: Choice
    seed: int
    paused: bool = False
    candidates: bool = True
    speed: float = 1.0  # of real time
    steps: int = 0  # decisions to take while paused
    again: bool = False  # an episode should begin
    numbers: dict[str, float] = field(default_factory=dict)  # of the goal
    command: dict[str, float] = field(
        default_factory=dict
    )  # of a robot that follows one; or nothing
    pull: Pull | None = None


class Panel:
    """The controls of `wishes`."""

    def __init__(
        self, server: ViserServer, wishes: Wishes, modes: Sequence[str], rewards: Sequence[str]
    ) -> None:
        """rewards: names of conf/reward that may be chosen; none: there is no choice."""
        self._gui, self._wishes = server.gui, wishes
        self._gui.configure_theme(
            show_share_button=False, show_logo=False, dark_mode=False, control_width="medium"
        )
        self._gui.main_panel.dock_right()  # beside the robot
        self._gui.set_panel_label("hybrid_rl")
        self._status = self._gui.add_markdown("")
        self._run()
        self._modes = self._gui.add_dropdown(
            "mode", tuple(modes), initial_value=wishes.choice.mode, visible=len(modes) > 1
        )
        self._modes.on_update(lambda _: self._choose(mode=self._modes.value))
        hint = "a quarter of its candidates and of its gradient steps"
        quick, label = wishes.choice.quick, "plan less, faster"
        self._quick = self._gui.add_checkbox(label, quick, hint=hint, visible=False)
        self._quick.on_update(lambda _: self._choose(quick=self._quick.value))
        if rewards:
            names = ("of the training", *rewards)
            first = wishes.choice.reward or names[0]
            reward = self._gui.add_dropdown("reward", names, initial_value=first)
            reward.on_update(
                lambda _: self._choose(reward="" if reward.value == names[0] else reward.value)
            )
        self._command = self._gui.add_folder("Command", visible=False)
        self._goal = self._gui.add_folder("Goal", visible=False)
        self._plots = {each: self._plot(each) for each in PLOTS}
        self._body = self._gui.add_folder(
            "Body and disturbances", expand_by_default=False, visible=False
        )
        self._goals: list[Slider] = []
        self._handles: list[Any] = []

    def _run(self) -> None:
        """Pause, step, a new episode, its seed, the speed."""
        gui, wishes = self._gui, self._wishes
        paused = gui.add_checkbox("paused", wishes.paused)
        paused.on_update(lambda _: setattr(wishes, "paused", paused.value))
        buttons = gui.add_button_group("", (STEP, AGAIN))

        @buttons.on_click
        def _(_: Any) -> None:
            if buttons.value == STEP:
                paused.value = wishes.paused = True
                wishes.steps += 1
            else:
                wishes.again = True

        seed = gui.add_number("seed", wishes.seed, min=0, max=LAST_SEED, step=1)
        seed.on_update(lambda _: self._seeded(int(seed.value)))
        speed = gui.add_slider("speed", 0.1, 1.0, 0.1, wishes.speed, hint="times real time")
        speed.on_update(lambda _: setattr(wishes, "speed", speed.value))
        paths = gui.add_checkbox("imagined paths", wishes.candidates)
        paths.on_update(lambda _: setattr(wishes, "candidates", paths.value))
        gui.add_html(LEGEND)

    def _seeded(self, seed: int) -> None:
        self._wishes.seed, self._wishes.again = seed, True

    def _choose(self, **changed: Any) -> None:
        self._wishes.choice = replace(self._wishes.choice, **changed)

    def _plot(self, name: str) -> Any:
        colour, aspect = PLOTS[name], 2.6
        return self._gui.add_uplot(
            data=(np.zeros(1), np.zeros(1)),
            series=({"label": "t [s]"}, {"label": name, "stroke": colour, "width": 2}),
            aspect=aspect,
            scales={"x": {"time": False}},
            visible=False,
        )

    def command(self, found: Sequence[Slider]) -> None:
        """Sliders of what the robot is to do."""
        with self._command:
            for one in found:
                self._slider(one, self._wishes.command.__setitem__)
        self._command.visible = bool(found)

    def body(self, found: Sequence[Slider]) -> None:
        """Sliders of the body, which make other programs."""
        with self._body:
            for one in found:
                self._slider(one, self._changed)
        self._body.visible = bool(found)

    def _changed(self, key: str, value: float) -> None:
        self._choose(changes={**self._wishes.choice.changes, key: f"{value:g}"})

    def _slider(self, one: Slider, moved: Any) -> Any:
        label = one.key.partition(".")[2].replace("_", " ")
        first = min(max(one.value, one.least), one.most)
        handle = self._gui.add_slider(label, one.least, one.most, one.step, first, hint=one.key)
        handle.on_update(lambda _: moved(one.key, handle.value))
        return handle

    def show(self, modes: Sequence[str], planner: bool, goals: list[Slider], line: str) -> None:
        """The modes there are, whether one plans, sliders of the goal, a line about what acts."""
        if planner != self._quick.visible:
            self._quick.visible = planner
        if tuple(modes) != tuple(self._modes.options):
            self._modes.options = tuple(modes)
            self._modes.value = self._wishes.choice.mode
        if goals != self._goals:
            for handle in self._handles:
                handle.remove()
            self._wishes.numbers.clear()
            with self._goal:
                self._handles = [
                    self._slider(one, self._wishes.numbers.__setitem__) for one in goals
                ]
            self._goals, self._goal.visible = goals, bool(goals)
        if line != self._status.content:
            self._status.content = line

    def plot(self, history: History) -> None:
        """The last decisions."""
        for name, handle in self._plots.items():
            t, y = history.curve(name)
            handle.visible = len(y) > 1
            if len(y) > 1:
                handle.data = (t, y)
