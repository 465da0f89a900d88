"""The folders of configuration files, and the names that their groups offer; without JAX."""

from pathlib import Path

from hybrid_rl.errors import UsageError
from hybrid_rl.settings import registry

HERE = Path(__file__).parents[1]
CONF = next(p for p in (HERE / "conf", HERE.parent / "conf") if (p / "train.yaml").exists())
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


def options(group: str) -> list[str]:
    """Names that a configuration group offers, with their folders."""
    files = {
        path.relative_to(conf / group).with_suffix("").as_posix()
        for conf in (CONF, THESIS)
        for path in (conf / group).rglob("*.yaml")
    }
    return sorted(files | registry.choices(CONF).get(group, {}).keys())


def groups(config_dir: str | Path | None = None) -> set[str]:
    """The names of the groups in conf/, and of those in a folder of the user."""
    folders = [CONF, THESIS, *([Path(config_dir).expanduser()] if config_dir else [])]
    files = (path.relative_to(folder) for folder in folders for path in folder.rglob("*.yaml"))
    found = {above.as_posix() for file in files for above in file.parents} - {"."}
    return found | registry.ROLES.keys()


def file(group: str, name: str) -> Path:
    """The YAML file of an option of the library or of the thesis.

    Raises:
        FileNotFoundError: if there is none.
    """
    for conf in (CONF, THESIS):
        if (path := conf / group / f"{name}.yaml").is_file():
            return path
    raise FileNotFoundError(f"{group}={name}")
