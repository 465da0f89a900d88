"""An expert's decisions, or a trained policy, as a file to learn from.

    python -m hybrid_rl.demonstrate task=panda_stack episodes=20
    python -m hybrid_rl.demonstrate task=quadcopter_se3 expert=babble env.twist=2
    python -m hybrid_rl.demonstrate run=DIR mode=policy out=demonstrations/ant.npz
    python -m hybrid_rl.demonstrate run=DIR policy=policies/mine.npz

The file is demonstrations/T.npz by default. The expert is the task's scripted one, or another of
conf/expert, such as babble (random actions); in the task with its defaults or with env.KEY=VALUE,
episode.KEY=VALUE, expert.KEY=VALUE. With run=DIR it is the trained controller (mode: full, policy
or planner; the first seed), without exploration. Episode i starts from key i of `seed`.

With policy=FILE it writes no episodes but the parameters of the run's policy (learner: its seed, or
else the first), which expert=trained, policy=trained and policy=started read, and `evaluate`,
`render` and `export` with policy=FILE. It holds command=TEXT and what `evaluate run=DIR
mode=policy` wrote.
"""

if __name__ == "__main__":
    from hybrid_rl.cli import interrupt

    interrupt.install()

from pathlib import Path
from typing import Any

from hybrid_rl.cli import command
from hybrid_rl.cli.arguments import CONFIG_DIR, MODE, Argument, flag, output, read, whole
from hybrid_rl.data.demonstrations import save
from hybrid_rl.errors import UsageError
from hybrid_rl.run.recording import record, save_policy, scripted_expert
from hybrid_rl.run.saved import load

ARGUMENTS = (
    Argument("task", "", "a task with a scripted expert"),
    Argument("expert", "", "with task=T: another of conf/expert, such as babble"),
    CONFIG_DIR,
    Argument("run", "", "instead: folder of a trained run"),
    Argument("mode", "full", "of run=DIR: full, policy or planner", MODE),
    Argument("policy", "", "with run=DIR: the file for its policy's parameters"),
    Argument("models", False, "with policy=FILE: also model, reward, critic, to plan with", flag),
    Argument("learner", None, "with policy=FILE: its seed; empty: the first", whole(least=0)),
    Argument("command", "", "with policy=FILE: how it was trained, kept in the file"),
    Argument("episodes", 10, "how many", whole()),
    Argument("seed", 0, "of the first states", whole(least=0)),
    Argument("out", "", "the file; empty: demonstrations/TASK.npz"),
)
GROUPS = {name: f"with task=T: a key of its {name}" for name in ("env", "episode", "expert")}


def main() -> None:
    """The command."""
    given, changes = read(__doc__, ARGUMENTS, GROUPS, ("task", "run"))
    others = ["policy"] if given["task"] else ["expert", *changes]
    if wrong := [name for name in others if name in changes or given[name]]:
        raise UsageError(f"{wrong[0]}: give it with {'run=DIR' if given['task'] else 'task=T'}")
    if given["policy"]:
        _write_policy(given)
        return
    out, episodes, seed = given["out"], given["episodes"], given["seed"]
    if out:
        output("out", out, (".npz",))
    if task := given["task"]:
        world, controller, params = scripted_expert(given, changes)
    else:
        run = load(Path(given["run"]))
        task, world = run.task, run.episode
        controller, params = run.learner(mode=given["mode"], world=True)
    if not out:
        Path("demonstrations").mkdir(exist_ok=True)
    out = output("out", out or f"demonstrations/{task}.npz", (".npz",))
    recording = record(world, controller, params, episodes, seed)
    save(out, task, world.spec.dt, recording.decisions, recording.episode)
    line = f"{out}: {episodes} episodes, {len(recording.episode):,} decisions, seed {seed}, return "
    returns = recording.returns
    line += f"{returns.mean():,.1f} ({returns.min():,.1f} to {returns.max():,.1f})"
    if recording.success is not None:
        line += f", {int(recording.success.sum())} succeeded"
    print(line)


def _write_policy(given: dict[str, Any]) -> None:
    """Write the parameters of the policy of run=DIR to policy=FILE."""
    file, models = output("policy", given["policy"], (".npz",)), given["models"]
    folder = Path(given["run"])
    task, count = save_policy(file, folder, given["learner"], given["command"], models)
    what = "policy and models" if models else "policy"
    print(f"{file}: the {what} of {folder}, {count:,} parameters, task {task}")


if __name__ == "__main__":
    command.run(main)
