"""Tests that run the same MJX program run in one process, which compiles it once."""

import pytest


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    """One xdist group for each "task-mjx" in a test's brackets."""
    for item in items:
        case = item.name.partition("[")[2].rstrip("]")
        if case.endswith("-mjx"):
            item.add_marker(pytest.mark.xdist_group(case))
