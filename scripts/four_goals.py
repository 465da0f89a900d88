"""The picture at the top of docs/results/planning.md: one robot, four goals, nothing retrained.

    python -m scripts.four_goals policy=halfcheetah out=docs/results/four_goals.gif

Four episodes beside and below each other, in real time, each with the goal and the speed that the
robot has on average after its first second.
"""

from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from hybrid_rl.analysis.drawing import episode, frames
from hybrid_rl.cli import command
from hybrid_rl.cli.arguments import Argument, output, read, whole
from hybrid_rl.envs.mujoco.scenery import scene_of
from hybrid_rl.run.retarget import retargeted
from hybrid_rl.run.saved import Trained
from hybrid_rl.run.saved import read as policy

GOALS = {
    "goal: 2 m/s": ["reward=speed", "reward.target=2"],
    "goal: -2 m/s": ["reward=speed", "reward.target=-2"],
    "goal: 5 m/s": ["reward=speed", "reward.target=5"],
    "goal: fast, torso level": ["reward=level"],
}
FPS, SHADES = 10, 64
ARGUMENTS = (
    Argument("policy", "halfcheetah", "a policy with its models, NAME of policies/ or a file"),
    Argument("steps", 100, "decisions of an episode", whole()),
    Argument("width", 280, "of one of the four, in pixels", whole(even=True)),
    Argument("out", "four_goals.gif", "the picture"),
)


def panels(trained: Trained, name: str, words: list[str], steps: int, width: int) -> list[Any]:
    """The pictures [h, width, 3] of an episode with the goal that the words name."""
    aimed = retargeted(trained, words)
    x = (shown := episode(aimed, steps=steps).poses)[:, 0]
    dt = aimed.episode.spec.dt
    first = round(1 / dt)
    speed = (x[-1] - x[first]) / (dt * (len(x) - 1 - first))
    font, drawn = ImageFont.load_default(size=14), []
    for each in frames(
        scene_of(aimed.episode.env), shown[:: round(1 / FPS / dt)], width, width // 2
    ):
        picture = Image.fromarray(each)
        ImageDraw.Draw(picture).text((6, 4), f"{name}; runs at {speed:.1f} m/s", "black", font)
        drawn.append(np.asarray(picture))
    print(f"{name}: {speed:.2f} m/s", flush=True)
    return drawn


def main() -> None:
    """The command."""
    given: Any = read(__doc__, ARGUMENTS)[0]
    out, trained = output("out", Path(given["out"]), (".gif",)), policy(given["policy"])
    each = [panels(trained, *goal, given["steps"], given["width"]) for goal in GOALS.items()]
    tiled = [
        np.vstack([np.hstack(four[:2]), np.hstack(four[2:])]) for four in zip(*each, strict=True)
    ]
    palette = Image.fromarray(np.vstack(tiled[:: len(tiled) // 4])).quantize(SHADES)
    first, *rest = (
        Image.fromarray(one).quantize(palette=palette, dither=Image.Dither.NONE) for one in tiled
    )
    first.save(out, save_all=True, append_images=rest, duration=1000 / FPS, loop=0)


if __name__ == "__main__":
    command.run(main)
