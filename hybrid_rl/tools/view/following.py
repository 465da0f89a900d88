"""The newest checkpoint of a run that is training."""

import threading
from contextlib import suppress
from pathlib import Path

from hybrid_rl import CheckpointError, Trained, newest
from hybrid_rl.tools.view.subject import learner
from hybrid_rl.types import Params

EVERY = 2.0  # [s] between two looks at the folder


class Follower:
    """Reads the parameters of newer checkpoints in a thread."""

    def __init__(self, folder: Path, trained: Trained, seed: int | None) -> None:
        """Begin; seed: of the learner, None is the first."""
        self._folder, self._seed = folder, seed
        self._trained, self._found = trained, None
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._watch, daemon=True, name="follow")
        self._thread.start()

    def newest(self) -> tuple[Params, int] | None:
        """Parameters and step of a checkpoint that was not given before."""
        found, self._found = self._found, None
        return found

    def close(self) -> None:
        """End the thread."""
        self._over.set()

    def _watch(self) -> None:
        while not self._over.wait(EVERY):
            with suppress(CheckpointError):  # replaced while it was read; the next one follows
                if trained := newest(self._trained, self._folder):
                    self._trained = trained
                    self._found = learner(trained, self._seed), trained.step
