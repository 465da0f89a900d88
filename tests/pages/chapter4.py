"""docs/results/chapter4.md."""

from pages import chapter4_active, chapter4_exploration, chapter4_queries

PAGE = "docs/results/chapter4.md"
CITED = [*chapter4_active.CITED, *chapter4_exploration.CITED, *chapter4_queries.CITED]
PLAIN = [
    "jax 0.10, unless",
    *chapter4_active.PLAIN,
    *chapter4_exploration.PLAIN,
    *chapter4_queries.PLAIN,
]
