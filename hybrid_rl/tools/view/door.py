"""The door of a window's server: who may enter, and what a page may send.

A request needs the key that is in the link, a Host that is this machine, by address or name, and no
Origin but that Host. Of the messages of a page three enter: the camera, a drag, and the value of a
control, within its range. All others are dropped.
"""

import logging
import secrets
import socket
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from ipaddress import ip_address
from typing import Annotated, Any, Literal
from urllib.parse import urlsplit

import msgspec
import numpy as np
from msgspec import Meta, Struct
from websockets import Headers
from websockets.asyncio import server as websockets
from websockets.http11 import Request, Response

LONGEST = 2**16  # [bytes] of a message
REFUSED = b"open the link that `python -m hybrid_rl.view` printed\n"
SILENT = logging.getLogger("hybrid_rl.view.door")  # of what strangers send
SILENT.addHandler(logging.NullHandler())
SILENT.propagate = False
Number = Annotated[float, Meta(ge=-1e20, le=1e20)]  # finite
Text = Annotated[str, Meta(max_length=200)]
Vector = tuple[Number, Number, Number]


class Camera(Struct, tag_field="type", tag="ViewerCameraMessage"):
    """The camera of a browser."""

    wxyz: tuple[Number, Number, Number, Number]
    position: Vector
    fov: Number
    near: Number
    far: Number
    image_height: Annotated[int, Meta(ge=0, le=2**16)]
    image_width: Annotated[int, Meta(ge=0, le=2**16)]
    look_at: Vector
    up_direction: Vector


class Drag(Struct, tag_field="type", tag="SceneNodeDragMessage"):
    """The mouse pulls at something drawn."""

    phase: Literal["start", "update", "end"]
    name: Text
    instance_index: Annotated[int, Meta(ge=0, le=2**16)] | None
    start_position: Vector
    start_screen_pos: tuple[Number, Number]
    end_position: Vector
    end_screen_pos: tuple[Number, Number]
    button: Literal["left", "middle", "right"]
    modifier: Text | None
    owner: Text = ""


class Value(Struct):
    """The only property that a page may change."""

    value: bool | Number | Text


class Update(Struct, tag_field="type", tag="GuiUpdateMessage"):
    """A control has another value."""

    uuid: Text
    updates: Value


def within(control: Any, value: bool | float | str) -> bool | float | str | None:
    """The value of a control of viser that is nearest to `value`; None: it is of another kind."""
    if (options := getattr(control, "options", None)) is not None:
        return value if value in options else None
    if isinstance(value, str) or isinstance(value, bool) != isinstance(control.value, bool):
        return None
    return value if isinstance(value, bool) else float(np.clip(value, control.min, control.max))


class Door:
    """The door of the server of one window."""

    def __init__(self, host: str) -> None:
        """host: the address that it serves."""
        self.key = secrets.token_urlsafe(16)
        self._names = {"localhost", socket.gethostname().lower(), host.lower()}
        self.controls: Mapping[str, Any] = {}  # by their id

    @contextmanager
    def hung(self) -> Iterator[None]:
        """A server that viser starts within has this door."""
        plain, hung = websockets.serve, []

        def serve(handler: Any, host: str, port: int, **settings: Any) -> Any:
            hung.append(port)
            inner = settings["process_request"]
            settings["process_request"] = lambda *asked: self._asked(inner, *asked)
            settings |= {"max_size": LONGEST, "logger": SILENT}
            return plain(handler, host, port, create_connection=self._connection(), **settings)

        websockets.serve = serve  # type: ignore
        try:
            yield
        finally:
            websockets.serve = plain
        assert hung, "viser starts its server in another way"

    def _connection(self) -> type[websockets.ServerConnection]:
        """Connections on which the server hears only what enters."""
        door = self

        class Connection(websockets.ServerConnection):
            async def recv(self, decode: Any = None) -> Any:
                while (heard := door.heard(await super().recv(False))) is None:
                    pass
                return heard

        return Connection

    def _asked(self, inner: Callable[..., Any], connection: Any, request: Request) -> Any:
        """The response to a request; `inner`: the server's own."""
        if not self.admits(request):
            kind = {"Content-Type": "text/plain", "Content-Length": str(len(REFUSED))}
            return Response(403, "Forbidden", Headers(kind), REFUSED)
        request.path = "/"
        return inner(connection, request)

    def heard(self, raw: bytes) -> bytes | None:
        """The message of a page as the server hears it; None: it does not."""
        try:
            message = msgspec.msgpack.decode(raw, type=Camera | Drag | Update)
        except msgspec.DecodeError:
            return None
        if isinstance(message, Update):
            control = self.controls.get(message.uuid)
            message.updates.value = value = control and within(control, message.updates.value)
            if value is None:
                return None
        return msgspec.msgpack.encode(message)

    def admits(self, request: Request) -> bool:
        """Whether a request has the key, and Host and Origin are this window's."""
        hosts, origins = map(request.headers.get_all, ("Host", "Origin"))
        try:
            path = request.path.partition("?")[0].strip("/").encode()
            (host,) = (each.lower() for each in hosts)
            known = secrets.compare_digest(path, self.key.encode()) and self._ours(host)
            return known and all(urlsplit(each).netloc == host for each in origins)
        except ValueError:  # of what is no host or no text
            return False

    def _ours(self, host: str) -> bool:
        """Whether a Host, with its port, is this machine's: no other name for it."""
        name = urlsplit(f"//{host}").hostname or ""
        return name in self._names or bool(ip_address(name))
