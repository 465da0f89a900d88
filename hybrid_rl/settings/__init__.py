"""From words to parts: overrides, the composed configuration, the run that is built from it."""
