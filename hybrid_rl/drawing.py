"""Positions of a MuJoCo scene, drawn without a display: an array, a video, a GIF.

The backend is chosen at the first drawing, by a trial in a process of its own: EGL
(graphics cards, and software rendering by Mesa), else OSMesa. MUJOCO_GL=egl or
osmesa in the environment decides instead. MuJoCo's own Renderer is not used, since
it is bound to whatever MUJOCO_GL was when mujoco was first imported.
"""

import contextlib
import importlib
import os
import subprocess
import sys
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path

import mujoco
import numpy as np

from hybrid_rl.training.progress import Progress

BACKENDS = ("egl", "osmesa")
CAMERA = "track"  # taken where a scene has one of this name
SHADOWS = 1024  # [pixels] of the shadow map; 4096 triples the time without a graphics card
SUFFIXES = (".mp4", ".gif")
GIF_FPS = 20.0  # [1/s] at most
TRIAL = """
import mujoco
from mujoco.{backend} import GLContext
window = GLContext(8, 8)
window.make_current()
drawer = mujoco.MjrContext(mujoco.MjModel.from_xml_string("<mujoco/>"), 150)
drawer.free()
window.free()
"""


class NoGraphicsError(OSError):
    """Nothing here can draw without a display; one line says what to install."""


def draw(
    scene: str,
    qpos: np.ndarray,
    out: str | Path,
    fps: float,
    width: int = 640,
    height: int = 480,
) -> Path:
    """Writes a video; H.264 for .mp4, endless for .gif.

    scene: MJCF text. qpos: [frames, nq]. fps: [1/s]. width, height: [pixels], even.
    """
    out = Path(out)
    if out.suffix not in SUFFIXES:
        raise ValueError(f"{out}: must end in {' or '.join(SUFFIXES)}")
    if out.suffix == ".gif" and fps > GIF_FPS:
        stride = int(np.ceil(fps / GIF_FPS))
        qpos, fps = qpos[::stride], fps / stride
    out.parent.mkdir(parents=True, exist_ok=True)
    part = out.with_stem(f".{out.stem}.part")
    pictures = _told(frames(scene, qpos, width, height), len(qpos))
    try:
        (_write_mp4 if out.suffix == ".mp4" else _write_gif)(part, pictures, fps)
        part.replace(out)
    finally:
        part.unlink(missing_ok=True)
    return out


def frames(
    scene: str, qpos: np.ndarray, width: int = 640, height: int = 480
) -> Iterator[np.ndarray]:
    """One picture [height, width, 3] (uint8) for each row of qpos [frames, nq]."""
    model = mujoco.MjModel.from_xml_string(scene)
    if np.ndim(qpos) != 2 or np.shape(qpos)[1] != model.nq:
        raise ValueError(f"qpos is {np.shape(qpos)}; the scene takes [frames, {model.nq}]")
    model.vis.global_.offwidth, model.vis.global_.offheight = width, height
    model.vis.quality.shadowsize = SHADOWS
    data, camera, option = mujoco.MjData(model), _camera(model), mujoco.MjvOption()
    view = mujoco.MjrRect(0, 0, width, height)
    picture = np.empty((height, width, 3), np.uint8)
    with _drawer(model, width, height) as drawer:
        scenery = mujoco.MjvScene(model, maxgeom=10_000)
        scenery.flags[mujoco.mjtRndFlag.mjRND_REFLECTION] = False
        for data.qpos[:] in qpos:
            mujoco.mj_forward(model, data)
            every = mujoco.mjtCatBit.mjCAT_ALL
            mujoco.mjv_updateScene(model, data, option, None, camera, every, scenery)
            mujoco.mjr_render(view, scenery, drawer)
            mujoco.mjr_readPixels(picture, None, view, drawer)
            yield picture[::-1].copy()  # OpenGL counts rows from below


@cache
def backend() -> str:
    """The first of BACKENDS that draws here, or what MUJOCO_GL names.

    Raises:
        NoGraphicsError: where none does.
    """
    if sys.platform == "darwin":
        return "cgl"
    wish = os.environ.get("MUJOCO_GL", "").strip().lower()
    tried = (wish,) if wish in BACKENDS else BACKENDS
    for name in tried:
        clean = {key: value for key, value in os.environ.items() if key != "PYOPENGL_PLATFORM"}
        trial = [sys.executable, "-c", TRIAL.format(backend=name)]
        done = subprocess.run(trial, env={**clean, "MUJOCO_GL": name}, capture_output=True)
        if done.returncode == 0:
            return name
    raise NoGraphicsError(
        f"cannot draw without a display: {' and '.join(tried)} failed; "
        "install libegl1 or libosmesa6 (Debian: apt-get install libegl1 libosmesa6)"
    )


@contextlib.contextmanager
def _drawer(model: mujoco.MjModel, width: int, height: int) -> Iterator[mujoco.MjrContext]:
    """An off-screen place to draw, given back at the end."""
    name = backend()
    if name in BACKENDS:
        os.environ["PYOPENGL_PLATFORM"] = name
    window = importlib.import_module(f"mujoco.{name}").GLContext(width, height)
    try:
        window.make_current()
        drawer = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_150)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, drawer)
        yield drawer
        drawer.free()
    finally:
        window.free()


def _camera(model: mujoco.MjModel) -> mujoco.MjvCamera:
    """The scene's own that follows the robot, else a free one that follows its first body."""
    camera = mujoco.MjvCamera()
    number = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_CAMERA, CAMERA)
    if number >= 0:
        camera.type, camera.fixedcamid = mujoco.mjtCamera.mjCAMERA_FIXED, number
    else:
        mujoco.mjv_defaultFreeCamera(model, camera)
        camera.type, camera.trackbodyid = (
            mujoco.mjtCamera.mjCAMERA_TRACKING,
            min(1, model.nbody - 1),
        )
    return camera


def _told(pictures: Iterable[np.ndarray], total: int) -> Iterator[np.ndarray]:
    """The same pictures, with progress on the terminal."""
    with Progress(total, label="drawing", unit="pictures") as progress:
        for number, picture in enumerate(pictures, 1):
            yield picture
            progress.update(number, {})


def _write_mp4(out: Path, pictures: Iterable[np.ndarray], fps: float) -> None:
    import imageio.v3 as iio

    with iio.imopen(out, "w", plugin="pyav") as video:
        video.init_video_stream("libx264", fps=fps, pixel_format="yuv420p")
        for picture in pictures:
            video.write_frame(picture)


def _write_gif(out: Path, pictures: Iterable[np.ndarray], fps: float) -> None:
    from PIL import Image

    first, *rest = (
        Image.fromarray(picture).quantize(128, dither=Image.Dither.NONE) for picture in pictures
    )
    first.save(out, save_all=True, append_images=rest, duration=1000 / fps, loop=0)
