"""Sphinx's configuration of the documentation site; scripts/docs.py runs it."""

import inspect
import re
from pathlib import Path

from docutils import nodes
from nbclient import NotebookClient
from sphinx.util.osutil import relative_uri

import hybrid_rl

project = "hybrid_rl"
release = version = hybrid_rl.__version__
copyright = "the hybrid_rl contributors"
extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.viewcode"]

html_theme = "furo"
html_title = "hybrid_rl"
html_static_path = ["static"]  # relative to this file
html_css_files = ["site.css"]
html_js_files = [(name, {"defer": "defer"}) for name in ("site.js", "robots/start.js")]
html_show_sphinx = False
html_favicon = "static/icon.svg"
html_theme_options = {"top_of_page_buttons": []}
highlight_language = "bash"
exclude_patterns = ["docs/static"]

myst_heading_anchors = 4  # GitHub's anchors, as the links of the pages have them
myst_enable_extensions = ["dollarmath"]
nb_execution_mode = "cache"
nb_execution_raise_on_error = True
nb_execution_timeout = 600  # [s] a cell, on a busy machine
nb_execution_cache_path = str(Path(__file__).parents[1] / "build" / "docs" / "notebooks")
NotebookClient.extra_arguments.default_args = (["--log-level=ERROR"],)  # else each kernel warns

linkcheck_timeout = 30  # [s]
linkcheck_retries = 3
linkcheck_anchors = False  # many sites make theirs in the browser

autodoc_member_order = "bysource"
autodoc_class_signature = "separated"
autodoc_typehints = "none"
autodoc_default_options = {"members": True, "exclude-members": "__init__, __new__"}
maximum_signature_line_length = 88
SECTIONS = ("Args:", "Raises:", "Returns:", "Yields:")
FIELD = re.compile(r"^ {4}(\w+): (.+?)(?: = (.+?))?  # (.+)$", re.MULTILINE)


def escaped(line: str) -> str:
    """A line of a docstring, plain text with `code`, as reStructuredText."""
    parts = re.split(r"`+([^`]+)`+", line)
    text = [re.sub(r"([\\*_|`])", r"\\\1", part) for part in parts[::2]]
    code = [f"``{part}``" for part in parts[1::2]]
    return "".join(a + b for a, b in zip(text, [*code, ""], strict=True))


def as_rst(lines: list[str]) -> list[str]:
    """A docstring: paragraphs are escaped, indented blocks (equations, tables) kept as they are."""
    result: list[str] = []
    blocks = re.split(r"\n\s*\n", "\n".join(lines).strip("\n"))
    in_section = False
    for block in blocks:
        rows = block.split("\n")
        in_section = rows[0].strip() in SECTIONS or (in_section and rows[0].startswith(" "))
        if in_section:
            result += [row if row.strip() in SECTIONS else escaped(row) for row in rows]
        elif all(row.startswith("    ") for row in rows):
            result += [".. code-block:: text", "", *rows]
        else:
            for row in rows:
                indented = row.startswith("    ")
                result += [f"| {escaped(row.strip())}" if indented else escaped(row)]
        result.append("")
    return result


def fields(part: type) -> list[str]:
    """The commented fields of a dataclass or a named tuple, as a list."""
    try:
        source = inspect.getsource(part)
    except (OSError, TypeError):
        return []
    found = FIELD.findall(source.split("\n    def ")[0])
    entries = [
        f"* ``{name}: {kind}{f' = {value}' if value else ''}``: {escaped(comment)}"
        for name, kind, value, comment in found
    ]
    return ["", *entries, ""] if entries else []


def convert(_app, what, _name, obj, _options, lines):  # noqa: ANN001, ANN201
    """Replace the lines of a docstring by reStructuredText, before Napoleon reads them."""
    lines[:] = as_rst(lines)
    if what == "class":
        lines += fields(obj)


def skip(_app, _what, _name, obj, skipped, _options):  # noqa: ANN001, ANN201
    """Leave out the fields of named tuples, which `fields` lists."""
    return True if type(obj).__name__ == "_tuplegetter" else skipped


def link_pictures(app, tree, page):  # noqa: ANN001, ANN201
    """Make each picture that is no link a link to its file, which is as large as it was drawn."""
    for picture in list(tree.findall(nodes.image)) if app.builder.format == "html" else ():
        if not isinstance(picture.parent, nodes.reference) and picture["uri"] in app.env.images:
            file = f"{app.builder.imagedir}/{app.env.images[picture['uri']][1]}"
            to = relative_uri(app.builder.get_target_uri(page), file)
            picture.replace_self(
                nodes.reference("", "", picture.deepcopy(), refuri=to, internal=True)
            )


def setup(app):  # noqa: ANN001, ANN201
    """Register what changes docstrings and pictures."""
    app.connect("doctree-resolved", link_pictures)
    app.connect("autodoc-skip-member", skip)
    app.connect("autodoc-process-docstring", convert, priority=400)
