"""The words of a run that begins with another one: those of run=DIR, and the new ones.

config.yaml keeps the words that made it as `recipe`. They are composed with the new ones, so
that what refers to another key follows it.
"""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from omegaconf import DictConfig, OmegaConf

from hybrid_rl.errors import UsageError
from hybrid_rl.files import targets as parts
from hybrid_rl.run import folder
from hybrid_rl.settings import build as configuration
from hybrid_rl.settings import words as overrides
from hybrid_rl.settings.groups import search_path
from hybrid_rl.settings.words import name

CHOSEN = ("task", "algo", "learning")  # they make the parameters
WIDE = ("settings", "experiment")  # they would set what DIR has set
OWN = ("random_steps", "pretrain", "run_dir", "freeze", "distributed", "resume", "run")
FRESH = ("random_steps=0", "pretrain=0")  # the learners have begun
FOREIGN = re.compile(r"\$\{[^}]*:|^\+*(hydra|(?!demonstrations=)[\w@]+=[^=]*\.\.)")


def add_recipe(texts: Sequence[str], config_dir: str | Path | None = None) -> list[str]:
    """The words of a command, with those of the run in run=DIR before them."""
    named = [text for text in texts if text.startswith("run=") and text != "run=null"]
    if not named:
        return [*texts]
    given = overrides.typed_values(texts)
    if given.get("resume", "null") != "null":
        raise UsageError(
            "run, resume: give one of them; run=DIR begins a new run with what DIR has learned, "
            "resume=DIR continues DIR itself"
        )
    (which,) = overrides.parse(named[-1:])
    folders = list(which.sweep_iterator()) if which.is_sweep_override() else [which.value()]
    paths = (Path(str(each).strip("'\"")) for each in folders)
    first, *others = [_recipe(path, config_dir) for path in paths]
    if any({*each} != {*first} for each in others):
        raise UsageError(f"{named[-1]}: runs that the same words made only")
    known = overrides.typed_values(first)
    for key in (*CHOSEN, *WIDE):
        if key in given and given[key] != known.get(key):
            has = f"; it has {key}={known[key]}" if key in known else ""
            line = f"what is learned in {named[-1]} does not fit" if key in CHOSEN else ""
            line = line or f"with {named[-1]} the settings come from there; give single keys"
            raise UsageError(f"{key}={given[key]}: {line}{has}")
    words = [text for text in (*first, *FRESH) if name(text) not in given]
    options = [text for text in texts if text.startswith("-")]
    return [*options, *words, *(text for text in texts if text not in options)]


def _recipe(run_dir: Path, config_dir: str | Path | None) -> list[str]:
    """The words that made the run in a folder, which may come from anybody."""
    config: DictConfig = folder.read(run_dir, "run")
    values: Any = OmegaConf.to_container(config)
    words = values.get("recipe")
    if words is None:
        raise UsageError(f"run={run_dir}: its config.yaml keeps no recipe; train it again")
    at = f"{run_dir / 'config.yaml'}: recipe"
    if not (isinstance(words, list) and all(isinstance(each, str) for each in words)):
        raise UsageError(f"{at}: must be a list of KEY=VALUE")
    kept = [re.sub(r"\$\(([^)]*)\)", r"${\1}", text) for text in words if name(text) not in OWN]
    folders = config_dir or values.get("config_dir")
    if wrong := [text for text in kept if FOREIGN.search(text)]:
        raise UsageError(f"{at}: {wrong[0]}: is no KEY=VALUE of a run")
    made: Any = OmegaConf.to_container(configuration.load(kept, folders))
    made.pop("recipe")
    parts.check(made, run_dir)
    chosen = {"task": config.task, "algo": config.algo}
    kept = [*(f"{k}={v}" for k, v in chosen.items() if k not in map(name, kept)), *kept]
    return [search_path(folders), *kept] if folders and not config_dir else kept
