"""The newest checkpoint of a run that is training."""

import threading
from pathlib import Path

from hybrid_rl import CheckpointError, Trained
from hybrid_rl.run.checkpoints import checkpoint
from hybrid_rl.run.saved import build_run, of
from hybrid_rl.tools.view.subject import learner
from hybrid_rl.types import Params

EVERY = 2.0  # [s] between two looks at the folder


class Follower:
    """Reads the parameters of newer checkpoints in a thread."""

    def __init__(self, folder: Path, trained: Trained, seed: int | None) -> None:
        """Begin; seed: of the learner, None is the first."""
        assert trained.config is not None
        self._folder, self._seed, self._config = folder, seed, trained.config
        self._step, self._found = trained.step, None
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
        run = None
        while not self._over.wait(EVERY):
            steps = checkpoint.steps(self._folder / "checkpoints")
            if not steps or steps[-1] <= self._step:
                continue
            run = run or build_run(self._config)
            try:
                trained = of(run, self._folder)
            except CheckpointError:  # replaced while it was read; the next one follows
                continue
            self._step = trained.step
            self._found = learner(trained, self._seed), trained.step
