"""Overrides of the user: what they name, and how Hydra takes them.

Values are forced (`++KEY=VALUE`): a key need not stand in a YAML file, as fields of parts have the
defaults of their classes. `settings.complete.require` refuses a key that nothing reads.
"""

import re
from collections.abc import Collection, Iterable, Mapping
from typing import Any

from hydra.core.override_parser.overrides_parser import OverridesParser
from hydra.core.override_parser.types import Override, Quote, QuotedString
from omegaconf import OmegaConf

from hybrid_rl.errors import NO_WORDS, UsageError


def listed(texts: Any) -> list[str]:
    """The words of a command; UsageError for anything else, such as an environment."""
    several = isinstance(texts, Iterable) and not isinstance(texts, str | Mapping)
    words = [*texts] if several else [texts]
    flaws = [word for word in words if not isinstance(word, str)]
    if isinstance(texts, str):
        line = f'"{texts}": give a list, {texts.split()}'
    elif flaws:
        line = f"{getattr(flaws[0], '__name__', type(flaws[0]).__name__)}: {NO_WORDS}"
    else:
        return words
    raise UsageError(line)


def parse(texts: Iterable[str]) -> list[Override]:
    """Overrides of the configuration, those of Hydra's own keys left out."""
    parser = OverridesParser.create()
    return [parser.parse_override(text) for text in texts if not name(text).startswith("hydra")]


def of_job(hydra: Any) -> list[str]:
    """The overrides of a job as typed, by Hydra's configuration; `a=${b}` stays as it is."""
    return typed(plain(hydra.overrides.task))


def name(text: str) -> str:
    """The key or the group of an override."""
    return text.lstrip("+~").partition("=")[0]


def typed_values(texts: Iterable[str]) -> dict[str, str]:
    """Overrides as key -> value, as they were typed."""
    return {name(text): text.partition("=")[2] for text in listed(texts)}


def quoted(value: str) -> str:
    """A value as it is typed in an override, in quotes if Hydra would read it as something else."""
    if re.fullmatch(r"[\w./-]+", value) and value_of(value) == value:
        return value
    return QuotedString(value, Quote.double).with_quotes()


def is_swept(text: str) -> bool:
    """Whether an override is sweep.KEY=[A,B], of learners in one program."""
    return text.lstrip("+").startswith("sweep.")


def is_group(text: str, groups: Collection[str]) -> bool:
    """Whether an override chooses a file of conf/, or is one of Hydra's own keys."""
    key = name(text).partition("@")[0]
    return "@" in name(text) or key in groups or key.startswith("hydra")


def forced(texts: Iterable[str], groups: Collection[str]) -> list[str]:
    """The overrides as Hydra takes them.

    A value may have a key that no YAML file has; the choice of a group is a name, also `null`.
    """

    def written(text: str) -> str:
        if "=" not in text or text.startswith(("~", "-")) or name(text).startswith("hydra"):
            return text  # an option, a key that is left out, or one of Hydra's
        if is_group(text, groups):
            return re.sub(r"=(null|true|false|[\d.]+)$", r'="\1"', text)
        return f"++{text.lstrip('+')}"

    return list(map(written, texts))


def typed(texts: Iterable[str]) -> list[str]:
    """Forced overrides as the user typed them."""
    return [text.removeprefix("++") for text in texts]


def plain(node: Any, resolve: bool = False) -> Any:
    """A configuration as dicts and lists; its interpolations stay text, unless they resolve."""
    return OmegaConf.to_container(node, resolve=resolve)


def value_of(text: str) -> Any:
    """A value as Hydra reads it."""
    try:
        return OverridesParser.create().parse_override(f"a={text}").value()
    except Exception:
        return text
