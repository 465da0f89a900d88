"""Overrides of the user: what they name, and how Hydra takes them.

Values are forced (`++KEY=VALUE`): a key need not stand in a YAML file, as fields of parts have the
defaults of their classes. `settings.complete.refusal` is the line about a key that nothing reads.
"""

import re
from collections.abc import Collection, Iterable, Sequence
from typing import Any

from hydra.core.override_parser.overrides_parser import OverridesParser
from hydra.core.override_parser.types import Override, Quote, QuotedString
from omegaconf import DictConfig, OmegaConf

PLAIN = re.compile(r"(?s)(?:node `|override )([^`=]+).*(?:not a container|merge DictConfig)")
TYPED = "key=value, text as 'key=\"TEXT\"'"
SHOW = "`python -m hybrid_rl.train --cfg job` shows all of them"


def parse(texts: Iterable[str]) -> list[Override]:
    """Overrides of the configuration, those of Hydra's own keys left out."""
    parser = OverridesParser.create()
    return [parser.parse_override(text) for text in texts if not name(text).startswith("hydra")]


def of_job(hydra: Any) -> list[str]:
    """The overrides of a job as typed, by Hydra's configuration; `a=${b}` stays as it is."""
    texts: Any = OmegaConf.to_container(hydra.overrides.task, resolve=False)
    return typed(texts)


def name(text: str) -> str:
    """The key or the group of an override."""
    return text.lstrip("+~").partition("=")[0]


def typed_values(texts: Iterable[str]) -> dict[str, str]:
    """Overrides as key -> value, as they were typed."""
    return {name(text): text.partition("=")[2] for text in texts}


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
    """The overrides as Hydra takes them: a value may have a key that no YAML file has."""

    def is_value(text: str) -> bool:  # no option and its word, and no key that is left out
        return "=" in text and not text.startswith(("~", "-")) and not is_group(text, groups)

    return [f"++{text.lstrip('+')}" if is_value(text) else text for text in texts]


def typed(texts: Iterable[str]) -> list[str]:
    """Forced overrides as the user typed them."""
    return [text.removeprefix("++") for text in texts]


def key(override: Override) -> str:
    """The key of the configuration that an override changes."""
    return override.package or override.key_or_group


def raw_values(config: DictConfig) -> dict[str, Any]:
    """`config` with its interpolations as text."""
    raw: Any = OmegaConf.to_container(config, resolve=False)
    return {name: value for name, value in raw.items() if name != "hydra"}


def as_typed(line: str, texts: Sequence[str]) -> str:
    """A message that begins with FIELD=VALUE of a part, with the key and the value as typed.

    A part names only its field: `reward='foo': ...` was typed as env.reward=foo. YAML reads 1e4 as
    10000.0.
    """
    head = re.match(r"([\w.]+)=(.*?): ", line)
    if head is None:
        return line
    value, values = value_of(head[2]), {str(value_of(head[2])), head[2].strip("'\"")}
    for each in parse(texts):
        path, text = key(each), each.get_value_element_as_str()
        if each.is_delete() or path.rsplit(".", 1)[-1] != head[1].rsplit(".", 1)[-1]:
            continue
        written = (each.input_line or "").partition("=")[2] or text
        if each.value() == value or {text.strip("'\""), str(each.value())} & values:
            return f"{path}={written}: {line[head.end() :]}"
    return line


def value_of(text: str) -> Any:
    """A value as Hydra reads it."""
    try:
        return OverridesParser.create().parse_override(f"a={text}").value()
    except Exception:
        return text
