"""Tests that run the same MJX program share a process: it is compiled once."""

import pytest


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    """One group for each "task-mjx" between a test's brackets."""
    for item in items:
        case = item.name.partition("[")[2].rstrip("]")
        if case.endswith("-mjx"):
            item.add_marker(pytest.mark.xdist_group(case))
