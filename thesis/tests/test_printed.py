"""Every value of a row "as printed" is in docs/results/printed.yaml, printed or with a reason."""

from typing import Any

import pytest
import yaml
from hydra import compose, initialize_config_dir

from hybrid_rl.run.logs.records import flatten_keys
from hybrid_rl.settings.build import CONF, READ
from hybrid_rl.settings.complete import complete, keys
from hybrid_rl.settings.groups import groups
from hybrid_rl.settings.words import forced, plain
from scripts.pages.values import RESULTS

ENTRIES = yaml.safe_load((RESULTS / "printed.yaml").read_text(encoding="utf-8"))
ROWS = [(title, name) for title, c in ENTRIES["chapters"].items() for name in c["rows"]]


def refers(value: Any) -> bool:
    """Whether a value is one of another key, or a list of such."""
    values = value if isinstance(value, list) and value else [value]
    return all(isinstance(each, str) and each.startswith("${") for each in values)


def values(line: str) -> dict[str, Any]:
    """What a row's parts read: full key -> value, but for options that are off."""
    with initialize_config_dir(str(CONF), version_base="1.3"):
        raw = compose("train", forced(line.split(" "), groups()))
    whole = complete(plain(raw), READ)
    read = keys(whole)
    return {
        key: value
        for key, value in flatten_keys(whole).items()
        if key in read
        and value is not None
        and value is not False
        and value != {}
        and not refers(value)
        and key not in ("task", "algo", *ENTRIES["run"])
        and not key.endswith("_target_")
        and ENTRIES["neutral"].get(key.split(".")[-1], ...) != value
    }


def listed(title: str, name: str) -> dict[str, list[Any]]:
    """The values that a row may have, of each key."""
    found: dict[str, list[Any]] = {}
    chapter = ENTRIES["chapters"][title]
    for block in [*chapter["printed"], *chapter["ours"]]:
        if name in block.get("only", [name]):
            for key, value in block.get("values", {}).items():
                found.setdefault(key, []).append(value)
            for key, several in block.get("any", {}).items():
                found.setdefault(key, []).extend(several)
    return found


@pytest.mark.parametrize(("title", "name"), ROWS, ids=[name for _, name in ROWS])
def test_every_value_of_a_row_is_printed_or_has_a_reason(title: str, name: str) -> None:
    allowed = listed(title, name)
    found = values(ENTRIES["chapters"][title]["rows"][name])
    missing = {key: value for key, value in found.items() if value not in allowed.get(key, [])}
    assert not missing


@pytest.mark.parametrize("title", ENTRIES["chapters"])
def test_every_listed_value_is_one_of_a_row(title: str) -> None:
    chapter = ENTRIES["chapters"][title]
    found = {name: values(line) for name, line in chapter["rows"].items()}
    for block in [*chapter["printed"], *chapter["ours"]]:
        rows = [found[name] for name in block.get("only", found)]
        several = {**{k: [v] for k, v in block.get("values", {}).items()}, **block.get("any", {})}
        for key, alternatives in several.items():
            for value in alternatives:
                assert any(row.get(key) == value for row in rows), f"{key}: {value}"


@pytest.mark.parametrize("title", ENTRIES["chapters"])
def test_every_block_has_a_source_or_a_reason(title: str) -> None:
    chapter = ENTRIES["chapters"][title]
    assert all(block["source"] for block in chapter["printed"])
    assert all(block["why"] for block in chapter["ours"])
