"""An installed wheel works from any folder, even one with envs/ and conf/ of its own."""

import json
import os
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path

import pytest

from hybrid_rl.data.demonstrations import load

ROOT = Path(__file__).resolve().parents[2]
RECORDED = ROOT / "demonstrations" / "ant.npz"


def run(*command, cwd):
    """Standard output of a command that has to succeed, without this checkout on its path."""
    env = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "PYTHONHOME")}
    done = subprocess.run([*map(str, command)], cwd=cwd, env=env, capture_output=True, text=True)
    assert done.returncode == 0, f"{command}\n{done.stdout}\n{done.stderr}"
    return done.stdout


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """The wheel, built from the sdist."""
    out = tmp_path_factory.mktemp("dist")
    run(sys.executable, "-m", "build", "--no-isolation", "--outdir", out, ROOT, cwd=out)
    return next(out.glob("*.whl"))


@pytest.fixture(scope="module")
def python(wheel, tmp_path_factory):
    """Python of a fresh environment that holds the wheel, and sees our dependencies alone."""
    venv = tmp_path_factory.mktemp("env")
    run(sys.executable, "-m", "venv", "--without-pip", venv, cwd=venv)
    python = venv / "bin/python"
    pip = [sys.executable, "-m", "pip", "--python", python, "--quiet"]
    run(*pip, "install", "--no-deps", "--no-index", wheel, cwd=venv)
    # A path in a .pth file is searched, but the .pth files there are not read: among them
    # the one that leads to this checkout.
    site = run(python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))", cwd=venv)
    folders = {sysconfig.get_path("purelib"), sysconfig.get_path("platlib")}
    Path(site.strip(), "dependencies.pth").write_text("\n".join(folders))
    return python


@pytest.fixture
def folder(tmp_path):
    """A user's working directory, with folders of its own whose names are ours in a checkout."""
    for name in ("envs", "conf", "tests"):
        tmp_path.joinpath(name).mkdir()
        tmp_path.joinpath(name, "__init__.py").write_text("raise RuntimeError('not ours')")
    tmp_path.joinpath("conf", "train.yaml").write_text("task: not ours")
    return tmp_path


def test_the_wheel_holds_the_package_and_its_entry_for_hydra(wheel):
    """Hydra takes plugins of the package hydra_plugins alone, which many distributions share."""
    names = zipfile.ZipFile(wheel).namelist()
    plugins = [name for name in names if name.startswith("hydra_plugins/")]
    assert plugins == ["hydra_plugins/hybrid_rl_sweeper.py"]
    rest = {name.split("/")[0] for name in set(names) - set(plugins)}
    name, version, *_ = wheel.name.split("-")
    assert rest == {"hybrid_rl", f"{name}-{version}.dist-info"}
    wanted = ["py.typed", "types.py", "envs/mujoco/physics.py", "conf/train.yaml"]
    assert not {f"hybrid_rl/{name}" for name in wanted} - set(names)
    sources = [*ROOT.glob("envs/**/*.*"), *ROOT.glob("conf/**/*.yaml"), RECORDED]
    for source in sources:
        assert "__pycache__" in source.parts or f"hybrid_rl/{source.relative_to(ROOT)}" in names
    assert wheel.stat().st_size < 6e6  # [bytes], most of them in policies and demonstrations/


def test_the_demonstrations_are_found_from_any_folder(python, tmp_path):
    """The ant's, which an experiment reads; a file of the user's comes first."""
    code = (
        "from hybrid_rl.data.archive import find\n"
        "from hybrid_rl.data.demonstrations import load\n"
        "print(len(load('demonstrations/ant.npz')['reward']), find('demonstrations/ant.npz'))"
    )
    count, path = run(python, "-c", code, cwd=tmp_path).split(maxsplit=1)
    assert int(count) == len(load(RECORDED)["reward"])
    assert Path(path.strip()).is_relative_to(python.parents[1])
    own = tmp_path / "demonstrations" / "ant.npz"
    own.parent.mkdir()
    own.write_bytes(RECORDED.read_bytes())
    assert run(python, "-c", code, cwd=tmp_path).split()[1] == "demonstrations/ant.npz"


def test_commands_work_from_any_folder(python, folder):
    origin = run(python, "-c", "import hybrid_rl.envs as e; print(e.__file__)", cwd=folder)
    assert Path(origin.strip()).is_relative_to(python.parents[1])
    listed = run(python, "-m", "hybrid_rl.list", cwd=folder)
    assert {"pendulum", "sac", "hybrid_stochastic"} <= set(listed.split())
    overrides = "task=pendulum algo=sac total_steps=300 eval_every=300 eval_episodes=1 run_dir=run"
    run(python, "-m", "hybrid_rl.train", *overrides.split(), cwd=folder)
    summary = json.loads(folder.joinpath("run", "summary.json").read_text())
    assert summary["finished"]
    assert summary["total_steps"] == 300
    rows = folder.joinpath("run", "metrics.jsonl").read_text().splitlines()
    assert any("eval/return" in json.loads(row) for row in rows)
