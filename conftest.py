"""What all tests run under: a CPU, strict shapes, and compiled programs kept between runs.

They are set as environment variables before JAX is imported, so that commands which a test starts
have them, too.
"""

import gc
import os
import pickle
from contextlib import suppress
from dataclasses import replace
from functools import cache, partial
from importlib.metadata import version
from pathlib import Path
from threading import local

import pytest

HERE = Path(__file__).resolve().parent
CACHE = HERE / ".cache" / "jax"
FLAGS = ["--xla_backend_optimization_level=0"]  # a third less to compile, same mathematics
if version("jaxlib").startswith("0.10."):  # later releases abort at unknown flags
    # The emitters would compute the frames of a long chain of bodies again and again: MJX's
    # kinematics of an arm took 6 s instead of 2 ms. Parts of a program compile in parallel, at
    # a tenth more time in all, and every core has a worker already.
    FLAGS += [
        "--xla_cpu_use_fusion_emitters=false",
        "--xla_cpu_parallel_codegen_split_count=1",
    ]
# What fixtures replace inside of Hydra and OmegaConf, to save time, is as in these releases.
KNOWN = version("hydra-core").startswith("1.3.") and version("omegaconf").startswith("2.3.")
SETTINGS = {
    "JAX_PLATFORMS": "cpu",
    "JAX_NUMPY_RANK_PROMOTION": "raise",
    "JAX_COMPILATION_CACHE_DIR": str(CACHE),
    "JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS": "0.5",
    "JAX_PERSISTENT_CACHE_MIN_ENTRY_SIZE_BYTES": "-1",
    "MPLBACKEND": "agg",
    "XLA_FLAGS": " ".join(FLAGS),
}

for name, value in SETTINGS.items():
    os.environ.setdefault(name, value)

gc.set_threshold(50_000, 50, 50)  # tracing makes many objects that stay

PARTS = 6  # commits that share the tests of a folder of tests/, each of which has its part
SLOW = [  # MJX compiles these for up to 40 s each
    f"{task}-mjx"
    for task in (
        "halfcheetah",
        "hopper",
        "quadcopter",
        "walker2d",
        "ant",
        "humanoid",
        "legs",
        "panda_stack",
        "reach",
        "sawyer_push",
        "sawyer_torque",
        "sprk",
        "swimmer",
    )
]


def pytest_addoption(parser):
    about = "run all tests: every robot under MJX, and those that commits take in turns"
    parser.addoption("--slow", action="store_true", help=about)


def pytest_configure(config):
    line = "turns(n): a commit runs every n-th of these tests, chosen by its hash"
    config.addinivalue_line("markers", line)


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config, items):
    """Give the tests of a file one worker; deselect slow tests and those of other commits."""
    for item in items:
        if item.get_closest_marker("xdist_group") is None:
            item.add_marker(pytest.mark.xdist_group(item.path.stem))
    if config.getoption("--slow"):
        return
    left = {item for item in items if any(name in item.nodeid for name in SLOW)}
    if not config.option.keyword and all(Path(each).name == "tests" for each in config.args):
        left |= others_turn(items)  # a folder, file or name that was asked for is run whole
    config.hook.pytest_deselected(items=[item for item in items if item in left])
    items[:] = [item for item in items if item not in left]


def others_turn(items):
    """The tests that another commit runs: TURN of the environment, else the hash, chooses.

    Those that read a fixture of their module run together, and so do those of equal parameters.
    """
    from hybrid_rl.run.machine.provenance import git_commit

    turn = int(os.environ.get("TURN") or f"0x{git_commit() or 0}", 0)
    places, left = {}, set()
    for item in items:
        mark, folders = item.get_closest_marker("turns"), item.path.relative_to(HERE).parts
        n = mark.args[0] if mark else PARTS if folders[0] == "tests" and folders[2:] else 1
        made = [each[-1] for each in item._fixtureinfo.name2fixturedefs.values()]
        shared = any(each.scope == "module" and each.baseid.endswith(".py") for each in made)
        of = "" if shared else item.callspec.id if hasattr(item, "callspec") else item.name
        before = places.setdefault(n, {})
        if (before.setdefault((item.path, of), len(before)) - turn) % n:
            left.add(item)
    return left


@pytest.fixture(scope="session", autouse=True)
def small_programs():
    """Workers also cache programs of under 0.5 s; commands do not, as two at once could collide."""
    import jax

    jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.0)


@pytest.fixture(scope="session", autouse=version("jax").startswith("0.10."))
def few_contexts():
    """Programs of a thread share an MLIR context, ten each, as in JAX 0.11; one takes 2 to 4 ms.

    What is lowered while another program is lowered has its own: it would become a part of it.
    """
    from jax._src.interpreters import mlir
    from jaxlib.mlir import ir

    make, kept = mlir.make_ir_context, local()

    def context():
        if ir.Context.current is not None:
            return make()
        if getattr(kept, "left", 0) == 0:
            kept.context, kept.left = make(), 10
        kept.left -= 1
        return kept.context

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(mlir, "make_ir_context", context)
        yield


