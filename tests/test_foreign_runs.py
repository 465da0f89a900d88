"""Run folders from anybody: reading one runs no code of it, changes nothing, and always ends."""

import json
import os
import sys
from pathlib import Path

import pytest
import yaml
from tiny import SMALL, call, call_train, contents, only_line

from hybrid_rl import config, demonstrate, evaluate, export, figures, render, report
from hybrid_rl.analysis import recorded
from hybrid_rl.analysis.results import RunFolder
from hybrid_rl.cli import command
from hybrid_rl.errors import UsageError
from hybrid_rl.run import folder as run_folder
from hybrid_rl.run import jax_settings
from hybrid_rl.run.log import RunLog
from hybrid_rl.run.loggers import CSV

METRIC = "metric=eval/return"
ROW = {"step": 5, "seed": 0, "wall_s": 1.0, "eval/return": -3.0}
READ = {"config.yaml": "settings", "metrics.jsonl": "rows", "summary.json": "summary"}
SYSTEM = {"_target_": "os.system", "command": "true"}
COMMANDS = {
    "evaluate": evaluate.main,
    "report": report.main,
    "export": export.main,
    "render": render.main,
    "demonstrate": demonstrate.main,
}


@pytest.fixture(scope="module")
def written() -> str:
    """config.yaml as training writes it."""
    return run_folder.described(config.load([*SMALL, "algo=sac"]))


