"""The numbers of paper/paper.md, which are those of README.md."""

from pages import chapter3, lookahead, readme
from pages.cited import Text

PAGE = "paper/paper.md"

HYBRID, SAC = lookahead.hybrid("half-cheetah"), chapter3.default("half-cheetah", "sac")
CITED = [
    Text("interquartile mean of # [#, #] after", HYBRID.at(50_000)),
    Text("there, has # [#, #]", SAC.at(50_000)),
    Text("finds the highest peak in # of # trials", readme.SEARCH),
    Text("it needs # measurements", [readme.chapter6_values.KLE3]),
    Text("travelling to the acquisition's maximum needs #", [readme.chapter6_values.LQR]),
    Text("stops in # of # falls", [readme.AT_REST, readme.FALLS["trials"]]),
]
PLAIN = ["date: 22 November 2026", "index: 1", "affiliation: 1", "after 50,000 decisions"]
