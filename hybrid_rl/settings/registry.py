"""Parts as choices of a group, without a YAML file: `critic=ensemble_q` is critics/ensemble_q.py.

A module of a role's folder is a choice by its name, unless conf/ has a file of that name; its part
is the class that is called like the module, or the only one. Modules are read as text, and imported
when a part is made.
"""

import re
from functools import cache
from pathlib import Path

PACKAGE = Path(__file__).parents[1]
GROUPS = "belief constraint controller critic learner model objective proposal schedule target"
ROLES = {  # group of conf/ -> folder of hybrid_rl
    **{group: f"{group}s" for group in GROUPS.split()},
    **{"features": "features", "map": "beliefs/maps", "policy": "policies"},
}
PART = re.compile(r"^@(?:part|dataclass\(frozen=True\))\nclass (\w+)", re.MULTILINE)


@cache
def choices(conf: Path) -> dict[str, dict[str, str]]:
    """Group -> name -> the class that it names, where `conf` has no file of that name."""
    return {
        group: {
            name: target
            for name, target in _of(PACKAGE / folder).items()
            if not (conf / group / f"{name}.yaml").exists()
        }
        for group, folder in ROLES.items()
    }


def _of(folder: Path) -> dict[str, str]:
    """The modules of a folder, and the folders in it, that define a part."""
    found = {}
    for path in [*folder.glob("*.py"), *folder.glob("*/__init__.py")]:
        home = path.parent if path.name == "__init__.py" else path.with_suffix("")
        classes = PART.findall(path.read_text(encoding="utf-8"))
        named = [name for name in classes if name.lower() == home.name.replace("_", "")]
        if home != folder and (named or len(classes) == 1):
            module = ".".join(("hybrid_rl", *home.relative_to(PACKAGE).parts))
            found[home.name] = f"{module}.{(named or classes)[0]}"
    return found


@cache
def register(conf: Path) -> None:
    """Let Hydra know the choices that `conf` has no file of."""
    from hydra.core.config_store import ConfigStore  # not for a list of names

    store = ConfigStore.instance()
    for group, names in choices(conf).items():
        for name, target in names.items():
            store.store(name, {"_target_": target}, group=group, provider="hybrid_rl")
