"""The controllers of a window, their world, and its numbers that a slider may change.

A number of a reward or of a constraint is an argument of the compiled programs: a slider moves it
without a compilation. Everything else makes other programs.
"""

import copy
from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import cached_property
from typing import Any, get_args

from hybrid_rl import Episode, Trained, UsageError, expert, retargeted
from hybrid_rl.fields import Must, choices, plain
from hybrid_rl.protocols import Controller
from hybrid_rl.types import Params

GOALS = ("reward", "constraint")  # fields of an episode
CHOSEN = (*GOALS, "planner", "expert")  # arguments that name a part
DISTURBED = {"delay": 0.25, "sensor_noise": 0.5, "action_noise": 0.5}  # of an episode -> the most
EFFORT = ("samples", "elites", "refined", "iterations")  # fields of a planner
QUICK = 4  # times fewer of them
SPAN = 5.0  # a slider ends at so many times its value; at so many, of what is 0 or has a sign


@dataclass(frozen=True)
class Slider:
    """The range of a number; key: group.KEY as on the command line."""

    key: str
    value: float
    least: float
    most: float
    step: float


@dataclass(frozen=True)
class Subject:
    """A learner or a scripted expert, in a world."""

    episode: Episode
    controllers: dict[str, Controller]  # mode -> who acts
    blind: frozenset[str]  # modes that get observations, and not the state of the world

    def named(self, mode: str) -> str:
        """The name of `mode` among the controllers; full is the only one where one acts."""
        if mode not in (*self.controllers, "full"):
            raise UsageError(f"mode={mode}: choose one of {', '.join(self.controllers)}")
        return mode if mode in self.controllers else next(iter(self.controllers))

    def plans(self, mode: str) -> bool:
        """Whether who acts in `mode` is quicker with fewer candidates."""
        return quicker(self.controllers[mode]) is not self.controllers[mode]

    def sees_world(self, mode: str) -> bool:
        """Whether who acts in `mode` gets the state of the world, and not only observations."""
        return mode not in self.blind or self.episode.observe is not None

    @cached_property
    def goals(self) -> list[Slider]:
        """The numbers of the reward and of the constraint."""
        parts = {name: getattr(self.episode, name) for name in GOALS}
        return [each for name, part in parts.items() if part for each in sliders(name, part)]

    @cached_property
    def body(self) -> list[Slider]:
        """The numbers of the environment, and the disturbances of its episodes."""
        found = sliders("episode", self.episode)
        found = [each for each in found if each.key.partition(".")[2] in DISTURBED]
        return sliders("env", self.episode.env) + found

    @cached_property
    def commands(self) -> list[Slider]:
        """The commands of a robot whose environment has `commands`, and `commanded`."""
        each = getattr(self.episode.env, "commands", {}).items()
        return [Slider(f"command.{name}", 0.0, -most, most, most / 20) for name, most in each]


