"""What the commands share: arguments, settings of JAX, one line for what goes wrong.

Exit codes: 0 done; 2 bad usage; 130 and 143 after Ctrl-C and SIGTERM; 1 any other failure.
"""

import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, NoReturn

from omegaconf import DictConfig
from omegaconf.errors import OmegaConfBaseException

from hybrid_rl import config as configuration
from hybrid_rl import interrupt
from hybrid_rl.config import CONF, SHOW, UsageError


def hydra_main(job: Callable[[DictConfig], None]) -> None:
    """Run `job` on the configuration that the command line composes, once or in a sweep."""
    import hydra
    from hydra.core.hydra_config import HydraConfig
    from hydra.errors import HydraException

    def checked(config: DictConfig) -> None:
        configuration.refuse_new_keys(HydraConfig.get().overrides.task)
        job(config)

    def alone(config: DictConfig) -> None:  # ends here, before Hydra adds lines of its own
        _reported(lambda: checked(config))

    for key in (text.removesuffix("=null") for text in sys.argv if text.endswith("=null")):
        if key != "experiment" and options(key):
            _fail(2, f"{key}=null: choose one of {', '.join(options(key))}")
    os.environ.setdefault("HYDRA_FULL_ERROR", "1")  # raises here instead of printing there
    try:
        hydra.main(config_path=str(CONF), config_name="train", version_base="1.3")(alone)()
    except (HydraException, OmegaConfBaseException) as error:
        report(error)
    except KeyboardInterrupt:
        _interrupted()


def report(error: Exception) -> NoReturn:
    """End the process with one line and the right code, or with a traceback for a fault of ours."""
    from hydra.errors import HydraException

    from hybrid_rl.training.rows import DivergenceError

    if isinstance(error, UsageError):
        _fail(2, str(error))
    if isinstance(error, (HydraException, OmegaConfBaseException)):
        _fail(2, explain(error))
    if isinstance(error, (OSError, DivergenceError, MemoryError)):
        _fail(1, str(error))
    if str(error).startswith("RESOURCE_EXHAUSTED"):  # of XLA
        what = str(error).splitlines()[0]
        _fail(1, f"{what}; fewer num_seeds or num_envs, or a smaller replay.capacity, may fit")
    raise error


def _fail(code: int, line: str) -> NoReturn:
    print(f"hybrid_rl: {' '.join(line.split())}", file=sys.stderr, flush=True)
    sys.exit(code)


def explain(error: Exception) -> str:
    """One line that names the key, the value and what is allowed, from an error of Hydra."""
    from hydra.errors import MissingConfigException

    if isinstance(error, MissingConfigException) and error.missing_cfg_file is not None:
        group, _, value = error.missing_cfg_file.partition("/")
        known = sorted({*options(group), *(error.options or ())})  # theirs: of --config-dir too
        return f"{group}={value}: unknown; choose one of {', '.join(known)}"
    cause = error.__cause__
    if cause is not None and "is not in struct" in str(cause):
        key = str(cause).split("full_key: ")[1].splitlines()[0].strip()
        return f"{key}: unknown key; {SHOW}"
    return f"{error} {cause or ''}"


def options(group: str) -> list[str]:
    """Names that a configuration group offers, with their folders."""
    return sorted(
        str(path.relative_to(CONF / group).with_suffix(""))
        for path in (CONF / group).rglob("*.yaml")
    )


def prepare(config: DictConfig) -> None:
    """Settings of JAX for this process: compilation cache, matrix precision, threads.

    Before JAX has looked for its devices. On a CPU, MJX factorises matrices of many worlds at
    once, and side by side; each such call holds one of XLA's threads while others do its work
    (jaxlib 0.10). Where there are two of them they wait for ever: so let there be eight.
    """
    import jax

    from hybrid_rl.envs.native import cores

    if config.physics == "mjx" and cores() < 8:
        os.environ.setdefault("NPROC", "8")
    jax.config.update("jax_default_matmul_precision", config.matmul_precision)
    if config.compile_cache is not None:
        cache = Path(str(config.compile_cache)).expanduser()
        _mend(cache)
        jax.config.update("jax_compilation_cache_dir", str(cache))
        jax.config.update("jax_compilation_cache_max_size", 4 * 2**30)
        jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.1)


def _mend(cache: Path) -> None:
    """Drop what a kill left half written: JAX would warn of it, and never write there again."""
    for entry in cache.glob("*-cache"):
        if not entry.with_name(entry.name.removesuffix("-cache") + "-atime").exists():
            entry.unlink(missing_ok=True)


def asked(config_overrides: list[str]) -> dict[str, str]:
    """Overrides as key -> value, as they were written."""
    pairs = (text.lstrip("+~").partition("=") for text in config_overrides)
    return {key: value for key, _, value in pairs}


def arguments(known: dict[str, Any], *groups: str) -> dict[str, str]:
    """`key=value` arguments of a command that is no training; `known` names the keys.

    Keys below one of `groups` of the configuration, as env.speed below env, are taken too.

    Raises:
        UsageError: for an argument of another form or an unknown key.
    """
    given = {}
    for text in sys.argv[1:]:
        key, equals, value = text.partition("=")
        if not equals or not (key in known or key.partition(".")[0] in groups):
            keys = ", ".join([*known, *(f"{group}.*" for group in groups)])
            raise UsageError(f"{text}: unknown argument; give key=value with {keys}")
        given[key] = value
    return given


def count(key: str, text: str, even: bool = False, least: int = 1) -> int:
    """A whole number from an argument.

    Raises:
        UsageError: for anything else.
    """
    if text.isdecimal() and int(text) >= least and not (even and int(text) % 2):
        return int(text)
    kind = "an even number" if even else "a whole number"
    raise UsageError(f"{key}={text}: must be {kind}, {least + even} or more")


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
