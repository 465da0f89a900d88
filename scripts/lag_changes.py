"""The package's half-cheetah, which learned without delay, acts late: a lag that changes.

    python -m scripts.lag_changes out=lag_changes.json

Gymnasium's half-cheetah, 20 decisions a second, physics at 100 Hz; an action that is sent acts from
the first step of the physics after its lag on. Nothing is learned. FILE has of each episode the
mean reward of a decision times 1000. Of `changes`: before the lag changes, in the 100 decisions
after that, and later. The controller keeps the `first` lag, estimates it every 100 decisions
(`followed`), knows the true one, or predicts `nothing`. Of `parts`, by lag [s]: what is beyond
whole decisions is left as it is, or the action is held back.
"""

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import gymnasium
import jax
import numpy as np
from hydra.utils import instantiate

from hybrid_rl.cli.arguments import Argument, output, read, whole
from hybrid_rl.envs.adapters.robot import PENDING
from hybrid_rl.outside.lag import FOLLOWED, followed
from hybrid_rl.outside.row_log import row_type
from hybrid_rl.run import saved
from hybrid_rl.run.saved import Trained
from hybrid_rl.training import wrappers
from hybrid_rl.training.ahead import AheadController
from hybrid_rl.training.history import informed

ARGUMENTS = (
    Argument("policy", "halfcheetah", "with its model"),
    Argument("episodes", 10, "of each arm", whole()),
    Argument("out", "", "JSON", needed="out=FILE.json"),
)
DT, STEP, SOONEST = 0.05, 0.01, 0.003  # [s] of a decision, of the physics, and of deciding
BEFORE, AFTER = 0.03, 0.09  # [s] lags
CHANGE, LATER, LENGTH = 300, 400, 800  # decisions
PARTS = (0.0, 0.01, 0.05, 0.06, 0.1, 0.11)  # [s]


@dataclass
class Late:
    """A policy whose actions act late."""

    policy: Trained

    def __post_init__(self) -> None:
        controller, self.params = self.policy.learner(None, "policy")
        assert self.policy.config is not None
        self.spec, model = self.policy.episode.spec, instantiate(self.policy.config.model)
        self.controller = AheadController(controller, model, self.spec, 0.0, PENDING)
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
    out, late = output("out", given["out"], (".json",)), Late(saved.read(given["policy"]))
    arms = [("changes", arm, BEFORE, AFTER) for arm in ("first", "followed", "known", "nothing")]
    arms += [("parts", arm, lag, lag) for lag in PARTS for arm in ("left", "held")]
    found: dict[str, Any] = {"policy": given["policy"], "changes": {}, "parts": {}}
    for kind, arm, before, after in arms:
        one = found[kind].setdefault(arm, {})
        spans = {"before": (100, CHANGE), "during": (CHANGE, LATER), "after": (LATER, LENGTH)}
        if kind == "parts":
            spans = {f"{before:g}": (100, LATER)}
        last = max(end for _, end in spans.values())
        for key in range(given["episodes"]):
            paid = late.paid(arm, (before, after), last, key)
            for span, (first, end) in spans.items():
                one.setdefault(span, []).append(round(float(paid[first:end].mean()), 1))
        print(kind, arm, {span: np.mean(one[span]) for span in spans}, flush=True)
        Path(out).write_text(json.dumps(found))


if __name__ == "__main__":
    main()
