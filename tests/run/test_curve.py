"""A curve in plain characters has the values of its points."""

import numpy as np

from hybrid_rl.run.logs import curve


def columns(text):
    """The row of the star in each column, from 0 at the bottom."""
    rows = [line.partition("|")[2].ljust(curve.WIDTH) for line in text.splitlines() if "|" in line]
    assert len(rows) == curve.HEIGHT
    stars = np.array([[mark == "*" for mark in row] for row in reversed(rows)])
    assert (stars.sum(0) == 1).all()
    return stars.argmax(0)


def test_each_column_has_one_star_at_the_height_of_the_line():
    x, y = [100, 300, 600], [-10.0, 1230.0, 610.0]
    text = curve.drawn(x, y, "Return", "decisions")
    rows = columns(text)
    assert (rows[0], rows.max(), rows[-1]) == (0, curve.HEIGHT - 1, (curve.HEIGHT - 1) // 2)
    top = round((curve.WIDTH - 1) * 200 / 500)
    assert (np.diff(rows[: top + 1]) >= 0).all()
    assert (np.diff(rows[top + 1 :]) <= 0).all()
    lines = text.splitlines()
    assert lines[0] == "Return"
    assert lines[1].startswith("1,230 |")
    assert lines[curve.HEIGHT].startswith("  -10 |")
    assert lines[-1].split() == ["100", "600", "decisions"]
    assert text.isascii()


def test_limits_that_lie_close_together_have_more_digits():
    lines = curve.drawn([1, 2], [-1.62, -1.48], "", "").splitlines()
    assert (lines[1].split()[0], lines[curve.HEIGHT].split()[0]) == ("-1.48", "-1.62")


def test_a_constant_is_a_line_at_the_bottom():
    assert (columns(curve.drawn([1, 2], [5.0, 5.0], "", "")) == 0).all()
