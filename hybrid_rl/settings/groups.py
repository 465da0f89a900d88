"""The folders of configuration files, and the names that their groups offer; without JAX.

Parts are choices of a group without a YAML file, too: `critic=ensemble_q` is critics/ensemble_q.py.
A module of a role's folder is a choice by its name, unless conf/ has a file of that name; its part
is the class that is called like the module, or the only one. Modules are read as text, and imported
when a part is made.
"""

import re
from collections.abc import Sequence
from functools import cache
from pathlib import Path

from hybrid_rl.errors import UsageError

PACKAGE = Path(__file__).parents[1]
GROUPS = "belief constraint controller critic learner model objective proposal schedule target"
ROLES = {  # group of conf/ -> folder of hybrid_rl
    **{group: f"{group}s" for group in GROUPS.split()},
    **{"features": "features", "map": "beliefs/maps", "policy": "policies"},
}
PART = re.compile(r"^@(?:part|dataclass\(frozen=True\))\nclass (\w+)", re.MULTILINE)
CONF = next(p for p in (PACKAGE / "conf", PACKAGE.parent / "conf") if (p / "train.yaml").exists())
THESIS = CONF.parent / "thesis" / "conf"  # methods by the thesis' names, on the search path
MODES = ("full", "policy", "planner")  # keys of `controllers`: who acts


def search_path(config_dir: str | Path) -> str:
    """The override by which Hydra finds the groups in a folder of the user."""
    folder = Path(config_dir).expanduser().resolve()
    if not folder.is_dir():
        raise UsageError(f"config_dir={config_dir}: no such folder")
    for group in filter(Path.is_dir, folder.iterdir()):
        for name in options(group.name):
            if (group / f"{name}.yaml").is_file():
                line = f"hybrid_rl has {group.name}={name} of its own, which a run would take"
                raise UsageError(f"config_dir={config_dir}: {line}; rename that file")
    return f"hydra.searchpath=['file://{folder}','pkg://hybrid_rl.thesis.conf']"


def files(group: str, folders: Sequence[Path] = (THESIS, CONF)) -> dict[str, Path]:
    """Name, with its folder -> the YAML file of an option, in folders like conf/."""
    homes = [folder / group for folder in folders]
    found = [(path, home) for home in homes for path in sorted(home.rglob("*.yaml"))]
    return {path.relative_to(home).with_suffix("").as_posix(): path for path, home in found}


def options(group: str) -> list[str]:
    """Names that a configuration group offers, with their folders."""
    return sorted({*files(group), *choices(CONF).get(group, ())})


def groups(config_dir: str | Path | None = None) -> set[str]:
    """The names of the groups in conf/, and of those in a folder of the user."""
    folders = [CONF, THESIS, *([Path(config_dir).expanduser()] if config_dir else [])]
    paths = (path.relative_to(folder) for folder in folders for path in folder.rglob("*.yaml"))
    found = {above.as_posix() for path in paths for above in path.parents} - {"."}
    return found | ROLES.keys()


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


def register() -> None:
    """Let Hydra know the choices that conf/ has no file of."""
    from hydra.core.config_store import ConfigStore  # not for a list of names

    store = ConfigStore.instance()
    for group, names in choices(CONF).items():
        for name, target in names.items():
            store.store(name, {"_target_": target}, group=group, provider="hybrid_rl")
