"""Each part refuses what its fields do not accept, and names the field.

A part that checks fields against each other, or against a world, has a row below.
"""

import pkgutil
from dataclasses import MISSING, fields, is_dataclass
from importlib import import_module
from typing import Annotated, Any, Literal, get_args, get_origin

import jax
import jax.numpy as jnp
import pytest
from toys import SPEC, Acting, Cart, speed

from hybrid_rl.constraints.limit import Limit
from hybrid_rl.controllers.adjoint import AdjointController
from hybrid_rl.controllers.goal import GoalController
from hybrid_rl.controllers.gradient import GradientController
from hybrid_rl.controllers.sampling import SamplingController
from hybrid_rl.core.domain import Box
from hybrid_rl.critics.categorical_q import CategoricalQ
from hybrid_rl.envs.analytic.pendulum import Pendulum
from hybrid_rl.envs.halfcheetah import HalfCheetah
from hybrid_rl.envs.quadcopter import Quadcopter
from hybrid_rl.envs.sawyer_push import SawyerPush
from hybrid_rl.features.monomials import Monomials
from hybrid_rl.fields import FieldError, Must, choices, plain
from hybrid_rl.learners.dagger import DAgger
from hybrid_rl.learners.embedding import EmbeddingLearner
from hybrid_rl.learners.information import InformationLearner
from hybrid_rl.learners.model import ModelLearner
from hybrid_rl.learners.model_based import ModelBased
from hybrid_rl.models.ensemble import Ensemble
from hybrid_rl.models.exact import Exact
from hybrid_rl.models.gaussian import Gaussian
from hybrid_rl.models.koopman import Koopman
from hybrid_rl.models.turned import Turned
from hybrid_rl.models.world import World
from hybrid_rl.objectives.disagreement import Disagreement
from hybrid_rl.objectives.fisher import FisherInformation
from hybrid_rl.objectives.weighted_sum import WeightedSum
from hybrid_rl.policies.deterministic import Deterministic
from hybrid_rl.policies.tanh_gaussian import TanhGaussian
from hybrid_rl.policies.unit_gaussian import UnitGaussian
from hybrid_rl.proposals.mixture import MixtureProposal
from hybrid_rl.proposals.noise import NoiseProposal
from hybrid_rl.rewards.aim import Aim
from hybrid_rl.rewards.known import KnownReward
from hybrid_rl.rewards.network import RewardNetwork
from hybrid_rl.rewards.push import Push
from hybrid_rl.rewards.run import Run
from hybrid_rl.targets.mixture import Mixture
from hybrid_rl.targets.policy_disagreement import PolicyDisagreement
from hybrid_rl.targets.policy_information import PolicyInformation
from hybrid_rl.training.episode import Episode

ROOMS = "beliefs constraints controllers critics features learners models objectives policies"
ROOMS += " proposals rewards schedules targets"
FREE = {  # numbers without a range: of any value, or checked with another field or the world
    *("Aim.target", "EmbeddingLearner.capacity", "EmbeddingLearner.interval"),
    *("Limit.least", "Limit.most", "ModelBased.target_entropy", "ModelBased.value_steps"),
    *("Run.direction", "SAC.target_entropy", "SoftActorCritic.target_entropy"),
    *(f"{name}.updates" for name in ("ActorCritic", "BehaviourCloning", "DDPG", "FlashSAC", "SAC")),
    *(f"{name}.updates" for name in ("InformationLearner", "ModelBased", "ModelLearner")),
    "SoftActorCritic.updates",
    *(f"{name}Gaussian.log_std_min" for name in ("", "Started", "Tanh", "Unit")),
    *(f"{name}Gaussian.log_std_max" for name in ("", "Started", "Tanh", "Unit")),
}


def parts() -> dict[str, type]:
    """Name -> class of every part that checks its fields."""
    found = {}
    for room in ROOMS.split():
        package = import_module(f"hybrid_rl.{room}")
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            for kind in vars(import_module(module.name)).values():
                check = getattr(kind, "__post_init__", None)
                if is_dataclass(kind) and "part." in getattr(check, "__qualname__", ""):
                    found[kind.__name__] = kind
    return found


PARTS = parts()


class Anything:
    """Stands where a part is needed."""

    def __getattr__(self, name: str) -> Any:
        return self

    def __call__(self, *given: Any) -> Any:
        return self


def given(kind: Any) -> Any:
    """A value that a field of this type accepts, as far as the type says."""
    of = plain(choices(kind)[0])
    return {tuple: (1.0,), Literal: None}.get(get_origin(of), Anything() if of is not str else "")


def wrong(kind: Any) -> Any:
    """What no field of this type accepts; None: nothing is known."""
    of = plain(kind)
    if of in (int, float):
        return (1.5 if of is int else float("nan")) if get_origin(kind) is Annotated else None
    if get_origin(of) in (tuple, Literal):
        return "none of these"
    has = any(isinstance(rule, Must) and rule.has for rule in get_args(kind)[1:])
    return object() if has else None


@pytest.mark.parametrize("name", sorted(PARTS))
def test_a_field_out_of_its_range_is_refused_by_its_name(name: str) -> None:
    kind, own = PARTS[name], fields(PARTS[name])
    needed = {f.name: given(f.type) for f in own if f.default is f.default_factory is MISSING}
    for field in own:
        if f"{name}.{field.name}" in FREE:
            continue
        for value in filter(lambda x: x is not None, map(wrong, choices(field.type))):
            with pytest.raises(FieldError, match=rf"^{name}: {field.name}="):
                kind(**needed | {field.name: value})


