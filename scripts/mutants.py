"""Do the tests catch a bug? Each of these is planted in a copy of the tree, one at a time.

    .venv/bin/python scripts/mutants.py            all of them, for many minutes
    .venv/bin/python scripts/mutants.py fisher     those whose name contains all words given

Only the tests that should notice a bug are run. The exit code is 1 if a bug stays unseen, or if a
changed sentence fails a test.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SENTENCE = "sentence"  # changed on a page: no test may fail
RESULTS = "thesis/tests/test_results.py"


@dataclass(frozen=True)
class Mutant:
    """Text of a file, what replaces it, and the tests that should fail."""

    file: str
    old: str
    new: str
    tests: str


MUTANTS = {
    "softmax weighs the worst plans": Mutant(
        "hybrid_rl/core/sampling.py",
        "exponent = reward_to_go / temperature",
        "exponent = -reward_to_go / temperature",
        "tests/core tests/controllers",
    ),
    "adjoint without the policy's feedback": Mutant(
        "hybrid_rl/core/adjoint.py",
        "rho = j_x + jax.vjp(policy, x)[1](g)[0] + f_x",
        "rho = j_x + f_x",
        "tests/core tests/controllers",
    ),
    "mode insertion gradient of the other sign": Mutant(
        "hybrid_rl/core/adjoint.py",
        "jump = objective(other) - objective(path)",
        "jump = objective(path) - objective(other)",
        "tests/core tests/controllers",
    ),
    "robots in the browser clip actions at the wrong end": Mutant(
        "scripts/browser/javascript.py",
        '"min": "Math.min({}, {})"',
        '"min": "Math.max({}, {})"',
        "tests/test_browser.py",
    ),
    "discount counted twice": Mutant(
        "hybrid_rl/core/returns.py",
        "y = r + discount * continues * value",
        "y = r + discount**2 * continues * value",
        "tests/core",
    ),
    "terminal states are bootstrapped": Mutant(
        "hybrid_rl/core/actor_critic.py",
        "(1 - batch.terminated)[None]",
        "jnp.ones_like(batch.terminated)[None]",
        "tests/core",
    ),
    "a time limit counts as an end": Mutant(
        "hybrid_rl/training/wrappers.py",
        "now.replace(truncated=truncated, info",
        "now.replace(terminated=truncated | now.terminated, info",
        "tests/training",
    ),
    "fisher information with a wrong exponent": Mutant(
        "hybrid_rl/core/fisher.py",
        "return -jnp.sum(1 / (total + prior))",
        "return -jnp.sum(1 / (total + prior) ** 2)",
        "tests/core tests/objectives",
    ),
    "a checkpoint is lost": Mutant(
        "hybrid_rl/run/checkpoints/checkpoint.py",
        "    draft.rename(path)\n",
        "    shutil.rmtree(draft)\n",
        "tests/run",
    ),
    "a resumed run forgets its record": Mutant(
        "hybrid_rl/run/checkpoints/store.py",
        'Record(**(own | {"ends": {}}))',
        'Record(**(own | {"ends": {}, "wall_s": 0.0, "step": 0}))',
        "tests/run",
    ),
    "a misspelt override is ignored": Mutant(
        "hybrid_rl/settings/complete.py",
        "if select(raw, path) is not LACKING:",
        "if True:",
        "tests/cli tests/test_errors.py",
    ),
    "violations in the tail count for the chance": Mutant(
        "hybrid_rl/controllers/gradient.py",
        "risk[:T].max()",
        "risk.max()",
        "tests/controllers/test_constrained.py",
    ),
    "no part of a batch is of the run's own decisions": Mutant(
        "hybrid_rl/data/replay.py",
        "jnp.maximum(given, first)",
        "first",
        "tests/data/test_replay.py",
    ),
    "an evaluation in Gymnasium is paid beyond the end": Mutant(
        "hybrid_rl/outside/host_loop.py",
        "np.where(done, 0, [got.reward, got.violated])",
        "[got.reward, got.violated]",
        "tests/outside/test_host_loop.py",
    ),
    "an action is repeated beyond the end": Mutant(
        "envs/adapters/external.py",
        "            if ended or cut:\n                break\n",
        "",
        "tests/outside/test_host_loop.py",
    ),
    "a broken-off episode leaves its plan": Mutant(
        "hybrid_rl/run/online.py",
        "zeros_like(self._past)\n        self._decide.begin()",
        "zeros_like(self._past)",
        "tests/run/test_online.py",
    ),
    "the critic is its own target": Mutant(
        "hybrid_rl/core/actor_critic.py",
        "self.critic.value(state.target, paths.x[-1]",
        "self.critic.value(state.critic, paths.x[-1]",
        "tests/learners/test_model_based.py",
    ),
    "a number on a page": Mutant(
        "docs/results/planning.md",
        "| half the mass | 2,863 |",
        "| half the mass | 2,864 |",
        RESULTS,
    ),
    "a number in a page's JSON": Mutant(
        "docs/results/fig_5_4_gains.json", '"good": [', '"good": [7, ', RESULTS
    ),
    f"a {SENTENCE} on a page": Mutant(
        "docs/results/chapter5.md",
        "is as good as ours if R",
        "does as well as ours if R",
        "",
    ),
}


def copy(folder: Path) -> None:
    """A clone of the repository, with what is changed here and not committed."""
    subprocess.run(["git", "clone", "-q", str(ROOT), str(folder)], check=True)
    listed = ["git", "ls-files", "--modified", "--others", "--exclude-standard", "-z"]
    names = subprocess.run(listed, cwd=ROOT, check=True, capture_output=True).stdout.split(b"\0")
    for name in filter(None, map(os.fsdecode, names)):
        if (ROOT / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, folder / name)


def failed(folder: Path, tests: str) -> str:
    """The first test that fails in `folder`; "" if none does."""
    line = [sys.executable, "-m", "pytest", "-q", "-x", "-n", "2", "--dist", "loadgroup"]
    cache = os.environ.get("JAX_COMPILATION_CACHE_DIR", str(ROOT / ".cache" / "jax"))
    env = {**os.environ, "PYTHONPATH": str(folder), "JAX_COMPILATION_CACHE_DIR": cache}
    done = subprocess.run(
        [*line, *tests.split()], cwd=folder, env=env, capture_output=True, text=True, check=False
    )
    found = re.findall(r"^FAILED (\S+)", done.stdout, re.MULTILINE)
    if not found and done.returncode:
        raise SystemExit(f"the tests did not run:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return found[0] if found else ""


def main() -> int:
    """Plant each bug, run the tests, report."""
    chosen = {k: m for k, m in MUTANTS.items() if all(word in k for word in sys.argv[1:])}
    if not chosen:
        raise SystemExit(f"none is named so; choose words of: {'; '.join(MUTANTS)}")
    unseen = 0
    for name, mutant in chosen.items():
        with tempfile.TemporaryDirectory() as temporary:
            copy(folder := Path(temporary) / "copy")
            path = folder / mutant.file
            text = path.read_text(encoding="utf-8")
            if mutant.old not in text:
                raise SystemExit(f"{mutant.file} no longer holds {mutant.old!r}")
            path.write_text(text.replace(mutant.old, mutant.new, 1), encoding="utf-8")
            began = time.monotonic()
            by = failed(folder, mutant.tests or f"{RESULTS} tests/test_links.py")
            fine = bool(by) != (SENTENCE in name)
            unseen += not fine
            took = f"{time.monotonic() - began:.0f} s"
            print(
                f"{'fine' if fine else 'BAD'}  {name}: {by or 'no test fails'} ({took})", flush=True
            )
    return int(unseen > 0)


if __name__ == "__main__":
    sys.exit(main())
