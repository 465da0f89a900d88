"""One HTML page about a run, or about several: curves, settings, evaluation, versions, a video.

    python -m hybrid_rl.report run=runs/hopper/sac/TIME
    python -m hybrid_rl.report run="runs/hopper/*/*" out=hopper.html
    python -m hybrid_rl.report run="runs/*/sac/*" out=mine.json

The page is one file without a script, and needs no network. Its curves are those of `figures`:
interquartile means over seeds with 95% bootstrap bands. Of several runs it lists the settings in
which they differ. `evaluate` adds its tables. The video is DIR/video.mp4 of each run; for a single
run without one, up to 200 decisions are drawn. out=FILE.json writes instead what a method has at
the end of its runs, a line for docs/results/community.md (hybrid_rl.tools.report.entry).
"""

if __name__ == "__main__":
    from hybrid_rl import command

    command.install()

import base64
import html
import json
from collections.abc import Sequence
from datetime import datetime, timedelta
from pathlib import Path
from string import Template
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

import hybrid_rl as hr
from hybrid_rl import Curve, RunFolder, UsageError, arguments, command, spread
from hybrid_rl.tools.report import panels
from hybrid_rl.tools.report.entry import entry
from hybrid_rl.tools.report.html_table import table

ARGUMENTS = (
    arguments.Argument(
        "run", "", 'run folders, with commas, or "GLOB"', needed="run=DIR, a run folder"
    ),
    arguments.Argument(
        "out", "", "page or .json; empty: DIR/report.html, of several runs report.html"
    ),
    arguments.Argument("video", "auto", "auto: as above; none", arguments.one_of("auto", "none")),
)
MACHINE = ("device", "physics", "precision", "git_commit")  # keys of summary.json
COMMIT = 10  # characters of its name
SHOWN = 200  # decisions of a video that is drawn
TEMPLATE = Path(__file__).with_name("page.html")


def page(runs: Sequence[RunFolder], video: bool = True) -> str:
    """The report of runs as HTML.

    video: with videos.
    """
    names = [" on ".join(str(run.summary.get(k, "?")) for k in ("algo", "task")) for run in runs]
    title = ", ".join(dict.fromkeys(names))
    if len(runs) > 1:
        title = f"{len(runs)} runs: {title}"
    parts = [
        ("Runs", _runs(runs)),
        ("Video", _videos(runs, video)),
        *_curves(runs),
        ("Evaluation", _evaluations(runs)),
        ("Configuration", _configuration(runs)),
        ("Machine and versions", _machine(runs)),
    ]
    sections = "\n".join(
        f"<section><h2>{name}</h2>\n{text}</section>" for name, text in parts if text
    )
    about = f"hybrid_rl {hr.__version__}, {datetime.now():%Y-%m-%d %H:%M}"
    template = Template(TEMPLATE.read_text(encoding="utf-8"))
    return template.substitute(title=html.escape(title), about=about, sections=sections)


def _state(run: RunFolder) -> str:
    """How a run ended."""
    summary = run.summary
    if not summary:
        return "no summary yet"
    if failed := summary.get("diverged"):
        ends = (f"seed {e['seed']} at {e['step']:,} ({e['quantity']})" for e in failed)
        return f"diverged: {', '.join(ends)}"
    return "finished" if summary.get("finished") else "stopped"


def _runs(runs: Sequence[RunFolder]) -> str:
    """What ran, where, how fast, and how it ended."""
    head = ("run", "task", "method", "seeds", "decisions", "end")
    head += ("evaluation return", "training return", "decisions/s", "wall time")

    def row(run: RunFolder) -> list[Any]:
        get = run.summary.get
        seeds = _span(get("seeds", sorted({each["seed"] for each in run.rows})))
        ends = (
            [value for value in get(key) or [] if value is not None]
            for key in ("final_eval", "final_return")
        )
        results = [spread(np.array(each)) if each else None for each in ends]
        steps = get("total_steps", max((each["step"] for each in run.rows), default=None))
        wall, speed = get("wall_s"), get("env_steps_per_s")
        return [
            *(run.path, get("task"), get("algo"), seeds, steps, _state(run), *results),
            *(speed and round(speed), wall and str(timedelta(seconds=round(wall)))),
        ]

    note = "<p class='quiet'>The last evaluation, and the training return over the last tenth of "
    note += "the decisions: interquartile mean over seeds and 95% bootstrap band.</p>"
    return table(head, map(row, runs)) + note


