"""Hydra's command line: its options, its help, and errors that name what was typed."""

import inspect
import os
import re
import sys
from collections.abc import Callable, Collection, Sequence
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
from hybrid_rl.settings.groups import CONF, groups, search_path

FLAGS = ("-m", "--multirun", "--resolve", "--version", "--hydra-help", "-sc", "--shell-completion")
VALUED = ("-c", "--cfg", "-p", "--package", "-i", "--info")  # a word follows
KEYS = (*configuration.READ, "schedule", "settings", "experiment", "sweep")  # in the help
# GROUP=NAME of a part, of one value
CHOICE = re.compile(r"^((?!hydra|task|algo|settings|experiment)[\w@./]+=)([\w./-]+)$")
FOLDER = ("config_dir", "--config-dir", "-cd")  # as of other commands, and of Hydra
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
        if (launcher := HydraConfig.get().runtime.choices["hydra/launcher"]) != "basic":
            raise UsageError(f"hydra/launcher={launcher}: sends the jobs of a sweep; add -m")
        run(config)

    def alone(config: DictConfig, *more: Any) -> Any:
        if HydraConfig.get().mode == RunMode.MULTIRUN:  # checked, and reported, by sweep.Sweeper
            return run(config, *more)
        command.reported(lambda: checked(config))  # ends here, before Hydra adds lines of its own

    def composed() -> None:
        options, words, folders = _sorted(sys.argv[1:])
        words = start.add_recipe(words, *folders)
        if {"--cfg=job", "-c=job"} & {*options}:
            print(OmegaConf.to_yaml(configuration.compose_raw(words, *folders)), end="")
            return
        line = [*options, *(f"--config-dir={folder}" for folder in folders), *words]
        sys.argv[1:] = _forced(line, groups(*folders))
        hydra.main(config_path=str(CONF), config_name="train", version_base="1.3")(alone)()

    if set(arguments.HELP) & set(sys.argv[1:]):
        print(usage(inspect.getmodule(job)))
        return
    os.environ.setdefault("HYDRA_FULL_ERROR", "1")  # raises here instead of printing there
    command.reported(composed)


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


def usage(module: Any) -> str:
    """What --help of a command with Hydra's overrides prints."""
    text = (CONF / "train.yaml").read_text(encoding="utf-8")
    lines = re.findall(r"^(?:  - )?(\w+): (\S.*?)(?: +# (.*))?$", text, re.MULTILINE)
    scalars = {line[0]: line for line in lines if line[0] in KEYS}.values()  # the last of each
    width = max(len(f"{key}={value}") for key, value, _ in scalars)
    keys = "\n".join(f"  {f'{key}={value}':{width}}  {about}" for key, value, about in scalars)
    return USAGE.format(doc=inspect.getdoc(module), keys=keys).strip()


def _sorted(line: Sequence[str]) -> tuple[list[str], list[str], list[str]]:
    """Options, overrides, and the folder of config_dir=DIR; Hydra's parser takes no mixture."""
    options, words, folders = [], [], []
    texts = iter(enumerate(line))
    for at, text in texts:
        name, equals, value = text.partition("=")
        if name in (*VALUED, *FOLDER) and (equals or name.startswith("-")):
            value = value if equals else next(texts, (at, ""))[1]
            if name in FOLDER:
                search_path(value)  # UsageError unless it is a folder
                folders.append(value)
            else:
                options.append(f"{name}={value}")
        elif name in FLAGS:
            options.append(text)
        elif not name.startswith("-") and (equals or text.startswith("~")):
            words.append(text)
        else:
            pair = "a list in quotes: 'KEY=[A, B]'" if "]" in text else arguments.as_pair(line, at)
            raise UsageError(f"{text}: is no KEY=VALUE; write {pair}")
    return options, words, folders
