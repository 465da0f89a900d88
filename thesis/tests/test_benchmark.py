"""The benchmark command: what is compared, and what it leaves behind."""

import json
import time
from pathlib import Path

import imageio.v3 as iio
import jax
import jax.numpy as jnp
import pytest
from matplotlib.figure import Figure
from tiny import call

from hybrid_rl.cli import command
from hybrid_rl.envs.mujoco import mjcf, mjx_warp
from hybrid_rl.tools.benchmark import __main__ as benchmark
from hybrid_rl.tools.benchmark import others, ours, parts, picture, products
from hybrid_rl.tools.benchmark.picture import draw
from hybrid_rl.tools.benchmark.race import Contestant, race

ROOT = Path(__file__).resolve().parents[2]


def run(*arguments):
    """Exit code of the command."""
    return call(lambda: command.run(benchmark.main), *arguments)


def test_a_race_takes_turns_and_divides_by_the_first():
    """One that does three times the work in the time of the other is three times as fast."""
    order = []

    def go(name):
        order.append(name)
        time.sleep(0.01)

    field = [Contestant(name, lambda n=name: go(n), work) for name, work in (("a", 1), ("b", 3))]
    first, second = race(field, 3)
    assert order == ["a", "b"] * 4  # the first turn warms up
    assert first["ratio"] == 1
    assert second["ratio"] == pytest.approx(3, rel=0.5)
    assert 0 < second["rate"] <= second["best"] <= 300


def test_without_precision_a_loop_has_that_of_its_method():
    """What `train` would use, for which `fast` has bf16 on a GPU."""
    asked = {"experiment": None, "algo": "hybrid_stochastic"}
    for settings, own in (("fast", "mixed"), ("default", "auto")):
        assert parts._config(asked, "native", settings).precision == own


def test_products_are_counted_by_loops_and_the_costlier_branch():
    """Three layers of 4 x 5 on 2 rows with their gradient, and one product of a choice."""
    x, w, square = jnp.ones((2, 4)), jnp.ones((4, 5)), jnp.ones((7, 7))

    def loss(w):
        return jax.lax.fori_loop(0, 3, lambda i, total: total + (x @ (w + i)).sum(), 0.0)

    def choice(w, square):
        branches = lambda: square[:1] @ square, lambda: (square @ square)[:1]
        return jax.grad(loss)(w), jax.lax.cond(w[0, 0] > 0, *branches)

    found = products.products(choice, w, square)
    assert products.operations(found) == 3 * 2 * (2 * 2 * 4 * 5) + 2 * 7**3
    contestant = products.alone("alone", found, 1)
    contestant.go()
    assert contestant.work == products.REPEATS


@pytest.mark.parametrize("implementation", ["native", "mjx"])
def test_a_bare_loop_steps_the_model_of_our_world(implementation, monkeypatch):
    """The same compiled model: solver, iterations, integrator and time step are equal."""
    home, name = (mjcf, "load") if implementation == "native" else (mjx_warp, "template")
    stepped, make = [], getattr(home, name)

    def made(*given):
        result = make(*given)
        stepped.append(id(result if home is mjcf else result[0]))
        return result

    def traced(name, run, *given, work):
        jax.eval_shape(run, *given)
        return Contestant(name, lambda: None, work)

    for module in (ours, others):
        monkeypatch.setattr(module, "compile_contestant", traced)
    monkeypatch.setattr(home, name, made)
    own = ours.worlds("cartpole", implementation, 2, 1)
    ours_stepped = set(stepped)
    stepped.clear()
    bare = others.bare_native if implementation == "native" else others.bare_mjx
    theirs = bare("cartpole", 2, round(own.work / 2))
    assert len(ours_stepped) == 1
    assert set(stepped) == ours_stepped
    assert theirs.work == own.work


def test_the_command_measures_every_part(tmp_path):
    """On the smallest of everything; soft actor-critic beside Brax's at the same sizes."""
    small = ["tasks=cartpole", "worlds=2", "plans=4x2", "algo=nn_mppi", "parts=physics,plan,loop"]
    every = ["experiment=thesis/fig_3_2_pendulum", "learners=1", "rounds=1"]
    names = {}
    for line in (small, ["algo=sac", "parts=updates"]):
        assert run(*every, *line, f"out={tmp_path / 'b.json'}") == 0
        tables = json.loads((tmp_path / "b.json").read_text())["tables"]
        assert all(row["rate"] > 0 for table in tables for row in table["rows"])
        names |= {table["part"]: [row["name"] for row in table["rows"]] for table in tables}
        for table in tables:
            if table["part"] == "physics":
                assert table["solver"]["iterations"] == mjcf.load("cartpole.xml").opt.iterations
    assert [*names] == ["physics", "plan", "loop", "updates"]
    assert any("bare mujoco.rollout" in name for name in names["physics"])
    assert names["updates"] == ["policy learner", "Brax's SAC"]


def test_loops_are_timed_by_precision_beside_the_committed_ones(tmp_path, capsys, monkeypatch):
    """A row for each precision; a row that is not known stands beside the first of its table."""
    assert all(table["rows"] for table in json.loads(parts.REFERENCE.read_text())["tables"])
    out, known = tmp_path / "b.json", tmp_path / "known.json"
    rows = [{"name": "native, tf32", "rate": 1e9}]
    table = {"what": "sac, default, 1 learner", "rows": rows}
    known.write_text(json.dumps({"machine": "a GPU", "tables": [table]}))
    monkeypatch.setattr(parts, "REFERENCE", known)
    line = ["parts=loop", "learners=1", "algo=sac", "rounds=1", "seconds=0.01", f"out={out}"]
    assert run(*line, "precision=float32,bf16") == 0
    (found,) = json.loads(out.read_text())["tables"]
    assert found["what"] == table["what"]
    assert [row["name"] for row in found["rows"]] == ["native, float32", "native, bf16"]
    assert capsys.readouterr().out.count("0.000 of 1,000,000,000 (a GPU, native, tf32)") == 2


def test_pictures_fit_a_screen_and_bars_begin_at_zero(tmp_path):
    """Those of the largest tables that there are."""
    numbers = json.loads((ROOT / "docs" / "results" / "speed_h200.json").read_text())
    pictures = draw(numbers["tables"], tmp_path / "speed.png")
    assert len(pictures) == 4
    for path in pictures:
        height, width = iio.imread(path).shape[:2]
        assert 2 / 3 < width / height < 2.6
        assert max(width, height) <= 1300
    axes = Figure().subplots()
    picture._bars(axes, numbers["tables"][-1], room=1.0)
    rates = [row["rate"] for row in numbers["tables"][-1]["rows"]]
    assert [bar.get_width() for bar in axes.patches] == rates
    assert axes.get_xlim()[0] == 0 == axes.patches[0].get_x()
