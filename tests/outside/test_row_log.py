"""Rows in a file, which one process writes and another reads."""

import errno
import os

import numpy as np
import pytest
from tiny import limited

from hybrid_rl.errors import UsageError
from hybrid_rl.outside.row_log import RowLog
from hybrid_rl.types import Spec

SPEC = Spec(obs=3, act=1, dt=0.1)


def append(log, number):
    """One more row."""
    row = np.zeros((), log.kind)
    row["number"] = number
    log.append(row)


@pytest.fixture
def log(tmp_path):
    """Three rows in a file."""
    log = RowLog(tmp_path / "rows", SPEC)
    for number in range(3):
        append(log, number)
    return log


@pytest.mark.parametrize("cut", [1, 40])
def test_a_torn_row_is_cut_off(log, tmp_path, cut):
    file = tmp_path / "rows"
    file.write_bytes(file.read_bytes()[:-cut])
    assert log.read(2) is None
    assert log.recover()["number"] == 1
    assert file.stat().st_size == 2 * log.kind.itemsize
    append(log, 2)
    assert log.read(2)["number"] == 2


def test_a_row_that_the_disk_has_no_room_for_is_an_error(log, tmp_path):
    full = pytest.raises(OSError, match=os.strerror(errno.EFBIG))
    with limited(3 * log.kind.itemsize + 10), full:
        append(log, 3)
    assert log.recover()["number"] == 2
    append(log, 3)
    assert log.read(3)["number"] == 3


def test_a_damaged_row_is_not_read(log, tmp_path):
    file = tmp_path / "rows"
    data = bytearray(file.read_bytes())
    data[2 * log.kind.itemsize + 30] ^= 1
    file.write_bytes(data)
    assert log.read(2) is None
    assert log.read(1) is not None


def test_rows_of_another_kind_are_refused_and_stay(log, tmp_path):
    before = (tmp_path / "rows").read_bytes()
    with pytest.raises(UsageError, match="rows: has rows of another version or robot; begin"):
        RowLog(tmp_path / "rows", SPEC._replace(act=2))
    assert (tmp_path / "rows").read_bytes() == before