@pytest.fixture
def folder(written, tmp_path, monkeypatch) -> Path:
    """A run folder in the current one, with a module next to it that tells when it is imported."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.delitem(sys.modules, "zz_evil", raising=False)
    path = tmp_path / "theirs" / "run"
    path.mkdir(parents=True)
    (path / "config.yaml").write_text(written)
    (path / "metrics.jsonl").write_text(json.dumps(ROW) + "\n")
    (path / "summary.json").write_text(json.dumps({"task": "pendulum", "algo": "sac"}))
    for each in (path, path.parent):
        (each / "zz_evil.py").write_text("open('ran', 'w')\nclass World: pass\n")
    return path


def refused(folder: Path, read=lambda folder: run_folder.read(folder, "run")) -> str:
    """The one line by which reading a folder is refused; it changes and imports nothing."""
    before, modules = contents(folder.parent.parent), set(sys.modules)
    with pytest.raises(UsageError) as caught:
        read(folder)
    assert contents(folder.parent.parent) == before
    assert not {"this", "zz_evil", "theirs", "antigravity"} & (set(sys.modules) - modules)
    line = str(caught.value)
    assert line.count("\n") == 0
    return line


def changed(folder: Path, **keys: object) -> None:
    """Give keys of config.yaml other values."""
    file = folder / "config.yaml"
    file.write_text(yaml.safe_dump(yaml.safe_load(file.read_text()) | keys))


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({"controllers": {"full": 5}}, "controllers.full=5: must be a part"),
        ({"controllers": {}}, "controllers.full=null: must be a part"),
        ({"learners": {"policy": {"tau": 1}}}, "learners.policy={'tau': 1}: must be a part"),
        ({"replay": {"capacity": 9}}, "must be a part, a group of keys with _target_"),
    ],
)
def test_a_section_that_holds_no_part_is_refused(folder, keys, words):
    changed(folder, **keys)
    line = refused(folder, lambda folder: config.build(run_folder.read(folder, "run")))
    assert words in line


@pytest.mark.parametrize(
    "name",
    [
        *(
            "os.system",
            "builtins.exec",
            "pydoc.pipepager",
            "subprocess.run",
            "this.s",
            "numpy.save",
        ),
        *("antigravity.webbrowser", "yaml.unsafe_load", "__main__.x", "site.main", "pytest.main"),
        "hybrid_rl.run.integrity.write_text",
        "hybrid_rl.analysis.results.RunFolder",
        "hybrid_rl.config.Path",
        "hybrid_rl.config.Run",
        "hybrid_rl.types.Spec",
        "hybrid_rl.data.trained.Path",
        "hybrid_rl.data.trained.save",
        "hybrid_rl.envs..os",
        "hybrid_rl..os.system",
        "hybrid_rl.run.provenance.subprocess.run",
        "hybrid_rl.envs.analytic.pendulum.jax.numpy.save",
        "hybrid_rl.envs.analytic.pendulum.dataclass",
        "hybrid_rl.envs.analytic.pendulum.Pendulum.reset",
        "hybrid_rl.scripts.bootstrap.main",
        "hybrid_rl.theirs.run.zz_evil.World",
        "hybrid_rl.envs.analytic",
        "hybrid_rl",
        "h\u0443brid_rl.envs.analytic.pendulum.Pendulum",  # a Cyrillic letter
        "os\uff0esystem",
        " os.system",
        "os.system\n",
        "os/system",
        "../os.system",
        "theirs.run.zz_evil.World",
        "theirs.zz_evil.World",
        "",
        None,
        5,
        ["os.system"],
        SYSTEM,
    ],
    ids=ascii,
)
def test_a_name_that_is_no_part_is_refused(folder, name):
    (folder.parent / "__init__.py").write_text("")
    changed(folder, env={"_target_": name})
    line = refused(folder)
    assert line.startswith(f"{folder}/config.yaml: env._target_=")


@pytest.mark.parametrize(
    ("keys", "at"),
    [
        ({"extra": SYSTEM}, "extra._target_"),
        ({"_target_": "os.system"}, "_target_"),
        ({"extra": [1, SYSTEM]}, "extra.1._target_"),
        ({"extra": [[[SYSTEM]]]}, "extra.0.0.0._target_"),
        ({"extra": {"_args_": [SYSTEM]}}, "extra._args_.0._target_"),
        ({"extra": {"_partial_": True, "a": SYSTEM}}, "extra.a._target_"),
        ({"extra": {"_recursive_": False, "a": SYSTEM}}, "extra.a._target_"),
        ({"hydra": {"launcher": SYSTEM}}, "hydra.launcher._target_"),
        ({"expert": SYSTEM}, "expert._target_"),
    ],
    ids=lambda given: given if isinstance(given, str) else "",
)
def test_it_is_refused_wherever_it_stands(folder, keys, at):
    changed(folder, **keys)
    assert refused(folder).startswith(f"{folder}/config.yaml: {at}=os.system: is no part of")
    assert "=os.system: is no part" in refused(folder, recorded.read)


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_refuses_it(folder, capfd, name):
    changed(folder, extra=[{"_target_": "hybrid_rl.run.integrity.write_text", "path": "ran"}])
    before = contents(folder)
    given = [f"run={folder}", *(["out=a.npz"] if name == "export" else [])]
    if name == "report":  # its page has the curves; only the film needs the parts
        assert call(lambda: command.guarded(report.main), *given) == 0
        assert "is no part of hybrid_rl" in (folder / "report.html").read_text()
        (folder / "report.html").unlink()
    else:
        assert call(lambda: command.guarded(COMMANDS[name]), *given) == 2
        assert "write_text: is no part of hybrid_rl" in only_line(capfd)
    assert contents(folder) == before
    assert not Path("ran").exists()


def test_a_run_is_not_resumed_with_it(folder, capfd):
    changed(folder, extra=SYSTEM)
    (folder / "checkpoints" / "5").mkdir(parents=True)
    assert call_train(f"resume={folder}", "total_steps=200") == 2
    assert "extra._target_=os.system: is no part of hybrid_rl" in only_line(capfd)


def test_a_class_of_the_user_is_a_part_and_a_function_is_none(folder):
    """Without importing the module; one that lies with the run is not the user's."""
    Path("zz_mine.py").write_text("open('ran', 'w')\nclass World:\n    pass\ndef made(): pass\n")
    changed(folder, env={"_target_": "zz_mine.World"})
    assert run_folder.read(folder, "run").env._target_ == "zz_mine.World"
    assert not Path("ran").exists()
    changed(folder, env={"_target_": "zz_mine.made"})
    assert "zz_mine.py has no class made" in refused(folder)
    changed(folder, env={"_target_": "theirs.zz_evil.World"})
    assert f"move {folder} out of {folder.parent}" in refused(folder)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("a: &a {x: 1}\nenv: {<<: *a}\n", "line 2 is no YAML of training (<< merges keys)"),
        ("a: !!python/object/apply:os.system [x]\n", "line 1 is no YAML of training (a tag)"),
        ("task: ${oc.env:HOME}\n", "line 1: ${oc.env:HOME} is an interpolation"),
        ("task: [{'${a}': 1}]\n", "is an interpolation; it must be a plain value"),
        ("x: &a [*a]\n", "*a refers to itself"),
        (
            "a0: &a0 [x,x,x,x,x,x,x,x,x]\n"
            + "".join(f"a{i}: &a{i} [{','.join([f'*a{i - 1}'] * 9)}]\n" for i in range(1, 10)),
            "holds more than 20,000 values",
        ),
        ("[" * 100_000, "line 1 is nested too deeply"),
        ("- " * 100_000, "line 1 is nested too deeply"),
        ("a: " + "9" * 6000 + "\n", "Exceeds the limit"),
        ("a: 1\n---\nb: 2\n", "line 2 is no YAML"),
        ("? [a, b]\n: 2\n", "line 1 is no YAML"),
        ("a: \0\n", "is no text in YAML"),
        ("a: " + "x" * 2_000_000, "is larger than 1 MB"),
    ],
    ids=range(13),
)
def test_yaml_that_is_more_than_plain_values_is_refused(folder, text, words):
    """Also where the values are only compared."""
    (folder / "config.yaml").write_text(text)
    assert words in refused(folder)
    assert words in refused(folder, lambda folder: RunFolder(folder).settings)


