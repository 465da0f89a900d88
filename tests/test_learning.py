"""Methods learn: each swings a pendulum up within a usual number of decisions.

Episodes of random actions return about -1,300; a pendulum that is swung up immediately and then
balanced returns about -150. The comments give the last evaluations of 40 learners, of
seeds 0 to 9, 100 to 109, 200 to 209 and 300 to 309. A commit runs one of the four.
"""

import numpy as np
import pytest
from tiny import rows_of, run

from hybrid_rl.core import adjoint, rollout

RANDOM = 400  # decisions: two episodes
MODEL = ["model=gaussian", "model.hidden=[64]", "reward_model.hidden=[64]"]
MODEL += [f"model_learner.{word}" for word in ("batch_size=64", "updates=2", "learning_rate=3e-3")]
SAC = ["policy.hidden=[64,64]", "critic.hidden=[64,64]"]
SAC += [
    f"policy_learner.{word}"
    for word in (
        *("batch_size=64", "policy_learning_rate=2e-3", "critic_learning_rate=2e-3"),
        *("alpha_learning_rate=1e-3", "alpha=0.1", "tau=0.02", "discount=0.97"),
    )
]
CASES = {  # method -> decisions, settings
    "nn_mppi": (800, [*MODEL, "planner.horizon=20", "planner.samples=32"]),  # -299 to -41
    "deterministic_mpc": (1200, [*MODEL, "shooting_planner.iterations=5"]),  # -250 to -42
    "sac": (4000, SAC),  # -256 to -41
    "hybrid_stochastic": (  # -247 to -42
        1600,
        [*MODEL, *SAC, "learning=replay", "planner.horizon=10", "planner.samples=16"],
    ),
}


@pytest.fixture
def rolled(monkeypatch):
    """Loops over a horizon are not unrolled: a long one compiles as fast as a short one."""
    for module in (adjoint, rollout):
        monkeypatch.setattr(module, "scan_unroll", lambda *_: 1)


@pytest.mark.turns(4)
@pytest.mark.usefixtures("rolled")
@pytest.mark.parametrize("algo", CASES)
def test_a_pendulum_is_swung_up(algo, tmp_path):
    """The last evaluations of both learners exceed -400; their random episodes are far below."""
    decisions, settings = CASES[algo]
    lengths = [f"{key}={decisions}" for key in ("total_steps", "eval_every", "checkpoint_every")]
    more = [f"random_steps={RANDOM}", "num_seeds=2", "eval_episodes=3", "log_every=500"]
    capacity = f"replay.capacity={decisions}"
    run(tmp_path / "run", f"algo={algo}", *settings, *lengths, *more, capacity)
    rows = rows_of(tmp_path / "run")
    at_random = [r["train/return"] for r in rows if "train/return" in r and r["step"] <= RANDOM]
    learned = [r["eval/return"] for r in rows if "eval/return" in r]
    assert len(at_random) == 4
    assert len(learned) == 2
    assert np.mean(at_random) < -800
    assert min(learned) > -400
