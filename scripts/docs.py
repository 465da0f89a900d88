"""Build the documentation site in build/docs/html, with Sphinx and MyST-NB.

    python scripts/docs.py
    python scripts/docs.py fast     the same without running the notebooks
    python scripts/docs.py links    requests every external link instead; needs the network

The sources are README.md, CONTRIBUTING.md, CHANGELOG.md and docs/, at the same paths, so that
their links work on GitHub and on the site. A page per method is made from its YAML, the section of
docs/methods.md and the docstrings of its parts; the reference from all docstrings. The robots of
scripts/browser run on the first page. A warning, such as a link that leads nowhere, is an error.
`make docs` runs it in .venv-docs. With the environment variable GITHUB_REPOSITORY=OWNER/NAME, which
workflows on GitHub set, notebooks link to Binder.
"""

import importlib
import json
import os
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path
from textwrap import dedent

from omegaconf import DictConfig, OmegaConf

from hybrid_rl.errors import UsageError
from hybrid_rl.files.targets import targets
from hybrid_rl.settings import build as config
from hybrid_rl.settings import groups as conf_files
from scripts.browser import robots

ROOT = Path(__file__).resolve().parents[1]
BEGAN = time.monotonic()
BUILD = ROOT / "build" / "docs"
SOURCE, HTML, LINKS = BUILD / "source", BUILD / "html", BUILD / "links"
AT_TOP = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "CITATION.cff", "LICENSE")
TASKS = ("pendulum", "cart_double_pendulum", "quadcopter_se3", "sprk_sand", "contact_plane")
TASKS += ("sawyer_torque", "cart_swing_up", "lander", "no_dynamics", "halfcheetah")
PACKAGES = {  # page of the reference -> folders and modules
    "Commands": (
        *("train", "evaluate", "render", "figures"),
        *("demonstrate", "export", "list"),
    ),
    "From Python": ("outside", "robot"),
    "Configuration": ("settings", "files", "api"),
    "Data structures": ("types", "errors"),
    "Protocols": ("protocols",),
    "Core mathematics": ("core",),
    "Models, maps and features": ("models", "features", "beliefs", "networks"),
    "Policies and critics": ("policies", "critics"),
    "Objectives, targets and proposals": ("objectives", "targets", "proposals"),
    "Controllers": ("controllers",),
    "Learners and data": ("learners", "data"),
    "Training": ("training",),
    "Runs": ("run",),
    "Analysis": ("analysis",),
    "Tools": ("tools",),
    "Thesis": ("thesis.studies",),
    "Environments": ("envs",),
}
TREE = """
```{toctree}
:hidden:
:caption: CAPTION

PAGES
```
"""
FIRST = """# hybrid_rl

Trains robots from few environment steps: it learns a model, a policy that learns through the model,
and a planner that acts with both, in JAX and MuJoCo.

```{container} robots
![A trained humanoid runs](docs/humanoid.jpg)
```

* **[Train a robot](README.md)**: two commands, three to eight minutes on two cores
* **[Give a trained robot a new goal](docs/results/planning.md)**: it plans, nothing is trained
* **[Bring your own](docs/howto.md)**: robot, task, method or planner
"""  # the first page, on which robots run on a click
NOTEBOOKS = [f"docs/notebooks/{path.stem}" for path in sorted(ROOT.glob("docs/notebooks/*.ipynb"))]
PAGES = {  # of the side bar, by what a reader asks
    "How do I begin?": [
        *("First page <self>", "Getting started <README>", "docs/concepts"),
        "Which method? <docs/which_method>",
    ],
    "Can it do another task?": [
        *("New goals <docs/results/planning>", "Your own robot, task, method <docs/howto>"),
        *("docs/tasks", "CONTRIBUTING"),
    ],
    "How do I train and deploy?": [
        *("Train and show <docs/howto_train>", "To a robot <docs/howto_deploy>"),
        *("From Python <docs/python>", "docs/not_learning", "docs/faq", "docs/files"),
    ],
    "How well does it work?": ["docs/results/README", "docs/atlas"],
    "How does it work?": ["docs/methods", "All methods <methods/index>", *NOTEBOOKS],
    "What is it called?": [
        *("Reference <reference/index>", "CHANGELOG"),
        "Software paper <paper/paper>",
    ],
}


