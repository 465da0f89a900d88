"""A suite: one setting on many tasks with the same seeds, as one table and one picture.

    python -m hybrid_rl.suite suite=gymnasium train=settings=annealed
    python -m hybrid_rl.suite suite=dm_control tasks=walker-run,finger-spin seeds=5
    CUDA_VISIBLE_DEVICES=1 python -m hybrid_rl.suite suite=gymnasium train=settings=annealed

A suite is gymnasium, dm_control, or a YAML file of yours, as gymnasium.yaml beside this file is;
each of its tasks is a run in OUT/TASK. The same command again continues what was stopped. Beside
the first one, on another GPU or on a host that shares the folder, it takes what no other process
has. Then it writes OUT.md, OUT.png and OUT.json of what there is: the interquartile mean over seeds
with its 95% bootstrap band, the mean, the lowest seed, and of peers the best mean (peers=FILE, such
as docs/results/suite_peers.json); then for each peer, over the tasks that it and we have, the mean
of (return - random) / (best - random), where best is the highest mean of any peer.
"""

if __name__ == "__main__":
    from hybrid_rl import command

    command.install()

import json
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import yaml

import hybrid_rl as hr
from hybrid_rl import Curve, RunFolder, UsageError, arguments, command

WHAT = arguments.one_of("all", "table")
ARGUMENTS = (
    arguments.Argument("suite", "gymnasium", "gymnasium, dm_control or FILE.yaml"),
    arguments.Argument("tasks", "", "of these alone, with commas between them; empty: all"),
    arguments.Argument("train", "", "words for train of all tasks, with spaces between them"),
    arguments.Argument("seed", 100, "the first", arguments.whole(least=0)),
    arguments.Argument("seeds", 10, "learners of each task", arguments.whole()),
    arguments.Argument("peers", "", "JSON of others' returns; empty: none"),
    arguments.Argument("out", "", "folder of the runs; empty: runs/suites/SUITE"),
    arguments.Argument("only", "all", "table: nothing is trained", WHAT),
)
Means = dict[str, dict[int, float]]  # task -> decisions -> mean return


def suite_of(name: str, tasks: str) -> dict[str, Any]:
    """The suite of a name or a file, with the tasks that were asked for."""
    file = Path(name) if name.endswith(".yaml") else Path(__file__).with_name(f"{name}.yaml")
    if not file.is_file():
        raise UsageError(f"suite={name}: give gymnasium, dm_control or a FILE.yaml that exists")
    suite = yaml.safe_load(file.read_text(encoding="utf-8"))
    asked = arguments.several(*suite["tasks"])("tasks", tasks) if tasks else suite["tasks"]
    return suite | {"name": file.stem, "tasks": {name: suite["tasks"][name] for name in asked}}


