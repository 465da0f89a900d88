"""Files of run folders from anybody: none hangs, fills the memory, or is more than plain values."""

import json
import os
from pathlib import Path

import pytest
from foreign import METRIC, ROW, made, no_plain_file, refused
from tiny import call, only_line

from hybrid_rl import figures
from hybrid_rl.analysis import tables
from hybrid_rl.analysis.results import RunFolder
from hybrid_rl.cli import command
from hybrid_rl.errors import UsageError
from hybrid_rl.run.logs.log import RunLog
from hybrid_rl.tools.report import __main__ as report

READ = {"config.yaml": "settings", "metrics.jsonl": "rows", "summary.json": "summary"}


@pytest.fixture
def folder(tmp_path, monkeypatch) -> Path:
    """A run folder in the current one; see `made`."""
    return made(tmp_path, monkeypatch)


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
    if kind != "large":
        no_plain_file(file, kind)
    else:
        with file.open("wb") as data:
            data.truncate(10**8)  # one line of zeros, which takes no space
    run = RunFolder(folder)
    with pytest.raises(UsageError, match=f"{file}: "):
        getattr(run, READ[name])


@pytest.mark.parametrize("kind", ["link", "pipe"])
def test_a_resumed_run_writes_to_its_own_files_only(folder, kind):
    """A link in it does not cut a file elsewhere, and a pipe does not hang."""
    precious = Path("precious.txt")
    precious.write_text("all that I have\n")
    file = folder / "metrics.jsonl"
    file.unlink(missing_ok=True)
    if kind == "link":
        file.symlink_to(precious.absolute())
    else:
        os.mkfifo(file)
    with (
        pytest.raises(UsageError, match=r"metrics\.jsonl: is a link, or no plain file"),
        RunLog(folder, [0]) as log,
    ):
        log.write([ROW])
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
    file = folder / "metrics.jsonl"
    known = file.read_bytes() + bad + b"\n" + json.dumps(ROW | {"step": 9}).encode() + b"\n"
    file.write_bytes(known + b'{"after')
    with pytest.raises(UsageError, match="line 2 is no row of metrics"):
        _ = RunFolder(folder).rows
    with RunLog(folder, [0]) as log:
        (note,) = log.rewind(len(known), 9)
        assert file.read_bytes() == known
        log.write([ROW | {"step": 10}])
    assert "rows before step 9 are missing or edited" in note


@pytest.mark.parametrize(
    "text",
    [
        "[" * 100_000,
        "[1]",
        '{"final_eval": 3}',
        '{"seeds": "0"}',
        '{"git_commit": 5}',
        '{"diverged": [5]}',
    ],
    ids=range(6),
)
def test_a_damaged_summary_is_one_line(folder, capfd, text):
    (folder / "summary.json").write_text(text)
    assert call(lambda: command.run(report.main), f"run={folder}", "video=none") == 2
    assert only_line(capfd).startswith(f"hybrid_rl: {folder}/summary.json: ")


def test_a_run_without_a_finite_evaluation_has_no_curve(folder, capfd):
    (folder / "metrics.jsonl").write_text(json.dumps(ROW | {"eval/return": None}) + "\n")
    line = [f"runs={folder}", METRIC, "out=a.png"]
    assert call(lambda: command.run(figures.main), *line) == 2
    assert "metric=eval/return: has no finite value in these runs" in only_line(capfd)


HEAD = "exp_name,env_name,seed,metric,env_step,value\n"


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        ("a,pendulum,0,m,1,1e308\n", "must have rows of the metric m, env_name of pendulum"),
        ("a,pendulum,0,m,nan,1\n", "must have rows of the metric m, env_name of pendulum"),
        ("a,pendulum,0,m,1,nan\na,pendulum,0,m,1,2\n", ""),
        ("a,pendulum,0,m,1," + "x" * 2_000_000, "must have the columns"),
        ("a,pendulum," + "9" * 5000 + ",m,1,1\n", "must have the columns"),
        ("\ud800", "is not text"),
        ("device", "no plain file"),
        ("pipe", "no plain file"),
        ("large", "is larger than 32 MB"),
    ],
    ids=range(9),
)
def test_a_table_of_others_is_read_within_limits(tmp_path, rows, words):
    file = tmp_path / "theirs.csv"
    if rows in ("device", "pipe"):
        no_plain_file(file, rows)
    else:
        file.write_bytes((HEAD + rows).encode("utf-8", "surrogatepass"))
    if rows == "large":
        os.truncate(file, 10**9)
    if not words:
        assert [one.each.tolist() for one in tables.read(file, "m", ["pendulum"])] == [[[2]]]
        return
    with pytest.raises(UsageError, match=f"^others={file}: .*{words}"):
        tables.read(file, "m", ["pendulum"])
