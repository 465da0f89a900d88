"""Trained policies in files: those of policies/, which come with the package, or one's own.

A file is that of hybrid_rl.data.trained. Its `about` is JSON with the world, the episode and the
policy as in config.yaml of the run, and with the command, the seed and the evaluation.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import jax
from omegaconf import DictConfig, OmegaConf

from hybrid_rl import config as configuration
from hybrid_rl.controllers.policy import PolicyController
from hybrid_rl.core import archive
from hybrid_rl.core.lifting import is_identity
from hybrid_rl.data.trained import TrainedPolicy, part
from hybrid_rl.envs.mujoco.physics import resolve
from hybrid_rl.errors import UsageError, shown
from hybrid_rl.evaluate import Trained, load
from hybrid_rl.run import folder as run_folder
from hybrid_rl.run.jax_settings import prepare
from hybrid_rl.run.reading import from_json, json_file
from hybrid_rl.run.results import RunFolder
from hybrid_rl.training.episode import Episode
from hybrid_rl.types import Params

PARTS, COUNTS = ("env", "episode", "policy"), ("seed", "step")  # of `about`
UNFIT = (TypeError, AttributeError, LookupError, ArithmeticError, AssertionError, RecursionError)


def names() -> list[str]:
    """The policies that come with the package."""
    return sorted(path.stem for each in archive.PARENTS for path in each.glob("policies/*.npz"))


def chosen(given: Mapping[str, Any]) -> Trained:
    """What the arguments run=DIR or policy=NAME name.

    Raises:
        UsageError: if both or none are given, or what they name is unusable.
    """
    if bool(given["run"]) == bool(given["policy"]):
        raise UsageError(
            "run, policy: give one of them; run=DIR is a folder that training wrote, "
            f"policy=NAME one of {', '.join(names())} or a file"
        )
    return read(given["policy"]) if given["policy"] else load(Path(given["run"]))


def read(name: str) -> Trained:
    """The policy NAME of the package, or that in a file whose name ends in .npz.

    Raises:
        UsageError: if there is none, or it is unusable.
    """
    file = Path(name) if name.endswith(".npz") else Path("policies", f"{name}.npz")
    prefix, known = f"policy={name}:", f"choose a file, or one of {', '.join(names())}"
    try:
        arrays = archive.read(prefix, file, hint=known)
        if archive.ABOUT not in arrays:
            raise UsageError(f"{prefix} has no description; write it again with `demonstrate`")
        about = _described(prefix, str(arrays[archive.ABOUT]))
        prepare(configuration.load([]))
        return _trained(prefix, str(file), str(arrays["task"]), about)
    except UsageError:
        raise
    except ValueError as error:
        raise UsageError(str(error)) from error
    except UNFIT as error:
        raise UsageError(f"{prefix} its description fits no policy ({shown(error)})") from error


def _trained(prefix: str, file: str, task: str, about: dict[str, Any]) -> Trained:
    """The policy that a description names, with the parameters in `file`."""
    env = _environment(prefix, file, about["env"])
    trained = TrainedPolicy(None, file, task, env, about["episode"])
    controller = PolicyController(trained.policy, explore=False)
    return Trained(
        task,
        Episode(env, **about["episode"]),
        {"full": controller, "policy": controller},
        Params(policy=jax.tree.map(lambda leaf: leaf[None], trained.load())),
        (about["seed"],),
        about["step"],
        tuple(_origin(about)),
        _world(task, about),
    )


def _world(task: str, about: Mapping[str, Any]) -> DictConfig:
    """What a description says of its world, as in the configuration of a run of one seed."""
    parts = {name: about[name] for name in ("env", "episode")}
    return OmegaConf.create({"task": task, "num_seeds": 1, "num_envs": 1, **parts})


def _described(prefix: str, text: str) -> dict[str, Any]:
    """`about` of a file."""
    try:
        about = from_json(text)
    except ValueError as error:
        raise UsageError(f"{prefix} its description is damaged") from error
    kinds = {**dict.fromkeys(PARTS, dict), **dict.fromkeys(COUNTS, int)}
    missing = [key for key in kinds if not isinstance(about, dict) or key not in about]
    if missing:
        raise UsageError(f"{prefix} its description lacks {', '.join(missing)}")
    if wrong := [key for key, kind in kinds.items() if type(about[key]) is not kind]:
        raise UsageError(f"{prefix} {wrong[0]} of its description is of a wrong kind")
    return about


def _environment(prefix: str, file: str, node: dict[str, Any]) -> Any:
    """The environment that a description names, with physics of this machine."""
    if isinstance(node.get("physics"), str):
        node = node | {"physics": resolve(node["physics"], 1)}
    return part(prefix, file, node)


def _origin(about: Mapping[str, Any]) -> list[str]:
    """Lines about how a policy was made."""
    lines = []
    if about.get("command"):
        lines.append(f"trained by: {shown(about['command'])}")
    match about.get("evaluation"):
        case {"mean": int() | float() as mean, "returns": list() as returns}:
            lines.append(f"evaluated then: {mean:,.1f} (mean of {len(returns)} episodes)")
    return lines


def description(folder: Path, trained: Trained, command: str) -> dict[str, Any] | None:
    """`about` of the policy of the first seed of the run in `folder`.

    None if its controller `policy` is not a policy of observations alone.
    """
    config = run_folder.read(folder, "run")
    node = config.controllers.get("policy")
    controller: Any = trained.controllers.get("policy")
    if not isinstance(controller, PolicyController):
        return None
    model = trained.learner(mode="policy")[1].model
    if not is_identity(controller.model, model, trained.episode.spec.obs):
        return None
    parts: Any = {
        "env": OmegaConf.to_container(config.env),
        "episode": OmegaConf.to_container(config.episode),
        "policy": OmegaConf.to_container(node.policy),
    }
    if isinstance(parts["env"].get("physics"), str):
        parts["env"]["physics"] = "auto"
    about = {**parts, "algo": config.algo, "seed": trained.seeds[0], "step": trained.step}
    summary = RunFolder(folder).summary
    made = {key: summary.get(key) for key in ("device", "versions", "git_commit")}
    return {**about, "command": command, "evaluation": _evaluation(folder, trained.step), **made}


def _evaluation(folder: Path, step: int) -> dict[str, Any] | None:
    """Mean and returns of the first seed in evaluation_policy.json of this step, if there are."""
    file = folder / "evaluation_policy.json"
    if not file.exists() or (values := json_file(file)).get("step") != step:
        return None
    try:
        return {"mean": float(values["mean"][0]), "returns": list(map(float, values["returns"][0]))}
    except (TypeError, ValueError, LookupError) as error:
        raise UsageError(f"{file}: is no evaluation that `evaluate` wrote") from error
