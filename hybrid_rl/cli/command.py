"""What the commands share: Hydra's command line, exit codes, one line for each error.

Exit codes: 0 done; 2 bad usage; 130 and 143 after Ctrl-C and SIGTERM; 1 any other failure.
"""

import inspect
import os
import re
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, NoReturn

from omegaconf import DictConfig
from omegaconf.errors import OmegaConfBaseException

from hybrid_rl import config as configuration
from hybrid_rl import overrides
from hybrid_rl.cli import arguments, interrupt
from hybrid_rl.config import CONF
from hybrid_rl.errors import UsageError, shown

FLAGS = {  # of Hydra -> how many words follow
    **dict.fromkeys(("-m", "--multirun", "-r", "--run", "--resolve", "--version"), 0),
    **dict.fromkeys(("--hydra-help", "-sc", "--shell-completion"), 0),
    **dict.fromkeys(("-c", "--cfg", "-p", "--package", "-cd", "--config-dir"), 1),
    **dict.fromkeys(("-cp", "--config-path", "-cn", "--config-name", "--experimental-rerun"), 1),
    **dict.fromkeys(("-i", "--info"), 1),
}
USAGE = """

{doc}

Keys that every method and every task has, with their defaults; the task sets those with null:
{keys}

Options:
  -m, --multirun   one job for every combination of values with commas between them
  --config-dir DIR a folder with groups of your own, such as DIR/algo/mine.yaml
  --cfg job        show the composed configuration, which is every key there is, and end
  --help           this text

`python -m hybrid_rl.list` shows the tasks, the methods and the experiments."""


def hydra_main(job: Callable[[DictConfig], Any]) -> None:
    """Run `job` on the configuration that the command line composes, once or in a sweep."""
    import hydra
    from hydra.core.hydra_config import HydraConfig
    from hydra.errors import HydraException
    from hydra.types import RunMode

    def checked(config: DictConfig) -> None:
        typed = overrides.of_job(HydraConfig.get())
        with as_typed(typed):
            overrides.refuse_new_keys(typed, HydraConfig.get().overrides.hydra)
            overrides.refuse_unused([config], typed, configuration.READ)
            job(config)

    def alone(config: DictConfig) -> Any:
        if HydraConfig.get().mode == RunMode.MULTIRUN:  # checked, and reported, by sweep.Sweeper
            return job(config)
        return _reported(lambda: checked(config))  # ends here, before Hydra adds lines of its own

    if set(arguments.HELP) & set(sys.argv[1:]):
        print(usage(inspect.getmodule(job)))
        return
    os.environ.setdefault("HYDRA_FULL_ERROR", "1")  # raises here instead of printing there
    try:
        _check_form(sys.argv[1:])
        hydra.main(config_path=str(CONF), config_name="train", version_base="1.3")(alone)()
    except (HydraException, OmegaConfBaseException, UsageError) as error:
        report(error)
    except KeyboardInterrupt:
        _interrupted()


@contextmanager
def as_typed(typed: Sequence[str]) -> Iterator[None]:
    """A UsageError names the key and the value as they were typed."""
    try:
        yield
    except UsageError as error:
        raise UsageError(overrides.as_typed(str(error), typed)) from error


def usage(module: Any) -> str:
    """What --help of a command with Hydra's overrides prints."""
    text = (CONF / "train.yaml").read_text(encoding="utf-8")
    lines = re.findall(r"^(?:  - )?(\w+): (\S.*?)(?: +# (.*))?$", text, re.MULTILINE)
    scalars = [line for line in lines if line[0] in (*configuration.READ, "settings", "experiment")]
    width = max(len(f"{key}={value}") for key, value, _ in scalars)
    keys = "\n".join(f"  {f'{key}={value}':{width}}  {about}" for key, value, about in scalars)
    return USAGE.format(doc=inspect.getdoc(module), keys=keys).strip()


