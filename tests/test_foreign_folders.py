"""Files of run folders from anybody: none hangs, fills the memory, or is more than plain values."""

import json
import os
from pathlib import Path

import pytest
from foreign import METRIC, ROW, made, no_plain_file, refused
from tiny import refusal

from hybrid_rl import __version__, figures
from hybrid_rl.analysis import tables
from hybrid_rl.analysis.results import RunFolder
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
        ("a: !!python/object/apply:os.system [x]\n", "is no YAML: could not determine"),
        ("task: ${oc.env:HOME}\n", "task=${oc.env:HOME}: is an interpolation"),
        ('task: [{a: ["${a}"]}]\n', "is an interpolation; it must be a plain value"),
        ("x: &a [*a]\n", "is nested too deeply"),
        ("a: 1\n---\nb: 2\n", "is no YAML: expected a single document"),
        ("- 1", "is no YAML"),
    ],
)
def test_yaml_that_is_more_than_plain_values_is_refused(folder, text, words):
    (folder / "config.yaml").write_text(f"version: {__version__}\n{text}")
    assert words in refused(folder)


@pytest.mark.parametrize("name", ["config.yaml", "metrics.jsonl", "summary.json"])
@pytest.mark.parametrize("kind", ["pipe", "device", "folder"])
def test_what_is_no_plain_file_is_not_read(folder, name, kind):
    """So nothing hangs."""
    file = folder / name
    file.unlink()
    no_plain_file(file, kind)
    run = RunFolder(folder)
    with pytest.raises(UsageError, match=f"{file}: "):
        getattr(run, READ[name])


def test_a_pipe_does_not_hang_a_resumed_run(folder):
    (folder / "metrics.jsonl").unlink()
    os.mkfifo(folder / "metrics.jsonl")
    refused = pytest.raises(UsageError, match=r"metrics\.jsonl: is a link, or no plain file")
    with refused, RunLog(folder, [0]) as log:
        log.write([ROW])


BAD_ROWS = [
    b'{"step": 5, "wall_s": 1.0}',
    b'{"step": 5, "seed": [0], "wall_s": 1.0}',
    b'{"step": 5, "seed": 0, "wall_s": 1.0, "eval/return": "high"}',
    b"7",
    b"\xff",
]


@pytest.mark.parametrize("bad", BAD_ROWS, ids=range(len(BAD_ROWS)))
def test_a_damaged_row_is_named(folder, bad):
    with (folder / "metrics.jsonl").open("ab") as file:
        file.write(bad + b"\n")
    with pytest.raises(UsageError, match="line 2 is no row of metrics"):
        _ = RunFolder(folder).rows


def test_a_damaged_summary_is_one_line(folder, capfd):
    (folder / "summary.json").write_text("{1}")
    line = refusal(capfd, f"run={folder}", "video=none", of=report.main)
    assert line.startswith(f"hybrid_rl: {folder}/summary.json: ")


def test_a_run_without_a_finite_evaluation_has_no_curve(folder, capfd):
    (folder / "metrics.jsonl").write_text(json.dumps(ROW | {"eval/return": None}) + "\n")
    line = refusal(capfd, f"runs={folder}", METRIC, "out=a.png", of=figures.main)
    assert "metric=eval/return: has no finite value in these runs" in line


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
