"""The command line of `train`: options, the help, and overrides for Hydra to compose."""

import inspect
import os
import re
import sys
from collections.abc import Callable, Sequence
from typing import Any

import hydra
from hydra.core.hydra_config import HydraConfig
from omegaconf import DictConfig, OmegaConf

from hybrid_rl.cli import arguments, command
from hybrid_rl.errors import UsageError
from hybrid_rl.run import start
from hybrid_rl.settings import build as configuration
from hybrid_rl.settings import words as overrides
from hybrid_rl.settings.groups import CONF, groups, search_path

SWEEP, SHOW = ("-m", "--multirun"), ("-c", "--cfg")
FOLDER = ("config_dir", "--config-dir", "-cd")  # as of other commands, and of Hydra
KEYS = (*configuration.READ, "schedule", "settings", "experiment", "sweep")  # in the help
# GROUP=NAME of a part, of one value
CHOICE = re.compile(r"^((?!hydra|task|algo|settings|experiment)[\w@./]+=)([\w./-]+)$")
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
Job = Callable[[DictConfig, Sequence[str]], Any]  # (composed configuration, overrides)


def main(job: Job) -> None:
    """Run `job` on the configuration that the command line composes; -m: on those of a sweep.

    A choice of Hydra's own, such as hydra/launcher, makes a sweep, if only of one job.
    """
    if set(arguments.HELP) & set(sys.argv[1:]):
        print(usage(inspect.getmodule(job)))
        return

    def composed() -> None:
        options, words, folders = _sorted(sys.argv[1:])
        words = start.add_recipe(words, *folders)
        if {*SWEEP} & {*options} or any(text.startswith("hydra/") for text in words):
            _sweep(job, words, folders)
            return
        config = configuration.compose_raw(words, *folders)
        if {*SHOW} & {*options}:
            print(OmegaConf.to_yaml(config), end="")
        else:
            job(config, words)

    command.reported(composed)


def _sweep(job: Job, words: Sequence[str], folders: Sequence[str]) -> None:
    """Let Hydra's sweeper, cli.sweep, run the jobs."""

    def one(config: DictConfig) -> Any:
        made: Any = HydraConfig.get()
        return job(configuration.read(config, made), overrides.of_job(made))

    names = groups(*folders)
    # a choice of one value is for the jobs, too: the default method may lack the part
    words = [
        CHOICE.sub(r"\1choice(\2)", text) if overrides.is_group(text, names) else text
        for text in overrides.forced(words, names)
    ]
    sys.argv[1:] = ["-m", *(f"--config-dir={folder}" for folder in folders), *words]
    os.environ.setdefault("HYDRA_FULL_ERROR", "1")  # raises here instead of printing there
    hydra.main(config_path=str(CONF), config_name="train", version_base="1.3")(one)()


def usage(module: Any) -> str:
    """What --help of a command with Hydra's overrides prints."""
    text = (CONF / "train.yaml").read_text(encoding="utf-8")
    lines = re.findall(r"^(?:  - )?(\w+): (\S.*?)(?: +# (.*))?$", text, re.MULTILINE)
    scalars = {line[0]: line for line in lines if line[0] in KEYS}.values()  # the last of each
    width = max(len(f"{key}={value}") for key, value, _ in scalars)
    keys = "\n".join(f"  {f'{key}={value}':{width}}  {about}" for key, value, about in scalars)
    return USAGE.format(doc=inspect.getdoc(module), keys=keys).strip()


def _sorted(line: Sequence[str]) -> tuple[list[str], list[str], list[str]]:
    """Options, overrides, and the folder of config_dir=DIR."""
    options, words, folders = [], [], []
    texts = iter(line)
    for text in texts:
        name, equals, value = text.partition("=")
        if name in (*SHOW, *FOLDER) and (equals or name.startswith("-")):
            value = value if equals else next(texts, "")
            if name in FOLDER:
                search_path(value)  # UsageError unless it is a folder
                folders.append(value)
            else:
                options.append(name)
        elif text in SWEEP:
            options.append(text)
        elif not name.startswith("-") and (equals or text.startswith("~")):
            words.append(text)
        else:
            raise UsageError(f"{text}: write KEY=VALUE, a list in quotes, 'KEY=[A, B]'")
    return options, words, folders
