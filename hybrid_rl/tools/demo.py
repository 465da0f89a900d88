"""What is installed, one trained robot, and what to type next.

    python -m hybrid_rl.demo
    python -m hybrid_rl.demo policy=ant out=ant.mp4
    python -m hybrid_rl.demo window=true

The robot runs in a live window of the browser where there is a display and the extra `view` is
installed, else in a video file, which needs no display. window=true opens the window's address
without a display, too, as over ssh; window=false writes the file.
"""

if __name__ == "__main__":
    from hybrid_rl import command

    command.install()

import os
import platform
import sys
import webbrowser
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path

from hybrid_rl import UsageError, __version__, arguments, command, load, names
from hybrid_rl import film as write_film
from hybrid_rl.tools.view import __main__ as view

ARGUMENTS = (
    arguments.Argument("policy", "halfcheetah", "a trained policy, NAME of policies/ or a file"),
    arguments.Argument("out", "", "the video; empty: NAME.mp4"),
    arguments.Argument(
        "window",
        "auto",
        "true, false, or auto: see above",
        arguments.one_of("auto", "true", "false"),
    ),
)
EXTRAS = {"view": "viser", "onnx": "onnx", "warp": "warp", "wandb": "wandb", "slurm": "submitit"}
SHOWN = 200  # decisions of the video
NEXT = """
Next:
  python -m hybrid_rl.view policy=halfcheetah reward=speed   # another goal, live{hint}
  python -m hybrid_rl.render policy=halfcheetah reward=speed reward.target=-2   # it runs backwards
  python -m hybrid_rl.train task=pendulum algo=sac settings=light   # train
  python -m hybrid_rl.list   # all tasks and methods
  python -m hybrid_rl   # all commands; --help after any of them"""


def installed() -> str:
    """Lines about this machine and this installation."""
    import jax

    device = jax.devices()[0]
    extras = [name for name, module in EXTRAS.items() if find_spec(module)]
    return "\n".join(
        (
            f"hybrid_rl {__version__}, Python {platform.python_version()}, "
            f"JAX {version('jax')} on {device.device_kind}, MuJoCo {version('mujoco')}",
            f"{len(names('task'))} tasks, {len(names('algo'))} methods; "
            f"trained policies: {', '.join(names('policies'))}",
            f"extras: {', '.join(extras) or 'none'}",
        )
    )


def windowed(asked: str) -> bool:
    """Whether to open a window: as asked, else where there are a display and viser."""
    if asked == "true":
        view.import_viser()
    has = sys.platform == "darwin" or any(map(os.environ.get, ("DISPLAY", "WAYLAND_DISPLAY")))
    return asked == "true" or (asked == "auto" and has and find_spec("mjviser") is not None)


def film(policy: str, out: Path) -> str:
    """Write a video of a trained policy; a line about it, or why there is none."""
    trained = load(policy, "policy")
    try:
        shown = write_film(trained, out, steps=min(SHOWN, trained.episode.steps))
    except OSError as error:  # without graphics, say
        return f"no video: {error}"
    line = f"{trained.task}: {len(shown.poses) - 1} decisions, return {shown.total:,.1f}"
    return f"{line}; see {out.absolute()}"


def main() -> None:
    """The command."""
    given, _ = arguments.read(__doc__, ARGUMENTS)
    policy = given["policy"]
    out = Path(given["out"] or f"{Path(policy).stem}.mp4")
    window = windowed(given["window"])
    print(installed(), flush=True)
    hint = "" if find_spec("mjviser") else f"; {view.INSTALL}"
    if not window:
        print(f"drawing {policy}, half a minute without a graphics card", flush=True)
        print(film(policy, out))
        print(NEXT.format(hint=hint))
        return
    if given["out"]:
        raise UsageError(f"out={given['out']}: is of a video; give it with window=false")
    print(NEXT.format(hint=hint), flush=True)
    shown = {**{each.name: each.default for each in view.ARGUMENTS}, "policy": policy}
    view.show(shown, {}, webbrowser.open if given["window"] == "auto" else None)


if __name__ == "__main__":
    command.run(main)
