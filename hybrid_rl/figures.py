"""Learning curves and other studies: a picture, with its numbers as JSON next to it.

    python -m hybrid_rl.figures runs="runs/halfcheetah/*/*" metric=train/return out=figure.png
    python -m hybrid_rl.figures runs="runs/hopper/sac/*,runs/hopper/mppi/*" out=two.png
    python -m hybrid_rl.figures study=model_learning runs="runs/quadcopter_se3/*/*"
    python -m hybrid_rl.figures study=koopman from=docs/results/fig_7_3.json out=fig_7_3.png
    python -m hybrid_rl.figures study=model_learning --help

study=NAME --help shows what a study measures and its arguments; study=list lists the studies. NAME
may also be a module of your own: study=my_study is my_study.py in this folder. A summary of the
numbers is printed. from=FILE.json draws a picture again, without its runs.
"""

if __name__ == "__main__":
    from hybrid_rl.cli import interrupt

    interrupt.install()

import ast
import inspect
import json
import sys
from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import replace
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, cast

from hybrid_rl.analysis.results import redrawn
from hybrid_rl.analysis.style import STYLE
from hybrid_rl.cli import command
from hybrid_rl.cli.arguments import HELP, Argument, output, read
from hybrid_rl.errors import UsageError, user_line
from hybrid_rl.files.atomic import replacing
from hybrid_rl.run.files.integrity import write_text
from hybrid_rl.run.logs.records import json_value
from hybrid_rl.run.machine.jax_settings import prepare
from hybrid_rl.settings.build import load
from hybrid_rl.settings.complete import nearest

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SUFFIXES = (".png", ".pdf", ".svg")
TABLE = ".csv"  # of studies with a function `table`
DPI, MOST_PIXELS = 200, 1600  # of a .png; across
DEFAULT = "learning_curves"
HOMES = ("hybrid_rl.analysis", "hybrid_rl.thesis.studies", "hybrid_rl.tools.tuner")  # of studies
ARGUMENTS = (  # of every study
    Argument("study", DEFAULT, "name of the study, or list"),
    Argument("out", "figure.png", f"the picture: {', '.join(SUFFIXES)}; JSON next to it"),
)
FROM = Argument("from", "", "instead of runs: the JSON of a picture, which is drawn again")


class Study(Protocol):
    """A module with these two functions, in HOMES or anywhere on Python's path.

    It draws in the style of all pictures, hybrid_rl.analysis.style.STYLE. The first line of its
    docstring is its entry in the list; the rest is its help.
    """

    figure: Callable[..., "tuple[Figure, dict[str, Any]]"]
    """The picture and its numbers. A keyword `name: Annotated[type, "help", kind] = default` is an
    argument of the command; `kind` (hybrid_rl.cli.arguments) parses and checks it."""
    summary: Callable[[dict[str, Any]], list[str]]
    """Lines to print about the numbers.

    A third function, `table(numbers)`, returns the text of a table, which out=FILE.csv saves.
    """
    draw: Callable[[dict[str, Any]], "Figure"]
    """If it is there: the picture of numbers from a JSON, with arrays for its lists."""


def studies() -> dict[str, str]:
    """Name of every study -> first line of its docstring; no study is imported."""
    lines = {}
    for path in _sources().values():
        module = ast.parse(path.read_text(encoding="utf-8"))
        functions = {node.name for node in module.body if isinstance(node, ast.FunctionDef)}
        if "figure" in functions:
            lines[path.stem] = (ast.get_docstring(module) or "").partition("\n")[0]
    return dict(sorted(lines.items()))


def _sources() -> dict[str, Path]:
    """Full name -> file of every module in HOMES."""
    folders = {home: import_module(home).__path__ for home in HOMES}
    return {
        f"{home}.{path.stem}": path
        for home, paths in folders.items()
        for folder in paths
        for path in Path(folder).glob("*.py")
    }