def _check_form(line: Sequence[str]) -> None:
    """Raise UsageError for what is neither key=value nor an option of Hydra's."""
    follow = 0
    for at, text in enumerate(line):
        name, equals, value = text.partition("=")
        if follow:
            follow -= 1
        elif name.startswith("-"):
            flags = [flag for flag in FLAGS if flag == name or flag.startswith(f"{name}")]
            if not flags:
                raise UsageError(f"{text}: unknown option; write {arguments.as_pair(line, at)}")
            follow = 0 if equals else FLAGS[flags[0]]
        elif not equals and text.count("]") > text.count("["):
            raise UsageError(f"{text}: has no key; put a list in quotes: 'key=[a, b]'")
        elif not equals and not text.startswith("~"):
            raise UsageError(f"{text}: has no value; write {arguments.as_pair(line, at)}")
        elif value == "null" and name != "experiment" and options(name):
            raise UsageError(f"{text}: choose one of {', '.join(options(name))}")


def report(error: BaseException) -> NoReturn:
    """End the process with one line and the right code, or with a traceback for a fault of ours."""
    result = diagnosis(error)
    if result is None:
        raise error
    _fail(*result)


def diagnosis(error: BaseException) -> tuple[int, str] | None:
    """Exit code and line for what went wrong; None for a fault of ours."""
    from hydra.errors import HydraException

    from hybrid_rl.errors import DivergenceError

    if isinstance(error, UsageError):
        return 2, str(error)
    if isinstance(error, (HydraException, OmegaConfBaseException)):
        return 2, explain(error)
    if isinstance(error, (OSError, DivergenceError, MemoryError)):
        return 1, str(error)
    if str(error).startswith("RESOURCE_EXHAUSTED"):  # of XLA
        what = str(error).splitlines()[0]
        return 1, f"{what}; fewer num_seeds or num_envs, or a smaller replay.capacity, may fit"
    return None


def _fail(code: int, line: str) -> NoReturn:
    print(f"hybrid_rl: {shown(' '.join(line.split()))}", file=sys.stderr, flush=True)
    sys.exit(code)


def explain(error: Exception) -> str:
    """One line that names the key, the value and what is allowed, from an error of Hydra."""
    from hydra.errors import MissingConfigException, OverrideParseException

    if isinstance(error, MissingConfigException) and error.missing_cfg_file is not None:
        parts = error.missing_cfg_file.split("/")
        deep = 2 if parts[0] == "hydra" else 1
        group, value = "/".join(parts[:deep]), "/".join(parts[deep:])
        known = sorted({*options(group), *(error.options or ())})  # theirs: of --config-dir too
        close = overrides.meant(value, known)
        return f"{group}={value}: unknown; choose one of {', '.join(known)}{close}"
    cause = error.__cause__
    if isinstance(cause, OmegaConfBaseException) and "is not in struct" in str(cause):
        return overrides.unknown(cause.parent_node, str(cause.full_key))
    if isinstance(error, OverrideParseException):
        return f"{error.override}: {str(error).splitlines()[-2]}; write key=value, text in quotes"
    if absent := re.match(r"Could not override '([^']+)'", str(error)):
        return f"{absent[1]}: the method has no such part; `python -m hybrid_rl.list` shows methods"
    return f"{error} {cause or ''}"


def options(group: str) -> list[str]:
    """Names that a configuration group offers, with their folders."""
    return sorted(
        str(path.relative_to(CONF / group).with_suffix(""))
        for path in (CONF / group).rglob("*.yaml")
    )


def guarded(job: Callable[[], None]) -> None:
    """Run `job`; what goes wrong becomes one line and an exit code, after it has cleaned up."""
    with interrupt.tidily():
        _reported(job)


def _reported(job: Callable[[], None]) -> None:
    try:
        job()
    except Exception as error:
        report(error)
    except KeyboardInterrupt:
        _interrupted()


def _interrupted() -> NoReturn:
    if interrupt.installed():
        interrupt.leave()
    _fail(130, "interrupted")
