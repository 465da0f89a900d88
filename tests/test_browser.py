"""Robots on the documentation's first page are those of Python, and run without a server."""

import math
import shutil
from contextlib import contextmanager
from types import SimpleNamespace

import chromium
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from hybrid_rl.analysis.curves import iqm
from hybrid_rl.envs.mujoco.physics import Physics
from hybrid_rl.training.episode import Episode
from scripts.browser import __main__ as built
from scripts.browser import robots
from scripts.browser.javascript import Program

LARGEST = 6_000_000  # bytes of all that the page loads
EXACT = 5  # decisions, before contacts multiply the last digit
EPISODES = 8
STYLE = "document.querySelector('.robots').style.display"
PAGE = """<!DOCTYPE html><html lang="en"><meta charset="utf-8"><link rel="icon" href="data:,">
<body><div class="robots" style="width: 320px"><img alt="" src="data:,"></div>
<style>.robots-stage { aspect-ratio: 16 / 9 }</style><script src="start.js"></script></html>"""


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """A page with the robots, in a folder."""
    folder = tmp_path_factory.mktemp("site")
    for file in built.OUT.iterdir():
        shutil.copy(file, folder)
    robots.write(folder / "robots.js")
    (folder / "index.html").write_text(PAGE, encoding="utf-8")
    return folder


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    """A Chromium; Debian's package is chromium, GitHub's machines have Google's."""
    if not chromium.PROGRAM:
        pytest.skip("needs Chromium")
    with chromium.opened(tmp_path_factory.mktemp("profile")) as page:
        page.size(800, 600)
        yield page


@pytest.fixture(scope="module")
def page(site, browser):
    """The page, after the click that loads the robots; they are drawn only where a test asks."""
    browser.open((site / "index.html").as_uri())
    browser.run("document.querySelector('.robots-start').click()")
    browser.wait("window.robots")
    browser.run(f"{STYLE} = 'none'")
    return browser


@contextmanager
def drawn(page, name):
    """A robot is drawn until the block ends: without a GPU this takes every core."""
    page.run(f"{STYLE} = ''")
    page.run(f"robots.show({name!r})")
    yield
    page.run(f"{STYLE} = 'none'")


def test_the_built_scripts_are_those_of_the_sources_and_small(site):
    assert built.found() == built.SHA256, "`python -m scripts.browser` makes them"
    assert built.sources() in (built.OUT / "robot.js").read_text(encoding="utf-8")[:200]
    assert sum(file.stat().st_size for file in site.iterdir()) < LARGEST


@pytest.mark.turns(2)
@pytest.mark.parametrize("name", robots.NAMES)
def test_decisions_and_returns_are_those_of_python(page, name):
    policy = robots.read(name)
    controller, params = policy.learner(mode="policy")
    played = jax.jit(episodes, static_argnums=(0, 1))(policy.episode, controller, params)
    obs, rewards, returns = played
    script = f"""(() => {{
        const world = new robots.World(robots.mujoco, ROBOTS[{name!r}]);
        const got = Array.from({{length: {EPISODES}}}, (_, i) => world.episode(i, {EXACT}));
        world.free();
        return got; }})()"""
    got = page.run(script)
    seen = np.array([each["seen"] for each in got])  # [N, k + 1, o]
    np.testing.assert_allclose(seen, obs, atol=1e-3)
    np.testing.assert_allclose([each["rewards"] for each in got], rewards, atol=1e-3)
    ours, theirs = np.array([each["total"] for each in got]), np.asarray(returns)
    assert iqm(ours) == pytest.approx(iqm(theirs), rel=0.05)


def episodes(episode: Episode, controller, params) -> tuple[Array, Array, Array]:
    """Observations [N, EXACT + 1, o], rewards [N, EXACT] of the first decisions, returns [N]."""

    def one(key):
        first = episode.reset(key)

        def decide(state, _):
            action, *_ = controller.act(params, (), state.obs, jax.random.key(0))
            after = episode.step(state, action)
            after = jax.tree.map(lambda a, b: jnp.where(state.done, a, b), state, after)
            return after, (after.obs, after.reward)

        last, (obs, rewards) = jax.lax.scan(decide, first, length=episode.steps)
        obs = jnp.concatenate([first.obs[None], obs[:EXACT]])
        return obs, rewards[:EXACT], last.clock.total

    return jax.vmap(one)(robots.keys()[:EPISODES])


