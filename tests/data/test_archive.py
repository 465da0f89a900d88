"""Files of policies, demonstrations and maps from anybody: read whole, or refused in one line."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from foreign import no_plain_file

from hybrid_rl.data import archive, demonstrations
from hybrid_rl.data import trained as saved
from hybrid_rl.errors import UsageError
from hybrid_rl.run import saved as trained
from hybrid_rl.types import Spec

WEIGHTS = "policy/trunk/params/Dense_0/kernel"


@pytest.fixture(scope="module")
def policy() -> dict[str, np.ndarray]:
    """The arrays of a policy of the package."""
    with np.load(archive.find("policies/lander.npz")) as file:
        return dict(file)


def described(policy: dict, /, **changes: Any) -> dict[str, np.ndarray]:
    """The arrays with another description."""
    about = json.loads(str(policy["about"])) | changes
    return policy | {"about": np.array(json.dumps(about))}


@pytest.mark.parametrize("kind", ["objects", "words", "path"])
def test_what_no_file_of_ours_holds_is_refused(tmp_path, policy, kind):
    """Objects would be pickles; nothing is unpacked."""
    odd = {"objects": np.array([None]), "words": np.array("a"), "path": np.zeros(4)}[kind]
    np.savez(tmp_path / "a.npz", **policy | {"../x" if kind == "path" else WEIGHTS: odd})
    with pytest.raises(UsageError, match=r"it must be absent|is damaged|must hold numbers"):
        trained.read(str(tmp_path / "a.npz"))
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.npz"]


@pytest.mark.parametrize("kind", ["pipe", "device", "folder", "text"])
def test_what_is_no_archive_is_refused(tmp_path, kind):
    file = tmp_path / "a.npz"
    if kind == "text":
        file.write_bytes(b"hello")
    else:
        no_plain_file(file, kind)
    for read in (demonstrations.load, trained.read):
        with pytest.raises(ValueError, match=r"policy|demonstrations="):
            read(str(file))


def test_arrays_that_no_policy_can_have_are_refused(tmp_path, policy):
    """1e300 is finite in the file, and not in float32."""
    large = policy[WEIGHTS].astype(float)
    large[0, 0] = 1e300
    for changed, words in (
        ({WEIGHTS: large}, "is not finite"),
        ({WEIGHTS: np.full(large.shape, "a")}, "must hold numbers"),
        ({"sizes": np.zeros(3)}, "sizes must be two numbers"),
    ):
        np.savez(tmp_path / "a.npz", **policy | changed)
        with pytest.raises(UsageError, match=words):
            trained.read(str(tmp_path / "a.npz"))


EVIL = {"_target_": "hybrid_rl.files.atomic.write_text", "path": "ran"}
ABOUT: tuple[dict[str, Any], ...] = (
    {"env": EVIL},
    {"policy": {"_target_": "a.B", "x": [[EVIL]]}},
    {"env": {"_target_": "os.system", "command": "true"}},
    {"env": [1]},
    {"env": {"_target_": "hybrid_rl.core.domain.Box"}},
    {"episode": {"action_repeat": "x"}},
    {"episode": {"_target_": "hybrid_rl.training.episode.Episode"}},
    {"policy": {"_target_": "hybrid_rl.policies.linear.Linear", "x": 1}},
    {"policy": {"_target_": "hybrid_rl.policies.linear.Linear", "_args_": []}},
)


@pytest.mark.parametrize("changes", ABOUT, ids=str)
def test_a_description_that_fits_nothing_is_one_line(tmp_path, policy, changes):
    np.savez(tmp_path / "a.npz", **described(policy, **changes))
    with pytest.raises(UsageError, match=r"^policy") as caught:
        trained.read(str(tmp_path / "a.npz"))
    assert str(caught.value).isprintable()
    assert not Path("ran").exists()


EXTERNAL = {"_target_": "hybrid_rl.envs.adapters.external.External", "id": "", "make": ""}
GAUSSIAN = {"_target_": "hybrid_rl.policies.tanh_gaussian.TanhGaussian"}


@pytest.mark.parametrize("key", ["make", "id", "kwargs"])
@pytest.mark.parametrize("name", ["subprocess:getoutput", "antigravity:A-v0"])
def test_a_description_names_no_code_of_others(tmp_path, monkeypatch, policy, key, name):
    """Whether its policy acts, or teaches in the configuration of another run."""
    monkeypatch.chdir(tmp_path)
    given = {"kwargs": {"cmd": "touch ran"}, key: {"cmd": name} if key == "kwargs" else name}
    named = described(policy, env=EXTERNAL | given, policy=GAUSSIAN | {"activation": name})
    np.savez("theirs.npz", **named)
    for read in (trained.read, saved.described):
        with pytest.raises(ValueError, match=f"={name}: is no part of hybrid_rl"):
            read("theirs.npz")
    assert [*Path().iterdir()] == [Path("theirs.npz")]


@pytest.mark.parametrize("key", ["env", "objective", "new"])
def test_a_description_has_no_interpolations(tmp_path, policy, key):
    np.savez(tmp_path / "a.npz", **described(policy, **{key: {"task": "${oc.env:HOME}"}}))
    with pytest.raises(UsageError, match="is an interpolation; it must be a plain value"):
        trained.read(str(tmp_path / "a.npz"))


def test_a_description_does_not_name_its_own_file(tmp_path, policy):
    file = tmp_path / "a.npz"
    itself = {"_target_": "hybrid_rl.data.trained.SavedPolicy", "policy": None}
    itself |= {"file": str(file), "task": "lander", "world": None}
    np.savez(file, **described(policy, policy=itself))
    with pytest.raises(UsageError, match="describes a policy in another file"):
        trained.read(str(file))


@pytest.mark.parametrize(
    "task", ['pendulum"""\nopen("ran","w")\n_="""', "a\x1b]0;t\x07", "${x}", "a b", "..", "\u0430"]
)
def test_a_task_is_a_plain_name(tmp_path, policy, task):
    """It is written into programs and shown on terminals."""
    np.savez(tmp_path / "a.npz", **policy | {"task": np.array(task)})
    with pytest.raises(UsageError, match=r"task=.*: must be letters, digits"):
        trained.read(str(tmp_path / "a.npz"))
    with pytest.raises(ValueError, match="a file needs a name of letters"):
        archive.write(tmp_path / "b.npz", task, Spec(3, 1, 0.05), {})
    assert not (tmp_path / "b.npz").exists()
