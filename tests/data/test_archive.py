"""Files of policies, demonstrations and maps from anybody: read whole, or refused in one line."""

import json
import warnings
import zipfile
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from foreign import no_plain_file

from hybrid_rl.beliefs.maps import learned
from hybrid_rl.data import archive, demonstrations
from hybrid_rl.errors import UsageError
from hybrid_rl.run import saved as trained
from hybrid_rl.types import Spec, Transition

WEIGHTS = "policy/trunk/params/Dense_0/kernel"


@pytest.fixture(scope="module")
def policy() -> dict[str, np.ndarray]:
    """The arrays of a policy of the package."""
    with np.load(archive.find("policies/lander.npz")) as file:
        return dict(file)


@pytest.fixture(scope="module")
def recorded(tmp_path_factory) -> bytes:
    """A file of demonstrations."""
    rng, flags = np.random.default_rng(0), np.zeros((2, 12))
    obs, after = rng.normal(size=(2, 12, 3))
    rows = Transition(obs, rng.uniform(-1, 1, (12, 1)), obs[:, 0], *flags, after)
    file = tmp_path_factory.mktemp("recorded") / "a.npz"
    demonstrations.save(file, "pendulum", 0.05, rows, np.arange(12) // 4)
    return file.read_bytes()


def refused(file: Path) -> None:
    """The file is refused by one line, whoever reads it."""
    for read in (demonstrations.load, trained.read):
        with pytest.raises(ValueError, match=r"policy|demonstrations=") as caught:
            read(str(file))
        assert str(caught.value).isprintable()


def described(policy: dict, /, **changes: Any) -> dict[str, np.ndarray]:
    """The arrays with another description."""
    about = json.loads(str(policy["about"])) | changes
    return policy | {"about": np.array(json.dumps(about))}


def npy(shape: str, dtype: str = "'<f4'", fortran: bool = False, version: int = 1) -> bytes:
    """A .npy file of 16 bytes of zeros, with a header of one's own."""
    text = f"{{'descr': {dtype}, 'fortran_order': {fortran}, 'shape': {shape}}}"
    head = text.encode("latin1").ljust(117) + b"\n"
    return b"\x93NUMPY" + bytes([version, 0]) + len(head).to_bytes(2, "little") + head + bytes(16)


MEMBERS = {  # what each member of a .npz is made of, which claims to be an array
    "negative": npy("(-4,)"),
    "overflow": npy("(4294967296, 4294967296)"),
    "petabyte": npy("(281474976710656,)"),
    "short": npy("(3,)"),
    "objects": npy("(2,)", "'|O'"),
    "records": npy("(1,)", "[('a', '<f8'), ('b', '<f8')]"),
    "nested": npy("(" * 40),
    "words": npy("print(1)"),
    "version": npy("(4,)", version=3),
    "no header": b"hello",
    "empty": b"",
}


@pytest.mark.parametrize("name", MEMBERS)
def test_an_array_whose_header_lies_is_refused(tmp_path, policy, name):
    """Before memory is taken for it; in both kinds of files."""
    for key in (WEIGHTS, "obs"):
        file = tmp_path / "a.npz"
        np.savez(file, **{n: array for n, array in policy.items() if n != key})
        with zipfile.ZipFile(file, "a") as data:
            data.writestr(f"{key}.npy", MEMBERS[name])
        with pytest.raises(ValueError, match=r"is damaged, cut short|must hold numbers|lacks"):
            archive.read("policy:", file, ["obs"] if key == "obs" else ())


def test_a_small_file_does_not_become_large(tmp_path, policy):
    """An array that is not needed is not read; all of them together have a limit."""
    file = tmp_path / "a.npz"
    np.savez_compressed(file, **policy, obs=np.zeros(2**27, np.int8))
    assert file.stat().st_size < 1e6
    with pytest.raises(ValueError, match="would need 100 times its size in memory"):
        archive.read("policy:", file)
    assert "obs" not in archive.read("policy:", file, ["dt"])


@pytest.mark.parametrize("name", ["../../x", "/etc/x", "task", "dt.npy"])
def test_names_of_members_are_no_paths_and_occur_once(tmp_path, policy, name):
    """Nothing is unpacked."""
    file = tmp_path / "a.npz"
    np.savez(file, **policy)
    with zipfile.ZipFile(file, "a") as data, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        data.writestr(name, npy("(4,)"))
    with pytest.raises(UsageError, match=r"it must be absent|is damaged, cut short"):
        trained.read(str(file))
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.npz"]


@pytest.mark.parametrize("kind", ["pipe", "device", "folder", "text", "npy", "protected"])
def test_what_is_no_archive_is_refused(tmp_path, policy, kind):
    file = tmp_path / "a.npz"
    if kind in ("pipe", "device", "folder"):
        no_plain_file(file, kind)
    elif kind in ("text", "npy"):
        file.write_bytes({"text": b"hello", "npy": npy("(4,)")}[kind])
    else:
        np.savez(file, **policy)
        data = bytearray(file.read_bytes())
        for at in (data.find(b"PK\x01\x02") + 8, 6):  # the flag of a password, in both headers
            data[at] |= 1
        file.write_bytes(data)
    refused(file)


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


EVIL = {"_target_": "hybrid_rl.run.files.integrity.write_text", "path": "ran"}
ABOUT: tuple[dict[str, Any], ...] = (
    {"env": EVIL},
    {"policy": {"_target_": "a.B", "x": [[EVIL]]}},
    {"env": [1]},
    {"seed": []},
    {"step": "1e400"},
    {"env": {"_target_": "hybrid_rl.core.domain.Box"}},
    {"episode": {"action_repeat": "x"}},
    {"episode": {"_target_": "hybrid_rl.training.episode.Episode"}},
    {"policy": {"_target_": "hybrid_rl.policies.linear.Linear", "x": 1}},
)


@pytest.mark.parametrize("changes", ABOUT, ids=str)
def test_a_description_that_fits_nothing_is_one_line(tmp_path, policy, changes):
    np.savez(tmp_path / "a.npz", **described(policy, **changes))
    with pytest.raises(UsageError, match=r"^policy") as caught:
        trained.read(str(tmp_path / "a.npz"))
    assert str(caught.value).isprintable()
    assert not Path("ran").exists()


def test_a_description_may_not_nest_without_end_or_name_its_own_file(tmp_path, policy):
    file, nested = tmp_path / "a.npz", "0"
    for _ in range(900):
        nested = '{"a": ' + nested + "}"
    itself = {"_target_": "hybrid_rl.data.trained.SavedPolicy", "policy": None}
    itself |= {"file": str(file), "task": "lander", "world": None}
    texts = ["[" * 100_000, '{"env":' * 100_000, "7", "null", ""]
    nodes = [described(policy, policy=node)["about"] for node in (json.loads(nested), itself)]
    for about in [*texts, *nodes]:
        np.savez(file, **policy | {"about": np.array(about)})
        with pytest.raises(UsageError, match=r"^policy"):
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


def mutated(whole: bytes) -> list[bytes]:
    """60 copies with a few bytes changed, and 20 that are cut."""
    rng, copies = np.random.default_rng(7), []
    for number in range(60):
        data = bytearray(whole)
        for at in rng.integers(len(data), size=1 + number % 8):
            data[at] = rng.integers(256)
        copies.append(bytes(data))
    return copies + [whole[:at] for at in rng.integers(len(whole), size=20)]


def test_mutated_files_are_read_whole_or_refused(tmp_path, policy, recorded):
    """Stored without compression, so that changes reach the arrays; the check sums are theirs."""
    file, accepted = tmp_path / "a.npz", {"policy": 0, "demonstrations": 0, "map": 0}
    np.savez(file, **policy)
    learned.save(tmp_path / "map.npz", np.eye(4) - 0.5, np.zeros(2), np.ones(2), 1.0)
    readers = {
        "policy": (file.read_bytes(), lambda: trained.read(str(file)).params),
        "demonstrations": (recorded, lambda: demonstrations.load(file)),
        "map": ((tmp_path / "map.npz").read_bytes(), lambda: learned._load.__wrapped__(str(file))),
    }
    for name, (whole, read) in readers.items():
        file.write_bytes(whole)
        expected = repr(read())  # what a change of the unused bytes leaves
        for data in mutated(whole):
            file.write_bytes(data)
            with suppress(ValueError):
                assert repr(read()) == expected
                accepted[name] += 1
    assert all(count < 60 for count in accepted.values())
