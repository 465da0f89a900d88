"""Errors of a run: each message is one line, and each class has its exit code."""


class UsageError(ValueError):
    """The request is invalid; the message says what to change. Exit code 2."""


class DivergenceError(ArithmeticError):
    """A learner reached NaN or infinity; names seed, step and quantity. Exit code 1."""


class CheckpointError(OSError):
    """A checkpoint cannot be written, or none can be read. Exit code 1."""


class MisfitError(CheckpointError):
    """A checkpoint is intact but belongs to another run."""


def shown(words: object) -> str:
    """Words of a file or a user in a line of ours: what a terminal would obey is escaped."""
    return "".join(c if c.isprintable() else ascii(c)[1:-1] for c in str(words))
