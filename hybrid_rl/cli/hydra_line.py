"""Hydra's command line: its options, its help, and errors that name what was typed."""

import inspect
import os
import re
import sys
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import hydra
from hydra.core.hydra_config import HydraConfig
from hydra.types import RunMode
from omegaconf import DictConfig, OmegaConf, open_dict

from hybrid_rl.cli import arguments, command
from hybrid_rl.errors import UsageError
from hybrid_rl.run import start
from hybrid_rl.settings import build as configuration
from hybrid_rl.settings import words as overrides
from hybrid_rl.settings.compose import check_choices
from hybrid_rl.settings.groups import CONF, groups, search_path

FLAGS = {  # of Hydra -> how many words follow
    **dict.fromkeys(("-m", "--multirun", "-r", "--run", "--resolve", "--version"), 0),
    **dict.fromkeys(("--hydra-help", "-sc", "--shell-completion"), 0),
    **dict.fromkeys(("-c", "--cfg", "-p", "--package", "-cd", "--config-dir"), 1),
    **dict.fromkeys(("-cp", "--config-path", "-cn", "--config-name"), 1),
    **dict.fromkeys(("-i", "--info"), 1),
}
KEYS = (*configuration.READ, "schedule", "settings", "experiment", "sweep")  # in the help
MODES = ("-m", "--multirun", "-r", "--run", "-c", "--cfg", "-i", "--info")  # Hydra takes one
# GROUP=NAME of a part, of one value
CHOICE = re.compile(r"^((?!hydra|task|algo|settings|experiment)[\w@./]+=)([\w./-]+)$")
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
        command.reported(lambda: checked(config))  # ends here, before Hydra adds lines of its own

    def composed() -> None:
        line = _ordered(sys.argv[1:])
        mine = [text.partition("=")[2] for text in line if text.startswith("--config-dir=")]
        line = start.add_recipe(line, *mine)
        if (shown := _shown(line, mine)) is not None:
            print(shown, end="")
            return
        sys.argv[1:] = _forced(line, groups(*mine))
        hydra.main(config_path=str(CONF), config_name="train", version_base="1.3")(alone)()

    if set(arguments.HELP) & set(sys.argv[1:]):
        print(usage(inspect.getmodule(job)))
        return
    os.environ.setdefault("HYDRA_FULL_ERROR", "1")  # raises here instead of printing there
    command.reported(composed)


def _shown(line: Sequence[str], config_dir: Sequence[str]) -> str | None:
    """What --cfg job prints: every key that a run of these overrides reads; None: another line."""
    if not {"--cfg job", "-c job", "--cfg=job"} & {" ".join(line[:2]), line[0] if line else ""}:
        return None
    words = [text for text in line if not text.startswith("-") and text != "job"]
    return OmegaConf.to_yaml(configuration.compose_raw(words, *config_dir))


def _forced(line: Sequence[str], names: Collection[str]) -> list[str]:
    """The words as Hydra takes them; names: of groups.

    In a sweep a choice of one value, too, is for the jobs: the default may lack the part.
    """
    line = overrides.forced(line, names)
    if not {"-m", "--multirun"} & {*line}:
        return line
    return [
        CHOICE.sub(r"\1choice(\2)", text) if overrides.is_group(text, names) else text
        for text in line
    ]


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
    """The options, then the overrides; Hydra's parser refuses options between these."""
    for text in line:
        if text.startswith(("config_dir=", "--config-dir=")):
            search_path(text.partition("=")[2])  # refuses what is no folder
    line = [re.sub("^config_dir=", "--config-dir=", text) for text in line]  # as elsewhere
    for flag in ({"--config-dir", "-cd"} & {*line}) - {*line[-1:]}:  # two words
        at = line.index(flag)
        line[at : at + 2] = [f"--config-dir={line[at + 1]}"]
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
