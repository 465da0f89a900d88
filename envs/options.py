"""Checks of options that are given as strings."""


def one_of(field: str, value: str, allowed: tuple[str, ...]) -> None:
    """Raise ValueError unless `value` is one of `allowed`."""
    if value not in allowed:
        raise ValueError(f"{field}={value!r}: choose one of {', '.join(allowed)}")
