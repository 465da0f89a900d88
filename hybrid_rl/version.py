"""The version of this package, and the time of its import."""

from time import monotonic

__version__ = "0.3.0.dev0"
BEGAN = monotonic()  # [s] of a command: hundredths after its process
