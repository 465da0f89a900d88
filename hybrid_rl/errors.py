"""Errors of a run: each message is one line, and each class has its exit code."""

import inspect
import re
import sysconfig
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

OURS = {Path(__file__).parent, Path(__file__).resolve().parents[1] / "envs"}
LIBRARIES = {Path(sysconfig.get_path(name)) for name in ("stdlib", "purelib", "platlib")}
FOREIGN = OURS | LIBRARIES  # folders of code that is not the user's
MOST = 300  # characters of another library's message
HINTS = {  # kind of error -> what to write instead
    "TracerBoolConversionError": "write jnp.where or jax.lax.cond instead of `if`",
    "TracerArrayConversionError": "write jnp instead of np",
    "ConcretizationTypeError": "write jnp instead of float(), int() and math",
    "FrozenInstanceError": "what changes belongs in the EnvState that step returns, as in info",
}
FAULTS = (Exception, SystemExit)  # what the user's code may raise; neither ends a run in silence

GYMNASIUM = (  # what an environment of Gymnasium is here
    "a gymnasium.Env, and this must be a class with JAX functions; task=gymnasium "
    "env.make=MODULE:CLASS, or External(make=CLASS) in Python, trains in it as it is"
)
NO_WORDS = (  # what to write where a command is a list of words
    'give a list of words, such as ["task=pendulum", "algo=sac"]; a Gymnasium environment is '
    '["task=gymnasium", "env.make=MODULE:CLASS"], one in JAX is part of an Agent (docs/python.md)'
)


class UsageError(ValueError):
    """The request is invalid; the message says what to change. Exit code 2."""


class PartError(UsageError):
    """A class of the user's is wrong; the message begins with its file. Exit code 2."""


class WorldError(PartError):
    """An environment of the user's is wrong; otherwise as PartError."""


class DivergenceError(ArithmeticError):
    """A learner reached NaN or infinity; names seed, step and quantity. Exit code 1."""


class CheckpointError(OSError):
    """A checkpoint cannot be written, or none can be read. Exit code 1."""


class MisfitError(CheckpointError):
    """A checkpoint is intact but belongs to another run."""


@dataclass(frozen=True)
class SourceOf:
    """Where the class of an object, perhaps the user's, is written; errors that name this."""

    object: Any
    error: type[PartError] = PartError  # what its methods raise

    def at(self, method: str = "") -> str:
        """FILE:LINE: CLASS.METHOD, as far as they are known."""
        kind = type(self.object)
        name = f"{kind.__name__}.{method}" if method else kind.__name__
        try:
            source = inspect.unwrap(getattr(kind, method)) if method else kind
            return f"{relative(self.file)}:{inspect.getsourcelines(source)[1]}: {name}"
        except (OSError, TypeError, AttributeError):  # typed in, or no plain method
            return f"{kind.__module__}: {name}"

    @property
    def file(self) -> str:
        """The file of the class; "" if it has none."""
        try:
            return inspect.getsourcefile(type(self.object)) or ""
        except TypeError:
            return ""

    def blamed(self, method: str, call: Callable[..., Any], *arguments: Any) -> Any:
        """The result of `call`; what goes wrong in it is the line of the user's that caused it."""
        try:
            return call(*arguments)
        except UsageError:
            raise
        except FAULTS as error:
            raised = traceback.extract_tb(error.__traceback__)[-1].filename
            own = not OURS.isdisjoint(Path(raised).parents)  # a line of this package raised it
            if isinstance(error, ValueError) and own and user_line(error) is None:
                raise  # it says what to change
            line = user_line(error, self.file)
            if line is None:
                raise self.error(f"{self.at(method)}: {one_line(error)}") from error
            where, _, what = line.partition(": ")
            raise self.error(f"{where}: {type(self.object).__name__}.{method}: {what}") from error


def install(extra: str) -> str:
    """The command that installs an extra of this package, of a checkout or a wheel, in any folder.

    In quotes, as zsh reads brackets as a pattern.
    """
    return f'pip install "hybrid_rl[{extra}]"'


def user_line(error: BaseException, own: str = "", ours: bool = False) -> str | None:
    """FILE:LINE of the user's, what was raised there and a hint; None if no such file took part.

    own: a file that counts as the user's wherever it is. ours: also None where the user's line
    called this package, in which it was raised.
    """
    if isinstance(error, SyntaxError) and error.filename:
        return f"{relative(error.filename)}:{error.lineno}: {error.msg}"
    frames = [(each.filename, each.lineno) for each in traceback.extract_tb(error.__traceback__)]
    frames += re.findall(r'File "(.+)", line (\d+)', str(error))  # of a callback, in JAX's message
    owners = OURS if ours else set()
    for file, line in reversed(frames):
        folders = set(Path(file).parents)
        if file == own or (file[:1] != "<" and not folders & FOREIGN):
            return f"{relative(file)}:{line}: {one_line(error)}"
        if folders & owners:
            return None
    return None


def blame(error: BaseException) -> str:
    """As `user_line`; `one_line` of an error in which no file of the user's took part."""
    return user_line(error) or one_line(error)


def one_line(error: BaseException) -> str:
    """The kind of an error, the gist of its message and a hint, in one line."""
    kind, text = type(error), str(error).strip()
    if "Traceback (most recent" in text:  # of a callback
        return text.splitlines()[-1]
    if kind.__module__.startswith("jax"):  # the rest is about tracing in general
        text = text.partition("\n")[0]
    text = " ".join(text.split())
    text = f"{text[:MOST]} ..." if len(text) > MOST else text
    hint = HINTS.get(kind.__name__)
    return f"{kind.__name__}: {text}".rstrip(": ") + (f"; {hint}" if hint else "")


def relative(file: str | Path) -> str:
    """A path as messages show it: from the working folder if it lies below."""
    path = Path(file)
    return str(path.relative_to(Path.cwd()) if Path.cwd() in path.parents else path)


def kind_of(value: Any) -> str:
    """float32[2], or the kind of a Python value."""
    if getattr(value, "dtype", None) is not None:
        return f"{value.dtype}{list(value.shape)}"
    if isinstance(value, tuple):
        return f"a tuple of {len(value)}"
    return "None" if value is None else f"a {type(value).__name__}"


def printable(words: object) -> str:
    """Words of a file or a user, for a line of ours: what a terminal would obey is escaped."""
    return "".join(c if c.isprintable() else ascii(c)[1:-1] for c in str(words))
