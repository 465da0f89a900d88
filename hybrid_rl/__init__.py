"""hybrid_rl: robots that learn with intent, batched on MuJoCo MJX and MuJoCo C."""

import os

__version__ = "0.2.0"

# OpenBLAS, which factorises JAX's matrices on a CPU, reads this when it is loaded. Many small
# matrices are factorised at once, and its threads wait for one another: up to 30 times slower.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# In a checkout `envs/` stands beside this package; in a wheel it is inside it.
if not os.path.isdir(os.path.join(os.path.dirname(__file__), "envs")):
    __path__ = [*__path__, os.path.dirname(os.path.dirname(__file__))]
