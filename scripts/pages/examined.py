"""The lines of the doctor on broken and on sound runs: docs/results/doctor.json, as tables."""

from scripts.pages.values import read


def table(kind: str) -> str:
    """A row for each run of a kind in the JSON, with the checks that found something."""
    rows = ["| run | check | line |", "|---|---|---|"]
    for name, found in read("doctor")[kind].items():
        for check, line in found.items() or [("", "nothing")]:
            rows.append(f"| {name} | {check} | {line} |")
            name = ""
    return "\n".join(rows) + "\n"
