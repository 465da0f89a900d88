"""Keys and values of version 0.2 under their present names; docs/renamed.md explains them."""

from collections.abc import Iterable

from hybrid_rl.errors import UsageError

VERSION = "0.3"
OF_NETWORK = ("hidden", "activation", "normalise", "ends", "rule", "scale", "members", "next_state")
PRECISION = {"highest": "float32", "high": "tf32", "default": "tf32"}  # of matmul_precision
RENAMED = {  # an override's beginning, KEY or KEY=VALUE -> what replaces it; the first that fits
    **{f"matmul_precision={old}": f"precision={new}" for old, new in PRECISION.items()},
    "matmul_precision": "precision, of bf16, tf32, float32",
    "settings=mbpo": "learning=mbpo",
    "mbpo.learner.early": "policy_learner.during_random",
    "mbpo.learner.expand": "policy_learner.value_steps, 0 where it was false",
    "mbpo.learner.lookahead": "policy_learner.steps, which 0 turns off",
    "mbpo.learner": "policy_learner",
    "mbpo.share": "mbpo.imagined_fraction, with learning=mbpo",
    "mbpo.memory": "policy_learner.branch_memory",
    "mbpo.steps": "policy_learner.branch_steps",
    "lookahead.steps": "policy_learner.steps",
    "lookahead": "policy_learner",
    "policy_learner.early": "policy_learner.during_random",
    "policy_learner.expand": "policy_learner.value_steps, 0 where it was false",
    "policy_learner.value_expansion": "policy_learner.value_steps, 0 where it was false",
    "policy_learner.lookahead": "policy_learner.steps, which 0 turns off",
    "objective=known_reward": "objective=predicted_return reward_model=known",
    "objective=quadratic": "objective=predicted_return reward_model=quadratic",
    "objective.state_weights": "reward_model.state_weights, with reward_model=quadratic",
    "objective.action_weights": "reward_model.action_weights, with reward_model=quadratic",
    "task_objective.state_weights": "goal.state_weights",
    "task_objective.action_weights": "goal.action_weights",
    "model_objective.state_weights": "goal.state_weights",
    "model_objective.action_weights": "goal.action_weights",
    **{f"reward={name}": f"reward_model={name}" for name in ("network", "known", "quadratic")},
    **{f"reward.{key}": f"reward_model.{key}" for key in OF_NETWORK},
    "dagger_learner.recent": "nothing: no method used it",
    "target=likely": "nothing: no method used it",
    "target=feature_information": "nothing: no method used it",
}
STILL = {"mbpo.steps": "learning=mbpo"}  # an old key that exists with another override


def check(overrides: Iterable[str]) -> None:
    """Refuse an override that has another name now.

    Raises:
        UsageError: with that name, in one line.
    """
    given = list(overrides)
    for text in given:
        key, _, values = text.lstrip("+~").partition("=")
        for old, new in RENAMED.items():
            if STILL.get(old) in given:
                continue
            inner = key.removeprefix(old)
            if old == key or (inner != key and inner.startswith(".")):
                raise UsageError(f"{text}: since {VERSION} it is {new}{inner}")
            if old in [f"{key}={value}" for value in values.split(",")]:
                raise UsageError(f"{text}: since {VERSION} {old} is {new}")
