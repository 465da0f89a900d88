"""Make docs/static/robots/mujoco.js and robot.js out of page/*.js and two packages of npm.

    python -m scripts.browser

mujoco.js is MuJoCo's own WebAssembly, compressed, as text in a script; robot.js is page/*.js with
MuJoCo's glue and three.js in one script. Both are classic scripts, since a browser loads neither
modules nor other files for a page that was opened from a file. They are in the repository, so that
`make docs` needs no Node; this command does, 18 or newer, with npm and its registry. `robots.py`
writes the third script whenever the site is made.
"""

import base64
import gzip
import hashlib
import json
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
OUT = ROOT / "docs" / "static" / "robots"
PAGE = Path(__file__).with_name("page")
WORK = ROOT / "build" / "browser"
VERSIONS = {"@mujoco/mujoco": "3.14.0", "three": "0.187.0", "esbuild": "0.28.2"}
SHA256 = {  # of what was made; a change of a version or of page/*.js changes it
    "mujoco.wasm": "2d380f1070a556c3003b4a7c7c10c98a5f61db4e91815de1075ec478e9487e76",
    "robot.js": "966a86097d37d23e6d7c8911dcdc8afae3340c6b929f2fbdb0a797c064a9f170",
}
NODE_ONLY = ("module", "fs", "path", "url", "crypto", "worker_threads")  # of MuJoCo's glue
GLOBAL = "window.MUJOCO_WASM_GZ="


def sources() -> str:
    """The SHA-256 of page/*.js, which the first line of robot.js names."""
    text = "".join(path.read_text(encoding="utf-8") for path in sorted(PAGE.glob("*.js")))
    return hashlib.sha256(text.encode()).hexdigest()


def wasm() -> bytes:
    """MuJoCo's WebAssembly that mujoco.js holds."""
    text = (OUT / "mujoco.js").read_text(encoding="ascii").strip()
    return gzip.decompress(base64.b64decode(text.removeprefix(GLOBAL).strip('";')))


def found() -> dict[str, str]:
    """The SHA-256 of what is in docs/static/robots."""
    contents = {"mujoco.wasm": wasm(), "robot.js": (OUT / "robot.js").read_bytes()}
    return {name: hashlib.sha256(content).hexdigest() for name, content in contents.items()}


def build() -> None:
    """Write both scripts."""
    WORK.mkdir(parents=True, exist_ok=True)
    (WORK / "package.json").write_text(json.dumps({"private": True, "dependencies": VERSIONS}))
    subprocess.run(["npm", "install", "--silent", "--ignore-scripts"], cwd=WORK, check=True)
    modules = WORK / "node_modules"
    raw = (modules / "@mujoco" / "mujoco" / "mujoco.wasm").read_bytes()
    packed = base64.b64encode(gzip.compress(raw, 9, mtime=0)).decode()
    (OUT / "mujoco.js").write_text(f'{GLOBAL}"{packed}";\n', encoding="ascii")
    first = f"/* `python -m scripts.browser` made this from scripts/browser/page, {sources()} */"
    command = ["node", modules / "esbuild" / "bin" / "esbuild", PAGE / "main.js", "--bundle"]
    command += ["--minify", "--format=iife", "--platform=browser", "--legal-comments=none"]
    command += ['--define:import.meta.url="file:///x"', f"--banner:js={first}"]
    command += [f"--external:{name}" for name in NODE_ONLY]
    command += [f"--outfile={OUT / 'robot.js'}", "--log-level=warning"]
    subprocess.run(command, env=os.environ | {"NODE_PATH": str(modules)}, check=True)


def main() -> None:
    """The command."""
    build()
    now = found()
    for name, digest in now.items():
        size = (OUT / name.replace("wasm", "js")).stat().st_size
        print(f"{name}: SHA-256 {digest}; as a script {size:,} bytes")
    if now != SHA256:
        sys.exit("these are not the SHA256 in scripts/browser/__main__.py; write them there")


if __name__ == "__main__":
    main()
