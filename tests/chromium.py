"""A headless Chromium, driven by its DevTools protocol over a WebSocket."""

import json
import shutil
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from websockets.sync.client import ClientConnection, connect

FLAGS = (  # of software rendering, where a machine has no display and no GPU
    *("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--remote-debugging-port=0"),
    *("--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"),
    *("--no-first-run", "--disable-background-networking", "--disable-component-update"),
)
PROGRAM = next(
    filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), ""
)


FIND = """text => {
  const seen = [...document.querySelectorAll('label, button, span, p, div')].filter(
    e => e.textContent.trim() === text && e.getClientRects().length);
  if (!seen.length) return null;
  const box = seen[seen.length - 1].getBoundingClientRect();
  return [box.x + box.width / 2, box.y + box.height / 2];
}"""


def until(ready: Callable[[], Any], seconds: float = 60) -> Any:
    """What `ready` returns as soon as it is true."""
    end = time.monotonic() + seconds
    while not (got := ready()):
        assert time.monotonic() < end, f"not within {seconds} s"
        time.sleep(0.05)
    return got


@contextmanager
def opened(profile: Path) -> Iterator["Chromium"]:
    """A Chromium that ends with the block; profile: an empty folder."""
    command = [PROGRAM, *FLAGS, f"--user-data-dir={profile}", "about:blank"]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    with subprocess.Popen(command, **quiet) as process:
        try:
            port, path = _address(profile / "DevToolsActivePort")
            with connect(f"ws://127.0.0.1:{port}{path}", max_size=None, proxy=None) as socket:
                yield Chromium(socket)
        finally:
            process.terminate()


def _address(file: Path) -> list[str]:
    """Port and path of the socket, once Chromium has written them."""
    for _ in range(300):
        if file.exists() and len(lines := file.read_text().split()) == 2:
            return lines
        time.sleep(0.1)
    raise TimeoutError("Chromium did not start within 30 s")


class Chromium:
    """One page. Its errors and the addresses that it requests are kept."""

    def __init__(self, socket: ClientConnection) -> None:
        self.socket, self.count, self.session = socket, 0, ""
        self.errors: list[str] = []
        self.requests: list[str] = []
        targets = self("Target.getTargets")["targetInfos"]
        (target,) = [each["targetId"] for each in targets if each["type"] == "page"]
        self.session = self("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self(f"{domain}.enable")

    def __call__(self, method: str, **params: Any) -> dict[str, Any]:
        """The result of a command; events that come before it are kept."""
        self.count += 1
        message = {"id": self.count, "method": method, "params": params}
        message |= {"sessionId": self.session} if self.session else {}
        self.socket.send(json.dumps(message))
        while True:
            answer = json.loads(self.socket.recv(timeout=60))
            if answer.get("id") == self.count:
                assert "error" not in answer, f"{method}: {answer['error']}"
                return answer["result"]
            self._event(answer.get("method"), answer.get("params", {}))

    def _event(self, name: str, params: dict[str, Any]) -> None:
        """Keep an error, a warning or an address."""
        if name == "Runtime.exceptionThrown":
            details = params["exceptionDetails"]
            self.errors.append(details.get("exception", details).get("description", str(details)))
        elif name == "Log.entryAdded" and params["entry"]["level"] in ("error", "warning"):
            self.errors.append(params["entry"]["text"])
        elif name == "Runtime.consoleAPICalled" and params["type"] in ("error", "warning"):
            self.errors.append(str([each.get("value") for each in params["args"]]))
        elif name == "Network.requestWillBeSent":
            self.requests.append(params["request"]["url"])

    def run(self, script: str) -> Any:
        """The value of JavaScript, of a promise what it resolves to."""
        options = {"awaitPromise": True, "returnByValue": True}
        answer = self("Runtime.evaluate", expression=script, **options)
        assert "exceptionDetails" not in answer, answer["exceptionDetails"]
        return answer["result"].get("value")

    def open(self, url: str) -> None:
        """Load a page, which may add to its address."""
        self("Page.navigate", url=url)
        there = f"location.href.startsWith({json.dumps(url)})"
        self.wait(f"{there} && document.readyState === 'complete'")

    def wait(self, condition: str, seconds: float = 60) -> None:
        """Until a condition in JavaScript holds."""
        try:
            until(lambda: self.run(f"Boolean({condition})"), seconds)
        except AssertionError as error:
            raise AssertionError(f"{condition}: {error}; {self.errors}") from error

    def mouse(self, kind: str, x: float, y: float) -> None:
        """mousePressed, mouseMoved or mouseReleased at a point, with the left button."""
        left = {"button": "left", "buttons": 1, "clickCount": 1}
        self("Input.dispatchMouseEvent", type=kind, x=x, y=y, **left)

    def click(self, text: str) -> None:
        """Click on the innermost visible element with exactly this text, once it stands still."""
        x, y = until(lambda: self._still(f"({FIND})({json.dumps(text)})"))
        for kind in ("mouseMoved", "mousePressed", "mouseReleased"):
            self.mouse(kind, x, y)

    def _still(self, script: str) -> Any:
        """What a script evaluates to, if it is the same after a moment."""
        before = self.run(script)
        time.sleep(0.5)
        return before if before == self.run(script) else None

    def size(self, width: int, height: int) -> None:
        """The window's size [pixels], drawn with half of them each way: no GPU draws them here."""
        size = {"width": width, "height": height, "deviceScaleFactor": 0.5, "mobile": False}
        self("Emulation.setDeviceMetricsOverride", **size)
