"""Positions of a MuJoCo scene, drawn without a display: an array, a video, a GIF, a still."""

import contextlib
import io
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from hybrid_rl.envs.mujoco.offscreen import Canvas
from hybrid_rl.files.atomic import replacing
from hybrid_rl.run.logs.progress import Progress

SUFFIXES = (".mp4", ".gif", ".png")
GIF_FPS = 20.0  # [1/s] at most


def draw(
    scene: str,
    qpos: np.ndarray,
    out: str | Path,
    fps: float,
    width: int = 640,
    height: int = 480,
) -> Path:
    """Writes a video, H.264 for .mp4, endless for .gif; for .png the picture halfway.

    scene: MJCF text. qpos: [frames, nq]. fps: [1/s]. width, height: [pixels], even.
    """

    def pictures(shown: Sequence[int], smooth: bool) -> Iterable[np.ndarray]:
        return frames(scene, qpos[list(shown)], width, height, smooth)

    return write(Path(out), len(qpos), fps, pictures)


def write(
    out: Path, count: int, fps: float, pictures: Callable[[Sequence[int], bool], Iterable[Any]]
) -> Path:
    """Writes a file of one of SUFFIXES, as `draw`, of `count` pictures.

    pictures: of (which of them, whether the picture is one of a .png) the pictures, even in size.
    """
    shown = range(count)
    if out.suffix == ".gif" and fps > GIF_FPS:
        stride = int(np.ceil(fps / GIF_FPS))
        shown, fps = shown[::stride], fps / stride
    if out.suffix == ".png":
        shown = range(count // 2, count // 2 + 1)
    out.parent.mkdir(parents=True, exist_ok=True)
    drawn = _counted(pictures(shown, out.suffix == ".png"), len(shown))
    to = {".mp4": _write_mp4, ".gif": _write_gif, ".png": _write_png}[out.suffix]
    with replacing(out) as draft:
        to(draft, drawn, fps)
    return out


def draw_beside(
    scene: str, qpos: np.ndarray, out: Path, width: int = 640, height: int = 480
) -> None:
    """Writes a .png of one picture beside the other, for each row of qpos [frames, nq]."""
    with replacing(out) as draft:
        _write_png(draft, [np.hstack(list(frames(scene, qpos, width, height)))], 0.0)


def frames(
    scene: str, qpos: np.ndarray, width: int = 640, height: int = 480, smooth: bool = True
) -> Iterator[np.ndarray]:
    """One picture [height, width, 3] (uint8) for each row of qpos [frames, nq]."""
    with contextlib.closing(Canvas(scene, width, height, smooth)) as canvas:
        yield from map(canvas.draw, qpos)


def _counted(pictures: Iterable[np.ndarray], total: int) -> Iterator[np.ndarray]:
    """The same pictures, with progress on the terminal."""
    with Progress(total, label="drawing") as progress:
        for number, picture in enumerate(pictures, 1):
            yield picture
            progress.update(number, {})


def _write_mp4(out: Path, pictures: Iterable[np.ndarray], fps: float) -> None:
    import imageio.v3 as iio

    made = io.BytesIO()  # as pyav does not close a file on a full disk
    with iio.imopen(made, "w", plugin="pyav", extension=".mp4") as video:
        video.init_video_stream("libx264", fps=fps, pixel_format="yuv420p")
        for picture in pictures:
            video.write_frame(picture)
    out.write_bytes(made.getvalue())


def _write_gif(out: Path, pictures: Iterable[np.ndarray], fps: float) -> None:
    from PIL import Image

    first, *rest = (
        Image.fromarray(picture).quantize(128, dither=Image.Dither.NONE) for picture in pictures
    )
    first.save(out, save_all=True, append_images=rest, duration=1000 / fps, loop=0)


def _write_png(out: Path, pictures: Iterable[np.ndarray], fps: float) -> None:
    import imageio.v3 as iio

    for picture in pictures:
        iio.imwrite(out, picture)
