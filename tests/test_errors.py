"""Wrong usage of `train` is one line and exit code 2, and nothing is written."""

from importlib import import_module

import jax
import pytest
from omegaconf import OmegaConf
from tiny import call, call_train, contents, only_line

from hybrid_rl.cli import command
from hybrid_rl.errors import UsageError
from hybrid_rl.settings import build as config
from hybrid_rl.settings import words as overrides
from hybrid_rl.settings.values import COUNTS

pytestmark = pytest.mark.turns(3)

COUNT = "must be a whole number, 1 or more"


USAGE = [  # overrides of train, words of the line
    ("task=cartpool", "task=cartpool: unknown; choose one of ant, cart_double_pendulum"),
    ("algo=ppo", " in `python -m hybrid_rl.list`; nearest: mppi; your own algo/ppo.yaml needs"),
    ("algo=dqn", "algo=dqn: unknown; choose one of the 6"),
    ("task=null", "task=null: choose one of ant, cart_double_pendulum"),
    ("constraint=3", "constraint=3: choose one of height, limit, pitch"),
    ("reward=3", "reward=3: choose one of aim, height, level"),
    ("reward_model=true", "reward_model=true: choose one of known, network, "),
    ("controller@planner=3", "controller@planner=3: choose one of adjoint, "),
    ("experiment=null", "experiment=null: choose one of the 4"),
    ("env=null", "env=null: must be a group of keys"),
    (
        "task=pendulum,cartpole",
        "task=pendulum,cartpole: several values are a sweep, which needs -m",
    ),
    (
        "task=pendulum algo=sac experiment=thesis/fig_3_2_hopper",
        "env.reward: Pendulum has no fields",
    ),
    (
        "task=pendulum algo=localisation",
        "which localisation (free_body.acceleration) reads; choose one of contact_plane, sawyer_p",
    ),
    ("task=pendulum algo=mapping", "has no env.acceleration, which mapping (free_body.accelerat"),
    (
        "task=pendulum algo=mppi policy=tanh_gaussian proposal=policy",
        "policy=TanhGaussian: PolicyProposal acts by it, and no learner of this method trains it",
    ),
    (
        "task=pendulum algo=mppi model=gaussian",
        "model=Gaussian: SamplingController acts by it, and no learner of this method trains it; ",
    ),
    ("--config-name other", "--config-name: a run has one configuration; choose by experiment="),
    ("eval_modes=[full,full]", "eval_modes=[full,full]: has one of them twice"),
    ("seed=${seeds}", "to seeds, which neither this task nor this method sets; give seed=VALUE"),
    ("run_dir=läufe", "run_dir=läufe: ä stands outside quotes; write key=value, text as 'key="),
    ("episode.randomise=[0.7,1.3]", "hybrid_rl: episode.randomise: must be a group of keys; "),
    ("task=gymnasium env.id=Pendulum-v1 reward=speed", "task=Pendulum-v1: reward needs an envi"),
    ("episode=3", "episode=3: must be a group of keys"),
    (
        "objective=foo",
        "objective=foo: unknown; choose one of disagreement, fisher, fourier_ergodic, ",
    ),
    ("experiment=foo", "experiment=foo: unknown; choose one of the 4"),
    ("experiment=thesis/fig_33", "`python -m hybrid_rl.list`; nearest: thesis/fig_3_3; "),
    ("task=gymnasium algo=mppi", "Pendulum-v1: mppi plans on the true dynamics, and this task st"),
    ("task=Hopper-v5", "walker2d; did you mean task=gymnasium env.id=Hopper-v5?"),
    ("task=gymnasium env.id=lab/A-v0", "Have you installed the proper package for lab?"),
    ("task=mine:Env", "walker2d; did you mean task=gymnasium env.make=mine:Env?"),
    (
        "task=gymnasium env.id=Hopper-v5 env.make=mine:Env",
        "env.id=Hopper-v5: env.make=mine:Env is another environment; give one of them",
    ),
    ("task=pendulm", "walker2d; did you mean pendulum?"),
    ("hydra/launcher=joblib", "hydra/launcher=joblib: unknown; choose one of basic, submitit_"),
    ("hydra/launcher=submitit_slurm", "submitit_slurm: sends the jobs of a sweep; add -m"),
    ("algo=kle3 settings=light", "settings=light: is not for this method, which has no proposal"),
    ("algo=nn_mppi reward_model=quadratic", "QuadraticReward has world, state_weights, action_we"),
    ("sed=3", "sed: hybrid_stochastic has no such key; did you mean seed?"),
    (
        "experment=thesis/fig_3_3",
        "experment: hybrid_stochastic has no such key; did you mean experiment?",
    ),
    ("total_step=3", "total_step: hybrid_stochastic has no such key; did you mean total_steps?"),
    ("xyz=3", "xyz: hybrid_stochastic has no such key; `--cfg job` shows every key"),
    (
        "task=pendulum env.id=Hopper-v5",
        "env.id: hybrid_stochastic has no such key; env has no keys",
    ),
    (
        "policy.target=1",
        "policy.target: hybrid_stochastic has no such key; policy has hidden, acti",
    ),
    ("planner.horizn=3", "has no such key; did you mean planner.horizon?"),
    ("planner.policy.hidden=[3]", "planner.policy={'hidden': [3]}: must be a part, or null"),
    (
        "temperature=3",
        "temperature: hybrid_stochastic has no such key; did you mean planner.temper",
    ),
    (
        "algo=sac learning_rate=1",
        "sac has no such key; did you mean policy_learner.policy_learning",
    ),
    (
        "policy_learner.rl=1",
        "hybrid_stochastic has no such key; policy_learner has policy, critic, ",
    ),
    ("policy_learner.lr=1", "has no such key; did you mean policy_learner.policy_learning_rate?"),
    (
        "gamma=0.9",
        "gamma: hybrid_stochastic has no such key; did you mean policy_learner.discount?",
    ),
    ("algo=sac policy_learner.gamma=1", "did you mean policy_learner.discount?"),
    ("total_timesteps=9", "hybrid_stochastic has no such key; did you mean total_steps?"),
    ("algo=SAC", "in `python -m hybrid_rl.list`; nearest: sac"),
    ("algo=nn_mppi planner=gradient", "policy=TanhGaussian: GradientController acts by it, and no"),
    ("env=pendulum", "env=pendulum: must be a group of keys; did you mean task=pendulum?"),
    ("planner=mine", "planner=mine: unknown; choose one of adjoint, gradient, refits, shooting"),
    ("controllers.full=${gradient}", "controllers.full: refers to gradient, which neither this "),
    ("controllers.full=${controllers.full}", "controllers.full: refers to itself"),
    ("total_steps 100", "total_steps: has no value; write total_steps=100"),
    ("task = pendulum", "task: has no value; write task=pendulum"),
    ("--task pendulum", "--task: unknown option; write task=pendulum"),
    ("--total-steps 10", "--total-steps: unknown option; write total_steps=10"),
    ("-m algo=sac --cfg job", "-m, --cfg: give one of them"),
    ("resume=", "resume=: no run folder there (no config.yaml in it)"),
    ("algo=sac replay.capacity=9", "replay.capacity=9: holds less than one batch, policy_learner."),
    ("algo=sac -m seed=-1,0", "seed=-1: must be a whole number, 0 or more (job 0: seed=-1)"),
    ("eval_modes=[full, policy]", "policy]: has no key; put a list in quotes"),
    ("algo=sac planner.horizon=7", "planner.horizon: sac has no such key"),
    (
        "algo=nn_mppi proposal=mixture",
        "proposal: nn_mppi has no such key; did you mean model_proposal?",
    ),
    (
        "algo=nn_mppi objective=fisher",
        "objective: nn_mppi has no such key; did you mean model_objective?",
    ),
    (
        "objective=weighted_sum",
        "objective.discount: WeightedSum has terms, weights, decays; leave it",
    ),
    (
        "algo=nn_mppi planner.execute=mean",
        "nn_mppi has no such key; did you mean model_planner.execute?",
    ),
    (
        "algo=deterministic_mpc planner.horizon=7",
        "deterministic_mpc has no such key; did you mean adjoint_planner",
    ),
    ("controller@mine=goal", "the method has no such part; +controller@mine=NAME adds it"),
    ("domain.low=[0]", "domain.low: hybrid_stochastic has no such key"),
    ("demonstrations=file algo=sac", "demonstrations: sac has no such key"),
    ("task=cartpole env.reward=foo", "env.reward=foo: choose one of cos, dm_control"),
    (
        "task=halfcheetah algo=kle3",
        "task=halfcheetah: kle3 needs an analytic environment; choose",
    ),
    ("policy_learner.tau=nan", "policy_learner.tau=nan: must be finite"),
    ("policy_learner.policy_learning_rate=inf", "policy_learning_rate=inf: must be finite"),
    ("seed=nan", "seed=nan: must be"),
    ("algo=nn_mppi model_planner.temperature=0", "model_planner.temperature=0: must be above 0"),
    ("+sed=3", "sed: hybrid_stochastic has no such key"),
    ("++planner.horizn=3", "planner.horizn: hybrid_stochastic has no such key"),
    ("total_steps", "total_steps: has no value; write total_steps=VALUE"),
    ("physics=bullet", "physics=bullet: choose one of auto, native, mjx, warp"),
    ("task=cartpole physics=warp", "physics=warp: must have an NVIDIA GPU"),
    *((f"{key}=0", f"{key}=0: {COUNT}") for key in ("total_steps", "planner.samples")),
    ("policy_learner.batch_size=2.5", "policy_learner.batch_size=2.5: must be a whole number"),
    ("num_envs=2.5", f"num_envs=2.5: {COUNT}"),
    ("num_envs=many", f"num_envs=many: {COUNT}"),
    ("seed=-1", "seed=-1: must be a whole number, 0 or more"),
    ("seed=4294967296", "seed=4294967296: must be at most 4294967295 with num_seeds=1"),
    ("seed=4294967290 num_seeds=8", "seed=4294967290: must be at most 4294967288 with num_seeds=8"),
    ("planner.temperature=0", "planner.temperature=0: must be above 0"),
    ("planner.temperature=-0.1", "planner.temperature=-0.1: must be above 0"),
    ("planner.temperature=hot", "planner.temperature=hot: must be a number"),
    ("policy.hidden=16", "policy.hidden=16: must be a list"),
    ("policy.hidden=(9,9)", "policy.hidden=(9,9): extraneous input '('; write key=value, text as"),
    ("episode.action_noise=a", "episode.action_noise=a: must be 0 or more"),
    ("policy.hidden=[0]", "policy.hidden=[0]: must be a whole number, 1 or more"),
    ("policy_learner.updates=1.5", "policy_learner.updates=1.5: with num_envs=1 this gives 1.5"),
    ("eval_modes=[full,both]", "eval_modes=[full,both]: must be a list of full, policy"),
    ("eval_modes=full", "eval_modes=full: must be a list of full, policy, planner"),
    ("checkpoint_replay=0", "checkpoint_replay=0: must be true or false"),
    ("precision=low", "precision=low: choose one of auto, mixed, bf16, tf32, float32"),
    ("replay.capacity=1000000000 total_steps=2147483647", "learners would take"),
    ("algo=bc", "demonstrations=demonstrations/pendulum.npz: no such file; `python -m hybrid_rl"),
    ("algo=bc demonstrations=null", "demonstrations.file=null: must be a word"),
    ("algo=bc num_demonstrations=0", "num_demonstrations=0: must be 1 or more"),
    ("pretrain=3", "pretrain=3: the memory has no demonstrations to learn from"),
    ("pretrain=-1", "pretrain=-1: must be a whole number, 0 or more"),
    (
        "task=halfcheetah algo=koopman_active",
        "task=halfcheetah: koopman_active needs an environment with an equilibrium; choose",
    ),
    (
        "task=pendulum algo=koopman_track",
        "koopman_track needs an environment with a reference; choose one of s",
    ),
    (
        "task=pendulum algo=koopman_active features=quadcopter",
        "features.coordinates=[9, 10, 11, 15, 16, 17, 12, 13, 14]: the observation of this task",
    ),
    (
        "algo=koopman_active features.terms=[[0,9]]",
        "features.terms=[0, 9]: has an index above 2, the last coordinate",
    ),
    ("algo=koopman_active policy_learner.horizon=0", f"policy_learner.horizon=0: {COUNT}"),
    ("algo=koopman_active model_learner.forgetting=0", "learner.forgetting=0: must lie in (0, 1]"),
    (
        "algo=koopman_known demonstrations=demonstrations/quadcopter_se3.npz",
        "is of task quadcopter_se3; this run has task pendulum",
    ),
    (
        "task=quadcopter_se3 algo=koopman_known num_demonstrations=1",
        "demonstrations: 20 decisions are too few for 22 regressors",
    ),
    ("algo=fisher model=exact", "model_learner.model=Exact: has no weights to learn; choose"),
    ("algo=nn_mppi reward_model=known reward_model.ends=null", "give model_learner.reward=null"),
    (
        "task=halfcheetah algo=fisher",
        "task=halfcheetah: fisher needs an environment with a known reward; choose one of cart_",
    ),
    *(
        (f"task=contact_plane algo=ergodic_localisation {override}", words)
        for override, words in (
            ("map=learned map.file=nowhere.npz", "map.file=nowhere.npz: no such file"),
            (
                "episode.steps=60 belief.capacity=50",
                "belief.capacity=50: an episode has 60 measurements, and poses need all of them",
            ),
            (
                "env.objects=[[0.5,0.5,0,0.45,0.45,0.01]]",
                "env.objects=[[0.5,0.5,0,0.45,0.45,0.01]]: leave no room to start; 20% of the box",
            ),
            ("env.objects=[[1.5,0.5,0,0.1,0.1,0.1]]", "its middle lies outside of the box"),
        )
    ),
    ("algo=fisher information.floor=0", "information.floor=0: must be above 0"),
    ("algo=disagreement model=gaussian", "information.model=Gaussian: needs an ensemble"),
    ("resume=nowhere", "resume=nowhere: no run folder there"),
    ("run_dir=", "run_dir=: is empty; give a folder, or leave it out"),
    ("total_steps=2147483648", "total_steps=2147483648: must be at most 2147483647: decisions"),
    ("total_steps=99999999999999999999", "must be at most 2147483647: decisions are counted in"),
    ("run_dir=/dev/null/run", "run_dir=/dev/null/run: cannot be written to (Not a directory)"),
]


