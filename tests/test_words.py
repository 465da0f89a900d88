"""Words that may not return to code, configuration and pages."""

import re
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
CODE = ("hybrid_rl/**/*.py", "envs/**/*.py", "hydra_plugins/*.py", "tests/**/*.py", "scripts/*.py")
TEXT = ("conf/**/*.yaml", "tests/conf/**/*.yaml", "*.md", "docs/**/*.md", "pyproject.toml")
PICTURES = re.compile(
    r"hybrid_rl/(analysis|render|tools)|thesis|tests/(analysis|test_figures|test_render)"
)
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
    r"explorer\.level": "guarded.level",
    r"likelihood\.\w+=|\$\{likelihood\}|@likelihood": "model_learner",
    r"look(s|ed|ing)?(?![ _](at|for|like|up)\b)": "prepare, consult, search",
    r"(?<!\bin )(?<!\btakes )(?<!\btake )(?<!decimal )places?(?! of\b)": "position, folder, index",
    r"rows(?=\s*=\s*(scan_)?unroll)": "unroll",
}
QUOTED = {  # file -> regular expression of names that are quoted there
    "CHANGELOG.md": r"`[^`]*`",
    "docs/results/chapter6.md": r"`explorer\.level`|\bexplorer\.level=\d+",
}
IN_CODE = {r"def _?once(?=\()": "what the function does once"}
IN_CODE_WITHOUT_PICTURES = {r"colour(s|ed)?(?=\s*[=(,):\]])": "correlation (noise), denormalise"}


def pattern_of(words: dict[str, str]) -> re.Pattern[str]:
    """Any of the words, whole, in a text or in an identifier with underscores."""
    return re.compile(rf"(?<![A-Za-z])({'|'.join(words)})(?![A-Za-z])", re.IGNORECASE)


def texts() -> Iterator[tuple[str, str, re.Pattern[str]]]:
    """Every file: its path, its text, and the pattern of what it may not contain."""
    text, code = pattern_of(WORDS), pattern_of(WORDS | IN_CODE)
    most = pattern_of(WORDS | IN_CODE | IN_CODE_WITHOUT_PICTURES)
    for globs in (CODE, TEXT):
        for file in sorted({path for glob in globs for path in ROOT.glob(glob)}):
            name, content = file.relative_to(ROOT).as_posix(), file.read_text(encoding="utf-8")
            if file == Path(__file__).resolve():
                continue
            if name in QUOTED:
                content = re.sub(QUOTED[name], lambda quote: "\n" * quote[0].count("\n"), content)
            pattern = text if globs is TEXT else code if PICTURES.match(name) else most
            yield name, content, pattern


def found_in(name: str, content: str, pattern: re.Pattern[str]) -> list[str]:
    """A line for every word of the pattern in a file."""
    return [
        f"{name}:{content.count(chr(10), 0, match.start()) + 1}: {match[0]}"
        for match in pattern.finditer(content)
    ]


def test_words_that_were_replaced_do_not_return() -> None:
    """The failure names file, line and word; WORDS names what to write instead."""
    lines = [line for file in texts() for line in found_in(*file)]
    assert not lines, "\n".join(lines)


def test_the_list_finds_its_words_and_spares_others() -> None:
    """In sentences and in identifiers; not in other words or fixed phrases."""
    pattern = pattern_of(WORDS | IN_CODE | IN_CODE_WITHOUT_PICTURES)
    bad = "as told|said = 1|test_it_is_told|two places|self.place(x)|def look(self)|colour = 0.5"
    for text in bad.split("|"):
        assert found_in("file", text, pattern) == [f"file:1: {pattern.search(text)[0]}"]
    good = (
        "in place|jax.device_put|Hydra looks for it|instead|placed|replaces|aside|colour of a line"
    )
    assert not [text for text in good.split("|") if pattern.search(text)]
