"""A live window on a robot in the browser."""