@pytest.mark.parametrize("name", ["config.yaml", "metrics.jsonl", "summary.json"])
@pytest.mark.parametrize("kind", ["pipe", "device", "folder", "large"])
def test_what_is_no_plain_file_of_its_size_is_not_read(folder, name, kind):
    """It neither hangs nor fills the memory."""
    file = folder / name
    file.unlink()
    if kind == "pipe":
        os.mkfifo(file)
    elif kind == "device":
        file.symlink_to("/dev/zero")
    elif kind == "folder":
        file.mkdir()
    else:
        with file.open("wb") as data:
            data.truncate(10**8)  # one line of zeros, which takes no space
    run = RunFolder(folder)
    with pytest.raises(UsageError, match=f"{file}: "):
        getattr(run, READ[name])


@pytest.mark.parametrize("name", ["metrics.jsonl", "metrics.csv"])
@pytest.mark.parametrize("kind", ["link", "pipe"])
def test_a_resumed_run_writes_to_its_own_files_only(folder, name, kind):
    """A link in it does not cut a file elsewhere, and a pipe does not hang."""
    precious = Path("precious.txt")
    precious.write_text("all that I have\n")
    (folder / name).unlink(missing_ok=True)
    if kind == "link":
        (folder / name).symlink_to(precious.absolute())
    else:
        os.mkfifo(folder / name)
    with (
        pytest.raises(UsageError, match=f"{name}: is a link, or no plain file"),
        RunLog(folder, [0], [CSV(folder)] if name == "metrics.csv" else []),
    ):
        pass
    assert precious.read_text() == "all that I have\n"


BAD_ROWS = [
    b'{"step": 5, "wall_s": 1.0}',
    b'{"step": 5, "seed": [0], "wall_s": 1.0}',
    b'{"step": -5, "seed": 0, "wall_s": 1.0}',
    b'{"step": 5, "seed": 0, "wall_s": NaN}',
    b'{"step": 5, "seed": 0, "wall_s": 1.0, "eval/return": [1]}',
    b'{"step": 5, "seed": 0, "wall_s": 1.0, "eval/return": 1' + b"0" * 400 + b"}",
    b"[" * 100_000,
    b"\xff\xfe\x00",
    b'{"step": 5, "seed": 0, "wall_s": 1.0, "eval/return": "high"}',
    b"7",
]