def _span(seeds: Sequence[int]) -> str:
    """How many seeds and which; three or more that follow each other by their ends."""
    which = ", ".join(map(str, seeds))
    if len(seeds) > 2 and list(seeds) == list(range(seeds[0], seeds[-1] + 1)):
        which = f"{seeds[0]} to {seeds[-1]}"
    return f"{len(seeds)} ({'seed' if len(seeds) == 1 else 'seeds'} {which})"


def _videos(runs: Sequence[RunFolder], wanted: bool) -> str:
    """The videos of the runs, each within the page."""
    if not wanted:
        return ""
    films = {run.path: run.path / "video.mp4" for run in runs}
    videos = {str(film): film.read_bytes() for film in films.values() if film.is_file()}
    if len(runs) == 1 and not videos:
        try:
            videos = _drawn(runs[0].path)
        except (OSError, ValueError) as error:  # no graphics, checkpoint or scene
            return f"<p class='quiet'>None: {html.escape(str(error))}</p>"
    figures = [
        '<figure><video controls muted loop playsinline preload="metadata" src="data:video/mp4;'
        f'base64,{base64.b64encode(film).decode()}"></video>'
        f"<figcaption>{html.escape(name)}</figcaption></figure>"
        for name, film in videos.items()
    ]
    return f'<div class="panels">{"".join(figures)}</div>' if figures else ""


def _drawn(folder: Path) -> dict[str, bytes]:
    """The beginning of the first evaluation episode of a run, with its caption."""
    trained = hr.load(folder)
    with TemporaryDirectory() as parent:
        out = Path(parent, "video.mp4")
        film = hr.film(trained, out, steps=min(SHOWN, trained.episode.steps))
        caption = (
            f"after {trained.step:,} decisions of training: the first {len(film.poses) - 1} of "
            f"{trained.episode.steps:,} decisions of an episode, return so far {film.total:,.1f}"
        )
        return {caption: out.read_bytes()}


def _curves(runs: Sequence[RunFolder]) -> list[tuple[str, str]]:
    """A section for each kind of metric: its panels, and a table of the last values."""
    sections, paths = [], [run.path for run in runs]
    each = {
        title: [some for name in names if (some := panels.found(paths, name))]
        for title, names in panels.metrics(runs).items()
    }
    labels = sorted({curve.label for found in each.values() for some in found for curve in some})
    for title, found in filter(lambda pair: pair[1], each.items()):
        drawings = [drawing for some in found for drawing in panels.panels(some, labels)]
        figures = "\n".join(f"<figure>{drawing}</figure>" for drawing in drawings)
        drawn = [curve for some in found for curve in some]
        head = ("metric", "task", "method", "seeds", "last", "mean over the run")
        more = f"<summary>Numbers</summary>{table(head, map(_ends, drawn))}"
        notes = dict.fromkeys(  # not that a metric is one of other methods
            note for curve in drawn for note in curve.notes if f": no {curve.metric}" not in note
        )
        lines = "".join(f'<p class="quiet">{html.escape(note)}</p>\n' for note in notes)
        text = f'<div class="panels">\n{figures}\n</div>\n{lines}<details>{more}</details>\n'
        sections.append((title, text))
    return sections


def _ends(curve: Curve) -> list[Any]:
    """A row about a curve: its last value and its mean, over the points that all seeds have."""
    row = [curve.metric, curve.task, curve.label, len(curve.seeds)]
    at = np.flatnonzero(curve.shared)
    return [
        *row,
        *((spread(curve.each[:, at[-1]]), spread(hr.area(curve))) if len(at) else ("", "")),
    ]