def words(suite: dict[str, Any], name: str, given: dict[str, Any]) -> list[str]:
    """The overrides of `train` for a task, without its folder."""
    first, *_, last = suite["at"]
    counts = {"total_steps": last, "eval_every": first // 10, "checkpoint_every": first // 5}
    counts |= {"seed": given["seed"], "num_seeds": given["seeds"]}
    own = f"{suite['tasks'][name]['train']} {suite.get('each', '')} {given['train']}"
    return [*own.split(), *(f"{key}={value}" for key, value in counts.items())]


def train(folder: Path, texts: list[str]) -> int:
    """Train in `folder`, from the start or where it was stopped; the exit code of that process."""
    if RunFolder(folder).summary.get("finished"):
        return 0
    begun = (folder / "config.yaml").exists()
    line = [f"resume={folder}"] if begun else [*texts, f"run_dir={folder}"]
    return subprocess.run([sys.executable, "-m", "hybrid_rl.train", *line], check=False).returncode


def evaluations(out: Path, suite: dict[str, Any]) -> Iterator[Curve]:
    """The curve of each task that has one."""
    for name in suite["tasks"]:
        if (out / name / "metrics.jsonl").exists():
            (curve,) = hr.curves(out / name, "eval/return")
            yield replace(curve, task=name, notes=())


def returns(curve: Curve, at: list[int]) -> dict[int, np.ndarray]:
    """Decisions -> returns [S] of the evaluation there, where all seeds have one."""
    shared = zip(curve.x, curve.each.T, curve.shared, strict=True)
    return {int(x): values for x, values, whole in shared if whole and x in at}


def best(peers: dict[str, Means], name: str, n: int) -> tuple[float, str] | None:
    """The highest mean return of any peer in a task after n decisions, and whose it is."""
    return max(((t[name][n], p) for p, t in peers.items() if n in t.get(name, {})), default=None)


def compared(ours: Means, peers: dict[str, Means], suite: dict[str, Any], n: int) -> list[str]:
    """A row for each peer after n decisions: tasks that both have, normalised means."""
    rows = []
    for peer, theirs in peers.items():
        pairs = []
        for name, task in suite["tasks"].items():
            if n in theirs.get(name, {}) and n in ours.get(name, {}):
                low = task.get("random", 0.0)
                top = max(t[name][n] for t in peers.values() if n in t.get(name, {}))
                pairs.append([(t[name][n] - low) / (top - low) for t in (theirs, ours)])
        if pairs:
            rows.append((len(pairs), *np.mean(pairs, 0), peer))
    head = f"| normalised mean after {n:,} decisions | tasks | theirs | ours |"
    lines = [
        f"| {peer} | {k} | {its:.2f} | {own:.2f} |" for k, its, own, peer in sorted(rows)[::-1]
    ]
    return ["", head, "|---|---|---|---|", *lines] if lines else []


def table(curves: list[Curve], peers: dict[str, Means], suite: dict[str, Any]) -> str:
    """The tables, in Markdown."""
    at, found = suite["at"], {curve.task: returns(curve, suite["at"]) for curve in curves}
    heads = [f"after {n:,}: IQM and band; mean; lowest | best peer, mean" for n in at]
    lines = [f"| task | {' | '.join(heads)} |", "|---" * (1 + 2 * len(at)) + "|"]
    for name in suite["tasks"]:
        cells = [name]
        for n in at:
            each, peer = found.get(name, {}).get(n), best(peers, name, n)
            more = "-" if each is None else f"{each.mean():,.0f}; {each.min():,.0f}"
            cells.append(more if each is None else f"{hr.spread(each)}; {more}")
            cells.append(f"{peer[1]}, {peer[0]:,.0f}" if peer else "-")
        lines.append(f"| {' | '.join(cells)} |")
    ours = {name: {n: float(v.mean()) for n, v in each.items()} for name, each in found.items()}
    return "\n".join([*lines, *(row for n in at for row in compared(ours, peers, suite, n))])


def write(out: Path, suite: dict[str, Any], peers: dict[str, Means]) -> str:
    """Write table, picture and numbers of the runs in `out`; the table."""
    curves = [*evaluations(out, suite)]
    if not curves:
        raise UsageError(f"out={out}: no run of these tasks has an evaluation yet")
    text, figure = table(curves, peers, suite), hr.plot(curves)
    for axes, name in zip(figure.axes, sorted(curve.task for curve in curves), strict=False):
        points = [(n, top[0]) for n in suite["at"] if (top := best(peers, name, n))]
        if points:  # crosses: the best peer
            axes.plot(*zip(*points, strict=True), "kx", ms=7, mew=2)
    figure.savefig(out.with_suffix(".png"), dpi=150)
    each = {curve.task: returns(curve, suite["at"]) for curve in curves}
    numbers = {name: {n: v.round(1).tolist() for n, v in own.items()} for name, own in each.items()}
    about = {"machine": hr.provenance.device(), "seeds": list(curves[0].seeds), "tasks": numbers}
    out.with_suffix(".json").write_text(json.dumps(about, indent=1) + "\n", encoding="utf-8")
    out.with_suffix(".md").write_text(text + "\n", encoding="utf-8")
    return text


def main() -> None:
    """The command."""
    given, _ = arguments.read(__doc__, ARGUMENTS)
    suite = suite_of(given["suite"], given["tasks"])
    out = Path(given["out"] or f"runs/suites/{suite['name']}")
    names = suite["tasks"] if given["only"] == "all" else ()
    codes = {name: train(out / name, words(suite, name, given)) for name in names}
    read = json.loads(Path(given["peers"]).read_text(encoding="utf-8")) if given["peers"] else {}
    peers = {
        peer: {t: {int(n): v[0] for n, v in own.items()} for t, own in each["tasks"].items()}
        for peer, each in read.items()
    }
    print(write(out, suite, peers))
    if failed := [name for name, code in codes.items() if code]:
        print(f"not finished by this process: {', '.join(failed)}")
        sys.exit(max(codes.values()))


if __name__ == "__main__":
    command.run(main)
