"""The folders of configuration files, and the names that their groups offer; without JAX."""

from pathlib import Path

from hybrid_rl.errors import UsageError

HERE = Path(__file__).parent
CONF = next(p for p in (HERE / "conf", HERE.parent / "conf") if (p / "train.yaml").exists())
THESIS = CONF.parent / "thesis" / "conf"  # methods by the thesis' names, on the search path
MODES = ("full", "policy", "planner")  # keys of `controllers`: who acts


def search_path(config_dir: str | Path) -> str:
    """The override by which Hydra finds the groups in a folder of the user.

    Raises:
        UsageError: if there is no such folder, or Hydra would take another file for one of it.
    """
    folder = Path(config_dir).expanduser().resolve()
    if not folder.is_dir():
        raise UsageError(f"config_dir={config_dir}: no such folder")
    for file in sorted(CONF.glob("*/**/*.yaml")):
        mine = folder / (name := file.relative_to(CONF))
        if mine.is_file() and mine.read_bytes() != file.read_bytes():
            raise UsageError(
                f"config_dir={config_dir}: hybrid_rl has {name.parent.as_posix()}={name.stem} of "
                f"its own, which a run would take; rename {name}"
            )
    return f"hydra.searchpath=['file://{folder}','pkg://hybrid_rl.thesis.conf']"


def options(group: str) -> list[str]:
    """Names that a configuration group offers, with their folders."""
    return sorted(
        path.relative_to(conf / group).with_suffix("").as_posix()
        for conf in (CONF, THESIS)
        for path in (conf / group).rglob("*.yaml")
    )


def file(group: str, name: str) -> Path:
    """The YAML file of an option of the library or of the thesis.

    Raises:
        FileNotFoundError: if there is none.
    """
    for conf in (CONF, THESIS):
        if (path := conf / group / f"{name}.yaml").is_file():
            return path
    raise FileNotFoundError(f"{group}={name}")
