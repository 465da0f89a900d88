"""The replay memory against the transitions that were added."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl.data.replay import Memory, Replay, unpack
from hybrid_rl.types import Spec, Transition

SPEC = Spec(obs=2, act=1, dt=0.1)


def transition(time: int, worlds: int) -> Transition:
    """Decision `time` of every environment, all numbers distinct."""
    base = 100.0 * time + jnp.arange(worlds, dtype=jnp.float32)
    obs = jnp.stack([base, base + 0.25], -1)
    flags = jnp.full(worlds, time % 3 == 0)
    return Transition(obs, base[:, None] + 0.5, -base, flags, ~flags, obs + 100.0)


def filled(capacity: int, worlds: int, times: int) -> tuple[Replay, Memory]:
    """A memory after `times` decisions."""
    replay = Replay(capacity)
    memory = replay.init(SPEC, worlds)
    for time in range(times):
        memory = replay.add(memory, transition(time, worlds))
    return replay, memory


@pytest.mark.parametrize(("capacity", "worlds", "times"), [(50, 1, 20), (12, 1, 40), (12, 3, 11)])
def test_sampled_transitions_have_their_successors(capacity: int, worlds: int, times: int) -> None:
    """Every sample was added and not overwritten; its next action is that of its successor."""
    replay, memory = filled(capacity, worlds, times)
    batch = replay.sample(memory, SPEC, 500, jax.random.key(0))
    time, world = np.divmod(np.asarray(batch.obs[:, 0]), 100)
    held = range(max(0, times - capacity // worlds), times - 1)
    assert set(time) == set(map(float, held))  # all but the newest, whose successor is unknown
    assert set(world) == set(map(float, range(worlds)))
    np.testing.assert_array_equal(batch.action[:, 0], batch.obs[:, 0] + 0.5)
    np.testing.assert_array_equal(batch.reward, -batch.obs[:, 0])
    np.testing.assert_array_equal(batch.next_obs, batch.obs + 100)
    np.testing.assert_array_equal(batch.next_action, batch.action + 100)
    np.testing.assert_array_equal(batch.terminated, time % 3 == 0)
    np.testing.assert_array_equal(batch.truncated, time % 3 != 0)


@pytest.mark.parametrize(("times", "since"), [(20, 8), (11, 0), (40, 8)])
def test_half_of_a_batch_is_of_this_run(times: int, since: int) -> None:
    """Eight decisions of three worlds were given; of later ones there must be a batch."""
    replay, memory = filled(60, 3, times)
    time = np.asarray(replay.sample(memory, SPEC, 30, jax.random.key(0), given=8).obs)[:, 0] // 100
    held = max(0, times - 20)
    assert time[::2].min() >= max(since, held)
    assert held <= time[1::2].min() < max(since, held + 4)
    assert time.max() < times - 1


def test_the_size_in_bytes_is_known_before_allocation() -> None:
    """`nbytes` is what `init` allocates."""
    replay = Replay(1000)
    assert replay.init(SPEC, 4).rows.nbytes == replay.nbytes(SPEC)


def test_another_goal_pays_for_what_is_kept_by_actions_as_the_world_clips_them() -> None:
    class Goal:
        """r = 1 + u + x' - x, of the first entries."""

        def reward_of(self, x: jax.Array, u: jax.Array, after: jax.Array) -> jax.Array:
            """The reward []."""
            return 1 + u[0] + after[0] - x[0]

    replay, memory = filled(8, 2, 3)  # one row of four is empty; actions 0.5, 1.5, 100.5, ...
    rows = replay.relabelled(memory, SPEC, Goal()).rows
    np.testing.assert_array_equal(rows[:, :, 3], [[101.5, 102], [102, 102], [102, 102], [0, 0]])
    np.testing.assert_array_equal(jnp.delete(rows, 3, -1), jnp.delete(memory.rows, 3, -1))


def test_a_memory_that_goes_on_begins_another_episode() -> None:
    """Of three worlds' newest decisions one is terminal, the others are cut."""
    no, ends = jnp.zeros(3, bool), jnp.array([False, True, False])
    replay, memory = Replay(12), Replay(12).init(SPEC, 3)  # four rows
    for time in range(6):
        flags = {"terminated": ends if time == 5 else no, "truncated": no}
        memory = replay.add(memory, transition(time, 3)._replace(**flags))
    memory = replay.resized(replay.interrupted(memory, SPEC))
    kept, none = unpack(np.asarray(memory.rows), SPEC), [[0, 0, 0]] * 3
    np.testing.assert_array_equal(kept.reward[:, 0], [-200, -300, -400, -500])
    np.testing.assert_array_equal(kept.terminated, [*none, [0, 1, 0]])
    np.testing.assert_array_equal(kept.truncated, [*none, [1, 0, 1]])
    assert not replay.interrupted(replay.init(SPEC, 3), SPEC).rows.any()
