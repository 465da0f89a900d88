"""Which loop trains an agent."""

from pathlib import Path

from hybrid_rl.envs.adapters.external import External
from hybrid_rl.envs.adapters.robot import Outside, Robot
from hybrid_rl.errors import UsageError
from hybrid_rl.files.atomic import own_folder
from hybrid_rl.training.agent import Agent
from hybrid_rl.training.axis import Axis
from hybrid_rl.training.host_loop import HostLoop
from hybrid_rl.training.loop import Loop
from hybrid_rl.training.robot_loop import RobotLoop


def loop_of(
    agent: Agent,
    seeds: tuple[int, ...],
    stride: int,
    folder: Path = Path(),
    axis: Axis | None = None,
) -> Loop:
    """On the device; on the host where its environment is there; or on a robot.

    folder: of the run, in which the files of a robot are. axis: of `Loop`.

    Raises:
        UsageError: for a world that the caller steps, or an axis on a robot.
    """
    env, axis = agent.episode.env, Axis() if axis is None else axis
    if axis.numbers and isinstance(env, Robot | Outside):
        raise UsageError("sweep: one robot has one learner; use -m, with one job after another")
    if isinstance(env, Robot):
        return RobotLoop(agent, seeds, stride, folder=own_folder(folder / "robot"))
    if isinstance(env, Outside):
        raise UsageError("task=online: is for a loop of yours; use hybrid_rl.OnlineLearner")
    return (HostLoop if isinstance(env, External) else Loop)(agent, seeds, stride, axis=axis)