@pytest.mark.parametrize(("given", "words"), USAGE, ids=[given for given, _ in USAGE])
def test_train_refuses(tmp_path, monkeypatch, capfd, given, words):
    monkeypatch.chdir(tmp_path)
    assert call_train("task=pendulum", "algo=hybrid_stochastic", *given.split()) == 2
    assert words in only_line(capfd)
    assert contents(tmp_path) == {}


@pytest.mark.parametrize("value", [0, 2.5, "many"])
def test_counts_are_whole_numbers(value):
    """Every count of a run, and of the replay memory and an episode."""
    composed = config.load(["task=pendulum", "algo=sac"])
    for key in (*COUNTS, "replay.capacity", "episode.steps", "episode.action_repeat"):
        changed = composed.copy()
        OmegaConf.update(changed, key, value)
        with pytest.raises(UsageError, match=rf"{key.rpartition('.')[2]}={value}: must be a whole"):
            config.build(changed)


def test_memory_that_runs_out_is_one_line(capfd):
    """Where XLA itself finds out."""
    out = RuntimeError("RESOURCE_EXHAUSTED: Out of memory allocating 12 bytes.\nand more")

    def fail():
        raise out

    assert call(lambda: command.run(fail)) == 1
    printed = capfd.readouterr().err
    assert printed.count("\n") == 1
    assert "allocating 12 bytes.; fewer num_seeds or num_envs" in printed


