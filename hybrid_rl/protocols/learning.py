"""Protocols of learners, which make parameters from data, and of demonstrations."""

from typing import Literal, Protocol

from jax import Array

from hybrid_rl.protocols.contract import gives
from hybrid_rl.types import Batch, Params, PyTree, Spec, Transition


class Demonstrations(Protocol):
    """An expert's decisions."""

    def load(self) -> Transition:
        """All of them [N, ...], in order."""


class Schedule(Protocol):
    """How learning rates change along a run."""

    def factor(self, decisions: Array) -> Array:
        """The factor [] of the learning rates, so many decisions [] into the run."""


class Learner(Protocol):
    """Data -> parameters.

    A `uniform` learner, UniformLearner, learns from batches of the memory. A `latest` one takes
    each decision once, with its true next observation: its updates get the transitions [E] of the
    step that just ended, without delay, from the first decision of the run on, random ones
    included. It has `every`: decisions of each environment between two updates; 1 uses them all.
    """

    owns: tuple[str, ...]  # fields of `Params` that it learns; that of "model" has a field `model`
    data: Literal["uniform", "latest"]

    @gives("key, spec -> state")
    def init(self, key: Array, spec: Spec) -> PyTree:
        """Initial state: parameters, optimisers, targets."""

    @gives("state -> owned")
    def params(self, state: PyTree) -> dict[str, PyTree]:
        """The fields of `Params` that this learner owns."""

    @gives("state, Params, batch, key -> state, metrics")
    def update(
        self, state: PyTree, params: Params, batch: Batch, key: Array
    ) -> tuple[PyTree, dict[str, Array]]:
        """The next state, and metrics name -> []; `params` of all learners before the update."""


class UniformLearner(Learner, Protocol):
    """A learner whose updates get batches [batches * batch_size] of the replay memory.

    `obs` and `next_obs` are planning states [B, n] if a model is learned by another learner, and
    `init` gets their size; the agent lifts them.
    """

    batch_size: int  # transitions of a batch
    batches: int  # batches of one update, concatenated
    updates: float  # per decision
    during_random: bool  # whether it also learns while decisions are random
