"""The report: one page with everything in it, about one run or several."""

import base64
import json
import re
from functools import partial
from html.parser import HTMLParser

import pytest
from tiny import call_command, refusal, write_run

import hybrid_rl as hr
from hybrid_rl.tools.report import __main__ as report

CONFIG = "task: hopper\nalgo: {algo}\nseed: 0\nlearners:\n  policy:\n    rate: {rate}\nenv: {{}}\n"
FILM = bytes(range(256))
VOID = {"meta", "link", "br", "img", "use", "path"}


class Page(HTMLParser):
    """Text by tag, attributes, and tags that are left open."""

    def __init__(self, text):
        super().__init__()
        self.open, self.attributes, self.texts = [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.attributes += [(tag, name, value) for name, value in attributes]
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        if tag not in VOID:
            assert self.open.pop() == tag

    def handle_data(self, data):
        self.texts.append((self.open[-1] if self.open else "", data.strip()))

    def of(self, tag):
        return [text for name, text in self.texts if name == tag and text]


def write(folder, algo="sac", rate=0.1, last="planner/handed_over", **summary):
    """A run folder."""
    line = {step: [0.01 * step, 0.01 * step + 1] for step in (1000, 2000, 3000)}
    values = {"task": "hopper", "algo": algo, "seeds": [0, 1], "total_steps": 3000}
    values |= {"finished": True, "final_eval": [30.0, 31.0], "wall_s": 61.2}
    values |= {"git_commit": "0123456789abcdef", "versions": {"jax": "0.10.2"}} | summary
    settings = CONFIG.format(algo=algo, rate=rate)
    return write_run(folder, settings, {"eval/return": line, last: line}, **values)


@pytest.fixture
def runs(tmp_path):
    """Two runs; one learner of the second ended."""
    first = write(tmp_path / "a<b>")
    returns = [[1.0, 3.0], [5.0, 5.0]]
    values = {"mode": "full", "step": 3000, "seeds": [0, 1], "returns": returns}
    (first / "evaluation_full.json").write_text(json.dumps(values))
    (first / "video.mp4").write_bytes(FILM)
    failed = {"seed": 1, "step": 2500, "quantity": "sac/q"}
    second = write(tmp_path / "second", rate=0.2, diverged=[failed], versions={"jax": "0.11.2"})
    return first, second


main = partial(call_command, report.main)


def test_a_page_about_two_runs_holds_everything(runs, tmp_path, capsys):
    first, second = runs
    out = tmp_path / "page.html"
    assert main(f"run={first},{second}", f"out={out}") == 0
    assert capsys.readouterr().out.startswith(f"{out}: 2 runs, ")
    text = out.read_text()
    page = Page(text)
    assert not page.open
    assert page.of("h1") == ["2 runs: sac on hopper"]
    headings = ["Runs", "Video", "Return", "Safety", "Evaluation", "Configuration"]
    assert page.of("h2") == [*headings, "Machine and versions"]
    cells = page.of("td")
    assert {str(first), "diverged: seed 1 at 2,500 (sac/q)", "finished", "0:01:01"} <= {*cells}
    at = cells.index("learners.policy.rate")
    assert cells[at + 1 : at + 3] == ["0.1", "0.2"]
    at = cells.index("full")
    assert cells[at : at + 8] == ["full", "3,000", "0", "2", "2", "1", "1", "3"]
    assert cells[cells.index("jax") + 1 :][:2] == ["0.10.2", "0.11.2"]
    assert "0123456789" in cells
    assert CONFIG.format(algo="sac", rate=0.2).strip() in page.of("pre")
    (film,) = [v for tag, name, v in page.attributes if (tag, name) == ("video", "src")]
    assert base64.b64decode(film.partition(",")[2]) == FILM


def test_a_page_needs_no_other_file_and_its_names_are_unique(runs):
    """It opens offline, and the colours of its curves are those of its style."""
    page = Page(report.page(hr.runs(f"{runs[0]},{runs[1]}")))
    loaded = ("src", "href", "xlink:href", "srcset", "poster", "data", "action")
    outside = [value for _, name, value in page.attributes if name in loaded]
    assert all(value.startswith(("#", "data:")) for value in outside)
    names = [value for _, name, value in page.attributes if name == "id"]
    assert len(names) == len({*names})
    assert {value[1:] for _, name, value in page.attributes if name == "xlink:href"} <= {*names}
    drawn = " ".join(v for _, name, v in page.attributes if name == "style")
    assert {"var(--c0)", "var(--grid)"} <= {*re.findall(r"var\([^)]*\)", drawn)}
    assert not re.search(r"#[0-9a-f]{6}", drawn)
    assert "script" not in {tag for tag, _, _ in page.attributes}


def test_a_method_has_one_colour_and_no_line_about_metrics_of_others(tmp_path):
    write(tmp_path / "first")
    write(tmp_path / "second", algo="ddpg", last="safety/limit")
    text = report.page(hr.runs(str(tmp_path)))
    alone = text.partition('aria-label="safety/limit hopper"')[2].partition("</svg>")[0]
    assert "var(--c1)" in alone
    assert "var(--c0)" not in alone
    assert ": no " not in text


def test_seeds_make_a_band_and_the_numbers_are_those_of_the_rows(runs):
    text = report.page(hr.runs(str(runs[0])))
    assert Page(text).of("h1") == ["sac on hopper"]
    cells = Page(text).of("td")
    at = cells.index("eval/return")
    assert cells[at + 1 : at + 4] == ["hopper", "sac", "2"]
    assert "2 (seeds 0, 1)" in cells
    assert report._span([3]) == "1 (seed 3)"
    assert report._span([0, 1, 2]) == "3 (seeds 0 to 2)"
    area = (15 + 25) / 2 + 0.5  # of seeds 0 and 1, which is 1 above
    ends = cells[at + 4].split()[0], cells[at + 5].split()[0]
    assert ends == ("30.5", f"{area:.4g}")
    assert cells[at + 4].endswith("[30, 31]")


def test_what_is_missing_or_damaged_is_one_line(runs, tmp_path, capfd):
    first, second = runs
    assert f"evaluate run={second}" in report.page(hr.runs(str(second)), video=False)
    assert "None: " in report.page(hr.runs(str(second)))  # nothing to draw
    (first / "evaluation_full.json").write_text('{"seeds": [0]}')
    for given, line in (
        (f"run={tmp_path / 'none'}", "run=" + str(tmp_path / "none") + ": no run there"),
        (f"run={first}", "evaluation_full.json: is no evaluation that `evaluate` wrote"),
        (f"run={tmp_path}", "evaluation_full.json: is no evaluation that `evaluate` wrote"),
        (f"run={second} out=a.pdf", "out=a.pdf: must end in .html"),
        (f"run={second} video=gif", "video=gif: choose one of auto, none"),
    ):
        assert line in refusal(capfd, *given.split(), of=report.main)