def test_a_robot_runs_is_pulled_and_does_not_fall(page):
    with drawn(page, "halfcheetah"):
        page.wait("robots.stats.time > 3")
        before = page.run("robots.stats")
        assert before["x"] > 5
        assert before["falls"] == 0
        page.run("robots.pause(true)")  # so that it stays under the mouse
        x, y = page.run("(p => [p.x, p.y])(robots.picture.window(robots.picture.root))")
        page.mouse("mousePressed", x, y)
        page.mouse("mouseMoved", x + 30, y - 10)
        page.run("robots.pause(false)")
        page.wait(f"robots.stats.decisions > {before['decisions'] + 20}")
        page.mouse("mouseReleased", x + 30, y - 10)
    after = page.run("robots.stats")
    assert after["pushes"] >= 10
    assert after["x"] > before["x"]
    assert after["falls"] == 0
    assert page.errors == []
    assert {url.split(":")[0] for url in page.requests} <= {"file", "data", "about"}


def test_a_robot_that_falls_often_stays_in_the_picture(page):
    """The camera's height follows from the robot's, however it came there."""
    with drawn(page, "hopper"):
        seen = page.run("""(() => {
            robots.pause(true);
            const { picture, after: [x, z, ...joints] } = robots;
            for (let fall = 0; fall < 10; fall++)
                for (const height of [0, -0.3, -0.6, -0.9, -1.1, 0])
                    picture.pose([x, z + height, ...joints]);
            const { x: left, y: top } = picture.window(picture.root);
            const box = picture.canvas.getBoundingClientRect();
            return [(left - box.left) / box.width, (top - box.top) / box.height]; })()""")
    assert np.all((np.array(seen) > 0.2) & (np.array(seen) < 0.8))


def test_without_webassembly_the_picture_stays(site, browser):
    script = browser("Page.addScriptToEvaluateOnNewDocument", source="delete window.WebAssembly")
    browser.open((site / "index.html").as_uri() + "#without")
    browser("Page.reload")
    browser.wait("document.readyState === 'complete' && typeof WebAssembly === 'undefined'")
    assert browser.run("document.querySelectorAll('.robots > *').length") == 1
    assert browser.run("document.querySelector('.robots img') !== null")
    assert browser.errors == []
    browser("Page.removeScriptToEvaluateOnNewDocument", identifier=script["identifier"])


def test_a_function_becomes_statements():
    program = Program()
    (out,) = program.function(
        lambda x: (jnp.where(x[::-1] > 0, x, -2.0)[1:].sum(),), ("x",), (np.zeros(3, np.float32),)
    )
    assert program.lines[0] == "const t0 = x[2] > 0.0;"
    assert program.lines[-1] == f"const {out} = t4 + t5;"
    with pytest.raises(ValueError, match="sort: has no equivalent"):
        program.function(jnp.sort, ("x",), (np.zeros(3, np.float32),))


def test_statements_compute_what_jax_does():
    """Those of which Python has the same syntax."""

    def f(x):
        a, b = x[:3], x[3:]
        each = jnp.clip(a, -1.0, 1.0), jnp.minimum(a, b), jnp.maximum(a, b), a - b, a / b, a**3
        return *each, jnp.atan2(a, b), jax.lax.rsqrt(a * a), -b, jnp.array([a.sum(), b.prod(), 0])

    program, x = Program(), np.array([-1.5, 0.25, 2.0, 0.5, -0.75, 1.5], np.float32)
    outputs = jax.tree.leaves(program.function(f, ("x",), (x,)))
    named = {**vars(math), "max": max, "min": min}
    known = {"x": x.tolist(), "Math": SimpleNamespace(**named)}
    for line in program.lines:
        name, expression = line.removeprefix("const ").removesuffix(";").split(" = ")
        known[name] = eval(expression, known)
    got = [[eval(entry, known) for entry in output] for output in outputs]
    np.testing.assert_allclose(got, jax.jit(f)(x), rtol=1e-6)


def test_a_step_of_mujoco_names_the_fields_that_it_returns():
    program = Program()
    program.function(*_stepped(("subtree_com", "cfrc_ext")))
    assert program.lines[-1].endswith('5, ["sensordata", "subtree_com", "cfrc_ext"]);')
    with pytest.raises(ValueError, match=r"humanoid.xml: has sensors, which the page does not"):
        program.function(*_stepped(()))  # those of accelerations would be of the last step


def _stepped(reads: tuple[str, ...]):
    """Arguments of `Program.function` for steps of the humanoid."""
    physics = Physics("humanoid.xml", "native", reads=reads)
    state = physics.reset(jnp.asarray(physics.model.qpos0, jnp.float32), jnp.zeros(23))
    return lambda s, u: physics.step(s, u, 5), ("s", "u"), (state, state.ctrl)
