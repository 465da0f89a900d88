"""Half-cheetahs that learned without delay act late: a lag that changes, parts of a decision.

    python -m hybrid_rl.train settings=light random_steps=1000 num_seeds=5 seed=100 run_dir=DIR
    python -m scripts.lag_changes run=DIR out=lag_changes.json

Gymnasium's half-cheetah, 20 decisions a second, physics at 100 Hz; an action that is sent acts from
the first step of the physics after its lag on. Nothing is learned. FILE has rewards of each learner
times 1000, means over episodes: per arm before the lag changes, in the 100 decisions after it, and
later. Arms of `changes`: the first lag for ever, `followed` every 100 decisions, the true one, and
a controller that predicts nothing. Of `parts`: a lag whose part of a decision is left as it is, or
held back until it is whole.
"""

import json
import math
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import gymnasium
import jax
import numpy as np

import hybrid_rl as hr
from hybrid_rl.cli.arguments import Argument, output, read, whole
from hybrid_rl.envs.adapters.robot import PENDING
from hybrid_rl.outside.lag import FOLLOWED, followed
from hybrid_rl.outside.row_log import row_type
from hybrid_rl.training import wrappers
from hybrid_rl.training.ahead import ahead
from hybrid_rl.training.history import informed

ARGUMENTS = (
    Argument("run", "", "of half-cheetahs", needed="run=DIR"),
    Argument("episodes", 3, "of each arm", whole()),
    Argument("out", "", "JSON", needed="out=FILE.json"),
)
DT, STEP, SOONEST = 0.05, 0.01, 0.003  # [s] of a decision, of the physics, and of deciding
BEFORE, AFTER = 0.03, 0.09  # [s] lags
CHANGE, LATER, LENGTH = 300, 400, 800  # decisions
PARTS = (0.0, 0.01, 0.05, 0.06, 0.1, 0.11)  # [s]


@dataclass
class Late:
    """A learner of a run, and the episodes in which its actions act late."""

    run: Any
    seed: int

    def __post_init__(self) -> None:
        controller, self.params = self.run.learner(self.seed, "full")
        self.spec, model = self.run.agent.spec, controller.model
        self.controller = ahead(controller, 0.0, PENDING)
        self.act, self.informed = jax.jit(self.controller.act), jax.jit(informed)

        def predict(obs: Any, u: Any) -> Any:
            return model.step(self.params.model, model.lift(self.params.model, obs), u)

        self.predict = jax.jit(jax.vmap(predict))

    def paid(self, arm: str, lags: tuple[float, float], length: int, key: int) -> np.ndarray:
        """Rewards [length] while the lag is `lags`[0], from CHANGE on `lags`[1]."""
        env: Any = gymnasium.make("HalfCheetah-v5").unwrapped
        obs, _ = env.reset(seed=key)
        rows, paid = np.zeros(length, row_type(self.spec)), np.zeros(length)
        state, still, coming = self.controller.init(self.spec), np.zeros(6), []
        past, acting, lag = [(-np.inf, still)] * (PENDING + 1), still, lags[0]
        for k in range(length):
            true = lags[k >= CHANGE]
            if arm in ("known", "left", "held"):
                lag = true
            elif arm == "followed" and k and k % FOLLOWED == 0:
                lag = followed(self.predict, rows[k - FOLLOWED : k], lag)
            decisions = round(lag / DT, 6)
            kinds = {"nothing": 0, "left": int(decisions), "held": math.ceil(decisions)}
            pending = kinds[arm] if arm in kinds else wrappers.whole(decisions)
            pending = min(pending, PENDING)
            sent = np.array([u for _, u in past[::-1]], np.float32)
            state = self.informed(state, sent, np.float32(pending))
            u, state, _ = self.act(
                self.params, state, obs.astype(np.float32), jax.random.key(1000 * key + k)
            )
            u, soonest = np.clip(np.asarray(u), -1, 1), SOONEST * (lag > 0)
            now = k * DT + min(max(pending * DT - lag, soonest), 0.9 * DT)
            past = [(now, u), *past[:-1]]
            coming.append((now + true, u))
            for t in k * DT + STEP * np.arange(5):
                while coming and coming[0][0] <= t + 1e-9:
                    acting = coming.pop(0)[1]
                env.do_simulation(acting, 1)
            row = rows[k]
            row["obs"], row["next_obs"], row["interval"] = obs, env._get_obs(), DT
            row["times"], row["sent"] = zip(*((at - k * DT, u) for at, u in past), strict=True)
            obs = env._get_obs()
            paid[k] = 1000 * (obs[8] - 0.1 * np.square(u).sum())
        return paid


def main() -> None:
    """The command."""
    given: Any = read(__doc__, ARGUMENTS)[0]
    out, run = output("out", given["out"], (".json",)), hr.load(given["run"])
    found: dict[str, Any] = {"seeds": list(run.seeds), "changes": {}, "parts": {}}
    for seed in run.seeds:
        learner = Late(run, seed)

        def mean(of: Any) -> np.ndarray:
            return np.mean([of(key=key) for key in range(given["episodes"])], 0)

        for arm in ("first", "followed", "known", "nothing"):
            paid = mean(partial(learner.paid, arm, (BEFORE, AFTER), LENGTH))
            spans = {"before": (100, CHANGE), "during": (CHANGE, LATER), "after": (LATER, LENGTH)}
            for span, (first, last) in spans.items():
                one = found["changes"].setdefault(arm, {}).setdefault(span, [])
                one.append(round(float(paid[first:last].mean()), 1))
        for lag in PARTS:
            for arm in ("left", "held"):
                paid = mean(partial(learner.paid, arm, (lag, lag), LATER))
                one = found["parts"].setdefault(arm, {}).setdefault(f"{lag:g}", [])
                one.append(round(float(paid[100:].mean()), 1))
        print(seed, {a: [v[-1] for v in one.values()] for a, one in found["changes"].items()})
        print(seed, {a: [v[-1] for v in one.values()] for a, one in found["parts"].items()})
        Path(out).write_text(json.dumps(found))


if __name__ == "__main__":
    main()
