"""The protocols that parts follow; shapes as in hybrid_rl.types.

Parts do not inherit from them: a class that has these methods and fields is a part.
"""

from hybrid_rl.protocols.control import (
    Controller,
    LabelledTarget,
    Objective,
    Proposal,
    Staged,
    Target,
)
from hybrid_rl.protocols.environments import (
    AnalyticEnv,
    BalancedEnv,
    ContactEnv,
    Env,
    RewardedEnv,
    TrackingEnv,
)
from hybrid_rl.protocols.learned import (
    Belief,
    Committee,
    ContactMap,
    Critic,
    EnsembleModel,
    Features,
    GoalPolicy,
    InformedBelief,
    LearnedPolicy,
    LinearModel,
    Model,
    Policy,
    Reward,
    StabilizingPolicy,
    Trainable,
    Uncertain,
    UnsquashedPolicy,
)
from hybrid_rl.protocols.learning import (
    Demonstrations,
    LatestLearner,
    Learner,
    PolicyReturn,
    UniformLearner,
)

__all__ = [
    "AnalyticEnv",
    "BalancedEnv",
    "Belief",
    "Committee",
    "ContactEnv",
    "ContactMap",
    "Controller",
    "Critic",
    "Demonstrations",
    "EnsembleModel",
    "Env",
    "Features",
    "GoalPolicy",
    "InformedBelief",
    "LabelledTarget",
    "LatestLearner",
    "LearnedPolicy",
    "Learner",
    "LinearModel",
    "Model",
    "Objective",
    "Policy",
    "PolicyReturn",
    "Proposal",
    "Reward",
    "RewardedEnv",
    "StabilizingPolicy",
    "Staged",
    "Target",
    "TrackingEnv",
    "Trainable",
    "Uncertain",
    "UniformLearner",
    "UnsquashedPolicy",
]
