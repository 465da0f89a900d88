"""Which loop trains an agent."""

from pathlib import Path

from hybrid_rl.envs.adapters.external import External
from hybrid_rl.envs.adapters.robot import Robot
from hybrid_rl.training.agent import Agent
from hybrid_rl.training.host_loop import HostLoop
from hybrid_rl.training.loop import Loop
from hybrid_rl.training.robot_loop import RobotLoop


def loop_of(agent: Agent, seeds: tuple[int, ...], stride: int, folder: Path = Path()) -> Loop:
    """On the device; on the host where its environment is there; or on a robot.

    folder: of the run, in which the files of a robot are.
    """
    env = agent.episode.env
    if isinstance(env, Robot):
        files = folder / "robot"
        files.mkdir(exist_ok=True)
        return RobotLoop(agent, seeds, stride, folder=files)
    return (HostLoop if isinstance(env, External) else Loop)(agent, seeds, stride)
