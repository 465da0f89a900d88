"""What every number on README.md and docs/results/*.md is recomputed from."""
