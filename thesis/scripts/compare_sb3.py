"""Stable-Baselines3's SAC as a yardstick, on Gymnasium's worlds or on ours.

    python thesis/scripts/compare_sb3.py --world ours --task hopper --seed 0 --run-dir runs/sb3

The numbers of Haarnoja et al. 2018 as SB3's authors tune MuJoCo tasks: batch 256, two layers
of 256, learning rate 3e-4, gamma 0.99, tau 0.005, an update a step after 10000 random steps.
Writes metrics.jsonl and summary.json as `python -m hybrid_rl.train` does. One thread: run
many in parallel. Needs `pip install stable-baselines3`.
"""

import argparse
import json
import os
import platform
import subprocess
import time
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

ONE_THREAD = {
    "JAX_PLATFORMS": "cpu",
    "OMP_NUM_THREADS": "1",
    "MKL_NUM_THREADS": "1",
    "NPROC": "1",  # XLA's thread pool
    "XLA_FLAGS": "--xla_cpu_multi_thread_eigen=false",
}
for name, value in ONE_THREAD.items():
    os.environ.setdefault(name, value)

import numpy as np  # noqa: E402 - threads are counted at import
import torch  # noqa: E402
from stable_baselines3 import SAC  # noqa: E402
from stable_baselines3.common.callbacks import BaseCallback  # noqa: E402

GYMNASIUM = {"halfcheetah": "HalfCheetah-v5", "hopper": "Hopper-v5"}
STEPS = 1000  # decisions until the time limit
SETTINGS = {
    "learning_rate": 3e-4,
    "buffer_size": 1_000_000,
    "learning_starts": 10_000,
    "batch_size": 256,
    "gamma": 0.99,
    "tau": 0.005,
    "train_freq": 1,
    "gradient_steps": 1,
    "policy_kwargs": {"net_arch": [256, 256]},
}


def make(world: str, task: str) -> Any:
    """A gymnasium.Env with a time limit of 1000 decisions."""
    if world == "gymnasium":
        import gymnasium

        return gymnasium.make(GYMNASIUM[task])
    from hybrid_rl.envs.adapters.gymnasium import GymnasiumEnv
    from hybrid_rl.envs.halfcheetah import HalfCheetah
    from hybrid_rl.envs.hopper import Hopper

    env = {"halfcheetah": HalfCheetah, "hopper": Hopper}[task](physics="native")
    return GymnasiumEnv(env, steps=STEPS)


class Log(BaseCallback):
    """Rows of metrics.jsonl: finished training episodes, and deterministic evaluations."""

    def __init__(self, run_dir: Path, world: Any, seed: int, every: int, episodes: int) -> None:
        super().__init__()
        self.world, self.seed, self.every, self.episodes = world, seed, every, episodes
        self.file = (run_dir / "metrics.jsonl").open("w", encoding="ascii")
        self.begin, self.paused = time.perf_counter(), 0.0  # [s]
        self.returns: list[tuple[int, float]] = []  # (step, train/return)
        self.last_eval: float | None = None

    def row(self, **values: float) -> None:
        """Append one row."""
        wall = round(time.perf_counter() - self.begin, 3)
        coordinates = {"step": self.num_timesteps, "seed": self.seed, "wall_s": wall}
        self.file.write(json.dumps(coordinates | values) + "\n")
        self.file.flush()

    def _on_step(self) -> bool:
        for info in self.locals["infos"]:
            if "episode" in info:
                value, length = float(info["episode"]["r"]), int(info["episode"]["l"])
                self.returns.append((self.num_timesteps, value))
                self.row(**{"train/return": value, "train/length": length})
        if self.num_timesteps % self.every == 0:
            start = time.perf_counter()
            self.last_eval = self.evaluate()
            self.row(**{"eval/return": self.last_eval})
            self.paused += time.perf_counter() - start
        return True

    def evaluate(self) -> float:
        """Mean return of the deterministic policy; the same first states each time."""
        total = 0.0
        for episode in range(self.episodes):
            obs, _ = self.world.reset(seed=1_000_000 + 1000 * self.seed + episode)
            done = False
            while not done:
                action, _ = self.model.predict(obs, deterministic=True)
                obs, reward, terminated, truncated, _ = self.world.step(action)
                total, done = total + float(reward), terminated or truncated
        return total / self.episodes


def commit() -> str | None:
    """The commit of this checkout, if it is one."""
    command = ["git", "-C", str(Path(__file__).parent), "rev-parse", "HEAD"]
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return None


def versions() -> dict[str, str]:
    """Version of each package that matters and is installed."""
    installed = {"python": platform.python_version()}
    for package in ("stable-baselines3", "torch", "gymnasium", "mujoco", "jax", "numpy"):
        try:
            installed[package] = version(package)
        except PackageNotFoundError:
            continue
    return installed


def summary(args: argparse.Namespace, log: Log, steps: int, finished: bool) -> dict[str, Any]:
    """What summary.json says."""
    wall = time.perf_counter() - log.begin
    last = [value for step, value in log.returns if step > 0.9 * args.steps]
    return {
        "task": args.task,
        "algo": f"sb3_sac_{args.world}",
        "seeds": [args.seed],
        "total_steps": steps,
        "finished": finished,
        "final_return": [float(np.mean(last)) if last else None],
        "final_eval_return": [log.last_eval],
        "wall_s": round(wall, 3),
        "env_steps_per_s": round(steps / max(wall - log.paused, 1e-9), 1),
        "physics": "gymnasium" if args.world == "gymnasium" else "native",
        "device": platform.processor() or platform.machine(),
        "versions": versions(),
        "git_commit": commit(),
    }


def arguments() -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--world", choices=("gymnasium", "ours"), required=True)
    parser.add_argument("--task", choices=tuple(GYMNASIUM), required=True)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--steps", type=int, default=50_000)
    parser.add_argument("--eval-every", type=int, default=5000)
    parser.add_argument("--eval-episodes", type=int, default=5)
    parser.add_argument("--learning-starts", type=int, default=SETTINGS["learning_starts"])
    parser.add_argument("--run-dir", type=Path, help="default: runs/TASK/sb3_sac_WORLD/SEED")
    args = parser.parse_args()
    default = Path("runs", args.task, f"sb3_sac_{args.world}", str(args.seed))
    args.run_dir = args.run_dir or default
    return args


def main() -> None:
    """Train, and write the run folder."""
    args = arguments()
    torch.set_num_threads(1)
    args.run_dir.mkdir(parents=True, exist_ok=True)
    settings = SETTINGS | {"learning_starts": args.learning_starts}
    config = {k: str(v) if k == "run_dir" else v for k, v in vars(args).items()}
    text = json.dumps({"args": config, "sac": settings}, indent=1)
    (args.run_dir / "config.json").write_text(text + "\n", encoding="ascii")
    world, judge = make(args.world, args.task), make(args.world, args.task)
    model = SAC("MlpPolicy", world, seed=args.seed, device="cpu", **settings)
    log = Log(args.run_dir, judge, args.seed, args.eval_every, args.eval_episodes)
    finished = False
    try:
        model.learn(args.steps, callback=log)
        finished = True
    finally:
        values = summary(args, log, model.num_timesteps, finished)
        path = args.run_dir / "summary.json"
        path.write_text(json.dumps(values, indent=1) + "\n", encoding="ascii")
    print(json.dumps(values))


if __name__ == "__main__":
    main()
