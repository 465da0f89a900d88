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

import inspect
import sys
from dataclasses import replace

from hybrid_rl.analysis.results import redrawn
from hybrid_rl.analysis.studies import arguments, save, studies, study_of, styled
from hybrid_rl.cli import command
from hybrid_rl.cli.arguments import HELP, Argument, output, read
from hybrid_rl.files.atomic import write_text
from hybrid_rl.run.machine.jax_settings import prepare
from hybrid_rl.settings.build import load

SUFFIXES = (".png", ".pdf", ".svg")
TABLE = ".csv"  # of studies with a function `table`
DEFAULT = "learning_curves"
ARGUMENTS = (  # of every study
    Argument("study", DEFAULT, "name of the study, or list"),
    Argument("out", "figure.png", f"the picture: {', '.join(SUFFIXES)}; JSON next to it"),
)
FROM = Argument("from", "", "instead of runs: the JSON of a picture, which is drawn again")


def _listing(known: dict[str, tuple[str, str]]) -> str:
    """The studies as text, one line each."""
    width = max(map(len, known))
    return "\n".join(f"  {name:{width}}  {about}" for name, (_, about) in known.items())


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
    of_all, again = (
        (replace(ARGUMENTS[0], default=name), *ARGUMENTS[1:]),
        getattr(study, "draw", None),
    )
    if again and any(text.startswith("from=") for text in line):
        values, _ = read(doc, (*of_all, FROM))
        out = output("out", values["out"], SUFFIXES)
        with styled():
            picture, numbers = redrawn(values["from"], "from", again)
        save(picture, numbers, out)
        print(out)
        return
    values, _ = read(doc, (*of_all, *([FROM] if again else []), *arguments(study)))
    values.pop("from", None)
    table = getattr(study, "table", None)
    suffixes = SUFFIXES if table is None else (*SUFFIXES, TABLE)
    out = output("out", values.pop("out"), suffixes)
    del values["study"]
    prepare(load([]))
    with styled():
        figure, numbers = study.figure(**values)
    if table is not None and out.suffix == TABLE:
        write_text(out, table(numbers))
        print(*study.summary(numbers), out, sep="\n")
        return
    save(figure, numbers, out)
    print(*study.summary(numbers), f"{out} and {out.with_suffix('.json')}", sep="\n")


if __name__ == "__main__":
    command.run(main)