def copy() -> None:
    """The pages and what they link to."""
    shutil.rmtree(SOURCE, ignore_errors=True)
    shutil.copytree(ROOT / "docs", SOURCE / "docs", ignore=shutil.ignore_patterns("conf.py"))
    shutil.move(SOURCE / "docs" / "static", SOURCE / "static")
    shutil.copytree(ROOT / "paper", SOURCE / "paper")
    _, matter, text = (ROOT / "paper" / "paper.md").read_text(encoding="utf-8").split("---\n", 2)
    (title,) = re.findall("title: '(.*)'", matter)  # its sections are headings of the first level
    write("paper/paper.md", f"# {title}\n" + re.sub("(?m)^#", "##", text))
    for name in AT_TOP:
        shutil.copy(ROOT / name, SOURCE / name)
    trees = "".join(tree(caption, pages) for caption, pages in PAGES.items())
    write("index.md", FIRST + trees)
    if repository := os.environ.get("GITHUB_REPOSITORY"):
        for name in NOTEBOOKS:
            on_binder(f"{name}.ipynb", repository)
    results = SOURCE / "docs" / "results" / "README.md"
    above = str(PAGES)  # which stand higher in the side bar
    names = sorted(path.stem for path in results.parent.glob("*.md"))
    others = [name for name in names if f"docs/results/{name}" not in above]
    with results.open("a", encoding="utf-8") as page:
        page.write(tree("", others))
    atlas = SOURCE / "docs" / "atlas.md"
    text = atlas.read_text(encoding="utf-8")
    gallery = r"^\| \| \| \|\n(?:\|.*\n)+"
    framed = re.sub(gallery, r"```{container} atlas\n\g<0>```\n", text, flags=re.MULTILINE)
    atlas.write_text(framed, encoding="utf-8")


def on_binder(name: str, repository: str) -> None:
    """Put a link under the title of a notebook; .binder/ says what Binder installs."""
    path = SOURCE / name
    notebook = json.loads(path.read_text(encoding="utf-8"))
    url = f"https://mybinder.org/v2/gh/{repository}/HEAD?labpath={name}"
    title, *text = notebook["cells"][0]["source"]
    notebook["cells"][0]["source"] = [title, "\n", f"[Run it on Binder]({url})\n", *text]
    path.write_text(json.dumps(notebook), encoding="utf-8")


def tree(caption: str, pages: list[str]) -> str:
    """A hidden table of contents, which becomes a part of the side bar."""
    text = TREE.replace("CAPTION", caption).replace("PAGES", "\n".join(pages))
    return text if caption else text.replace(":caption: \n", "")


def write(name: str, text: str) -> None:
    """A page of the site."""
    path = SOURCE / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def methods() -> None:
    """A page per method, and their index."""
    page = (ROOT / "docs" / "methods.md").read_text(encoding="utf-8")
    sections: dict[str, str] = {}
    for heading, text in re.findall(r"^### (.+)\n\n((?:(?!##).*\n)+)", page, re.MULTILINE):
        sections |= dict.fromkeys(heading.split(", "), text)
    links = re.compile(r"\]\((?!https?:)")
    lines = []
    for name in conf_files.options("algo"):
        path = conf_files.file("algo", name)
        yaml = path.read_text(encoding="utf-8")
        about = " ".join(line[2:] for line in re.findall(r"^# (?!@).*", yaml, re.MULTILINE))
        text = links.sub("](../docs/", sections[name])
        write(
            f"methods/{name}.md",
            f"# {name}\n\n{about}\n\n## What it does\n\n{text}\n## Parts and equations\n\n"
            f"{''.join(map(described, parts(name)))}\n## Settings\n\n"
            f"`python -m hybrid_rl.train algo={name} --cfg job` prints all keys with their values. "
            f"`{path.relative_to(ROOT)}`:\n\n```yaml\n{yaml}```\n",
        )
        lines.append(f"* [{name}]({name}.md): {about}")
    names = [line.split("[")[1].split("]")[0] for line in lines]
    write("methods/index.md", "# All methods\n\n" + "\n".join(lines) + "\n" + tree("", names))


def parts(method: str) -> list[str]:
    """Classes of the method's controllers and learners, by their full names, without the world."""
    composed = composed_on_a_task(method)
    found = targets([OmegaConf.to_container(composed[k]) for k in ("controllers", "learners")])
    return list(dict.fromkeys(name for _, name in found if ".envs." not in name))


