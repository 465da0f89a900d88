"""What can go wrong with a run: each message is one line, and each class has its exit code."""


class UsageError(ValueError):
    """The request makes no run; the line says what would. Exit code 2."""


class DivergenceError(ArithmeticError):
    """A learner reached NaN or infinity; the line names seed, step and quantity. Exit code 1."""


class CheckpointError(OSError):
    """A checkpoint cannot be written, or none can be read. Exit code 1."""


class MisfitError(CheckpointError):
    """A checkpoint is sound, and belongs to another run."""