def test_an_error_in_the_code_of_a_user_is_one_line_that_names_it(tmp_path, monkeypatch, capfd):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.py").write_text("def broken():\n    return {}['goal']\n")
    monkeypatch.syspath_prepend(tmp_path)
    assert call(lambda: command.run(import_module("mine").broken)) == 1
    assert only_line(capfd) == "hybrid_rl: mine.py:2: KeyError: 'goal'\n"


def test_a_fault_of_ours_is_a_traceback_without_frames_of_hydra(tmp_path, monkeypatch, capfd):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(config, "resolve", lambda *_: None)
    assert call_train("task=pendulum", "algo=sac") == 1
    printed = capfd.readouterr().err
    assert printed.startswith("Traceback (most recent call last):")
    assert "run/launch.py" in printed
    assert "/hydra/" not in printed


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (["task=pendulm"], "task=pendulm: unknown; choose one of ant, .*; did you mean pendulum?"),
        ("task=ant seed=1", r"\"task=ant seed=1\": give a list, \['task=ant', 'seed=1'\]"),
        (["sed=3"], "sed: hybrid_stochastic has no such key; did you mean seed?"),
    ],
)
def test_python_has_the_line_of_the_command(given, words):
    with pytest.raises(UsageError, match=f"^{words}"):
        config.load(given)


def test_devices_that_are_not_there_are_one_line(monkeypatch, capfd):
    """JAX says "assert _default_backend is not None" for cuda, and another traceback for tpu."""

    def fail():
        raise AssertionError

    monkeypatch.setenv("JAX_PLATFORMS", "cuda")
    assert call(lambda: command.run(fail)) == 1  # of something else: JAX has the devices
    assert only_line(capfd).endswith(": AssertionError\n")
    monkeypatch.setattr(jax, "devices", fail)
    assert call(lambda: command.run(fail)) == 2
    assert only_line(capfd) == (
        "hybrid_rl: JAX_PLATFORMS=cuda: JAX finds no such device here; unset it, or choose cpu\n"
    )


@pytest.mark.parametrize("value", ["a", "it's", "[8,8]", "a\\", 'a\\"b', "007", "null", "a b", ""])
def test_a_value_in_quotes_is_read_as_it_was(value):
    (read,) = overrides.parse([f"run_dir={overrides.quoted(value)}"])
    assert read.value() == value
