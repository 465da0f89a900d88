"""A file that is being written replaces an older one only once it is complete."""

import errno

import pytest

from hybrid_rl.drafts import replacing


def write(file, error):
    """Write half of `file`, then raise `error`."""
    with replacing(file) as draft:
        draft.write_text("half")
        raise error


@pytest.mark.parametrize(
    "error", [OSError(errno.ENOSPC, "No space left on device"), KeyboardInterrupt()]
)
def test_an_error_leaves_the_older_file(tmp_path, error):
    file = tmp_path / "figure.png"
    file.write_text("older")
    with pytest.raises(type(error)) as raised:
        write(file, error)
    assert file.read_text() == "older"
    assert [*tmp_path.iterdir()] == [file]
    assert getattr(raised.value, "filename", str(file)) == str(file)


def test_the_draft_ends_like_the_file_and_replaces_it(tmp_path):
    file = tmp_path / "figure.png"
    file.write_text("older")
    with replacing(file) as draft:
        assert draft.suffix == ".png"
        draft.write_text("newer")
        assert file.read_text() == "older"
    assert file.read_text() == "newer"
    assert [*tmp_path.iterdir()] == [file]
