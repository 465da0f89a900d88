"""What the tests of runs share."""

from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import pytest

SCRIPT = Path(__file__).parents[2] / "scripts" / "interrupt.py"


@pytest.fixture(scope="module")
def interrupt():
    """scripts/interrupt.py."""
    spec = spec_from_file_location("interrupt", SCRIPT)
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