def _evaluations(runs: Sequence[RunFolder]) -> str:
    """The tables of `evaluate`; without any, how to get them."""
    rows = []
    for run in runs:
        for file in filter(Path.is_file, sorted(run.path.glob("evaluation_*.json"))):
            rows += _evaluation(run, file)
    if not rows:
        first = html.escape(f"python -m hybrid_rl.evaluate run={runs[0].path}")
        return f"<p class='quiet'>None yet: <code>{first}</code> adds a table here.</p>"
    head = ("run", "mode", "step", "seed", "episodes", "mean return", "std", "lowest", "highest")
    successes = any(len(row) > len(head) for row in rows)
    full = len(head) + successes
    rows = [[*row, *[None] * (full - len(row))] for row in rows]
    return table((*head, *["successes"] * successes), rows)


def _evaluation(run: RunFolder, file: Path) -> list[list[Any]]:
    """A row for each seed of a file of `evaluate`."""
    try:
        values = json.loads(file.read_text(encoding="utf-8"))
        each = zip(values["seeds"], values["returns"], strict=True)
        rows = []
        for i, (seed, got) in enumerate(each):
            ends = (np.mean(got), np.std(got), np.min(got), np.max(got))
            mode = ", ".join([values["mode"], *map("=".join, values.get("changes", {}).items())])
            row = [run.path, mode, values["step"], seed, len(got), *map(float, ends)]
            rows.append([*row, *(f"{s:.0%}" for s in values.get("success", [])[i : i + 1])])
        return rows
    except (ValueError, LookupError, TypeError, AttributeError, RecursionError) as error:
        raise UsageError(f"{file}: is no evaluation that `evaluate` wrote") from error


def _configuration(runs: Sequence[RunFolder]) -> str:
    """The settings in which the runs differ, and all settings of each run."""
    text = ""
    if len(runs) > 1:
        each = hr.differences(runs)
        keys = list(dict.fromkeys(key for one in each for key in one))
        rows = [[key, *(one.get(key) for one in each)] for key in keys]
        none = "<p>The runs have the same settings, apart from their seeds and length.</p>"
        text = table(("setting", *(str(run.path) for run in runs)), rows) if keys else none
    same: dict[str, list[str]] = {}
    for run in runs:
        if run.settings:  # there is a file, of keys
            whole = (run.path / "config.yaml").read_text(encoding="utf-8")
            same.setdefault(whole, []).append(str(run.path))
    return text + "\n".join(
        f"<details><summary>config.yaml of {html.escape(', '.join(paths))}</summary>"
        f"<pre>{html.escape(yaml)}</pre></details>"
        for yaml, paths in same.items()
    )


def _machine(runs: Sequence[RunFolder]) -> str:
    """Device, commit and versions; a column for each set of them."""
    sets: dict[str, list[str]] = {}
    for run in runs:
        each = {key: run.summary.get(key) for key in MACHINE} | run.summary.get("versions", {})
        each["git_commit"] = (each["git_commit"] or "")[:COMMIT]
        if run.summary:
            sets.setdefault(json.dumps(each), []).append(str(run.path))
    if not sets:
        return ""
    columns = [json.loads(text) for text in sets]
    names = list(dict.fromkeys(name for column in columns for name in column))
    heads = [""] if len(sets) == 1 else [", ".join(paths) for paths in sets.values()]
    return table(("", *heads), [[n, *(c.get(n) for c in columns)] for n in names])


def main() -> None:
    """The command."""
    given, _ = arguments.read(__doc__, ARGUMENTS)
    runs = hr.runs(given["run"], "run")
    default = f"{runs[0].path}/report.html" if len(runs) == 1 else "report.html"
    out = arguments.output("out", given["out"] or default, (".html", ".json"))
    if out.suffix == ".json":
        out.write_text(entry(runs), encoding="utf-8")
        print(f"{out}: now the link, and in the name what is no default, by hand; then make pages")
        return
    out.write_text(page(runs, given["video"] == "auto"), encoding="utf-8")
    size = out.stat().st_size / 1e6
    print(f"{out}: {len(runs)} run{'s' * (len(runs) > 1)}, {size:.1f} MB")


if __name__ == "__main__":
    command.run(main)
