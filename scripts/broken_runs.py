"""Runs that are broken on purpose, and sound ones: what the doctor prints about each.

    python -m scripts.broken_runs folder=runs/broken out=docs/results/doctor.json
    python -m scripts.broken_runs folder=runs/tuning seed=100 runs=sound

A run that is in the folder already is not made again. The checks were written with seeds 0 to 3
and 100 in view, those of new episodes, of the reward's scale and of the action rate with seeds 10
to 13, that of noise at rest with seeds 4 and 5. The table has seed 6, of both kinds, as it was
found.
"""

import json
import os
import shlex
import subprocess
import sys
from pathlib import Path
from typing import Any

from hybrid_rl.cli.arguments import Argument, read, whole
from hybrid_rl.tools.doctor.__main__ import examine
from scripts.broken.faulty_world import AUDITED, INVENTED

HERE = Path(__file__).parent / "broken"  # the user's files: a world, and its task
ARGUMENTS = (
    Argument("folder", "runs/broken", "of the runs"),
    Argument("seed", 6, "of each run", whole(0)),
    Argument("runs", "all", "which: all, or some of broken, audited, invented, sound, robots"),
    Argument("out", "", "JSON with the lines on each run; empty: printed alone"),
)
SMALL = "settings=light total_steps=3000 random_steps=500 eval_every=1500 eval_episodes=3"
SMALL = f"{SMALL} log_every=100"
BROKEN = {  # name -> what differs from a sound run of the pendulum
    "clipped observation": "algo=sac env.limit=1",
    "wrong sign of the reward": "algo=sac env.paid=-1",
    "wrong sign, success measured": "algo=sac env.paid=-1 env.measured=true",
    "episode too short": "algo=sac episode.steps=8",
    "time limit before the reward": "algo=sac episode.steps=20",
    "reward too large": "algo=sac env.paid=1e4",
    "reward too small": "algo=sac env.paid=1e-4",
    "action too slow": "algo=sac env.lag=20",
    "decisions too rare": "algo=sac episode.action_repeat=20",
    "model that cannot see what moves": "algo=nn_mppi env.kept=[0,1]",
    "terminal bug": "algo=sac env.ends=50",
    "NaN reward": "algo=sac env.nan_above=6",
    "too few random decisions": "algo=nn_mppi random_steps=5",
    "delay": "algo=sac episode.delay=0.1",
    "noise": "algo=sac episode.sensor_noise=0.5",
}
SOUND = {  # name -> its task and method
    "pendulum, sac": "task=pendulum algo=sac",
    "pendulum, hybrid_stochastic": "task=pendulum algo=hybrid_stochastic",
    "cartpole, sac": "task=cartpole algo=sac",
    "lander, sac": "task=lander algo=sac",
    "half-cheetah, sac": "task=halfcheetah algo=sac",
    "half-cheetah, hybrid_stochastic": "task=halfcheetah algo=hybrid_stochastic",
    "hopper, sac": "task=hopper algo=sac",
    "hopper, hybrid_stochastic": "task=hopper algo=hybrid_stochastic",
    "walker2d, sac": "task=walker2d algo=sac",
    "quadcopter_se3, sac": "task=quadcopter_se3 algo=sac",
    "cart_pendulum, sac": "task=cart_pendulum algo=sac",
}
ROBOTS = {  # for the audited faults
    "half-cheetah": "halfcheetah.HalfCheetah 'env.velocities=[8,9,10,11,12,13,14,15,16]'",
    "hopper": "hopper.Hopper 'env.velocities=[5,6,7,8,9,10]'",
}


KINDS = {
    "broken": BROKEN,
    "audited": {name: f"task=faulty algo=sac 'env.kind={name}'" for name in AUDITED},
    "invented": {name: f"task=faulty algo=sac 'env.kind={name}'" for name in INVENTED},
    "sound": SOUND,
    "robots": {
        f"{robot}, {name}": f"task=faulty algo=sac 'env.kind={name}' env.of=hybrid_rl.envs.{world}"
        " 'env.own={physics: native}' env.steps=1000 episode.steps=1000"
        for robot, world in ROBOTS.items()
        for name in AUDITED
    },
}


def train(folder: Path, words: str, seed: int) -> None:
    """One run into `folder`; that of a world whose reward is NaN ends with 1."""
    if (folder / "summary.json").exists():
        return
    command = [sys.executable, "-m", "hybrid_rl.train", "--config-dir", str(HERE)]
    command += [*SMALL.split(), *shlex.split(words), f"seed={seed}", f"run_dir={folder}"]
    done = subprocess.run(command, env=_paths(), capture_output=True, text=True)
    if done.returncode not in (0, 1):
        raise RuntimeError(f"{folder}: {done.stderr.strip()}")


def _paths() -> dict[str, str]:
    paths = (str(HERE), str(Path.cwd()), os.environ.get("PYTHONPATH", ""))
    return {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, paths))}


def main() -> None:
    """The command."""
    given: Any = read(__doc__, ARGUMENTS)[0]
    found: dict[str, dict[str, dict[str, str]]] = {}
    sys.path.insert(0, str(HERE))
    for kind in KINDS if given["runs"] == "all" else given["runs"].split(","):
        found[kind] = {}
        for name, words in KINDS[kind].items():
            folder = Path(given["folder"], name.replace(",", "").replace(" ", "_"))
            task = "" if "task=" in words else "task=broken "
            train(folder, task + words, given["seed"])
            found[kind][name] = examine(folder)
            lines = [": ".join(each) for each in found[kind][name].items()]
            print(f"{kind}: {name}", *lines, sep="\n  ", flush=True)
    if given["out"]:
        out = Path(given["out"])
        old = json.loads(out.read_text()) if out.exists() else {}
        out.write_text(json.dumps(old | found, indent=1) + "\n")


if __name__ == "__main__":
    main()
