"""Receding-horizon control by gradient ascent on corrections of a policy, from several starts.

    u_t = clip(s pi(x_t) + v_t)         a candidate: a strength s and corrections v [T, m]
    v <- v + step g / rms(g),  g = dS/dv        the best candidates, and the last plan
    S = J - price sum_t d_t             over T decisions, and `tail` more with v = 0

The best candidate acts. The policy stays in the loop, so that it steadies the imagined path, and
the tail says what it makes of the state where the corrections end: without it, a plan of one second
stops working for the seconds after it. d_t is the mean over the entries of the state of the
ensemble's disagreement, in running standard deviations of the change; without this price gradients
lead to where the model is wrong. Without a policy, s = 0: shooting, from noise.

Without a constraint, the policy itself acts where the members of the ensemble, each rolled out
apart, do not agree that the best candidate gains on it, that is unless

    mean_i [J_i(s, v) - J_i(1, 0)] > doubt std_i [...]        i: the members of the ensemble

With a constraint of excess c, indicator width w, price and chance,

    p_t = mean_i sigmoid(c(x_t, u_t, f_i(x_t, u_t)) / w + margin)    over the ensemble's members
    S = ... - price sum_t p_t            unless J has learned the price with the reward

and candidates with max_t p_t > chance, t < T, rank below all others, by how far they are beyond the
limit. The tail does not count there: another plan acts before it comes.

Sources: corrections of a policy as in thesis Algorithm 2; gradient steps from roll-outs of a policy
as in Dream-MPC (2026); a tail of the policy as in roll-out algorithms (Bertsekas); the order of
candidates is that of constrained cross-entropy methods (Wen and Topcu 2018). Several strengths, the
step by its root mean square and the prices are our choice.
"""

from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import adjoint
from hybrid_rl.core.batching import join, prepend
from hybrid_rl.core.lifting import is_world
from hybrid_rl.core.rollout import Priced, predict_members, priced
from hybrid_rl.core.sampling import Kept
from hybrid_rl.fields import (
    Count,
    Discount,
    FieldError,
    Fraction,
    Natural,
    NotNegative,
    Positive,
    Strengths,
    part,
)
from hybrid_rl.protocols import Constraint, Model, Objective, Policy
from hybrid_rl.types import Considered, Params, Return, Spec


class Candidate(NamedTuple):
    """A policy's strength, and corrections."""

    s: Array  # []
    v: Array  # [T, m]


class Risk(NamedTuple):
    """How likely decisions violate the constraint, and how far."""

    risk: Array  # [] the probability of a violation; of a plan the largest before the tail
    beyond: Array  # [] distance beyond the limit [widths], the sum of a plan's; smooth: above 0