def study_of(name: str) -> Study:
    """The study of this name: one that is listed, or a module on Python's path."""
    known = studies()
    if name in known:
        (module,) = (full for full in _sources() if full.rpartition(".")[2] == name)
        return cast(Study, import_module(module))
    try:
        there = find_spec(name) is not None
        study = import_module(name) if there else None
    except Exception as error:  # whatever the user's module does
        reason = user_line(error) or f"cannot be imported ({error})"
        raise UsageError(f"study={name}: {reason}") from error
    if study is None:
        hint = f" (did you mean {near}?)" if (near := nearest(name, known)) else ""
        raise UsageError(
            f"study={name}: unknown; choose one of {', '.join(known)}, or a module of yours{hint}"
        )
    if not (hasattr(study, "figure") and hasattr(study, "summary")):
        raise UsageError(f"study={name}: {study.__file__} has no functions figure and summary")
    return cast(Study, study)


def arguments(study: Study) -> tuple[Argument, ...]:
    """The arguments of a study's `figure`; one without a default is required."""
    declared = []
    for name, parameter in inspect.signature(study.figure).parameters.items():
        about, *kind = parameter.annotation.__metadata__
        if parameter.default is parameter.empty:
            declared.append(Argument(name, "", about, *kind, needed=f"{name}=VALUE: {about}"))
        else:
            declared.append(Argument(name, parameter.default, about, *kind))
    return tuple(declared)


def _styled() -> AbstractContextManager[None]:
    """Within, matplotlib draws in the style of all pictures."""
    import matplotlib

    return matplotlib.rc_context(STYLE)


def save(figure: "Figure", numbers: dict[str, Any], out: Path) -> None:
    """Write the picture, and its numbers as JSON next to it.

    A JSON file that has these numbers already, such as the one that was redrawn, is left untouched.
    """
    out.parent.mkdir(parents=True, exist_ok=True)
    undated = {".pdf": {"CreationDate": None}, ".svg": {"Date": None}}.get(out.suffix)
    with _styled():
        dpi = min(DPI, MOST_PIXELS / figure.get_figwidth())
        with replacing(out) as draft:
            figure.savefig(draft, dpi=dpi, metadata=undated)
    file, values = out.with_suffix(".json"), json_value(numbers)
    if not (file.exists() and _content(file) == values):
        write_text(file, json.dumps(values, indent=1) + "\n")


def _content(file: Path) -> Any:
    """The content of a JSON file; None if it has none."""
    try:
        return json.loads(file.read_text(encoding="utf-8"))
    except (ValueError, RecursionError):
        return None


def _listing(known: dict[str, str]) -> str:
    """The studies as text, one line each."""
    width = max(map(len, known))
    return "\n".join(f"  {name:{width}}  {about}" for name, about in known.items())


def main() -> None:
    """The command."""
    line, known = sys.argv[1:], studies()
    if not line or "study=list" in line:
        print(f"Studies (study=NAME; with --help, the arguments of one):\n{_listing(known)}")
        return
    names = [text.removeprefix("study=") for text in line if text.startswith("study=")]
    name = names[-1] if names else DEFAULT
    study = study_of(name)
    doc = inspect.getdoc(study)
    if set(HELP) & set(line) and not any(text.startswith("study=") for text in line):
        doc = f"{inspect.cleandoc(__doc__ or '')}\n\nStudies (study=NAME):\n{_listing(known)}"
        doc += f"\n\nThe arguments below are those of study={DEFAULT}."
    of_all, again = (replace(ARGUMENTS[0], default=name), *ARGUMENTS[1:]), hasattr(study, "draw")
    if again and any(text.startswith("from=") for text in line):
        values, _ = read(doc, (*of_all, FROM))
        out = output("out", values["out"], SUFFIXES, ".json")
        with _styled():
            picture, numbers = redrawn(values["from"], "from", study.draw)
        save(picture, numbers, out)
        print(out)
        return
    values, _ = read(doc, (*of_all, *(FROM,) * again, *arguments(study)))
    values.pop("from", None)
    table = getattr(study, "table", None)
    suffixes = SUFFIXES if table is None else (*SUFFIXES, TABLE)
    out = output("out", values.pop("out"), suffixes, ".json")
    del values["study"]
    prepare(load([]))
    with _styled():
        figure, numbers = study.figure(**values)
    if table is not None and out.suffix == TABLE:
        write_text(out, table(numbers))
        print(*study.summary(numbers), out, sep="\n")
        return
    save(figure, numbers, out)
    print(*study.summary(numbers), f"{out} and {out.with_suffix('.json')}", sep="\n")


if __name__ == "__main__":
    command.run(main)