def composed_on_a_task(method: str) -> DictConfig:
    """The configuration of a method on the first task that it composes with."""
    for task in TASKS:
        try:
            return config.load([f"algo={method}", f"task={task}"])
        except (UsageError, ValueError):
            continue
    raise ValueError(f"algo={method}: fits none of {', '.join(TASKS)}")


def described(name: str) -> str:
    """A part: its name, the first paragraph of its module, and the equations after it."""
    module, _, title = name.rpartition(".")
    doc = importlib.import_module(module).__doc__ or ""
    first, *blocks = re.split(r"\n\s*\n", doc.strip("\n"))
    equations = next((block for block in blocks[:3] if block.startswith("    ")), "")
    quoted = re.sub(r"([*_|<>])", r"\\\1", re.sub(r"\s+", " ", first))
    text = f"**{{py:obj}}`{title} <{name}>`**: {quoted}\n\n"
    return text + (f"```text\n{dedent(equations)}\n```\n\n" if equations else "")


def reference() -> None:
    """A page per package, with all of its modules."""
    names = []
    for title, members in PACKAGES.items():
        page = re.sub(r"\W+", "_", title.lower())
        names.append(page)
        text = f"# {title}\n\n"
        for module in (name for member in members for name in modules(member)):
            text += f"## {module}\n\n```{{eval-rst}}\n.. automodule:: {module}\n```\n\n"
        write(f"reference/{page}.md", text)
    about = "Classes and functions by package, from their docstrings, with their source.\n"
    shown = tree("", names).replace(":hidden:\n", "")
    write("reference/index.md", f"# Reference\n\n{about}{shown}")


def modules(member: str) -> list[str]:
    """The modules of hybrid_rl.MEMBER, which is a package or a module."""
    folder = ROOT.joinpath("hybrid_rl", *member.split("."))
    if not folder.exists() and not folder.with_suffix(".py").exists():  # beside it in a checkout
        folder = ROOT.joinpath(*member.split("."))
    if not folder.is_dir():
        return [f"hybrid_rl.{member}"]
    inner = [path.relative_to(folder) for path in sorted(folder.rglob("*.py")) if shown(path)]
    ways = [".".join(("hybrid_rl", member, *path.with_suffix("").parts)) for path in inner]
    names = [way.removesuffix(".__init__") for way in ways]
    return [name for name in names if not name.endswith(".adapters.brax")]


def shown(path: Path) -> bool:
    """Whether the reference has a section of this file; of an `__init__.py`, if it holds code."""
    if path.name != "__init__.py":
        return not path.name.startswith("_")
    return bool(re.search(r"^(class|def) ", path.read_text(encoding="utf-8"), re.MULTILINE))


def build(builder: str, out: Path, *options: str) -> None:
    """Run Sphinx; the process ends if it fails."""
    command = [sys.executable, "-m", "sphinx", "--fail-on-warning", "--keep-going"]
    command += ["--fresh-env", "-c", str(ROOT / "docs"), "-d", str(BUILD / "doctrees")]
    command += ["--jobs", "2", "--builder", builder, *options]
    shutil.rmtree(out, ignore_errors=True)
    code = subprocess.run([*command, SOURCE, out], cwd=ROOT).returncode
    if code:
        sys.exit(code)


def main() -> None:
    """Copy, make and build."""
    if sys.argv[1:] not in ([], ["fast"], ["links"]):
        sys.exit("usage: python scripts/docs.py [fast | links]")
    still = ("-D", "nb_execution_mode=off") if sys.argv[1:] else ()
    say("copying the pages")
    copy()
    say("writing a page per method and the reference")
    methods()
    reference()
    say("Sphinx: five minutes of a core, with notebooks ten")
    if "links" in sys.argv:
        build("linkcheck", LINKS, *still)
        print(LINKS / "output.txt")
    else:
        build("html", HTML, *still)
        say("writing the robots of the first page")
        robots.write(HTML / "_static" / "robots" / "robots.js")
        print(HTML / "index.html")


def say(what: str) -> None:
    """A line about what comes next, with the seconds so far."""
    print(f"{time.monotonic() - BEGAN:4.0f} s: {what}", flush=True)


if __name__ == "__main__":
    main()