def quicker(controller: Controller) -> Controller:
    """A planner with fewer candidates, and fewer steps of them; the same if it has none."""
    numbers = {name: getattr(controller, name, None) for name in EFFORT}
    fewer = {name: -(-n // QUICK) for name, n in numbers.items() if isinstance(n, int)}
    part: Any = controller
    return replace(part, **fewer) if fewer else controller


def sliders(group: str, part: Any) -> list[Slider]:
    """One for each number of a part."""
    found = []
    for field in fields(part):
        value = getattr(part, field.name)
        if isinstance(value, bool) or not isinstance(value, int | float):
            continue
        whole = any(plain(kind) is int for kind in choices(field.type))
        signed = not whole and group != "episode" and _allowed(field.type, -1.0)
        most = SPAN * (abs(value) if value and not signed else max(1.0, abs(value)))
        if group == "episode":
            most = max(DISTURBED.get(field.name, most), value)
        most = next((x for x in (most, 1.0, 0.99) if _allowed(field.type, x)), value)
        step = 1.0 if whole else most / 100
        lows = -most if signed else 0.0, 0.0, step
        least = next((x for x in lows if _allowed(field.type, x)), value)
        if few := sorted(x for rule in _rules(field.type) for x in rule.of):
            least, most, step = few[0], few[-1], few[1] - few[0]
        found.append(Slider(f"{group}.{field.name}", value, least, most, step))
    return found


def _allowed(kind: Any, value: float) -> bool:
    """Whether the rules of a field's type hold for a number; whole where one must be."""
    number = int(value) if value.is_integer() else value
    return all(rule.hold(number) for rule in _rules(kind))


def _rules(kind: Any) -> list[Must]:
    """The rules of a field's type."""
    return [rule for each in choices(kind) for rule in get_args(each) if isinstance(rule, Must)]


def with_goals(whole: Any, episode: Episode, numbers: Mapping[str, Any]) -> Any:
    """`whole`, a part that holds the goals of `episode`, with other `numbers` in them.

    numbers: group.KEY -> value [], which may be traced: the checks of the fields do not run.
    """
    for name in GOALS:
        part = getattr(episode, name)
        mine = {key.partition(".")[2]: value for key, value in numbers.items()}
        mine = {key: mine[key] for key in mine if f"{name}.{key}" in numbers}
        if part is not None and mine:
            whole = replace_part(whole, part, _put(part, mine))
    return whole


def _put(part: Any, values: Mapping[str, Any]) -> Any:
    """A copy of a frozen part with other values of its fields."""
    part = copy.copy(part)
    for name, value in values.items():
        object.__setattr__(part, name, value)
    return part


def replace_part(whole: Any, old: Any, new: Any) -> Any:
    """`whole`, in which `new` stands wherever `old` stood; no field is checked again."""
    if isinstance(whole, tuple) and type(whole) is tuple:
        return tuple(replace_part(each, old, new) for each in whole)
    if not is_dataclass(whole) or isinstance(whole, type):
        return whole
    if type(whole) is type(old) and whole == old:
        return new
    each = {field.name: getattr(whole, field.name) for field in fields(whole)}
    other = {name: replace_part(value, old, new) for name, value in each.items()}
    other = {name: value for name, value in other.items() if value is not each[name]}
    return _put(whole, other) if other else whole


@dataclass(frozen=True)
class Source:
    """What the arguments of the command name, read once."""

    given: Mapping[str, Any]
    changes: Mapping[str, str]
    trained: Trained | None  # None: a scripted expert

    @property
    def plans(self) -> bool:
        """Whether there is a learned model with which to plan for another reward."""
        return self.trained is not None and self.trained.params.model is not None

    def subject(self, reward: str, changes: Mapping[str, str], quick: bool = False) -> Subject:
        """Who acts, with a reward of conf/reward ("": that of the training) and other changes.

        quick: whether planners think less.
        """
        given = {name: self.given[name] for name in CHOSEN if self.given[name]}
        words = {**self.changes, **changes}
        if self.trained is None:
            parts = expert(self.given["task"], _overrides(given, words), self._folder)
            return Subject(parts[0], {"expert": parts[1]}, frozenset())
        if reward != self.given["reward"]:
            words = {key: value for key, value in words.items() if not key.startswith("reward.")}
        if reward:
            given["reward"] = reward
        else:
            given.pop("reward", None)
        if self.plans and self.trained.agent is None:  # a file: its policy and models, no planner
            given.setdefault("planner", "gradient")
        trained = retargeted(self.trained, _overrides(given, words), self._folder)
        acting = dict(trained.controllers)
        if acting["full"] == acting.get("policy"):
            del acting["full"]
        blind = frozenset(mode for mode in acting if _observes(trained, mode))
        if quick:
            acting = {mode: quicker(controller) for mode, controller in acting.items()}
        return Subject(trained.episode, acting, blind)

    @property
    def _folder(self) -> str | None:
        """The folder with configuration groups of the user's."""
        return self.given["config_dir"] or None


def _overrides(*each: Mapping[str, str]) -> list[str]:
    return [f"{key}={value}" for some in each for key, value in some.items()]


def _observes(trained: Trained, mode: str) -> bool:
    """Whether observations are enough for who acts in `mode`."""
    try:
        return bool(trained.learner(mode=mode))
    except UsageError:
        return False


def learner(trained: Trained | None, seed: int | None) -> Params:
    """The parameters of the learner of `seed`; None: the first. A scripted expert has none."""
    if trained is None:
        return Params()
    return trained.learner(seed, next(iter(trained.controllers)), world=True)[1]
