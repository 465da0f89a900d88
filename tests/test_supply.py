"""What the project takes from others: pinned, checked by hashes, and named with its licence."""

import re
import tomllib
from pathlib import Path

import pytest
import yaml
from packaging.requirements import Requirement

from hybrid_rl import __version__
from scripts import bootstrap

ROOT = Path(__file__).resolve().parents[1]
ASSETS = ROOT / "envs" / "assets"
WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))
RECIPE = yaml.safe_load((ROOT / "recipe" / "recipe.yaml").read_text(encoding="utf-8"))
CONDA = {  # name on PyPI -> on conda-forge, where they differ
    "mujoco": "mujoco-python",
    "flatbuffers": "python-flatbuffers",
    "matplotlib": "matplotlib-base",
    "tensorboardX": "tensorboardx",
}
OF_EXTRAS = {"imageio[pyav]": "av"}  # conda has no extras: what one brings


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.stem)
def test_a_workflow_takes_actions_by_commit(path):
    """A tag or a branch may be moved to other code."""
    text = path.read_text(encoding="utf-8")
    used = re.findall(r"uses: (.*)", text)
    assert used
    pinned = re.compile(r"[\w-]+/[\w-]+@[0-9a-f]{40} # v\d+\.\d+\.\d+")
    assert [action for action in used if not pinned.fullmatch(action)] == []
    assert "pipx" not in text


def test_extras_are_installed_in_quotes():
    """On the pages and in docstrings; zsh reads brackets as a pattern. Messages have `install`."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    pages = [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]
    files = [file for top in ("hybrid_rl", "envs") for file in (ROOT / top).rglob("*.py")]
    texts = [file.read_text(encoding="utf-8") for file in (*pages, *files)]
    found = [one for text in texts for one in re.findall(r"pip install ((?:-e )?\S+\[\S+)", text)]
    quoted = [re.match(r'(?:-e )?"(?:\.|hybrid_rl)\[([\w,{}]+)\]"', one) for one in found]
    assert len(found) > 10
    assert [one for one, match in zip(found, quoted, strict=True) if match is None] == []
    named = {name for match in quoted if match for name in match[1].split(",")}
    assert named - {"{extra}"} <= set(project["optional-dependencies"])


@pytest.mark.parametrize("name", ["pip", "setuptools"])
def test_the_tools_of_the_set_up_are_locked_with_hashes(name):
    lines = bootstrap.locked(name).splitlines()
    assert re.fullmatch(rf"{name}==[\d.]+ \\", lines[0])
    assert all(re.fullmatch(r" +--hash=sha256:[0-9a-f]{64}( \\)?", line) for line in lines[1:])


def test_the_set_up_checks_the_hash_of_all_that_it_installs(tmp_path, monkeypatch):
    """Also of what builds a source distribution, which comes first and is used as it is."""
    lines = []
    monkeypatch.setattr(bootstrap, "VENV", tmp_path)
    for name in ("STAMP", "UNFINISHED"):
        monkeypatch.setattr(bootstrap, name, tmp_path / name)
    monkeypatch.setattr(bootstrap, "works", lambda *_: True)
    monkeypatch.setattr(bootstrap, "make_venv", lambda: None)
    monkeypatch.setattr(bootstrap.subprocess, "run", lambda line, check: lines.append(line))
    bootstrap.install()
    tools, rest, ours = lines
    assert all("--no-build-isolation" in line for line in lines)
    assert "--require-hashes" in tools
    assert "--require-hashes" in rest
    assert Path(tools[-1]).read_text() == bootstrap.locked("setuptools")
    assert rest[-1] == str(bootstrap.LOCK)
    assert "--no-deps" in ours


def test_every_model_is_named_with_its_source():
    text = (ASSETS / "NOTICES.md").read_text(encoding="utf-8")
    assert sorted(re.findall(r"`(\w+\.xml)`", text)) == sorted(p.name for p in ASSETS.glob("*.xml"))


def by_name(lines):
    """Name -> versions, of requirements as both packagers write them."""
    each = [Requirement(line) for line in lines]
    return {one.name: one.specifier for one in each}


def test_the_conda_recipe_requires_what_the_project_does():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    wanted = [f"python {project['requires-python']}"]
    for one in map(Requirement, project["dependencies"]):
        wanted.append(f"{CONDA.get(one.name, one.name)} {one.specifier}")
        wanted += [OF_EXTRAS[f"{one.name}[{extra}]"] for extra in sorted(one.extras)]
    least = RECIPE["context"]["python_min"]
    given = [line.replace("${{ python_min }}", least) for line in RECIPE["requirements"]["run"]]
    assert by_name(given) == by_name(wanted)


def test_version_recipe_changelog_and_citation_agree():
    """A release is in the changelog and in the citation; between two, the newest one is."""
    changes = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    newest, date = re.findall(r"^## \[([\d.]+)\] - (\S+)$", changes, re.M)[0]
    assert citation["version"] == newest
    assert str(citation["date-released"]) == date
    assert RECIPE["context"]["version"] == __version__
    assert __version__ == newest or (".dev" in __version__ and "\n## [Unreleased]\n" in changes)
