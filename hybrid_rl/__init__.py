"""hybrid_rl: robots that learn with intent, batched on MuJoCo MJX and MuJoCo C."""

from pathlib import Path

__version__ = "0.1.0"

# In a checkout `envs/` stands beside this package; in a wheel it is inside it.
if not (Path(__file__).parent / "envs").is_dir():
    __path__ = [*__path__, str(Path(__file__).parents[1])]
