"""The doctor of runs: it names what was done to a world, and finds nothing in a sound one."""

from dataclasses import replace
from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest
from tiny import call_command, finished, summary_of

from hybrid_rl.analysis.results import RunFolder
from hybrid_rl.tools.doctor import __main__ as doctor
from hybrid_rl.tools.doctor import evidence as evidence_of
from hybrid_rl.tools.doctor import learned, linear, observed, regular, task
from hybrid_rl.tools.doctor.evidence import Evidence, of_each, read
from hybrid_rl.tools.doctor.tried import Tried
from hybrid_rl.types import Spec, Transition

DT, STEPS, EPISODES = 0.1, 50, 30
OBSERVED = ("constant", "clipped", "noise", "action", "rare", "hidden")


def oscillator(delay=0, lag=1.0, dt=DT, steps=STEPS, seed=0, gain=1.0):
    """(x, v) [E, T+1, 2] and random actions [E, T, 1] of x'' = -x - 0.4 x' + 3 gain u."""
    gain = np.broadcast_to(gain, (EPISODES * STEPS // steps, steps))
    rng = np.random.default_rng(seed)
    x = np.empty((EPISODES * STEPS // steps, steps + 1, 2))
    action = rng.uniform(-1, 1, (*x[:, :-1, :1].shape[:2], 1))
    x[:, 0], motor = rng.normal(size=(len(x), 2)), np.zeros(len(x))
    for t in range(steps):
        now = x[:, t]
        for i in range(20):
            sent = int(np.floor(t + i / 20 - delay + 1e-9))
            asked = gain[:, t] * action[:, sent, 0] if sent >= 0 else np.zeros(len(x))
            motor = motor + (asked - motor) / lag if i == 0 or delay % 1 else motor
            v = now[:, 1] + dt / 20 * (3 * motor - now[:, 0] - 0.4 * now[:, 1])
            now = np.stack((now[:, 0] + dt / 20 * v, v), axis=1)
        x[:, t + 1] = now
    return x, action


def evidence(seen, action, reward=None, terminated=False, rest=None):
    """What the memory of a learner shows that made these episodes [E, T+1, o] in turn.

    rest: the evidence of episodes without action; None: the world cannot be run here.
    """
    ends = np.zeros(action.shape[:2])
    ends[:, -1] = 1
    reward = -(seen[:, 1:] ** 2).sum(-1) if reward is None else reward
    flags = (ends, 0 * ends) if terminated else (0 * ends, ends)
    each = (seen[:, :-1], action, reward, *flags, seen[:, 1:])
    made = Transition(*(a.reshape(1, -1, *a.shape[2:]) for a in each))
    agent = SimpleNamespace(spec=Spec(seen.shape[-1], 1, DT), random_steps=10**6, num_envs=1)
    agent.episode = SimpleNamespace(history=1)
    folder, run = SimpleNamespace(rows=[], summary={}), SimpleNamespace(agent=agent)
    given = Evidence(folder, run, made)
    vars(given)["at_rest"] = rest
    return given


def found(given):
    """Names of the checks of what is observed that have a line."""
    return {name for name in OBSERVED if getattr(observed, name)(given)}


def test_a_sound_world_gets_no_line():
    x, action = oscillator()
    goal = np.broadcast_to(np.arange(len(x))[:, None], x.shape[:2])  # one in each episode
    given = evidence(np.dstack((x, goal)), action, reward=evidence(x, action).made.reward)
    assert found(given) == set()
    rest = task.ends, task._fixed, task.reward, regular.alternates, regular.gains
    assert [check(given) for check in rest] == [None] * 5


@pytest.mark.parametrize("delay", [1, 1.4, 2, 4])
@pytest.mark.parametrize("random", [10**6, 0])
def test_a_delay_is_measured(delay, random):
    """By whole decisions, if none is random."""
    given = evidence(*oscillator(delay=delay))
    given.run.agent.random_steps = random
    words = observed.action(given).split()
    assert words[:3] + words[4:6] == ["an", "action", "acts", "decisions", "late"]
    assert float(words[3]) == pytest.approx(delay if random else round(delay), rel=0.1)
    assert f"episode.lag={float(words[3]) * DT:.3g} " in observed.action(given)
    assert found(given) == {"action"}


def test_a_slow_motor_and_one_that_is_off_have_different_lines():
    assert "older actions act more" in observed.action(evidence(*oscillator(lag=20.0)))
    x, action = oscillator(delay=STEPS)
    assert "no action changed" in observed.action(evidence(x, action))
    clock = np.broadcast_to(np.arange(STEPS + 1.0), x.shape[:2])  # its change is always the same
    assert "no action changed" in observed.action(evidence(np.dstack((x, clock)), action))


def test_commands_that_are_lost_and_signs_that_an_episode_draws_differ():
    arrived = np.random.default_rng(7).random((EPISODES, STEPS)) < 0.5
    share, line = regular.gains(evidence(*oscillator(gain=arrived))).split(" of the actions ")
    assert float(share[:-1]) == pytest.approx(50, abs=3)
    assert line.startswith("had no effect")
    signs = np.where(np.arange(EPISODES) % 3, 1.0, -1.0)[:, None]
    given = evidence(*oscillator(gain=signs))
    assert f"the other way in 10 of {EPISODES}" in regular.gains(given)
    assert observed.action(given) is None  # though their effects nearly cancel out


def test_entries_that_are_swapped_every_other_decision_are_noticed():
    x, action = oscillator()
    x[:, 1::2] = x[:, 1::2, ::-1].copy()
    line = regular.alternates(evidence(x, action))
    assert "if every other decision has a rule of its own" in line


def test_a_velocity_that_is_one_decision_old_is_a_late_sensor_and_no_delay():
    x, action = oscillator()
    x[:, 1:, 1] = x[:, :-1, 1].copy()
    line = observed.action(evidence(x, action))
    assert line.startswith("obs 1 shows an action later than obs 0: that sensor is late")


def test_a_reward_that_is_one_decision_late_is_noticed():
    x, action = oscillator()
    paid = -(x[:, :-1] ** 2).sum(-1) - action[..., 0] ** 2
    late = np.concatenate((0 * paid[:, :1], paid[:, :-1]), axis=1)
    assert task.reward(evidence(x, action, reward=paid)) is None
    assert "the reward is paid one decision late" in task.reward(evidence(x, action, reward=late))


def test_limits_and_sensors_that_are_off_are_named_with_their_entries():
    x, action = oscillator()
    line = observed.clipped(evidence(np.clip(x, [-9, -0.5], [9, 0.5]), action))
    assert line.startswith("obs 1 stood at its limit, -0.5 or 0.5, in ")
    flag = np.sign(x[..., :1])
    assert observed.clipped(evidence(np.concatenate((x, flag), -1), action)) is None
    off = np.concatenate((x, np.full_like(flag, 3.0)), -1)
    assert observed.constant(evidence(off, action)).startswith("obs 2 never changed")


def test_noise_is_measured():
    x, action = oscillator()
    x = x + np.random.default_rng(2).normal(size=x.shape) * [0.0, 0.4]
    line = observed.noise(evidence(x, action))
    assert line.startswith("obs 1 moves and moves back: noise of about 0.")
    assert float(line.split("about ")[1].split()[0]) == pytest.approx(0.4, rel=0.25)


def test_what_moves_back_is_noise_only_if_it_does_so_at_rest():
    x, action = oscillator()
    noise = np.random.default_rng(2).normal(size=x.shape) * [0.0, 0.4]
    still, none = evidence(0 * x + [1.0, 0.0], 0 * action), evidence(x, action)
    noisy = evidence(0 * x + [1.0, 0.0] + noise, 0 * action)
    assert observed.noise(evidence(x + noise, action, rest=noisy)).startswith("obs 1 moves")
    for rest in (still, none):
        assert observed.noise(evidence(x + noise, action, rest=rest)) is None
    short = evidence(x[:1, :2], action[:1, :1])  # too few decisions to say anything
    assert observed.noise(evidence(x + noise, action, rest=short)).startswith("obs 1 moves")


def test_a_velocity_that_is_missing_is_missed():
    x, action = oscillator()
    few = evidence(x[:3, :, :1] ** 3, action[:3])
    assert observed.hidden(few) is None  # a plane does not fit, which proves nothing
    assert "not observed" in observed.hidden(evidence(x[..., :1], action))


def test_ends_and_lengths():
    x, action = oscillator()
    line = task.ends(evidence(x, action, terminated=True))
    number = f"{EPISODES - 1} of {EPISODES - 1}"
    assert line.startswith(f"{number} terminations came at decision {STEPS}")
    assert "within 2 decisions" in task.ends(evidence(*oscillator(steps=2), terminated=True))
    assert task._fixed(evidence(*oscillator(steps=5))).endswith("episode.steps=50")


@pytest.mark.parametrize(
    ("sign", "rows", "limits", "speaks"),
    [
        (-1, [], 0, True),
        (1, [], 0, False),
        (-1, [{"world/success": 1}], 0, False),
        (-1, [], 0.1, False),
    ],
)
def test_a_task_that_pays_for_an_early_end_has_a_line(sign, rows, limits, speaks):
    given = evidence(*oscillator())
    over = np.random.default_rng(0).uniform(size=given.made.reward.shape)
    flags = {"terminated": 1.0 * (over > 0.9), "truncated": 1.0 * (over < limits)}
    made = given.made._replace(reward=sign * (1 + over), **flags)
    line = task.ends(replace(given, made=made, folder=SimpleNamespace(rows=rows)))
    assert bool(line) == speaks
    assert not speaks or line.startswith("nearly every reward is negative, and ")


def test_a_reward_that_is_constant_or_hides_is_noticed():
    x, action = oscillator()
    given = partial(evidence, x, action)
    assert "nothing to learn" in task.reward(given(np.full(action.shape[:2], -1.0)))
    offset = 100 + 0.1 * np.random.default_rng(0).normal(size=action.shape[:2])
    assert "subtract" in task.reward(given(offset))


def test_rare_decisions_are_noticed_and_fast_velocities_beside_slow_positions_are_no_fault():
    x, action = oscillator()
    fast = np.random.default_rng(1).normal(size=(*x.shape[:2], 3))
    assert observed.rare(evidence(np.concatenate((x, fast), -1), action)) is None
    for rare in ((fast, action), oscillator(dt=1.5)):
        assert "decide more often" in observed.rare(evidence(*rare))


def test_a_policy_that_is_paid_after_the_limit_is_cut():
    """In 32 episodes of four limits, of 20 decisions each."""
    paid = np.random.default_rng(0).normal(size=(32, 80))
    agent = SimpleNamespace(episode=SimpleNamespace(steps=20))
    for later, last, line in (
        (0.0, 80, None),
        (-9.0, 80, None),
        (9.0, 80, "episode.steps=80"),
        (9.0, 79, None),  # all have ended by then, and repeat their last reward
    ):
        reward = paid + later * (np.arange(80) >= 40)
        lives = np.broadcast_to(np.arange(80) < last, paid.shape)
        tried = Tried(None, None, reward, lives, None)
        found = task._cut(SimpleNamespace(by_policy=tried, run=SimpleNamespace(agent=agent)))
        assert found is None if line is None else found.endswith(line)


def test_a_reward_that_is_lower_where_the_task_succeeds_is_noticed():
    """In 32 episodes of random actions, by 3 a decision."""
    rng = np.random.default_rng(0)
    paid, success = rng.normal(size=(32, 50)), rng.random((32, 50)) < 0.3
    folder = SimpleNamespace(rows=[{"world/success": 0.3}])
    lines = []
    for more in (0.0, 3.0, -3.0):
        tried = Tried(None, None, paid + more * success, np.ones_like(success), success)
        lines.append(task.sign(SimpleNamespace(by_chance=tried, folder=folder)))
    assert lines[:2] == [None, None]
    assert "is the sign of the reward wrong?" in lines[2]
    assert float(lines[2].split()[4]) == pytest.approx(3, abs=0.2)


def test_a_model_is_judged_beside_no_change_and_collisions_count_once():
    rng = np.random.default_rng(0)
    obs, change = rng.normal(size=(2, 500, 2))
    action = np.zeros((500, 1))
    rows = obs, action, obs + change * [1, 0]
    np.testing.assert_allclose(learned._unseen(lambda obs, action: obs, rows), [1, 0])
    assert learned._unseen(lambda *_: rows[2], rows).max() == 0
    struck = rows[2] + 1e3 * (np.arange(500) == 7)[:, None]
    assert learned._unseen(lambda *_: rows[2], (obs, action, struck))[0] > 0.5 / 500
    inside = learned._within(obs[:50], rows)
    assert 0 < len(inside[0]) < 500
    assert (abs(inside[0]) <= abs(obs[:50]).max(0)).all()


# A tiny run of a method with a model.
folder = finished("task=pendulum", "algo=nn_mppi", "total_steps=120", "random_steps=3")


main = partial(call_command, doctor.main)


def test_the_command_reads_a_run(folder, capsys):
    """Its model has hardly learned, and three random decisions are few."""
    assert main(f"run={folder}") == 0
    lines = dict(line.split("  ", 1) for line in capsys.readouterr().out.splitlines())
    assert "random_steps=3" in lines["random decisions"]
    assert set(lines) <= set(doctor.CHECKS)
    assert doctor.examine(folder).keys() == lines.keys()
    given = read(folder)
    for number in (0, 1000):  # none are a choice
        agent = replace(given.run.agent, random_steps=number)
        assert learned.random(replace(given, run=replace(given.run, agent=agent))) is None


def test_learners_that_diverged_come_first(folder):
    given, end = read(folder), {"seed": 4, "step": 70, "quantity": "world/reward"}
    rows = [*given.folder.rows, {"step": 70, "seed": 4, "wall_s": 1.0, "diverged": "world/reward"}]
    for shown in ({"rows": [], "summary": {"diverged": [end]}}, {"rows": rows, "summary": {}}):
        line = learned.diverged(replace(given, folder=SimpleNamespace(**shown)))
        assert line.startswith("world/reward is not finite from step 70 on, seed 4: the world")
    assert next(iter(doctor.CHECKS)) == "numbers"


def test_damaged_numbers_are_one_line(folder, monkeypatch, capsys):
    given = read(folder)
    made = given.made._replace(obs=np.full_like(given.made.obs, np.nan))
    monkeypatch.setattr(evidence_of, "decisions", lambda *_: made)
    damaged = read(folder)
    assert damaged.made is None
    assert learned.diverged(damaged).startswith("the replay memory of the newest checkpoint has")
    assert main(f"run={folder}") == 0
    assert capsys.readouterr().out.startswith("numbers  ")


# A tiny run of two learners without a model, seeds 4 and 5.
pair = finished("task=pendulum", "algo=sac", "total_steps=60", "num_seeds=2", "seed=4")


def test_a_value_beyond_all_rewards_is_noticed(pair):
    given = read(pair).learners[0]
    row = {"sac/q": 1.0, "sac/alpha": 0.01, "seed": 4}
    low, high = (SimpleNamespace(rows=[row | {"sac/q": q}]) for q in (-5.0, 70.0))
    assert learned.critic(replace(given, folder=low)) is None
    line = learned.critic(replace(given, folder=high))
    assert line.startswith("the critic's value 70 (sac/q) is above ")
    unfinished = SimpleNamespace(rows=[row | {"sac/alpha": None}], path=given.path)
    assert learned.critic(replace(given, folder=unfinished)) is None
    assert learned.scale(replace(given, folder=unfinished)) is None
    for factor, line in ((1e6, "divide the reward by 1e"), (1e-6, "multiply the reward by 1e")):
        rows = SimpleNamespace(rows=[row | {"step": 9_000}], path=given.path)
        made = given.made._replace(reward=given.made.reward * factor)
        assert line in learned.scale(replace(given, made=made, folder=rows))
    assert learned.scale(given) is None  # after 60 decisions values are no sums yet


def test_each_learner_is_examined_by_itself(pair):
    one, two = (given := read(pair)).learners
    np.testing.assert_array_equal(two.made.reward, given.made.reward[1:])
    assert one.by_policy.obs.shape == two.by_policy.obs.shape
    assert (one.by_policy.action != two.by_policy.action).any()
    assert {row["seed"] for row in two.rows} == {5}
    seen = (4, -5.0), (5, 70.0), (5, 80.0)
    values = [{"step": 9, "seed": seed, "sac/q": q} for seed, q in seen]
    for rows, seeds in (
        (values[:2], "seed 5: the"),
        ([*values[1:], values[2] | {"seed": 4}], "seeds 4, 5: the"),
    ):
        many = replace(given, folder=SimpleNamespace(rows=rows, path=given.path))
        assert of_each(learned.critic)(many).startswith(f"{seeds} critic's value")
    assert of_each(learned.critic)(given) is None


def test_a_policy_below_linear_ones_may_decide_too_often(pair, monkeypatch):
    """By chance one of fifty returns more than all others, and does so again."""
    given = read(pair).learners[0]

    def returns(run, controller, params, number, key):
        by_chance = isinstance(controller, linear.Linear)
        return np.full((len(params.policy[0]) if by_chance else 1, number), high * by_chance)

    monkeypatch.setattr(linear, "_returns", returns)
    for high in (0.0, 9.0):
        line = linear.better(given)
        assert ("episode.action_repeat=4" in line) if high else line is None


def test_a_run_without_memory_is_examined_by_its_rows(folder, tmp_path):
    for name in ("config.yaml", "metrics.jsonl", "summary.json"):
        (tmp_path / name).write_bytes((folder / name).read_bytes())
    assert set(doctor.examine(tmp_path)) == {"random decisions"}
    assert summary_of(tmp_path)["finished"]
    assert RunFolder(tmp_path).rows
