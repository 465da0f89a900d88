"""What is wrong with a run that does not learn, as far as its folder shows it.

    python -m hybrid_rl.doctor run=runs/hopper/sac/TIME

A line for each fault: what was seen, what it means, what to try. Fix the first one first: later
ones may follow from it. The command reads metrics.jsonl, summary.json, and the replay memory and
networks of the newest checkpoint. It also runs new episodes with the policy, linear ones, random
actions and zero actions; in a Gymnasium environment only with the policy and with linear ones. It
writes nothing. The page "My robot does not learn" of the documentation explains the checks, and
what they found.
"""

if __name__ == "__main__":
    from hybrid_rl import command

    command.install()

import sys
from collections.abc import Callable
from pathlib import Path

from hybrid_rl import arguments, command
from hybrid_rl.tools.doctor import learned, linear, observed, regular, task
from hybrid_rl.tools.doctor.evidence import Evidence, of_each, read

ARGUMENTS = (arguments.Argument("run", "", "folder of the run", needed="run=DIR, a run folder"),)
NOTHING = """{folder}: no fault found.
The doctor does not know what you want, nor how hard it is. What to look at next:
  python -m hybrid_rl.render run={folder}
      what the robot does: is that what the reward pays?
  python -m hybrid_rl.evaluate run={folder} mode=policy
      and mode=planner, if the run has both: the worse one is at fault
  python -m hybrid_rl.report run={folder}
      all curves; returns that still rise need more decisions
More in the documentation, on the page "My robot does not learn"."""
CHECKS: dict[str, Callable[[Evidence], str | None]] = {  # in the order of that page
    "numbers": learned.diverged,
    "silent sensor": observed.constant,
    "observation limits": observed.clipped,
    "action rate": observed.rare,
    "noise": observed.noise,
    "action": observed.action,
    "every other decision": regular.alternates,
    "action's gain": regular.gains,
    "hidden state": observed.hidden,
    "model": of_each(learned.forecast),
    "ends": task.ends,
    "episode": task.short,
    "reward": task.reward,
    "reward's sign": task.sign,
    "reward's scale": of_each(learned.scale),
    "random decisions": learned.random,
    "critic": of_each(learned.critic),
    "linear policies": of_each(linear.better),
}


def examine(folder: Path | str) -> dict[str, str]:
    """Name of a check -> its line, for those of CHECKS that have found something."""
    return _found(read(Path(folder)))


def _found(run: Evidence) -> dict[str, str]:
    """Name of a check -> its line, as `examine` gives them."""
    found = {name: check(run) for name, check in CHECKS.items()}
    return {name: line for name, line in found.items() if line}


def main() -> None:
    """The command."""
    folder = Path(arguments.read(__doc__, ARGUMENTS)[0]["run"])
    run = read(folder)
    print(f"{folder}: {len(CHECKS)} checks, some by new episodes", file=sys.stderr, flush=True)
    found = _found(run)
    width = max(map(len, found), default=0)
    for name, line in found.items():
        print(f"{name:{width}}  {line}")
    if not found:
        print(NOTHING.format(folder=folder))


if __name__ == "__main__":
    command.run(main)
