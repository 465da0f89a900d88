"""Peers' returns on the tasks of the suites, from the authors' own files.

    python -m scripts.suite_peers clones=FOLDER out=docs/results/suite_peers.json

FOLDER holds clones of the repositories of PEERS, each as OWNER+NAME/repo. A number is [mean, lowest
seed, seeds] at so many decisions: frames over the action repeat, by linear interpolation in each
seed; none where not all seeds have come so far. Each of a method's settings is a peer.
"""

import csv
import io
import json
import subprocess
from collections import defaultdict
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from hybrid_rl.cli.arguments import Argument, read
from hybrid_rl.tools.suite import __main__ as suite

SUITES = Path(suite.__file__).parent
AT = (50_000, 100_000)  # decisions
GYMNASIUM = {"HalfCheetah", "Hopper", "Walker2d", "Ant", "Humanoid"}
DHMBPO = {"": "main/gym/esvg", "2 updates": "utd/2", "4 updates": "utd/4", "8 updates": "utd/8"}
DHMBPO |= {"10 steps": "d_roll_len/10", "40 steps": "d_roll_len/40"}
SIMBA = "DAVIAN-Robotics/SimbaV2"
PEERS = {  # name -> repository, files, action repeat in dm_control
    **{
        f"DHMBPO {name}".strip(): ("4kubo/erl_lib", f"results/{folder}/*.csv", 2)
        for name, folder in DHMBPO.items()
    },
    "DHMBPO, dm_control": ("4kubo/erl_lib", "results/main/dmc/esvg/*.csv", 2),
    "TD-MPC2": ("nicklashansen/tdmpc2", "results/tdmpc2/*.csv", 2),
    "SAC, by TD-MPC2's authors": ("nicklashansen/tdmpc2", "results/sac/*.csv", 2),
    "BMPC": ("wertyuilife2/bmpc", "results/data_dmc_all_1M.json", 2),
    **{f"SimbaV2, {n} updates": (SIMBA, f"results/simbaV2_utd{n}.csv", 2) for n in (1, 2, 4, 8)},
    "BRO, 10 updates": (SIMBA, "results/baseline/bro_utd10.csv", 1),
    "CrossQ": (SIMBA, "results/baseline/crossq.csv", 2),
    "MR.Q": (SIMBA, "results/baseline/mrq.csv", 2),
    "SAC": (SIMBA, "results/baseline/sac.csv", 2),
    "FlashSAC": ("Holiday-Robot/FlashSAC", "results/stateRL_cpusim/FlashSAC.csv", 1),
    "XQC": ("Holiday-Robot/FlashSAC", "results/stateRL_cpusim/baseline/XQC.csv", 2),
}
Points = dict[str, dict[str, list[tuple[float, float]]]]  # task -> seed -> (frames, return)


def name_of(task: str) -> str:
    """The name of a task in the suites: HalfCheetah-v5, walker-run."""
    plain = task.removesuffix("-v4").removesuffix("_v4")
    return f"{plain}-v5" if plain in GYMNASIUM else task.replace("_", "-")


def git(clones: Path, repository: str, *words: str) -> str:
    """What git prints about the clone of a repository."""
    clone = clones / repository.replace("/", "+") / "repo"
    line = ["git", f"--git-dir={clone}", *words]
    return subprocess.run(line, capture_output=True, check=True).stdout.decode()


def files(clones: Path, repository: str, pattern: str) -> Iterable[tuple[str, str]]:
    """Name and text of the files of the newest commit."""
    for name in git(clones, repository, "ls-tree", "-r", "HEAD", "--name-only").splitlines():
        if Path(name).match(pattern) and Path(name).parent == Path(pattern).parent:
            yield Path(name).stem, git(clones, repository, "show", f"HEAD:{name}")


def points(stem: str, text: str) -> Points:
    """What a table of one task, or of several, holds."""
    found: Points = defaultdict(lambda: defaultdict(list))
    for row in csv.DictReader(io.StringIO(text)):
        task, frames = row.get("env_name", stem), row.get("env_step") or row["step"]
        value = row.get("value") or row.get("reward")
        if row.get("metric", "avg_return") == "avg_return" and value:
            found[name_of(task)][row["seed"]].append((float(frames), float(value)))
    return found


def at(seeds: dict[str, list[tuple[float, float]]], frames: int) -> list[float] | None:
    """[mean, lowest seed, seeds] after so many frames; None: not all seeds have come so far."""
    curves = [np.array(sorted(each)).T for each in seeds.values()]
    if not curves or any(x[-1] < 0.99 * frames for x, _ in curves):
        return None
    ends = [np.interp(frames, x, y) for x, y in curves]
    return [round(float(np.mean(ends)), 1), round(float(min(ends)), 1), len(ends)]


def of_bmpc(text: str) -> Points:
    """BMPC's file, which has means of five seeds alone."""
    each = json.loads(text)["BMPC"].items()
    return {name_of(k): {"mean": [*zip(v["steps"], v["values"], strict=True)]} for k, v in each}


def rows(name: str, clones: Path, tasks: set[str]) -> dict[str, Any]:
    """Task -> decisions -> [mean, lowest seed, seeds] of a peer."""
    repository, pattern, repeat = PEERS[name]
    table: dict[str, Any] = {}
    for stem, text in files(clones, repository, pattern):
        means = pattern.endswith(".json")
        for task, seeds in (of_bmpc(text) if means else points(stem, text)).items():
            times = {str(n): at(seeds, n * (1 if task.endswith("-v5") else repeat)) for n in AT}
            known = {n: [each[0], None, 5] if means else each for n, each in times.items() if each}
            if known and task in tasks:
                table[task] = known
    return dict(sorted(table.items()))


def main() -> None:
    """The command."""
    out = Argument("out", "suite_peers.json", "the numbers")
    given, _ = read(__doc__, (Argument("clones", "", "of", needed="clones=FOLDER"), out))
    suites = [yaml.safe_load(file.read_text()) for file in SUITES.glob("*.yaml")]
    clones, tasks = Path(given["clones"]), {name for each in suites for name in each["tasks"]}
    found = {}
    for name, (repository, pattern, repeat) in PEERS.items():
        commit = git(clones, repository, "rev-parse", "HEAD").strip()[:10]
        source = f"{repository}@{commit}:{pattern}"
        found[name] = {"source": source, "repeat": repeat, "tasks": rows(name, clones, tasks)}
    Path(given["out"]).write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