@part
class GradientController:
    """A planner over K candidates and T decisions."""

    model: Model
    objective: Objective
    policy: Policy | None = None  # None: no strengths; a tail is then one of zeros
    strengths: Strengths = (1.0, 0.8, 0.6, 0.4, 0.2)  # the candidates have in turn
    horizon: Count = 10  # T [decisions]
    tail: Natural = 20  # [decisions] of the policy after them
    samples: Count = 32  # K
    noise: NotNegative = 0.1  # [u] std of the candidates' corrections
    correlation: Discount = 0.8  # of the noise of successive decisions
    quiet: Fraction = 0.34  # share without noise, rounded up to whole rounds of strengths
    refined: Count = 5  # of the K, which gradients improve
    iterations: Natural = 5
    step: Positive = 0.05  # [u] root mean square of an iteration's change
    disagreement_price: NotNegative = 3.0  # of one running std of the change, in one decision
    doubt: NotNegative | None = 1.0  # std over the members by which a plan must beat the policy
    constraint: Constraint | None = None
    margin: NotNegative = 0.0  # [widths] that plans keep from the constraint's limit
    priced: bool = False  # whether the objective's reward, learned with it, has its price already

    def __post_init__(self) -> None:
        if is_world(self.model):
            words = "has no gradients; choose model=exact, or one that learns, such as ensemble"
            raise FieldError(self, "model", words)

    def init(self, spec: Spec) -> Kept:
        """No corrections, and the objective's initial memory."""
        v = jnp.zeros((self.horizon, spec.act))
        first = jnp.float32(self.strengths[0] if self.policy is not None else 0.0)
        return Kept(v, v[0], self.objective.init(spec), first)

    def act(
        self, params: Params, state: Kept, obs: Array, key: Array
    ) -> tuple[Array, Kept, dict[str, Array]]:
        """Action [m], next state, metrics. The key is consumed."""
        return self.considered(params, state, obs, key)[:3]

    def considered(
        self, params: Params, state: Kept, obs: Array, key: Array
    ) -> tuple[Array, Kept, dict[str, Array], Considered]:
        """As `act`, and the candidates: what acts, then the refined, their starts, the drawn."""
        preparing, drawing = jax.random.split(key)
        x = self.model.lift(params.model, obs)
        value, memory = self.objective.prepare(params, state.memory, x, state.u, preparing)
        score = jax.vmap(lambda one: self._scored(params, value, x, one))
        drawn = self._drawn(state, drawing)
        first = score(drawn)
        best = jax.lax.top_k(self._rank(first), min(self.refined, self.samples))[1]
        last = Candidate(state.more, state.plan)
        starts = prepend(last, jax.tree.map(lambda leaf: leaf[best], drawn))
        refined = self._refined(params, value, x, starts)
        each = join(refined, starts)
        found = score(each)
        winner = jnp.argmax(self._rank(found))
        plan, chosen = jax.tree.map(lambda leaf: leaf[winner], (each, found))
        plan, chosen = self._surely(params, value, x, plan, chosen)
        u = chosen.path.u[0]
        gain = found.score[: len(starts.s)].max() - found.score[len(starts.s) :].max()
        risk = {} if self.constraint is None else {"planner/risk": chosen.notes.risk}
        metrics = {
            "planner/planned_return": chosen.value,
            "planner/disagreement": chosen.disagreement / (self.horizon + self.tail),
            "planner/gain": jnp.where(jnp.isfinite(gain), gain, jnp.nan),  # of the gradients
            "planner/strength": plan.s,
            **risk,
            **self._agreement(params, value, x, u),
        }
        after = state.later(plan.v, u, memory)._replace(more=plan.s)
        paths = prepend(chosen.path, join(found.path, first.path))
        return u, after, metrics, Considered(paths, jnp.int32(0))

    def greedy(self) -> "GradientController":
        """The same controller: the best candidate acts."""
        return self

    def _drawn(self, state: Kept, key: Array) -> Candidate:
        """Candidates [K, ...] with the strengths in turn. The key is consumed."""
        K, c = self.samples, self.correlation
        e = jax.random.normal(key, (self.horizon, K, state.plan.shape[1]))

        def along(before: Array, new: Array) -> tuple[Array, Array]:
            now = c * before + jnp.sqrt(1 - c**2) * new
            return now, now

        e = jnp.concatenate([e[:1], jax.lax.scan(along, e[0], e[1:])[1]]).swapaxes(0, 1)
        each = jnp.array(self.strengths if self.policy is not None else (0.0,), jnp.float32)
        number, count = jnp.arange(K), len(each)
        loud = number // count >= self.quiet * K / count
        if self.policy is None:  # around the last plan
            return Candidate(jnp.zeros(K), state.plan[None] + self.noise * e)
        return Candidate(each[number % count], self.noise * e * loud[:, None, None])

    def _surely(
        self, params: Params, value: Return, x: Array, plan: Candidate, chosen: Priced
    ) -> tuple[Candidate, Priced]:
        """The plan at x [n], or the policy's own where the members doubt that it gains."""
        if self.policy is None or self.doubt is None or self.constraint is not None:
            return plan, chosen
        own = Candidate(jnp.ones(()), jnp.zeros_like(plan.v))

        def gain(member: Array) -> Array:
            a, b = (self._scored(params, value, x, one, member).value for one in (plan, own))
            return a - b

        members = len(predict_members(self.model, params.model, x, chosen.path.u[0])[2])
        gains = jax.vmap(gain)(jnp.arange(members))
        surely = gains.mean() > self.doubt * gains.std()
        others = (own, self._scored(params, value, x, own))
        return jax.tree.map(lambda a, b: jnp.where(surely, a, b), (plan, chosen), others)

    def _scored(
        self, params: Params, value: Return, x: Array, one: Candidate, member: Array | None = None
    ) -> Priced:
        """The candidate from x [n], by the mean of the ensemble or by one member."""
        v = jnp.concatenate([one.v, jnp.zeros((self.tail, one.v.shape[1]))])

        def act(x: Array, v: Array) -> Array:
            u = v
            if self.policy is not None:
                u = one.s * self.policy.mean(params.policy, x) + v
            return jnp.clip(u, -1, 1)

        model, price = self.model, self.disagreement_price
        found = priced(model, params.model, value, price, act, x, v, member, self._risk)
        far, T = jnp.where(jnp.isfinite(found.score), found.notes.beyond, jnp.inf), self.horizon
        return found._replace(notes=Risk(found.notes.risk[:T].max(), far[:T].sum()))

    def _risk(self, x: Array, u: Array, each: Array) -> tuple[Array, Risk]:
        """The cost [] of violating the constraint by u [m] at x [n], and the risk of it.

        each: [members, n] the predicted next states.
        """
        limit, none = self.constraint, jnp.zeros(())
        if limit is None:
            return none, Risk(none, none)
        far = jax.vmap(lambda after: limit.excess(x, u, after) / limit.width)(each) + self.margin
        chance = jax.nn.sigmoid(far).mean()
        cost = 0 * chance if self.priced else limit.price * chance
        return cost, Risk(chance, jax.nn.softplus(far).mean())

    def _rank(self, found: Priced) -> Array:
        """Numbers [K] in the order of the candidates: the largest is that of the best."""
        if self.constraint is None or self.constraint.chance is None:
            return found.score
        safe = (found.notes.risk <= self.constraint.chance) & jnp.isfinite(found.score)
        order = jnp.lexsort((found.score, jnp.where(safe, 0.0, -found.notes.beyond), safe))
        return jnp.argsort(order)

    def _refined(self, params: Params, value: Return, x: Array, starts: Candidate) -> Candidate:
        """Candidates [C, ...] after the gradient steps."""

        def score(v: Array, s: Array) -> Array:
            return self._scored(params, value, x, Candidate(s, v)).score

        def iterate(v: Array, _: None) -> tuple[Array, None]:
            g = jnp.nan_to_num(jax.vmap(jax.grad(score))(v, starts.s), posinf=0.0, neginf=0.0)
            size = jnp.sqrt(jnp.mean(g**2, (1, 2), keepdims=True))
            return jnp.clip(v + self.step * g / (size + 1e-6), -2, 2), None

        return Candidate(starts.s, jax.lax.scan(iterate, starts.v, length=self.iterations)[0])

    def _agreement(self, params: Params, value: Return, x: Array, u: Array) -> dict[str, Array]:
        """Metrics of the action u [m] against the policy's."""
        if self.policy is None:
            return {}
        step = partial(self.model.step, params.model)
        return adjoint.agreement(step, self.policy, params, value, x, u, self.horizon)
