"""Files of runs: replaced only once they are complete, and never those that a link leads to."""

import ast
import errno
import os
import re
from pathlib import Path

import numpy as np
import pytest
from tiny import contents

from hybrid_rl.envs.adapters.robot import Robot
from hybrid_rl.envs.adapters.stand_in import Cartpole
from hybrid_rl.errors import CheckpointError, UsageError
from hybrid_rl.files.atomic import open_own, own_folder, refuse_link, replacing
from hybrid_rl.files.lock import lock
from hybrid_rl.outside import handover
from hybrid_rl.outside.robot_process import RobotProcess, report
from hybrid_rl.outside.row_log import RowLog
from hybrid_rl.run.checkpoints import checkpoint
from hybrid_rl.run.logs.log import RunLog
from hybrid_rl.run.logs.loggers import TensorBoard, WandB
from hybrid_rl.types import Spec

PACKAGE = Path(__file__).resolve().parents[1] / "hybrid_rl"
WRITERS = ("run/**/*.py", "training/*.py", "robot.py")
WRITERS += ("outside/*.py", "cli/sweep.py", "files/[alr]*.py")
OPENS = r".+\.(write_text|write_bytes|touch|mk\w*dirs?|mkfifo|copy2|copyfile)|(.*\.)?(open|fdopen)"
OPENS += r"|(np|OmegaConf)\.save\w*"
OPENED = {  # in what writes to run folders; the folder of a run itself is the user's, or new
    "files/atomic.py": {
        "refuse_link(folder).mkdir(exist_ok=True)",  # `own_folder`
        "os.open(file, flags | NO_LINK | NO_WAIT, 438)",  # `own_file`
        "open(file, mode, opener=lambda path, flags: own_file(Path(path), flags), **how)",
        "os.open(path, os.O_RDONLY)",  # `sync`
        "draft.open('x', encoding='utf-8')",  # of `replacing`
    },
    "files/reading.py": {"os.open(file, os.O_RDONLY | NO_WAIT)", "os.fdopen(handle, 'rb')"},
    "files/lock.py": {"folder.mkdir(parents=True, exist_ok=True)"},
    "run/folder.py": {"folder.mkdir(parents=True)"},
    "run/exported.py": {"draft.write_bytes(model.SerializeToString())"},  # of `replacing`
    "run/logs/progress.py": {"os.open(os.devnull, os.O_WRONLY)"},
    "run/checkpoints/checkpoint.py": {
        "draft.mkdir()",  # a name that is free
        "(draft / name).write_text(text + '\\n', encoding='utf-8')",
        "manifest.write_text(json.dumps({'files': listed}, indent=1) + '\\n', encoding='ascii')",
        "path.open('rb')",
    },
    "cli/sweep.py": {"folder.mkdir(parents=True, exist_ok=True)"},
}


def write(file, error):
    """Write half of `file`, then raise `error`."""
    with replacing(file) as draft:
        draft.write_text("half")
        raise error


FULL = OSError(errno.ENOSPC, "No space left on device")


@pytest.mark.parametrize("error", [FULL, KeyboardInterrupt()])
def test_an_error_leaves_the_older_file(tmp_path, error):
    file = tmp_path / "figure.png"
    file.write_text("older")
    with pytest.raises(type(error)) as raised:
        write(file, error)
    assert file.read_text() == "older"
    assert [*tmp_path.iterdir()] == [file]
    assert getattr(raised.value, "filename", str(file)) == str(file)


def test_the_draft_ends_like_the_file_and_replaces_it(tmp_path):
    file = tmp_path / "figure.png"
    file.write_text("older")
    with replacing(file) as draft:
        assert draft.suffix == ".png"
        draft.write_text("newer")
        assert file.read_text() == "older"
    assert file.read_text() == "newer"
    assert [*tmp_path.iterdir()] == [file]


