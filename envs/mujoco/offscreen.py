"""Rendering of a MuJoCo scene without a display.

The first rendering chooses the backend by a trial in a separate process: EGL (graphics cards, and
software rendering by Mesa), else OSMesa. The environment variable MUJOCO_GL=egl or osmesa
overrides the choice. MuJoCo's own Renderer is not used because it is bound to the value of
MUJOCO_GL at the first import of mujoco, and because without a display a failure of its default
backend ends the process.
"""

import atexit
import contextlib
import importlib
import os
import subprocess
import sys
import weakref
from functools import cache

import mujoco
import numpy as np

from hybrid_rl.envs.mujoco import scenery

BACKENDS = ("egl", "osmesa")
SHADOWS = 1024  # [pixels] of the shadow map; 4096 takes three times as long in software
RASTERISERS = ("llvmpipe", "softpipe", "swrast", "software")  # Mesa's drivers without a card
TRIAL = """
import mujoco
from mujoco.{backend} import GLContext
window = GLContext(8, 8)
window.make_current()
try:
    from OpenGL import GL
    print(GL.glGetString(GL.GL_RENDERER).decode(), flush=True)
except ImportError:
    pass
model = mujoco.MjModel.from_xml_string("<mujoco/>")
context = mujoco.MjrContext(model, 150)
context.free()
window.free()
"""


class NoGraphicsError(OSError):
    """No backend can render without a display; the message names what to install."""


def backend() -> str:
    """The first of BACKENDS that works on this machine, or the one that MUJOCO_GL names."""
    return chosen()[0]


def by_processor() -> bool:
    """Whether the processor draws, a few pictures a second, and no graphics card."""
    return any(name in chosen()[1].lower() for name in RASTERISERS)


@cache
def chosen() -> tuple[str, str]:
    """The backend, and what it draws with, by the first trial that succeeds."""
    if sys.platform == "darwin":
        return "cgl", ""
    requested = os.environ.get("MUJOCO_GL", "").strip().lower()
    tried = (requested,) if requested in BACKENDS else BACKENDS
    clean = {key: value for key, value in os.environ.items() if key != "PYOPENGL_PLATFORM"}
    for name in tried:
        run, env = [sys.executable, "-c", TRIAL.format(backend=name)], {**clean, "MUJOCO_GL": name}
        done = subprocess.run(run, env=env, capture_output=True, text=True)
        if done.returncode == 0:
            return name, done.stdout
    raise NoGraphicsError(
        f"cannot draw without a display: {' and '.join(tried)} failed; "
        "install libegl1 or libosmesa6 (Debian: apt-get install libegl1 libosmesa6)"
    )


def lend() -> None:
    """Let renderers of MuJoCo and Gymnasium draw with `backend()`, if a command disabled them."""
    if os.environ.get("MUJOCO_GL") == "disable":
        os.environ["MUJOCO_GL"] = backend()
        from mujoco.rendering.classic import gl_context  # which reads MUJOCO_GL

        mujoco.GLContext = importlib.reload(gl_context).GLContext


class Canvas:
    """Renders images of one scene; `close()`, or the end of the process, frees its resources.

    scene: MJCF text, or a file for `mjcf.spec`; `scenery.dressed` adds the light that it lacks.
    width, height: [pixels]. smooth: whether edges are, if the processor has to draw, which then
    takes twice as long.
    """

    def __init__(
        self, scene: str, width: int = 640, height: int = 480, smooth: bool = True
    ) -> None:
        name = backend()
        if name in BACKENDS:
            os.environ["PYOPENGL_PLATFORM"] = name
        self.model = scenery.dressed(scene)
        self.model.vis.global_.offwidth, self.model.vis.global_.offheight = width, height
        self.model.vis.quality.shadowsize = SHADOWS
        if not smooth and by_processor():
            self.model.vis.quality.offsamples = 0
        self._data, self._camera = mujoco.MjData(self.model), scenery.camera(self.model)
        self._view = mujoco.MjrRect(0, 0, width, height)
        self._scenery = mujoco.MjvScene(self.model, maxgeom=10_000)
        self._scenery.flags[mujoco.mjtRndFlag.mjRND_REFLECTION] = False
        self._window = importlib.import_module(f"mujoco.{name}").GLContext(width, height)
        with contextlib.ExitStack() as parts:
            parts.callback(self._window.free)
            self._window.make_current()
            self._context = mujoco.MjrContext(self.model, mujoco.mjtFontScale.mjFONTSCALE_150)
            parts.callback(self._context.free)
            parts.callback(self._window.make_current)  # OpenGL frees in the current window
            self.close = weakref.finalize(self, parts.pop_all().close)
        self.close.atexit = False  # but before EGL ends, which registered earlier
        atexit.register(self.close)

    def draw(self, qpos: np.ndarray) -> np.ndarray:
        """The image [height, width, 3] (uint8) at joint positions qpos [nq]."""
        self._window.make_current()
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self._context)
        self._data.qpos[:] = qpos
        mujoco.mj_forward(self.model, self._data)
        seen = self.model, self._data, mujoco.MjvOption(), None, self._camera
        mujoco.mjv_updateScene(*seen, mujoco.mjtCatBit.mjCAT_ALL, self._scenery)
        mujoco.mjr_render(self._view, self._scenery, self._context)
        picture = np.empty((self._view.height, self._view.width, 3), np.uint8)
        mujoco.mjr_readPixels(picture, None, self._view, self._context)
        return picture[::-1].copy()  # OpenGL counts rows from below
