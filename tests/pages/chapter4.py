"""docs/results/chapter4.md."""

from pages import chapter4_exploration

PAGE = "docs/results/chapter4.md"
CITED = [*chapter4_exploration.CITED]
PLAIN = [*chapter4_exploration.PLAIN]
