"""Rows in a file, which one process writes and another reads."""

import errno
import os
import resource

import numpy as np
import pytest

from hybrid_rl.errors import UsageError
from hybrid_rl.outside.row_log import RowLog
from hybrid_rl.types import Spec

SPEC = Spec(obs=3, act=1, dt=0.1)


@pytest.fixture
def log(tmp_path):
    """Three rows in a file."""
    log = RowLog(tmp_path / "rows", SPEC)
    for number in range(3):
        row = np.zeros((), log.kind)
        row["number"], row["obs"] = number, number
        log.append(row)
    return log


def test_rows_are_read_as_they_were_written(log):
    assert [log.read(i)["obs"].tolist() for i in range(3)] == [[0] * 3, [1] * 3, [2] * 3]
    assert log.read(3) is None


@pytest.mark.parametrize("cut", [1, 40])
def test_a_torn_row_is_cut_off(log, tmp_path, cut):
    file = tmp_path / "rows"
    file.write_bytes(file.read_bytes()[:-cut])
    assert log.read(2) is None
    assert log.recover()["number"] == 1
    assert file.stat().st_size == 2 * log.kind.itemsize
    row = np.zeros((), log.kind)
    row["number"] = 2
    log.append(row)
    assert log.read(2)["number"] == 2


def test_a_row_that_the_disk_has_no_room_for_is_an_error(log, tmp_path):
    row = np.zeros((), log.kind)
    row["number"] = 3
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (3 * log.kind.itemsize + 10, limits[1]))
    try:
        with pytest.raises(OSError, match=os.strerror(errno.EFBIG)):
            log.append(row)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert log.recover()["number"] == 2
    log.append(row)
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
