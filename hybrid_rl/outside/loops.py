"""Which loop trains an agent."""

from pathlib import Path

from hybrid_rl.envs.adapters.external import External
from hybrid_rl.envs.adapters.robot import Outside, Robot
from hybrid_rl.errors import UsageError
from hybrid_rl.outside.host_loop import HostLoop
from hybrid_rl.outside.robot_loop import RobotLoop
from hybrid_rl.training.agent import Agent
from hybrid_rl.training.loop import Axis, Loop


def loop_of(
    agent: Agent,
    seeds: tuple[int, ...],
    stride: int,
    folder: Path = Path(),
    axis: Axis | None = None,
) -> Loop:
    """On the device; on the host where its environment is there; or on a robot.

    folder: of the run, in which the files of a robot are. axis: of `Loop`.
    """
    env = agent.episode.env
    if isinstance(env, Robot):
        return RobotLoop(agent, seeds, stride, folder=folder / "robot")
    if isinstance(env, Outside):
        raise UsageError("task=online: is for a loop of yours; use hybrid_rl.OnlineLearner")
    kind = HostLoop if isinstance(env, External) else Loop
    return kind(agent, seeds, stride, axis=Axis() if axis is None else axis)
