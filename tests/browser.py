"""A page in headless Chromium, over its DevTools protocol."""

import base64
import json
import shutil
import subprocess
import tempfile
import time
from pathlib import Path
from typing import Any
from urllib.request import urlopen

FOUND = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), "")
FLAGS = (
    *("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--remote-debugging-port=0"),
    *("--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"),
    *("--no-first-run", "--disable-background-networking", "--disable-component-update"),
)
PATIENCE = 60.0  # [s] for what a page should come to


class Browser:
    """One page; `events` are errors and requests so far, as (method, parameters)."""

    def __init__(self, url: str, width: int = 1280, height: int = 800) -> None:
        from websockets.sync.client import connect

        self._folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        line = [FOUND, *FLAGS, f"--user-data-dir={self._folder.name}", "about:blank"]
        self._process = subprocess.Popen(line, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        file = Path(self._folder.name, "DevToolsActivePort")
        self.wait(lambda: file.exists() and len(file.read_text().splitlines()) == 2)
        port = file.read_text().splitlines()[0]
        (page,) = [
            each
            for each in json.load(urlopen(f"http://127.0.0.1:{port}/json"))
            if each["type"] == "page"
        ]
        self._socket = connect(page["webSocketDebuggerUrl"], max_size=None, ping_interval=None)
        self._number, self.events = 0, []
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.send(f"{domain}.enable")
        size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 500}
        self.send("Emulation.setDeviceMetricsOverride", **size)
        self.send("Page.navigate", url=url)

    def send(self, method: str, **params: Any) -> dict[str, Any]:
        """The result of a method of the protocol."""
        self._number += 1
        self._socket.send(json.dumps({"id": self._number, "method": method, "params": params}))
        while True:
            got = json.loads(self._socket.recv(PATIENCE))
            if got.get("id") == self._number:
                return got["result"]
            self.events.append((got.get("method"), got.get("params")))

    def value(self, script: str) -> Any:
        """What a script evaluates to."""
        return self.send("Runtime.evaluate", expression=script, returnByValue=True)["result"].get(
            "value"
        )

    def mouse(self, kind: str, x: float, y: float, buttons: int = 0) -> None:
        """A move, a press or a release of the left button, at pixels."""
        kinds = {"move": "mouseMoved", "press": "mousePressed", "release": "mouseReleased"}
        button = "left" if buttons or kind == "release" else "none"
        self.send(
            "Input.dispatchMouseEvent",
            **{"type": kinds[kind], "x": x, "y": y, "button": button, "buttons": buttons},
            clickCount=0 if kind == "move" else 1,
        )

    def click(self, text: str) -> None:
        """Click on the innermost visible element with exactly this text, once it stands still."""
        x, y = self.wait(lambda: self._still(f"({FIND})({json.dumps(text)})"))
        self.mouse("press", x, y, 1)
        self.mouse("release", x, y)

    def _still(self, script: str) -> Any:
        """What a script evaluates to, if it is the same after a moment."""
        before = self.value(script)
        time.sleep(0.5)
        return before if before == self.value(script) else None

    def picture(self, file: Path) -> None:
        """Write a screenshot."""
        file.write_bytes(base64.b64decode(self.send("Page.captureScreenshot")["data"]))

    def errors(self) -> list[Any]:
        """Exceptions and errors in the page's log, and requests to another host."""
        self.value("0")
        bad = [each for each in self.events if each[0] == "Runtime.exceptionThrown"]
        entries = [p["entry"] for name, p in self.events if name == "Log.entryAdded"]
        bad += [entry for entry in entries if entry["level"] == "error"]
        asked = [p["request"]["url"] for n, p in self.events if n == "Network.requestWillBeSent"]
        inside = ("http://127.0.0.1", "ws://127.0.0.1", "data:", "blob:", "about:", "file:")
        return bad + [url for url in asked if not url.startswith(inside)]

    @staticmethod
    def wait(ready: Any, patience: float = PATIENCE) -> Any:
        """What `ready` returns as soon as it is true."""
        until = time.monotonic() + patience
        while not (got := ready()):
            assert time.monotonic() < until, "waited in vain"
            time.sleep(0.05)
        return got

    def close(self) -> None:
        """End the browser."""
        self._socket.close()
        self._process.terminate()
        self._process.wait()
        self._folder.cleanup()


FIND = """text => {
  const seen = [...document.querySelectorAll('label, button, span, p, div')].filter(
    e => e.textContent.trim() === text && e.getClientRects().length);
  if (!seen.length) return null;
  const box = seen[seen.length - 1].getBoundingClientRect();
  return [box.x + box.width / 2, box.y + box.height / 2];
}"""
