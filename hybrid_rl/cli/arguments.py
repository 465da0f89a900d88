"""key=value arguments of a command, declared once for parsing, checks and --help."""

import inspect
import math
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryFile
from typing import Any

from hybrid_rl.errors import UsageError
from hybrid_rl.settings.complete import nearest
from hybrid_rl.settings.groups import MODES

Kind = Callable[[str, str], Any]  # (name, text) -> value
HELP = ("--help", "-h")


def text(name: str, given: str) -> str:
    """Any text."""
    return given


def _kind(parse: Callable[[str], Any], holds: Callable[[Any], bool], must: str) -> Kind:
    """The values that `parse` makes of a text, where they hold; must: words of the error."""

    def kind(name: str, given: str) -> Any:
        with suppress(ValueError):
            if holds(value := parse(given)):
                return value
        raise UsageError(f"{name}={given}: {must}")

    return kind


def flag(name: str, given: str) -> bool:
    """true or false."""
    return one_of("true", "false")(name, given.lower()) == "true"


def whole(least: int = 1, even: bool = False) -> Kind:
    """A whole number."""
    called = "an even number" if even else "a whole number"
    must = f"must be {called}, {least + even} or more"
    return _kind(int, lambda n: n >= least and not (even and n % 2), must)


def number(least: float = -math.inf, what: str = "") -> Kind:
    """A finite number; what: words that follow "a number" in the message."""
    what = what or (f", {least:g} or more" if least > -math.inf else "")
    return _kind(float, lambda x: math.isfinite(x) and x >= least, f"must be a number{what}")


def numbers(each: Kind | None = None) -> Kind:
    """Numbers with commas between them; each: kind of one."""
    one = each or number(what=", or several with commas between them")
    return lambda name, given: [one(name, part) for part in given.split(",")]


def one_of(*known: str) -> Kind:
    """One of the names."""
    return _kind(str, known.__contains__, f"choose one of {', '.join(filter(None, known))}")


def several(*known: str) -> Kind:
    """Some of the names, with commas between them."""
    return numbers(one_of(*known))


@dataclass(frozen=True)
class Argument:
    """One argument of a command."""

    name: str
    default: Any  # as `kind` returns it
    about: str  # description in --help
    kind: Kind = text
    needed: str = ""  # what to give, for an argument that is required


MODE = one_of(*MODES)  # who acts
POLICY = Argument("policy", "", "instead: a trained policy, NAME of policies/ or a file")

GOAL = (  # of commands that show a trained run in another world or on another goal
    Argument("reward", "", "another reward, of conf/reward; empty: as in training"),
    Argument("constraint", "", "a constraint, of conf/constraint; empty: as in training"),
    Argument("planner", "", "of conf/controller; empty: gradient with reward= or constraint="),
)
CHANGES = {
    **{name: f"another value for a key of the {name}" for name in ("env", "episode")},
    **{each.name: f"a key of the part that {each.name}= chooses" for each in GOAL},
}
CONFIG_DIR = Argument("config_dir", "", "folder with configuration groups of yours")
ROBOT = (  # of commands that show a trained robot, or a scripted expert
    Argument("run", "", "folder of a trained run"),
    POLICY,
    Argument("task", "", "instead: a task with a scripted expert"),
    Argument("expert", "", "with task=T: another of conf/expert, such as babble"),
    *GOAL,
    CONFIG_DIR,
    Argument("mode", "full", "of run or policy: full, policy or planner", MODE),
    Argument("seed", None, "of run=DIR: a learner; of task=T: the first state", whole(least=0)),
)
ROBOT_CHANGES = {**CHANGES, "expert": "with task=T: a key of its expert"}


SHOWN = ("run", "policy", "task")  # of ROBOT, one of which is given


def robot(given: Mapping[str, Any], changes: Mapping[str, str]) -> str:
    """The run, policy or task that values of ROBOT name."""
    named = next(given[name] for name in SHOWN if given[name])
    others = [*(argument.name for argument in GOAL), "mode"] if given["task"] else ["expert"]
    for argument in ROBOT:
        name, chosen = argument.name, given[argument.name] != argument.default
        if name in others and (chosen or any(key.startswith(f"{name}.") for key in changes)):
            fits = "run=DIR or policy=NAME" if given["task"] else "task=T"
            raise UsageError(f"{name}: is not for {named}; give it with {fits}")
    return named


def read(
    doc: str | None,
    known: Sequence[Argument],
    groups: Mapping[str, str] | None = None,
    one: Sequence[str] = (),
) -> tuple[dict[str, Any], dict[str, str]]:
    """The values of all `known` arguments, and the `group.key=value` of the user.

    With --help the process prints the help and ends.

    Args:
        doc: the docstring of its module.
        known: its arguments.
        groups: groups of the configuration whose keys it accepts -> their description in --help.
        one: the arguments of which the user gives exactly one.
    """
    groups = groups or {}
    line = sys.argv[1:]
    if set(HELP) & set(line):
        lines = [(f"{each.name}={_written(each.default)}", each) for each in known]
        rows = [(head, ("needed; " if each.needed else "") + each.about) for head, each in lines]
        rows += [(f"{group}.KEY=VALUE", about) for group, about in groups.items()]
        rows.append(("--help", "this text"))
        width = min(max(len(head) for head, _ in rows), 34)
        table = "\n".join(f"  {head:{width}}  {about}" for head, about in rows)
        print(f"{inspect.cleandoc(doc or '')}\n\nArguments, with their defaults:\n{table}")
        sys.exit(0)
    named = {argument.name: argument for argument in known}
    values, changes = {argument.name: argument.default for argument in known}, {}
    for given in line:
        name, equals, value = given.partition("=")
        if equals and name in named:
            values[name] = named[name].kind(name, value)
        elif equals and "." in name and name.partition(".")[0] in groups:
            changes[name] = value
        else:
            keys = ", ".join([*named, *(f"{group}.KEY" for group in groups)])
            near = nearest(name.lstrip("-").replace("-", "_"), named)
            hint = f"did you mean {near}=VALUE?" if near else f"give KEY=VALUE with {keys}"
            raise UsageError(f"{given}: unknown argument; {hint}")
    for argument in known:
        if argument.needed and not values[argument.name]:
            raise UsageError(f"{argument.name}: not given; give {argument.needed}")
    if one and sum(bool(values[name]) for name in one) != 1:
        about = "; ".join(f"{name}=, {named[name].about}" for name in one)
        raise UsageError(f"{', '.join(one)}: give one of them: {about}")
    return values, changes


def _written(value: Any) -> str:
    """A default as it is typed."""
    if value is None or isinstance(value, bool):
        return "" if value is None else str(value).lower()
    return ",".join(value) if isinstance(value, list) else f"{value}"


def output(key: str, out: str | Path, suffixes: Sequence[str]) -> Path:
    """`out`, the value of argument `key`, as a path, after a check that it can be written to."""
    out = Path(out)
    if out.suffix not in suffixes:
        raise UsageError(f"{key}={out}: must end in {', '.join(suffixes)}")
    try:
        with TemporaryFile(dir=out.absolute().parent):
            pass
    except OSError as error:
        raise UsageError(f"{key}={out}: cannot be written to ({error.strerror})") from error
    return out
