#!/usr/bin/env python3
"""Makes docs/assurance.md and docs/data/assurance.json from claims.toml: what is claimed, and how it is checked.

    assurance.py            checks that evidence and steps exist and that both documents are those of the claims
    assurance.py --write    writes them, with the last run of each step from target/test-steps.csv where there is one
"""

import csv
import json
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
PAGE = ROOT / "docs/assurance.md"
DATA = ROOT / "docs/data/assurance.json"
RUNS = ROOT / "target/test-steps.csv"
MEANS = {
    "proof": "shown for all states by a solver, a linker or an induction",
    "exhaustive": "run on every state of a small enough case",
    "differential": "two implementations compared bit by bit",
    "golden": "compared with kept bits, or by a second model with the vectors",
    "mutant": "faults planted, which must be noticed",
    "fuzz": "inputs made by a coverage-guided fuzzer",
    "sampled": "run on chosen or random cases",
    "counted": "instructions, symbols or clauses counted",
}
HEAD = """# What is certain, and how

Written by `tests/assurance/assurance.py --write` from `tests/assurance/claims.toml`; the same rows stand in
[data/assurance.json](data/assurance.json).

**The boundary.** Of the arithmetic of a galpixel, of the order of collisions and of the fills, what is claimed is
proved or enumerated: for the paper's example over all states, for other budgets over all states of small ones, and by
comparison with a second model beyond. Of *pictures* nothing is proved: a certificate bounds the error of a position
against the second-order path that the update gives, not against what the camera or the renderer shows later, and not
what is filled where nothing is known. Of *time* instructions are counted, in emulators and under callgrind; cycles,
caches and buses are not. No board and no FPGA was at hand: logic and firmware ran in simulators. A claim below holds as
far as its row says, and the column *not covered* is part of it.
"""


def runs():
    """Returns the last run of each step: when, of what, how it ended."""
    found = {}
    if RUNS.is_file():
        for row in csv.DictReader(RUNS.open(encoding="utf-8")):
            found[row["step"]] = {"date": row["date"], "commit": row["commit"], "result": row["result"]}
    return found


def rows(claims, last):
    """Returns the claims, numbered, each with its command and its last run."""
    return [
        {
            "number": number,
            **claim,
            "command": f"./test.sh {claim['step']}",
            "last_run": last.get(claim["step"]),
        }
        for number, claim in enumerate(claims, 1)
    ]


def page(found):
    """Returns the document."""
    lines = [HEAD, "| means | what it is |", "| --- | --- |"]
    lines += [f"| {name} | {about} |" for name, about in MEANS.items()]
    lines += ["", "| # | claim | means | over | not covered | evidence | command | last run |", "| --- " * 8 + "|"]
    for row in found:
        run = row["last_run"]
        ran = f"{run['date']}, {run['commit']}: {run['result']}" if run else "not recorded"
        cells = [row["number"], row["says"], row["by"], row["over"], row["uncovered"], f"`{row['evidence']}`"]
        lines.append("| " + " | ".join(map(str, [*cells, f"`{row['command']}`", ran])) + " |")
    return "\n".join(lines) + "\n"


def faults(claims):
    """Yields what is wrong with the claims."""
    steps = (ROOT / "test.sh").read_text(encoding="utf-8")
    for number, claim in enumerate(claims, 1):
        path, _, name = claim["evidence"].partition("::")
        file = ROOT / path
        if not file.exists():
            yield f"claim {number}: {path} does not exist"
        elif name and name not in file.read_text(encoding="utf-8"):
            yield f"claim {number}: nothing called {name} in {path}"
        if claim["by"] not in MEANS:
            yield f"claim {number}: \"{claim['by']}\" is none of {', '.join(MEANS)}"
        if f"step_{claim['step']}()" not in steps:
            yield f"claim {number}: test.sh has no step {claim['step']}"


def main():
    claims = tomllib.loads((Path(__file__).parent / "claims.toml").read_text(encoding="utf-8"))["claim"]
    wrong = list(faults(claims))
    kept = {row["step"]: row["last_run"] for row in json.loads(DATA.read_text(encoding="utf-8"))} if DATA.is_file() else {}
    last = {step: run for step, run in kept.items() if run}
    if "--write" in sys.argv[1:]:
        last |= runs()
    found = rows(claims, last)
    texts = {PAGE: page(found), DATA: json.dumps(found, indent=2) + "\n"}
    for path, text in texts.items():
        if "--write" in sys.argv[1:]:
            path.write_text(text, encoding="utf-8")
        elif not path.is_file() or path.read_text(encoding="utf-8") != text:
            wrong.append(f"{path.relative_to(ROOT)} is not that of the claims: tests/assurance/assurance.py --write")
    for fault in wrong:
        print(fault)
    print(f"{len(claims)} claims, {len(wrong)} faults")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
