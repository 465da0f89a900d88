"""The door of the window's server: who enters, and what a page may send."""

import math
import urllib.error
import urllib.request
from types import SimpleNamespace

import pytest
import viser
from chromium import until
from msgspec import msgpack
from websockets import Headers, InvalidStatus
from websockets.http11 import Request
from websockets.sync.client import connect

from hybrid_rl.tools.view.__main__ import serve
from hybrid_rl.tools.view.door import Door

UP, AT = [0.0, 0.0, 1.0], [0.0, 0.0]
OWN = ("Host", "127.0.0.1")
CAMERA = {
    "type": "ViewerCameraMessage",
    **{"position": UP, "look_at": UP, "up_direction": UP, "wxyz": [1.0, *UP]},
    **{"fov": 1.0, "near": 0.1, "far": 10.0, "image_height": 800, "image_width": 600},
}
DRAG = {
    "type": "SceneNodeDragMessage",
    **{"phase": "start", "name": "/torso", "instance_index": 0, "button": "left", "modifier": None},
    **{"start_position": UP, "end_position": UP, "start_screen_pos": AT, "end_screen_pos": AT},
    "owner": "",
}
CONTROLS = {
    "reward": SimpleNamespace(value="speed", options=("speed", "level")),
    "speed": SimpleNamespace(value=1.0, min=0.1, max=1.0),
    "seed": SimpleNamespace(value=0, min=0, max=2**32 - 1),
    "paused": SimpleNamespace(value=False),
}


@pytest.fixture
def door():
    one = Door("127.0.0.1")
    one.controls = CONTROLS
    return one


def update(uuid, **updates):
    return {"type": "GuiUpdateMessage", "uuid": uuid, "updates": updates}


@pytest.mark.parametrize(
    ("path", "headers", "enters"),
    [
        ("/KEY", {"Host": "127.0.0.1:8080"}, True),
        ("/KEY/?websocket=ws://x", {"Host": "[::1]:1"}, True),
        ("/KEY", {"Host": "localhost:9000", "Origin": "http://localhost:9000"}, True),
        ("/KEY", {"Host": "localhost:9000", "Origin": "http://localhost:8080"}, False),
        ("/KEY", {"Host": "127.0.0.1:8080", "Origin": "http://evil.example"}, False),
        ("/KEY", {"Host": "127.0.0.1:8080", "Origin": "null"}, False),
        ("/KEY", {"Host": "evil.example:8080"}, False),
        ("/KEY", {"Host": "evil.example", "Origin": "http://evil.example"}, False),
        ("/KEY", {"Host": "[127.0.0.1"}, False),
        ("/KEY", {"Host": "127.0.0.1", "Origin": "http://[127.0.0.1"}, False),
        ("/KEY\udcff", {"Host": "127.0.0.1"}, False),
        ("/KEY", {}, False),
        ("/", {"Host": "127.0.0.1:8080"}, False),
        ("/key", {"Host": "127.0.0.1:8080"}, False),
        ("/KEY/" + 6000 * "a", {"Host": "127.0.0.1:8080"}, False),
        ("/KEY/../../etc/passwd", {"Host": "127.0.0.1:8080"}, False),
        ("/KEY", [("Host", "127.0.0.1"), ("Host", "evil.example")], False),
        ("/KEY", [OWN, ("Origin", "http://127.0.0.1"), ("Origin", "http://evil.example")], False),
    ],
)
def test_only_the_window_s_own_page_enters(door, path, headers, enters):
    request = Request(path.replace("KEY", door.key), Headers(headers))
    assert door.admits(request) == enters


@pytest.mark.parametrize(
    ("given", "got"),
    [
        (update("reward", value="level"), "level"),
        (update("speed", value=0.5), 0.5),
        (update("speed", value=1), 1.0),
        (update("speed", value=0), 0.1),
        (update("speed", value=-1e9), 0.1),
        (update("seed", value=2**63), 2**32 - 1),
        (update("seed", value=-1), 0),
        (update("paused", value=True), True),
    ],
)
def test_a_value_is_within_the_range_of_its_control(door, given, got):
    assert msgpack.decode(door.heard(msgpack.encode(given)))["updates"] == {"value": got}


@pytest.mark.parametrize("given", [CAMERA, DRAG])
def test_the_camera_and_a_drag_enter_as_they_are(door, given):
    assert msgpack.decode(door.heard(msgpack.encode(given))) == given


@pytest.mark.parametrize(
    "given",
    [
        *(update("reward", value=each) for each in ("speed\nx: ${oc.env:HOME}", "", 1, None)),
        *(update("speed", value=each) for each in (math.nan, math.inf, "fast", None, True, [1])),
        *(update("paused", value=each) for each in (1, "yes", [[]])),
        *(update("speed", **{key: 1}) for key in ("max", "update_cb", "removed", "nothing")),
        update("another", value=1),
        update([1], value=1),
        update("x" * 1000, value=1),
        {"type": "GuiUpdateMessage", "uuid": "speed"},
        {"type": "ShareUrlRequest"},
        {"type": "FileTransferStartUpload", "filename": "../../x"},
        {"type": "RunJavascriptMessage", "source": "alert(1)"},
        {"type": []},
        {},
        [],
        {**CAMERA, "fov": math.nan},
        {**CAMERA, "wxyz": "abcd"},
        {**CAMERA, "position": [1.0]},
        {**DRAG, "end_position": [math.inf, 0.0, 0.0]},
        {**DRAG, "instance_index": -1},
        {**DRAG, "phase": "never"},
        {**DRAG, "name": None},
        *(b"", b"\xc1" * 50, b"\x91" * 60000, b"\xc7\x05\xffabcde", b"hello"),
    ],
)
def test_anything_else_is_dropped(door, given):
    assert door.heard(given if isinstance(given, bytes) else msgpack.encode(given)) is None


def test_a_server_has_the_door(monkeypatch, capfd):
    """A hostile page is refused; of a page with the link what does not fit is not heard."""
    server, link = serve({"host": "127.0.0.1", "port": 8491})
    shared = []
    monkeypatch.setattr(server, "request_share_url", lambda: shared.append(1))
    try:
        speed = server.gui.add_slider("speed", 0.1, 1.0, 0.1, 1.0)
        (uuid,) = server.gui._gui_input_handle_from_uuid
        root = link.rpartition("/")[0]
        assert "text/html" in urllib.request.urlopen(link).headers["Content-Type"]
        with pytest.raises(urllib.error.HTTPError, match="403"):
            urllib.request.urlopen(root)
        ours, other = (each.replace("http", "ws") for each in (link, root))
        for address, origin in ((ours, "http://evil.example"), (other, root)):
            with pytest.raises(InvalidStatus, match="403"):
                connect(address, origin=origin, proxy=None)
        version = [f"viser-v{viser.__version__}"]
        with connect(ours, origin=root, subprotocols=version, proxy=None) as page:
            for each in (CAMERA, {"type": "ShareUrlRequest"}, update(uuid, value=0)):
                page.send(msgpack.encode(each))
            page.send(b"\xc1")
            until(lambda: speed.value == 0.1)
        assert not shared
    finally:
        server.stop()
    assert "Traceback" not in capfd.readouterr().err
