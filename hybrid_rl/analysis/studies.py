"""Studies by name: modules that draw a figure from runs, and the files of their pictures.

A study is a module in HOMES, or anywhere on Python's path, with these functions:

    figure(...) -> (Figure, numbers)   a keyword `name: Annotated[type, "help", kind] = default` is
        an argument of the command; `kind` (hybrid_rl.cli.arguments) parses and checks it
    summary(numbers) -> [line]         lines to print about the numbers
    draw(numbers) -> Figure            if it is there: of a JSON, with arrays for its lists
    table(numbers) -> text             if it is there: of a table, which out=FILE.csv saves

It draws in the style of all pictures, hybrid_rl.analysis.style.STYLE. The first line of its
docstring is its entry in the list; the rest is its help.
"""

import ast
import inspect
import json
from contextlib import AbstractContextManager
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from hybrid_rl.analysis.style import STYLE
from hybrid_rl.cli.arguments import Argument
from hybrid_rl.errors import UsageError
from hybrid_rl.files.atomic import replacing, write_text
from hybrid_rl.run.logs.records import json_value
from hybrid_rl.settings.complete import nearest

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DPI, MOST_PIXELS = 200, 1600  # of a .png; across
HOMES = ("hybrid_rl.analysis", "hybrid_rl.thesis.studies")  # of studies


def studies() -> dict[str, tuple[str, str]]:
    """Name of every study -> its module, first line of its docstring; no study is imported."""
    found = {}
    for home in HOMES:
        for folder in import_module(home).__path__:
            for file in Path(folder).glob("*.py"):
                module = ast.parse(file.read_text(encoding="utf-8"))
                functions = {node.name for node in module.body if isinstance(node, ast.FunctionDef)}
                if "figure" in functions:
                    line = (ast.get_docstring(module) or "").partition("\n")[0]
                    found[file.stem] = f"{home}.{file.stem}", line
    return dict(sorted(found.items()))


def study_of(name: str) -> ModuleType:
    """The study of this name: one that is listed, or a module on Python's path."""
    known = studies()
    if name in known:
        module, _ = known[name]
        return import_module(module)
    try:
        study = import_module(name)
    except ModuleNotFoundError as error:
        if not name.startswith(str(error.name)):  # one that the user's module imports
            raise
        hint = f" (did you mean {near}?)" if (near := nearest(name, known)) else ""
        line = f"choose one of {', '.join(known)}, or a module of yours{hint}"
        raise UsageError(f"study={name}: unknown; {line}") from error
    if not (hasattr(study, "figure") and hasattr(study, "summary")):
        raise UsageError(f"study={name}: {study.__file__} has no functions figure and summary")
    return study


def arguments(study: ModuleType) -> tuple[Argument, ...]:
    """The arguments of a study's `figure`; one without a default is required."""
    declared = []
    for name, parameter in inspect.signature(study.figure).parameters.items():
        about, *kind = parameter.annotation.__metadata__
        if parameter.default is parameter.empty:
            declared.append(Argument(name, "", about, *kind, needed=f"{name}=VALUE: {about}"))
        else:
            declared.append(Argument(name, parameter.default, about, *kind))
    return tuple(declared)


def styled() -> AbstractContextManager[None]:
    """Within, matplotlib draws in the style of all pictures."""
    import matplotlib

    return matplotlib.rc_context(STYLE)


def save(figure: "Figure", numbers: dict[str, Any], out: Path) -> None:
    """Write the picture, and its numbers as JSON next to it."""
    out.parent.mkdir(parents=True, exist_ok=True)
    undated = {".pdf": {"CreationDate": None}, ".svg": {"Date": None}}.get(out.suffix)
    with styled():
        dpi = min(DPI, MOST_PIXELS / figure.get_figwidth())
        with replacing(out) as draft:
            figure.savefig(draft, dpi=dpi, metadata=undated)
    write_text(out.with_suffix(".json"), json.dumps(json_value(numbers), indent=1) + "\n")
