"""What the commands share: Hydra's command line, exit codes, one line for each error.

Exit codes: 0 done; 2 bad usage; 128 + number after a signal, as 130 after Ctrl-C and 143 after
SIGTERM; 1 any other failure.
"""

import inspect
import os
import re
import select as polling
import sys
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from types import ModuleType
from typing import Any, NoReturn

import yaml
from omegaconf import DictConfig, OmegaConf, open_dict
from omegaconf.errors import OmegaConfBaseException

from hybrid_rl import config as configuration
from hybrid_rl import overrides, renamed
from hybrid_rl.cli import arguments, interrupt
from hybrid_rl.composition import CONF, check_choices, explain, groups, search_path
from hybrid_rl.errors import UsageError, printable, user_line
from hybrid_rl.fields import FieldError
from hybrid_rl.run import inherited

FLAGS = {  # of Hydra -> how many words follow
    **dict.fromkeys(("-m", "--multirun", "-r", "--run", "--resolve", "--version"), 0),
    **dict.fromkeys(("--hydra-help", "-sc", "--shell-completion"), 0),
    **dict.fromkeys(("-c", "--cfg", "-p", "--package", "-cd", "--config-dir"), 1),
    **dict.fromkeys(("-cp", "--config-path", "-cn", "--config-name"), 1),
    **dict.fromkeys(("-i", "--info"), 1),
}
KEYS = (*configuration.READ, "schedule", "settings", "experiment", "sweep")  # in the help
# GROUP=NAME of a part, of one value
CHOICE = re.compile(r"^((?!hydra|task|algo|settings|experiment)[\w@./]+=)([\w./-]+)$")
MODES = ("-m", "--multirun", "-r", "--run", "-c", "--cfg", "-i", "--info")  # Hydra takes one
NO_FLAGS = ("-cp", "--config-path", "-cn", "--config-name")  # they would leave conf/train.yaml
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


def hydra_main(job: Callable[..., Any]) -> None:
    """Run `job` on the configuration that the command line composes, once or in a sweep.

    A sweeper may give `job` further arguments.
    """
    import hydra
    from hydra.core.hydra_config import HydraConfig
    from hydra.types import RunMode

    def run(config: DictConfig, *more: Any) -> Any:
        with open_dict(config):
            config.hydra = HydraConfig.get()
        return job(*configuration.read_only([config]), *more)

    def checked(config: DictConfig) -> None:
        typed = overrides.of_job(HydraConfig.get())
        if (launcher := HydraConfig.get().runtime.choices["hydra/launcher"]) != "basic":
            raise UsageError(f"hydra/launcher={launcher}: sends the jobs of a sweep; add -m")
        with as_typed(typed):
            run(config)

    def alone(config: DictConfig, *more: Any) -> Any:
        if HydraConfig.get().mode == RunMode.MULTIRUN:  # checked, and reported, by sweep.Sweeper
            return run(config, *more)
        return _reported(lambda: checked(config))  # ends here, before Hydra adds lines of its own

    if set(arguments.HELP) & set(sys.argv[1:]):
        print(usage(inspect.getmodule(job)))
        return
    os.environ.setdefault("HYDRA_FULL_ERROR", "1")  # raises here instead of printing there
    try:
        line = inherited.add_choices(_ordered(sys.argv[1:]))
        mine = [text.partition("=")[2] for text in line if text.startswith("--config-dir=")]
        if (shown := _shown(line, mine)) is not None:
            print(shown, end="")
            return
        names = groups(*mine)
        line = overrides.forced(line, names)
        if {"-m", "--multirun"} & {*line}:  # one value, too, is for the jobs, not for the default
            chosen = [
                text for text in line if CHOICE.match(text) and overrides.is_group(text, names)
            ]
            line = [CHOICE.sub(r"\1choice(\2)", text) if text in chosen else text for text in line]
        sys.argv[1:] = line
        hydra.main(config_path=str(CONF), config_name="train", version_base="1.3")(alone)()
    except Exception as error:
        report(error)
    except KeyboardInterrupt:
        _interrupted()


def _shown(line: Sequence[str], config_dir: Sequence[str]) -> str | None:
    """What --cfg job prints: every key that a run of these overrides reads; None: another line."""
    if not {"--cfg job", "-c job", "--cfg=job"} & {" ".join(line[:2]), line[0] if line else ""}:
        return None
    words = [text for text in line if not text.startswith("-") and text != "job"]
    return OmegaConf.to_yaml(configuration.compose_raw(words, *config_dir))


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
    scalars = {line[0]: line for line in lines if line[0] in KEYS}.values()  # the last of each
    width = max(len(f"{key}={value}") for key, value, _ in scalars)
    keys = "\n".join(f"  {f'{key}={value}':{width}}  {about}" for key, value, about in scalars)
    return USAGE.format(doc=inspect.getdoc(module), keys=keys).strip()