def opened(file: Path) -> set[str]:
    """Calls in a source file that open or make a file or a folder."""
    calls = [node for node in ast.walk(ast.parse(file.read_text())) if isinstance(node, ast.Call)]
    found = {ast.unparse(node) for node in calls if re.fullmatch(OPENS, ast.unparse(node.func))}
    return {each for each in found if not each.startswith("self._open")}


def test_what_writes_to_a_run_opens_by_one_function():
    """Another way to open has to be listed, with the reason why it follows no link."""
    files = {file for pattern in WRITERS for file in PACKAGE.glob(pattern)}
    found = {file.relative_to(PACKAGE).as_posix(): opened(file) for file in files}
    assert {name: calls for name, calls in found.items() if calls} == OPENED


def process(run: Path) -> RobotProcess:
    """The learner's view of a robot's process."""
    return RobotProcess(Robot(Cartpole), run / "robot")


def tensorboard(run: Path) -> None:
    TensorBoard(run, [0, 1]).close()


WRITE = {  # what would be written, by the file or the folder that is a link
    "robot/rows": lambda run: RowLog(run / "robot" / "rows", Spec(4, 1, 0.05)).recover(),
    "robot/parameters.new": lambda run: handover.publish(run / "robot" / "parameters", [1.0], 1),
    "robot/parameters": lambda run: handover.latest(run / "robot" / "parameters", [np.ones(1)]),
    "robot/console": lambda run: process(run)._start(),
    "robot/lock": lambda run: process(run).alive(),
    "robot/error": lambda run: process(run).watch(),
    "robot/stop": lambda run: open_own(run / "robot" / "stop").close(),
    "robot": lambda run: own_folder(run / "robot"),
    "lock": lambda run: lock(run, "run_dir").__enter__(),
    "metrics.jsonl": lambda run: RunLog(run, [0]).flush(),
    "tensorboard": tensorboard,
    "tensorboard/seed_0": tensorboard,
    "wandb": lambda run: WandB(run, [0], {}).id_of(0),
    "wandb/seed_0.id": lambda run: WandB(run, [0], {}).id_of(0),
    "checkpoints": lambda run: checkpoint.save(run / "checkpoints", 5, {"a": np.ones(1)}, {}),
    "study.db": lambda run: refuse_link(run / "study.db"),
}


@pytest.mark.parametrize("kind", ["file", "missing", "folder", "device"])
@pytest.mark.parametrize("name", WRITE)
def test_no_writer_follows_a_link(tmp_path, monkeypatch, name, kind):
    """Nor makes the file that it would lead to, nor reads without end."""
    monkeypatch.setattr("subprocess.Popen", lambda *_, **__: pytest.fail("started"))
    monkeypatch.setattr("hybrid_rl.outside.robot_process._lower", lambda: None)
    run, theirs = tmp_path / "run", tmp_path / "precious"
    (run / name).parent.mkdir(parents=True)
    if kind == "folder":
        theirs.mkdir()
        (theirs / "a").write_text("mine")
    elif kind == "file":
        theirs.write_text("mine")
    (run / name).symlink_to("/dev/zero" if kind == "device" else theirs)
    before = contents(tmp_path)
    with pytest.raises((UsageError, CheckpointError), match="is a link"):
        WRITE[name](run)
    if name not in ("robot/console", "robot/error"):  # after other files of its own
        assert contents(tmp_path) == before
    assert not theirs.exists() or contents(theirs.parent)["precious"] == before["precious"]
    assert theirs.exists() == (kind in ("file", "folder"))


def test_a_line_for_the_learner_stops_no_robot(tmp_path):
    """What ends motion comes after it."""
    (tmp_path / "precious").write_text("mine")
    (tmp_path / "error").symlink_to(tmp_path / "precious")
    report(tmp_path, "a line")
    assert (tmp_path / "precious").read_text() == "mine"
    os.unlink(tmp_path / "error")
    report(tmp_path, "a line")
    assert (tmp_path / "error").read_text() == "a line"