@pytest.mark.parametrize("bad", BAD_ROWS, ids=range(len(BAD_ROWS)))
def test_a_damaged_row_is_named_and_a_resumed_run_goes_on_without_it(folder, bad):
    """metrics.csv gets the sound rows; nothing is lost by an error in the middle."""
    file = folder / "metrics.jsonl"
    known = file.read_bytes() + bad + b"\n" + json.dumps(ROW | {"step": 9}).encode() + b"\n"
    file.write_bytes(known + b'{"after')
    with pytest.raises(UsageError, match="line 2 is no row of metrics"):
        _ = RunFolder(folder).rows
    with RunLog(folder, [0], [CSV(folder)]) as log:
        (note,) = log.rewind(len(known), 9)
    assert "rows before step 9 are missing or edited" in note
    assert file.read_bytes() == known
    steps = [line.split(",")[0] for line in (folder / "metrics.csv").read_text().split()]
    assert steps == ["step", "5", "9"]


@pytest.mark.parametrize(
    "text",
    [
        "[" * 100_000,
        '{"a":' * 100_000,
        "[1]",
        '{"final_eval": 3}',
        '{"seeds": "0"}',
        '{"wall_s": NaN}',
        '{"total_steps": "many"}',
        '{"versions": null}',
        '{"git_commit": 5}',
        '{"diverged": [5]}',
    ],
    ids=range(10),
)
def test_a_damaged_summary_is_one_line(folder, capfd, text):
    (folder / "summary.json").write_text(text)
    assert call(lambda: command.guarded(report.main), f"run={folder}", "video=none") == 2
    assert only_line(capfd).startswith(f"hybrid_rl: {folder}/summary.json: ")


def test_a_run_without_a_finite_evaluation_has_no_curve(folder, capfd):
    (folder / "metrics.jsonl").write_text(json.dumps(ROW | {"eval/return": None}) + "\n")
    line = [f"runs={folder}", METRIC, "out=a.png"]
    assert call(lambda: command.guarded(figures.main), *line) == 2
    assert "metric=eval/return: has no finite value in these runs" in only_line(capfd)


def test_words_that_a_terminal_or_matplotlib_obeys_are_shown_as_they_are(folder, capfd):
    """In a line of ours, and in a picture."""
    changed(folder, task="$\\undefined{x}$", algo="$y_{$")
    for main, out in ((report.main, "a.html"), (figures.main, "a.svg")):
        line = [f"run={folder}"] if main is report.main else [f"runs={folder}", METRIC]
        line.append(f"out={out}")
        assert call(lambda main=main: command.guarded(main), *line) == 0
    assert "$\\undefined{x}$" in Path("a.svg").read_text()
    capfd.readouterr()
    changed(folder, env={"_target_": "a\x1b]0;title\x07\nhybrid_rl: done"})
    assert call(lambda: command.guarded(evaluate.main), f"run={folder}") == 2
    line = only_line(capfd)
    assert "\\x1b]0;title\\x07\\nhybrid_rl: done" in line
    assert line.strip().isprintable()


@pytest.mark.parametrize("name", ["a b", 'x"""\nimport os', "..", "a/b", "", "\u0430lgo"])
def test_a_task_or_a_method_has_a_plain_name(folder, name):
    """It becomes a folder's name, and a word in a program."""
    for key in ("task", "algo"):
        changed(folder, **{"task": "pendulum", "algo": "sac", key: name})
        with pytest.raises(UsageError, match=f"{key}=.*: must be letters, digits"):
            config.build(run_folder.read(folder, "run"))


def test_a_folder_does_not_say_where_programs_are_kept(folder, tmp_path):
    """And only JAX's own files are deleted there, in a folder of our own."""
    changed(folder, compile_cache=str(tmp_path / "precious"))
    default = config.load([]).compile_cache
    assert run_folder.read(folder, "run").compile_cache == default
    cache = jax_settings.cache_folder(str(tmp_path / "cache"))
    assert cache is not None
    half, whole = (f"jit_f-{digit * 64}" for digit in "ab")
    names = ("thesis-cache", "jit_f-1234-cache", f"{half}-cache", f"{whole}-cache")
    for name in (*names, f"{whole}-atime"):
        (cache / name).touch()
        (cache.parent / name).touch()
    jax_settings._repair(cache)
    assert not (cache / f"{half}-cache").exists()
    assert len(list(cache.iterdir())) == 4
    assert len(list(cache.parent.iterdir())) == 6