def test_every_number_of_a_part_has_a_range_but_for_a_few() -> None:
    bare = {
        f"{name}.{field.name}"
        for name, kind in PARTS.items()
        for field in fields(kind)
        if {int, float} & {*choices(field.type)}
    }
    assert bare == FREE


CART, ACTING, POLE = Cart(), Acting(), Pendulum()
CHEETAH, FLYING = HalfCheetah("native"), Quadcopter("native")
PUSHER = SawyerPush("native")
BOX = Box((0, 1), (0.0, 0.0), (1.0, 1.0))
NOTHING: Any = object()
TERMS = {"a": speed(), "b": speed()}
ONES = {"a": 1.0, "b": 1.0}
WHITE = NoiseProposal()
BOTH = MixtureProposal(WHITE, WHITE)
KEY = jax.random.key(0)
PATHLESS = Mixture(((0.1,),), (1.0,), (1.0,))
GAUSSIAN = Gaussian(hidden=(8,))


def limit(**given: Any) -> Any:
    """Makes a limit of the quadcopter's velocity."""
    return lambda: Limit(FLYING, **{"quantity": "velocity", **given})


def dagger(**given: Any) -> Any:
    """Makes a learner that asks."""
    return lambda: DAgger(Deterministic(hidden=(8,)), ACTING, **given)


def branches(**given: Any) -> Any:
    """Makes a learner by imagined decisions."""
    return lambda: ModelBased(ACTING, ACTING, CART, ACTING, **given)


TOGETHER = [  # what is made, and how the line begins, behind the name of the part
    (lambda: AdjointController(CART, speed()), "gain=null: "),
    (lambda: GradientController(World(CART), speed()), "model=World: "),
    (lambda: SamplingController(CART, speed(), BOTH, log_density=True), "log_density=true: "),
    (lambda: GoalController(PATHLESS, BOX, ahead=4), "ahead=4: "),
    (dagger(candidates=10, spread=0.2), "target=null: .*candidates"),
    (dagger(better=True), "target=null: .*queries"),
    (dagger(length=5), "length=5: .*model"),
    (lambda: EmbeddingLearner(Koopman(Monomials()), interval=4), "interval=4: .* 5 or more"),
    (lambda: EmbeddingLearner(Koopman(Monomials()), capacity=100), "capacity=100: .* 200"),
    (
        lambda: ModelLearner(GAUSSIAN, RewardNetwork(next_state=True), reward_discount=0.9),
        r"next_state=true: .*reward_discount=0",
    ),
    (branches(steps=3, value_steps=4), "value_steps=4: .*steps=3"),
    (lambda: CategoricalQ(hidden=(8, 16)), r"hidden=\[8, 16\]"),
    (lambda: UnitGaussian(hidden=()), r"hidden=\[\]"),
    (lambda: Gaussian(layer_norm="scale"), "layer_norm=scale"),
    (lambda: Turned(Ensemble(GAUSSIAN, 3), POLE), "world=Pendulum: .*heading"),
    (lambda: Disagreement(GAUSSIAN), "choose model=ensemble"),
    (lambda: FisherInformation(GAUSSIAN, probes=4), "probes=4: .*criterion=T"),
    (lambda: WeightedSum(TERMS, {"a": 1.0}), "weights need a, b"),
    (lambda: WeightedSum(TERMS, ONES, {"c": 0.5}), "decays are of some"),
    (lambda: PolicyInformation(TanhGaussian()), "TanhGaussian: .*policy=deterministic"),
    (lambda: PolicyDisagreement(Deterministic()), "Deterministic: .*policy=clones"),
    (lambda: Mixture(stds=(0.1,)), "stds="),
    (lambda: Mixture(weights=(0.0, 1.0)), "weights="),
    (lambda: KnownReward(CHEETAH), "needs an environment with a known reward"),
    (lambda: Aim(CHEETAH, "altitude"), "world=HalfCheetah: .*altitude.* height, pitch, speed"),
    (lambda: Run(PUSHER), "world=SawyerPush: .*speed.* block, reach"),
    (lambda: Push(CHEETAH), "world=HalfCheetah: .*block.* height, pitch, speed"),
    (lambda: Episode(CHEETAH, reward=NOTHING), "object has no reward_of"),
    (limit(), "most=null: "),
    (limit(quantity="wind", most=1.0), "world=Quad.*: has no wind, only spin, velocity, motion"),
    (limit(most=(1.0, 2.0)), r"most=\[1.0, 2.0\]: .*velocity.* 3 "),
    (limit(least=(1.0, 2.0, 3.0), norm=True), "least=.*norm.*velocity.* 1 "),
    # what only the sizes of a task, or the parameters of a run, can show
    (lambda: FisherInformation(Exact(POLE)).init(SPEC), "model=Exact: .*weights"),
    (lambda: InformationLearner(Exact(POLE)).init(KEY, SPEC), "model=Exact: .*weights"),
    (lambda: World(CART).step((), jnp.zeros(2), jnp.zeros(1)), "needs a planner that samples"),
    (lambda: Monomials((0, 4)).init(KEY, SPEC), r"coordinates=\[0, 4\]: .* entries 0 to 1"),
    (lambda: Monomials(terms=((0, 4),)).init(KEY, SPEC), r"terms=\[0, 4\]: "),
]


@pytest.mark.parametrize(("make", "line"), TOGETHER, ids=[line for _, line in TOGETHER])
def test_what_does_not_fit_together_is_one_line(make: Any, line: str) -> None:
    with pytest.raises(ValueError, match=line) as caught:
        make()
    assert "\n" not in str(caught.value)
