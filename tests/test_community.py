"""The table of docs/results/community.md, which others extend by a file."""

import json
import re
from functools import partial

import pytest
from tiny import call_command, refusal, write_run

from hybrid_rl.tools.report import __main__ as report
from scripts.pages import __main__ as pages
from scripts.pages import community

main = partial(call_command, report.main)
PAGE = community.RESULTS / "community.md"
ROW = {"task": "hop", "steps": 9, "seeds": [0, 1], "returns": [2, 4.0], "decisions_per_s": None}
ENTRY = {"name": "a", "link": "https://a.org/b", "machine": "m", "rows": [ROW]}


def test_every_file_has_its_fields_and_its_lines_on_the_page():
    text = PAGE.read_text(encoding="utf-8")
    for path in community.FOLDER.iterdir():
        assert path.suffix == ".json"
        entry = community.read(path)
        assert text.count(f"| [{entry['name']}](") >= len(entry["rows"]), path.name
    assert community.table() in text, "`make pages` writes it"
    assert PAGE in pages.pages()


def test_the_example_of_the_page_is_an_entry(tmp_path):
    text = re.findall(r"```json\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)[0]
    tmp_path.joinpath("example.json").write_text(text)
    assert community.read(tmp_path / "example.json")["rows"][0]["task"] == "HalfCheetah-v5"


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"link": "http://a.org"}, "link=http"),
        ({"name": "a | b"}, "name"),
        ({"extra": 1}, "keys"),
        ({"rows": [{**ROW, "seeds": [0]}]}, "one return for each seed"),
        ({"rows": [{**ROW, "returns": [1, float("nan")]}]}, "finite"),
        ({"rows": [{**ROW, "returns": "hybrid_hopper/none@1"}]}, "none"),
        ({"rows": [{key: ROW[key] for key in ROW if key != "task"}]}, "task"),
    ],
)
def test_a_wrong_field_is_an_error_that_names_file_and_field(wrong, words, tmp_path):
    path = tmp_path / "mine.json"
    path.write_text(json.dumps(ENTRY | wrong))
    with pytest.raises(ValueError, match=rf"^mine\.json: .*{words}"):
        community.read(path)


def test_the_best_return_of_a_task_comes_first(tmp_path, monkeypatch):
    monkeypatch.setattr(community, "FOLDER", tmp_path)
    better = {**ENTRY, "name": "b", "rows": [{**ROW, "returns": [5, 7], "decisions_per_s": 1234}]}
    for name, entry in (("1", ENTRY), ("2", better)):
        tmp_path.joinpath(f"{name}.json").write_text(json.dumps(entry))
    _, _, *rows = community.table().splitlines()
    assert rows == [
        "| hop, 9 | [b](https://a.org/b) | 2 | 6 [5, 7] | 1,234 | m |",
        "|  | [a](https://a.org/b) | 2 | 3 [2, 4] |  | m |",
    ]


def write(folder, algo, device="cpu: one"):
    """A run of two seeds; the second was not evaluated at the end."""
    returns = {"eval/return": {10: [10, 11], 20: [20, 21], 30: [99]}}
    values = {"task": "hopper", "algo": algo, "seeds": [0, 1], "total_steps": 30, "device": device}
    settings = f"task: hopper\nalgo: {algo}\nseed: 0\n"
    return write_run(folder, settings, returns, env_steps_per_s=51.26, **values)


def test_the_report_of_a_run_is_an_entry_but_for_its_link(tmp_path):
    run, out = write(tmp_path / "run", "sac"), tmp_path / "mine.json"
    assert main(f"run={run}", f"out={out}") == 0
    with pytest.raises(ValueError, match="link"):
        community.read(out)
    entry = json.loads(out.read_text()) | {"link": "https://a.org"}
    out.write_text(json.dumps(entry))
    assert (entry["name"], entry["machine"]) == ("sac", "cpu: one")
    (row,) = community.read(out)["rows"]
    assert (row["task"], row["steps"], row["decisions_per_s"]) == ("hopper", 20, 51.3)
    assert (row["seeds"], list(row["returns"])) == ([0, 1], [20, 21])


def test_an_entry_is_of_one_method_on_one_machine(tmp_path, capfd):
    write(tmp_path / "runs" / "a", "sac")
    for algo, device, words in (("ddpg", "cpu: one", "ddpg, sac"), ("sac", "gpu: b", "gpu: b")):
        write(tmp_path / "runs" / algo / "b", algo, device)
        given = f"run={tmp_path}/runs/a,{tmp_path}/runs/{algo}", f"out={tmp_path}/m.json"
        assert words in refusal(capfd, *given, of=report.main)
        assert not (tmp_path / "m.json").exists()
