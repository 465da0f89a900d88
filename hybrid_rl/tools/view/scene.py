"""The robot and its imagined paths, drawn in the browser by viser and mjviser.

mjviser follows the first body that moves by moving the whole world; what is drawn beside the robot,
and what a drag says, moves with it.
"""

import time
from collections.abc import Callable
from typing import Any

import mujoco
import numpy as np
from mjviser import ViserMujocoScene
from viser import ClientHandle, SceneNodeDragEvent, ViserServer

from hybrid_rl import scenery
from hybrid_rl.tools.view.imagined import PLANAR, lines, point_of
from hybrid_rl.tools.view.push import Pull

PALE, BRIGHT = (110, 135, 175), (255, 122, 0)  # of lines, on a light and a dark ground
UPRIGHT = 0.5  # cosine of a torso's tilt, below which the robot has tipped over
BACK = 1.6  # times as far as in a video, as paths lead ahead
ABOVE = 0.3  # of a phone's height, by which the robot is above the middle: below is the panel


class Scene:
    """What is drawn of an environment."""

    def __init__(self, server: ViserServer, env: Any, pull: Callable[[Pull | None], None]) -> None:
        """Draw the robot at rest; pull: called with each drag, None at its end."""
        self._server, self._pull = server, pull
        self.model = scenery.dressed(scenery.scene_of(env))
        self._data = mujoco.MjData(self.model)
        self._drawn = ViserMujocoScene(server, self.model, num_envs=1)
        self._lines: dict[str, Any] = {}
        self._torso = point_of(self.model)[0]
        self._turns = self.model.body_dofnum[self._torso] >= PLANAR
        for group in self._drawn._mesh_groups:
            group.handle.on_drag("left")(self._dragged(group.body_ids))
        self._aim()
        server.on_client_connect(self._raised)

    @property
    def offset(self) -> np.ndarray:
        """What is added [3] [m] to positions in the world."""
        return self._drawn._scene_offset

    @property
    def tipped(self) -> bool:
        """Whether a torso that can turn is far from upright, as it is drawn."""
        upright = (self._data.xmat[self._torso].reshape(3, 3) @ self._rest.T)[2, 2]
        return bool(self._turns and upright < UPRIGHT)

    def draw(self, qpos: np.ndarray) -> None:
        """The robot at positions [nq]."""
        self._data.qpos[:] = qpos
        mujoco.mj_kinematics(self.model, self._data)
        mujoco.mj_comPos(self.model, self._data)
        self._drawn.update_from_mjdata(self._data)

    def imagine(self, drawn: np.ndarray | None, chosen: int = 0) -> None:
        """The `lines` of K paths, those of the chosen one bright; None: no paths."""
        paths = np.zeros((0, 1, 2, 3)) if drawn is None else lines(self.model, drawn)
        self._line("candidates", paths, PALE, 1.5)
        self._line("chosen", paths[chosen : chosen + 1], BRIGHT, 5.0)

    def _line(
        self, name: str, paths: np.ndarray, colour: tuple[int, int, int], width: float
    ) -> None:
        """Paths [K, n, T, 3] as lines; nothing is sent that would not be seen."""
        handle = self._lines.get(name)
        if not len(paths):
            if handle is not None:
                handle.visible = False
            return
        ends = np.stack([paths[..., :-1, :], paths[..., 1:, :]], -2).reshape(-1, 2, 3)
        points = (ends + self.offset + self._before).astype(np.float32)
        if handle is None:
            handle = self._lines[name] = self._server.scene.add_line_segments(
                f"/{name}", points, colour, thickness=width, thickness_units="screen"
            )
        handle.points, handle.visible = points, True

    def _dragged(self, bodies: np.ndarray) -> Callable[[SceneNodeDragEvent], None]:
        """What happens when one of `bodies` is dragged."""

        def dragged(event: SceneNodeDragEvent) -> None:
            if event.phase == "end":
                self._pull(None)
                return
            first = min(event.instance_index or 0, len(bodies) - 1)
            name = self.model.body(int(bodies[first])).name
            at, to = (np.array(p) - self.offset for p in (event.start_position, event.end_position))
            self._pull(Pull(name, at, to, time.monotonic()))

        return dragged

    def _aim(self) -> None:
        """Put the camera where a video has it."""
        mujoco.mj_forward(self.model, self._data)
        self._rest = self._data.xmat[self._torso].reshape(3, 3).copy()
        found, view = scenery.camera(self.model), self._server.initial_camera
        if found.type == mujoco.mjtCamera.mjCAMERA_FIXED:
            at = self._data.cam_xpos[found.fixedcamid]
            ahead = -self._data.cam_xmat[found.fixedcamid].reshape(3, 3)[:, 2]
            followed = self._data.xpos[self._drawn._tracked_body_id or 0]
            distance = float(np.linalg.norm(at - followed))
            centre = at + distance * ahead
        else:
            azimuth, elevation = np.radians([found.azimuth, found.elevation])
            flat = np.cos(elevation)
            ahead = np.array([flat * np.cos(azimuth), flat * np.sin(azimuth), np.sin(elevation)])
            centre, distance = np.array(found.lookat), found.distance
            if found.type == mujoco.mjtCamera.mjCAMERA_TRACKING:
                centre = self._data.subtree_com[found.trackbodyid]
        self.draw(self._data.qpos)
        view.fov = np.radians(self.model.vis.global_.fovy)
        view.look_at = centre + self.offset
        view.position = view.look_at - BACK * distance * ahead
        torso = self.model.geom_bodyid == self._torso
        thick = self.model.geom_size[torso, 0].max(initial=0.0) if self._turns else 0.0
        self._before = -1.5 * thick * ahead  # [m] of lines: a torso does not hide their beginning

    def _raised(self, client: ClientHandle) -> None:
        """The camera of a phone sees the robot above its panel."""
        camera, view = client.camera, self._server.initial_camera
        if camera.image_width < camera.image_height:
            distance = np.linalg.norm(view.position - view.look_at)
            lower = 2 * ABOVE * distance * np.tan(view.fov / 2)
            camera.look_at = view.look_at - [0, 0, lower]
