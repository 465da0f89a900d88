"""hybrid_rl: robots that learn with intent, batched on MuJoCo MJX and MuJoCo C."""

import os

__version__ = "0.2.0"

# In a checkout `envs/` stands beside this package; in a wheel it is inside it.
if not os.path.isdir(os.path.join(os.path.dirname(__file__), "envs")):
    __path__ = [*__path__, os.path.dirname(os.path.dirname(__file__))]
