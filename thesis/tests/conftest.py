"""Runs that several tests of studies read."""

from pathlib import Path

import pytest
from studied import trained

SHORT = ["total_steps=12", "episode.steps=12", "num_seeds=2"]
CONTACTS = {
    "map": ("experiment=thesis/fig_5_2", "algo=noise_mapping", "belief.capacity=16"),
    "pose": (
        "experiment=thesis/fig_5_4",
        "algo=entropy_localisation",
        "belief.particles=50",
        "goal.samples=10",
    ),
}


@pytest.fixture(scope="session")
def contact_runs(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Folders of two runs of 12 decisions with two learners: of a map and of a pose."""
    folder = tmp_path_factory.mktemp("contacts")
    for name, overrides in CONTACTS.items():
        trained(*overrides, *SHORT, f"run_dir={folder / name}")
    return {name: folder / name for name in CONTACTS}