@pytest.fixture(scope="session", autouse=KNOWN)
def parsed_once():
    """YAML and references that were read before are not parsed again."""
    import yaml
    from omegaconf import OmegaConf, base
    from omegaconf._utils import get_yaml_loader

    parsed, load = cache(partial(yaml.load, Loader=get_yaml_loader())), OmegaConf.load

    def remembered(file):
        if not hasattr(file, "read"):
            with Path(file).open(encoding="utf-8") as stream:
                return remembered(stream)
        start, found = file.tell(), None
        with suppress(yaml.YAMLError):
            found = parsed(file.read())
        if isinstance(found, (dict, list)):
            return OmegaConf.create(found)
        file.seek(start)  # an error names the file
        return load(file)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(OmegaConf, "load", staticmethod(remembered))
        patch.setattr(base, "parse", cache(base.parse))
        yield


@pytest.fixture(scope="session", autouse=KNOWN)
def composed_once():
    """Hydra composes a command's configuration one time, and resolves no name that is fixed.

    Without `hydra.mode` it would compose all of it only to find that none is set; and for each
    group of a defaults list it makes a configuration of all choices, in case a name refers to them.
    """
    from hydra._internal import defaults_list as defaults
    from hydra._internal.hydra import Hydra
    from hydra.core.default_element import InputDefault

    mode, choices = Hydra.get_mode, defaults._create_interpolation_map
    resolve = InputDefault._resolve_interpolation_impl

    def mode_of(self, config_name, overrides):
        given = any("hydra.mode" in word for word in overrides)
        return mode(self, config_name, overrides) if given else None

    def choices_of(overrides, elements, self_added):
        parts = ("path", "group", "value")
        refers = any("${" in str([getattr(each, part, "") for part in parts]) for each in elements)
        return choices(overrides, elements, self_added) if refers else None

    def resolved(self, known, name):
        fixed = isinstance(name, str) and "${" not in name
        return name if fixed else resolve(self, known, name)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Hydra, "get_mode", mode_of)
        patch.setattr(defaults, "_create_interpolation_map", choices_of)
        patch.setattr(InputDefault, "_resolve_interpolation_impl", resolved)
        yield


@pytest.fixture(scope="session", autouse=KNOWN)
def merged_once():
    """Hydra merges the files of equal choices one time, and puts the values into a copy.

    Files of this repository do not change meanwhile; of all others the key has the texts.
    """
    from hydra._internal import config_loader_impl as loader
    from hydra._internal.defaults_list import Overrides

    Loader, lists, merged = loader.ConfigLoaderImpl, {}, {}  # the last by the id of a list
    make, merge = loader.create_defaults_list, Loader._compose_config_from_defaults_list

    def files(repo):
        sources = repo.get_sources()
        folders = [Path(each.path) for each in sources if each.scheme() == "file"]
        others = [each for each in folders if not each.is_relative_to(HERE)]
        found = sorted(file for folder in others for file in folder.rglob("*.yaml"))
        return [each.path for each in sources], [(file, file.read_bytes()) for file in found]

    def listed(repo, config_name, overrides_list, **options):
        values = Overrides(repo=repo, overrides_list=overrides_list).config_overrides
        chosen = [each for each in overrides_list if each not in values]
        key = str((config_name, [each.input_line for each in chosen], options, files(repo)))
        if key not in lists:
            lists[key] = make(repo, config_name, chosen, **options)
        return replace(lists[key], config_overrides=values)

    def copied(self, defaults, repo):
        if id(defaults) not in merged:  # the list is kept, so that no other one has its id
            merged[id(defaults)] = defaults, pickle.dumps(merge(self, defaults, repo))
        return pickle.loads(merged[id(defaults)][1])

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(loader, "create_defaults_list", listed)
        patch.setattr(Loader, "_compose_config_from_defaults_list", copied)
        yield


@pytest.fixture(scope="module", autouse=True)
def frozen():
    """What the files before this one left is not searched for garbage again."""
    gc.collect()
    gc.freeze()


@pytest.fixture
def can_draw():
    """Whether this machine can draw; if not, it names the packages to install."""
    from hybrid_rl.envs.mujoco import offscreen

    try:
        offscreen.backend()
    except offscreen.NoGraphicsError:
        with pytest.raises(offscreen.NoGraphicsError, match="install libegl1 or libosmesa6"):
            offscreen.backend()
        return False
    return True


@pytest.fixture
def draws(can_draw):
    """For tests of pictures alone: skips them where this machine cannot draw."""
    if not can_draw:
        pytest.skip("needs libegl1 or libosmesa6")
