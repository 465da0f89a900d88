"""Run folders from anybody: reading one runs no code of it, changes nothing, and always ends."""

from pathlib import Path

import pytest
from foreign import METRIC, changed, made, refused
from tiny import call, only_line

from hybrid_rl import evaluate, figures
from hybrid_rl.cli import command
from hybrid_rl.errors import UsageError
from hybrid_rl.run import folder as run_folder
from hybrid_rl.run.machine import jax_settings
from hybrid_rl.settings import build as config
from hybrid_rl.thesis.studies import recorded
from hybrid_rl.tools.report import __main__ as report

SYSTEM = {"_target_": "os.system", "command": "true"}


@pytest.fixture
def folder(tmp_path, monkeypatch) -> Path:
    """A run folder in the current one; see `made`."""
    return made(tmp_path, monkeypatch)


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
        *("os.system", "builtins.exec", "numpy.save", "antigravity.webbrowser", "__main__.x"),
        "hybrid_rl.run.files.integrity.write_text",
        "hybrid_rl.settings.build.Path",
        "hybrid_rl.types.Spec",
        "hybrid_rl.data.trained.save",
        "hybrid_rl.envs..os",
        "hybrid_rl.run.machine.provenance.subprocess.run",
        "hybrid_rl.envs.analytic.pendulum.jax.numpy.save",
        "hybrid_rl.envs.analytic.pendulum.dataclass",
        "hybrid_rl.envs.analytic.pendulum.Pendulum.reset",
        "hybrid_rl.scripts.bootstrap.main",
        "hybrid_rl.envs.analytic",
        "h\u0443brid_rl.envs.analytic.pendulum.Pendulum",  # a Cyrillic letter
        "os.system\n",
        "../os.system",
        "theirs.run.zz_evil.World",
        *("", None, 5, ["os.system"]),
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
        ({"extra": [[[SYSTEM]]]}, "extra.0.0.0._target_"),
        ({"extra": {"_args_": [SYSTEM]}}, "extra._args_.0._target_"),
        ({"expert": SYSTEM}, "expert._target_"),
    ],
    ids=lambda given: given if isinstance(given, str) else "",
)
def test_it_is_refused_wherever_it_stands(folder, keys, at):
    changed(folder, **keys)
    assert refused(folder).startswith(f"{folder}/config.yaml: {at}=os.system: is no part of")
    assert "=os.system: is no part" in refused(folder, recorded.read)


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


def test_words_that_a_terminal_or_matplotlib_obeys_are_shown_as_they_are(folder, capfd):
    """In a line of ours, and in a picture."""
    changed(folder, task="$\\undefined{x}$", algo="$y_{$")
    for main, out in ((report.main, "a.html"), (figures.main, "a.svg")):
        line = [f"run={folder}"] if main is report.main else [f"runs={folder}", METRIC]
        line.append(f"out={out}")
        assert call(lambda main=main: command.run(main), *line) == 0
    assert "$\\undefined{x}$" in Path("a.svg").read_text()
    capfd.readouterr()
    changed(folder, env={"_target_": "a\x1b]0;title\x07\nhybrid_rl: done"})
    assert call(lambda: command.run(evaluate.main), f"run={folder}") == 2
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
