"""Words that may not return to code, configuration and pages."""

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
GLOBS = ("hybrid_rl/**/*.py", "envs/**/*.py", "hydra_plugins/*.py", "tests/**/*.py", "scripts/*.py")
GLOBS += ("conf/**/*.yaml", "tests/conf/**/*.yaml", "*.md", "docs/**/*.md", "pyproject.toml")
WORDS = {  # regular expression -> what to write
    "told": "the verb for what happens: print, log, report",
    r"heed\w*": "use",
    "anew": "again",
    "alike": "uniformly, the same way",
    "nobody": "a sentence about what does happen",
    "none knows": "unknown",
    "said": "output, lines, values",
    "head[_ ]start": "pretrain",
    r"whiten\w*": "normalise",
    "imagining": "mbpo, imagined",
    "acquirer": "goal",
    r"climb\w*": "gradient ascent, target_density",
    r"likelihood\.\w+=|\$\{likelihood\}|@likelihood": "model_learner",
    r"look(s|ed|ing)?(?![ _](at|for|like|up)\b)": "prepare, consult, search",
    r"(?<!\bin )(?<!\btakes )(?<!\btake )(?<!decimal )places?(?! of\b)": "position, folder, index",
}
PATTERN = re.compile(rf"(?<![A-Za-z])({'|'.join(WORDS)})(?![A-Za-z])", re.IGNORECASE)
CODE = re.compile(r"`[^`\n]*`")  # quoted on a page


def test_words_that_were_replaced_do_not_return() -> None:
    """The failure names file, line and word; WORDS names what to write instead."""
    lines = []
    for file in sorted({path for glob in GLOBS for path in ROOT.glob(glob)} - {Path(__file__)}):
        text = file.read_text(encoding="utf-8")
        for number, line in enumerate(text.splitlines(), 1):
            line = CODE.sub("", line) if file.suffix == ".md" else line
            lines += [f"{file}:{number}: {match[0]}" for match in PATTERN.finditer(line)]
    assert not lines, "\n".join(lines)
