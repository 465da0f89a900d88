"""How long a run takes: by its operations before it is compiled, then by its speed.

    seconds = rounds (operations / OPERATIONS + ROUND),   a round: one decision in each environment

On a CPU the notes of a run of more than half an hour name what makes it shorter; nothing changes
by itself.
"""

import os
from dataclasses import dataclass, field
from typing import Any

from omegaconf import DictConfig, OmegaConf

from hybrid_rl.config import CONF
from hybrid_rl.run.progress import clock, rate
from hybrid_rl.run.schedule import Speed

LONG = 1800.0  # [s]
OPERATIONS = 35e9  # [1/s] of a core; an AMD EPYC with ten gradient steps per decision
ROUND = 0.002  # [s] for all that is not counted; the same machine with settings=light
SURE = 100  # decisions with learning after which the speed is known


@dataclass
class Duration:
    """Notes about the time of a run; instead: an override that makes a shorter one."""

    on_cpu: bool
    instead: str
    trial: Speed | None = field(default_factory=Speed)  # until the speed is known

    def before(self, operations: float, rounds: int) -> str | None:
        """A note if the `rounds` of so many operations will take long on this CPU."""
        seconds = rounds * (operations / (OPERATIONS * (os.cpu_count() or 1)) + ROUND)
        if not self.on_cpu or seconds <= LONG:
            return None
        return f"about {clock(seconds)} on this CPU, by its operations{self._hint(seconds)}"

    def after(
        self, decisions: int, seconds: float, learners: int, left: int, so_far: float
    ) -> str | None:
        """The estimate of the whole time, once SURE decisions of each learner are counted.

        decisions: of all learners, just made in `seconds`; left: those to come; so_far: [s].
        """
        if self.trial is None:
            return None
        self.trial.add(decisions, seconds)
        if self.trial.decisions < SURE * learners or not self.trial.rate:
            return None
        speed, self.trial = self.trial.rate, None
        whole = so_far + left / speed
        note = f"about {clock(whole)} for the whole run at {rate(speed)} decisions/s, "
        return note + "without the evaluations to come" + self._hint(whole)

    def _hint(self, seconds: float) -> str:
        """What makes the run shorter, if it is long and on a CPU."""
        return f"; {self.instead} takes less" if self.on_cpu and seconds > LONG else ""


def instead(config: DictConfig) -> str:
    """settings=light for hybrid learning and its baselines; fewer decisions for other methods."""
    light: Any = OmegaConf.load(CONF / "settings" / "light.yaml")
    networks = ["reward"]
    if "lookahead" in config.get("policy_learner", ()):  # that of SAC
        networks.append("critic")
    sizes = [(OmegaConf.select(config, f"{name}.hidden"), light[name].hidden) for name in networks]
    if all(size in (None, smaller) for size, smaller in sizes):
        return "a smaller total_steps"
    return "settings=light"
