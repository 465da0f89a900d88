"""What computes in which numbers, by precision=NAME."""

import json
import re
from collections import Counter

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from small import load
from tiny import CONF, call, call_train, summary_of

import hybrid_rl
from hybrid_rl import evaluate
from hybrid_rl.controllers.policy import PolicyController
from hybrid_rl.networks import MLP, precision
from hybrid_rl.policies.tanh_gaussian import TanhGaussian
from hybrid_rl.run.exported import program
from hybrid_rl.settings.build import build
from hybrid_rl.training.loop import Axis
from hybrid_rl.types import Params, Spec

pytestmark = pytest.mark.turns(3)


@pytest.fixture(autouse=True)
def _as_before():
    """Other tests compute as they would without these."""
    yield
    precision.choose("auto")


def products(f, *given):
    """The types of the results of all products in `f`, and their precisions."""
    text = str(jax.make_jaxpr(f)(*given))
    kinds = re.findall(r":(\w+)\[[\d,]*\] = dot_general", text)
    return Counter(kinds), set(re.findall(r"precision=\(?(?:Precision\.)?(\w+)", text))


@pytest.mark.parametrize(
    ("name", "hidden", "of_products"),
    [("float32", "f32", "HIGHEST"), ("tf32", "f32", "DEFAULT"), ("bf16", "bf16", "DEFAULT")],
)
def test_hidden_layers_have_the_precision_and_outputs_float32(name, hidden, of_products):
    net, x = MLP((8, 8), 3, layer_norm=True), jnp.ones((4, 5))
    with precision.using(name):
        params = jax.eval_shape(net.init, jax.random.key(0), x)
        kinds, at = products(net.apply, params, x)
        gradient = jax.eval_shape(jax.grad(lambda params: net.apply(params, x).sum()), params)
        assert kinds == Counter({hidden: 2}) + Counter({"f32": 1})
        assert at == {of_products}
        assert jax.eval_shape(net.apply, params, x).dtype == jnp.float32
    assert {leaf.dtype for leaf in jax.tree.leaves((params, gradient))} == {jnp.dtype("float32")}


@pytest.mark.parametrize(("name", "on_gpu"), [("auto", "tf32"), ("mixed", "bf16")])
def test_auto_and_mixed_follow_the_device(name, on_gpu, monkeypatch):
    net, x = MLP((8,), 3), jnp.ones(5)
    precision.choose(name)
    assert products(lambda: net.init(jax.random.key(0), x))[1] == {"HIGHEST"}
    monkeypatch.setattr(precision.jax, "default_backend", lambda: "gpu")
    assert precision.current() == on_gpu


def test_the_numbers_of_a_sweep_leave_the_products_as_they_are():
    """They are arrays of float32, which would raise a bfloat16 that they met."""
    words, keys = ("task=pendulum", "algo=sac"), ("discount", "tau", "critic_learning_rate")
    other = [f"policy_learner.{key}=0.25" for key in keys] + ["policy.log_std_max=0.25"]
    agent, changed = (build(load("sac", *words, *more)).agent for more in ([], other))
    axis = Axis.of([{"agent": agent}, {"agent": changed}])
    assert len(axis.numbers) >= len(other)
    with precision.using("bf16"):
        state = jax.eval_shape(agent.init, jax.random.key(0))
        numbers = dict.fromkeys(axis.numbers, jnp.float32(0.25))
        swept = products(lambda x, s: axis.put(agent, "agent", x).step(s, 0), numbers, state)
        assert swept == products(lambda s: agent.step(s, 0), state)
    assert swept[0]["bf16"] > 0


@pytest.mark.parametrize(
    "algo", ["koopman_active", "koopman_embedding", "gp_active", "kle3", "flash_sac"]
)
def test_what_is_no_multilayer_perceptron_stays_in_float32(algo):
    agent = build(load(algo, "task=pendulum", f"algo={algo}")).agent
    with precision.using("bf16"):
        state = jax.eval_shape(agent.init, jax.random.key(0))
        assert set(products(agent.step, state, jnp.int32(0))[0]) == {"f32"}


def test_information_is_measured_in_float32():
    """Of a model's weights, along a path; the model itself learns in bfloat16."""
    run = build(load("fisher", "task=pendulum", "algo=fisher"))
    with precision.using("bf16"):
        key, of = jax.random.key(0), run.agent.learners
        state = jax.eval_shape(run.agent.init, key)
        params = jax.eval_shape(run.agent.params, state)
        learner, information = of["model"], of["information"]
        batch = lambda memory: run.agent._batch(memory, information, params, key)  # noqa: E731
        rows = jax.eval_shape(batch, state.memory)
        of_model = products(learner.update, state.learners["model"], params, rows, key)[0]
        measured = products(information.update, state.learners["information"], params, rows, key)
    assert "bf16" in of_model
    assert set(measured[0]) == {"f32"}


def test_an_exported_policy_computes_in_float32():
    policy, spec = TanhGaussian((8,)), Spec(3, 1, 0.05)
    precision.choose("bf16")
    params = Params(policy=policy.init(jax.random.key(0), spec))
    made = program(spec, PolicyController(policy, explore=False), params)
    assert "bf16" not in made.mlir_module()


def test_a_run_keeps_its_precision_and_can_change_it(tmp_path):
    """Its parameters and the states of its optimisers are float32 with each."""

    def called():
        return summary_of(folder)["precision"]

    folder = tmp_path / "run"
    given = ["settings=tiny", "algo=sac", "eval_modes=[]", "checkpoint_every=300"]
    assert call_train(CONF, *given, "precision=bf16", "physics=mjx", f"run_dir={folder}") == 0
    assert called() == "bf16"
    leaves = jax.tree.leaves(hybrid_rl.load(folder).params)
    assert {leaf.dtype.name for leaf in leaves} == {"float32"}
    assert call_train(f"resume={folder}", "total_steps=650") == 0
    assert called() == "bf16"
    assert call_train(f"resume={folder}", "total_steps=700", "precision=float32") == 0
    assert called() == "float32"
    for name in ("float32", "bf16"):
        assert call(evaluate.main, f"run={folder}", "episodes=1", f"precision={name}") == 0
    assert json.loads((folder / "evaluation_full.json").read_text())["precision"] == "float32"
    found = json.loads((folder / "evaluation_full_precision=bf16.json").read_text())
    assert (found["precision"], found["changes"]) == ("bf16", {"precision": "bf16"})
    assert np.isfinite(found["mean"]).all()
