"""How long a run takes, by its speed.

On a CPU the note on a run of more than half an hour names what makes it shorter; nothing changes
by itself.
"""

from dataclasses import dataclass, field
from typing import Any

from omegaconf import DictConfig, OmegaConf

from hybrid_rl.config import CONF
from hybrid_rl.run.logs.progress import clock, rate
from hybrid_rl.run.schedule import Speed

LONG = 1800.0  # [s]
SURE = 100  # decisions with learning after which the speed is known


@dataclass
class Duration:
    """A note about the time of a run; instead: an override that makes a shorter one."""

    on_cpu: bool
    instead: str
    trial: Speed | None = field(default_factory=Speed)  # until the speed is known

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
        note = f"about {clock(whole)} for the whole run, without the evaluations to come, "
        note += f"by the speed of its first learning, {rate(speed)} decisions/s"
        hint = f"; {self.instead} takes less" if self.on_cpu and whole > LONG else ""
        return note + hint


def instead(config: DictConfig) -> str:
    """settings=light where it makes a network smaller; fewer decisions for other methods."""
    light: Any = OmegaConf.load(CONF / "settings" / "light.yaml")
    for name in ("reward_model", "critic"):
        part = config.get(name) or {}
        if {*light[name]} <= {*part} and part.hidden != light[name].hidden:
            return "settings=light"
    return "a smaller total_steps"
