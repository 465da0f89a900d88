"""The file of demonstrations: saved decisions are loaded, and bad files are refused."""

from dataclasses import replace
from pathlib import Path

import jax
import numpy as np
import pytest
import small

from hybrid_rl.data.demonstrations import COLUMNS, Demonstrations, save
from hybrid_rl.data.replay import Replay, unpack
from hybrid_rl.envs.analytic.pendulum import Pendulum
from hybrid_rl.settings import build as config
from hybrid_rl.types import Transition

LENGTHS = (4, 5, 3)  # of the episodes
EPISODE = np.repeat(np.arange(3), LENGTHS)
N = len(EPISODE)
LAST = np.cumsum(LENGTHS) - 1


def decisions() -> Transition:
    """Three episodes of distinct numbers: terminated, truncated, and with neither flag."""
    rng = np.random.default_rng(0)
    flags = np.zeros((2, N))
    flags[0, LAST[0]] = flags[1, LAST[1]] = 1
    obs, after = rng.normal(size=(2, N, 3))
    return Transition(obs, rng.uniform(-1, 1, (N, 1)), rng.normal(size=N), *flags, after)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """A valid file."""
    save(tmp_path / "deep" / "file.npz", "pendulum", 0.05, decisions(), EPISODE)
    return tmp_path / "deep" / "file.npz"


def loaded(file: Path, /, **fields: object) -> Transition:
    """The decisions that a task loads from it."""
    given = {"file": str(file), "task": "pendulum", "world": Pendulum()}
    return Demonstrations(**given | fields).load()


def test_saved_decisions_are_loaded(file: Path) -> None:
    """In float32, and the episode that ended with neither flag is truncated; or the first few."""
    put = decisions()
    put.truncated[LAST[2]] = 1
    for episodes in (None, 1, 2, 3):
        got = loaded(file, episodes=episodes)
        count = sum(LENGTHS[:episodes])
        for a, b in zip(got, put, strict=True):
            np.testing.assert_array_equal(a, b[:count].astype(np.float32))


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({"task": "cartpole"}, "is of task pendulum; this run has task cartpole"),
        ({"episodes": 4}, "num_demonstrations=4: .* has 3"),
        ({"episode": {"action_repeat": 4}}, "is of dt 0.05; this run has dt 0.2"),
        ({"file": "nowhere.npz"}, "nowhere.npz: no such file"),
    ],
)
def test_a_file_for_another_use_is_refused(file: Path, fields: dict, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        loaded(file, **fields)


def put_in(array: np.ndarray, at: int, value: float) -> np.ndarray:
    array = np.array(array, float)
    array[at] = value
    return array


EMPTY = {**dict.fromkeys((*COLUMNS, "episode"), ()), "obs": (3,), "action": (1,), "next_obs": (3,)}


@pytest.mark.parametrize(
    ("arrays", "words"),
    [
        ({"obs": np.zeros((N, 4))}, r"obs is \(12, 4\); it must be \(12, 3\)"),
        ({"episode": EPISODE[:-1]}, r"episode is \(11,\); it must be \(12,\)"),
        ({"episode": EPISODE[::-1]}, "episodes must follow one another"),
        ({"obs": put_in(decisions().obs, 7, np.nan)}, r"obs is not finite at \[7, 0\]"),
        ({"obs": put_in(decisions().obs, 2, 1e300)}, r"obs is not finite at \[2, 0\]"),
        ({"action": put_in(decisions().action, 5, 1.5)}, r"action must lie in \[-1, 1\]"),
        ({"truncated": put_in(np.zeros(N), 1, 1)}, "continues after its end, in row 1"),
        ({name: np.zeros((0, *shape)) for name, shape in EMPTY.items()}, "there is no decision"),
    ],
    ids=lambda given: "" if isinstance(given, dict) else given[:20],
)
def test_an_inconsistent_file_is_refused(tmp_path: Path, arrays: dict, words: str) -> None:
    whole = {**decisions()._asdict(), "episode": EPISODE, "task": "pendulum", "sizes": (3, 1)}
    np.savez(tmp_path / "bad.npz", **whole | {"dt": 0.05} | arrays)
    with pytest.raises(ValueError, match=words):
        loaded(tmp_path / "bad.npz")


@pytest.mark.parametrize("worlds", [1, 3])  # of three, one stretch ends with a terminal decision
def test_a_memory_begins_with_the_demonstrations(file: Path, worlds: int) -> None:
    """Every sample is a demonstrated decision with its successor; cut stretches are truncated."""
    shown = Demonstrations(str(file), "pendulum", Pendulum())
    replay, spec = Replay(100, shown), Pendulum().spec
    memory = replay.init(spec, worlds)
    assert int(memory.count) == replay.num_demonstrated(worlds) == N // worlds
    batch = replay.sample(memory, spec, 400, jax.random.key(0))
    put = loaded(file)
    row = np.abs(np.asarray(batch.obs)[:, None] - put.obs[None]).sum(-1).argmin(1)
    last = np.arange(1, worlds + 1) * (N // worlds) - 1
    assert set(row) == set(range(N)) - set(last)  # their successors are not known yet
    for name in ("obs", "action", "reward", "terminated", "truncated", "next_obs"):
        np.testing.assert_array_equal(getattr(batch, name), getattr(put, name)[row])
    np.testing.assert_array_equal(batch.next_action, put.action[row + 1])
    truncated = np.asarray(memory.rows)[N // worlds - 1, :, 3 + 1 + 2]
    np.testing.assert_array_equal(truncated, 1 - put.terminated[last])
    assert replay.within(5, worlds).capacity == N + 5 * worlds
    assert replace(replay, capacity=13).within(5, worlds).capacity == 13
    assert replay.within(0, 5).capacity == N  # none of them is dropped


def test_demonstrations_earn_what_the_run_pays(tmp_path: Path) -> None:
    """Less the price of its constraint; in a method that is not for imitation, too."""
    given = ["task=pendulum", "replay.demonstrations=${recorded}"]
    given += ["constraint=torque", "constraint.most=0.5", "constraint.price=3"]
    agent = config.build(small.with_demonstrations(small.load("sac", *given), tmp_path)).agent
    memory = jax.jit(agent.init)(jax.random.key(0)).memory
    kept = unpack(memory.rows[: int(memory.count), 0], agent.spec)
    earned = jax.vmap(Pendulum().reward_of)(kept.obs, kept.action, kept.next_obs)
    broken = np.abs(kept.action[:, 0]) > 0.5
    assert 0 < broken.sum() < len(broken)
    np.testing.assert_allclose(kept.reward, earned - 3 * broken, rtol=1e-5)


def test_a_memory_smaller_than_the_demonstrations_is_refused(file: Path) -> None:
    """No demonstrations are dropped silently."""
    shown = Demonstrations(str(file), "pendulum", Pendulum())
    with pytest.raises(ValueError, match=r"capacity=11: the demonstrations alone have 12"):
        Replay(11, shown)
    assert Replay(8, replace(shown, episodes=1)).num_demonstrated(1) == 4