def _ordered(line: Sequence[str]) -> list[str]:
    """The options, then the overrides; Hydra's parser refuses options between these.

    Raises:
        UsageError: for what is neither key=value nor an option of Hydra's.
    """
    for text in line:
        if text.startswith(("config_dir=", "--config-dir=")):
            search_path(text.partition("=")[2])  # refuses what is no folder
    line = [re.sub("^config_dir=", "--config-dir=", text) for text in line]  # as elsewhere
    for flag in ({"--config-dir", "-cd"} & {*line}) - {line[-1]}:  # two words
        at = line.index(flag)
        line[at : at + 2] = [f"--config-dir={line[at + 1]}"]
    renamed.check(line)
    check_choices(line)
    follow, found, modes = 0, [], []  # words that belong to an option; places of all these; modes
    for at, text in enumerate(line):
        name, equals, _ = text.partition("=")
        if follow:
            follow -= 1
            found.append(at)
        elif name.startswith("-"):
            flags = [flag for flag in FLAGS if flag.startswith(name)]
            if not flags:
                raise UsageError(f"{text}: unknown option; write {arguments.as_pair(line, at)}")
            if flags[0] in NO_FLAGS:
                raise UsageError(f"{text}: a run has one configuration; choose by experiment=NAME")
            follow = 0 if equals else FLAGS[flags[0]]
            found.append(at)
            if flags[0] in MODES:
                modes.append(text)
        elif not equals and text.count("]") > text.count("["):
            raise UsageError(f"{text}: has no key; put a list in quotes: 'key=[a, b]'")
        elif not equals and not text.startswith("~"):
            raise UsageError(f"{text}: has no value; write {arguments.as_pair(line, at)}")
    if len(modes) > 1:
        raise UsageError(f"{', '.join(modes)}: give one of them")
    rest = (text for at, text in enumerate(line) if at not in found)
    return [*(line[at] for at in found), *rest]


def report(error: BaseException) -> NoReturn:
    """End the process with one line and the right code, or with a traceback for a fault of ours."""
    if isinstance(error, BrokenPipeError) and _unread():
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # Python writes at its end
        sys.exit(1)
    result = diagnosis(error)
    if result is None:
        traceback.print_exception(error)  # begins where it was caught, without Hydra's frames
        sys.exit(1)
    _fail(*result)


def _unread() -> bool:
    """Whether nothing reads the output any more, as in `| head`."""
    if not hasattr(polling, "poll"):  # Windows
        return False
    poll = polling.poll()
    poll.register(sys.stdout.fileno(), 0)
    return any(event & polling.POLLERR for _, event in poll.poll(0))


def diagnosis(error: BaseException) -> tuple[int, str] | None:
    """Exit code and line for what went wrong; None for a fault of ours."""
    from hydra.errors import HydraException

    from hybrid_rl.errors import DivergenceError

    if isinstance(error, (UsageError, FieldError)):  # the latter while a program is traced
        return 2, str(error)
    if isinstance(error, (HydraException, OmegaConfBaseException, yaml.YAMLError)):
        return 2, explain(error)
    if isinstance(error, (OSError, DivergenceError, MemoryError)):
        return 1, str(error)
    if platform := _missing(error):
        named = f"JAX_PLATFORMS={platform}"
        return 2, f"{named}: JAX finds no such device here; unset it, or choose cpu"
    if isinstance(error, ImportError) and "failed to map segment" in str(error):  # ulimit -v
        return 1, f"out of memory: {error}"
    if str(error).startswith("RESOURCE_EXHAUSTED"):  # of XLA
        what = str(error).splitlines()[0]
        return 1, f"{what}; fewer num_seeds or num_envs, or a smaller replay.capacity, may fit"
    if line := user_line(error, ours=True):
        return 1, line
    return None


def _missing(error: BaseException) -> str | None:
    """What JAX_PLATFORMS names, if JAX may have raised this as there is no such device."""
    named = os.environ.get("JAX_PLATFORMS")
    if not named or not isinstance(error, (RuntimeError, AssertionError)):
        return None
    import jax

    try:
        jax.devices()
    except (RuntimeError, AssertionError):
        return named
    return None


def _fail(code: int, line: str) -> NoReturn:
    print(f"hybrid_rl: {printable(' '.join(line.split()))}", file=sys.stderr, flush=True)
    sys.exit(code)


def make_callable(module: str, function: Callable[..., Any]) -> None:
    """Let a module be called as its function: hybrid_rl.train() is hybrid_rl.train.train()."""

    class Called(ModuleType):
        __call__ = staticmethod(function)
        __signature__ = inspect.signature(function)

    sys.modules[module].__class__ = Called


def run(job: Callable[[], None]) -> None:
    """Run `job`; what goes wrong becomes one line and an exit code, after it has cleaned up."""
    with interrupt.as_exception():
        _reported(job)


def _reported(job: Callable[[], None]) -> None:
    try:
        job()
    except Exception as error:
        report(error)
    except SystemExit as end:
        if line := user_line(end, ours=True):  # it would end without a word
            _fail(1, line)
        raise
    except KeyboardInterrupt:
        _interrupted()


def _interrupted() -> NoReturn:
    if interrupt.installed():
        interrupt.leave()
    _fail(130, "interrupted")
