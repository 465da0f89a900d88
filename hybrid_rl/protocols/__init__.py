"""The protocols that parts follow; shapes as in hybrid_rl.types.

Parts do not inherit from them: a class that has these methods and fields is a part.
"""

from hybrid_rl.protocols.control import Controller, Objective, Proposal, Target
from hybrid_rl.protocols.environments import (
    Analytic,
    AnalyticEnv,
    Balanced,
    BalancedEnv,
    Constraint,
    Env,
    Goal,
    Measured,
    MeasuredEnv,
    Rewarded,
)
from hybrid_rl.protocols.learned import (
    Belief,
    Critic,
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
)
from hybrid_rl.protocols.learning import (
    Demonstrations,
    Learner,
    Schedule,
    UniformLearner,
)

__all__ = [
    "Analytic",
    "AnalyticEnv",
    "Balanced",
    "BalancedEnv",
    "Belief",
    "Constraint",
    "Controller",
    "Critic",
    "Demonstrations",
    "Env",
    "Features",
    "Goal",
    "GoalPolicy",
    "InformedBelief",
    "LearnedPolicy",
    "Learner",
    "LinearModel",
    "Measured",
    "MeasuredEnv",
    "Model",
    "Objective",
    "Policy",
    "Proposal",
    "Reward",
    "Rewarded",
    "Schedule",
    "StabilizingPolicy",
    "Target",
    "Trainable",
    "Uncertain",
    "UniformLearner",
]
