#!/usr/bin/env python3
"""Numbers the clauses of docs/spec.md and says what exercises each.

    clauses.py             checks: numbers are in order, and every clause is exercised by something that exists
    clauses.py --number    writes the numbers into docs/spec.md
    clauses.py --report    prints the report as Markdown

A clause is a paragraph or an item of a list, with the tables and formulas that follow it. `clauses.toml` says for each
which rules of the model reach it (tests/model, each of which the golden vectors must reach), which tests and proofs
check it, and which modules of logic hold to it. A clause that informs and decides no bit says so there.
"""

import fnmatch
import re
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
SPEC = ROOT / "docs/spec.md"
EVIDENCE = ("rules", "tests", "proofs", "logic")
NUMBER = re.compile(r"\*\*(\d+)\.(\d+)\*\* ")
sys.path.insert(0, str(ROOT / "tests/model"))
sys.dont_write_bytecode = True

import galpix_model as model  # noqa: E402


def blocks(text):
    """Yields (section, kind, first line, text) of each clause; `kind` is what stands before its number."""
    section, fenced, open_clause, lines = 0, False, False, text.split("\n")
    for index, line in enumerate(lines):
        if line.strip().startswith("```"):
            fenced = not fenced
            continue
        heading = re.match(r"## (\d+)\.", line)
        if heading:
            section, open_clause = int(heading.group(1)), False
        if fenced or not section or line.startswith("#") or line.startswith("|"):
            open_clause = open_clause and not line.startswith("#")
            continue
        if not line.strip():
            open_clause = False
            continue
        item = re.match(r"( *(?:- |\d+\. ))", line)
        # What continues an item or a paragraph is no new clause; nor is text that is set under an item.
        if item or (not open_clause and not line.startswith(" ")):
            # A paragraph in lower case goes on after a formula.
            body = NUMBER.sub("", line[len(item.group(1)):] if item else line)
            if item or not body[0].islower():
                yield section, item.group(1) if item else "", index, body
            open_clause = True


def numbered(text):
    """Returns the text with every clause numbered within its section."""
    lines, counts = text.split("\n"), {}
    for section, before, index, body in list(blocks(text)):
        counts[section] = counts.get(section, 0) + 1
        lines[index] = f"{before}**{section}.{counts[section]}** {body}"
    return "\n".join(lines)


def clauses(text):
    """Returns the beginning of each clause by its number."""
    found, counts = {}, {}
    lines = text.split("\n")
    for section, _, index, body in blocks(text):
        counts[section] = counts.get(section, 0) + 1
        whole = body if len(body) >= 60 else f"{body} {lines[index + 1].strip()}"
        found[f"{section}.{counts[section]}"] = re.sub(r"[*`]", "", whole)
    return found


def missing(kind, name):
    """Returns why a piece of evidence does not exist; nothing if it does."""
    if kind == "rules":
        return None if any(fnmatch.fnmatchcase(rule, name) for rule in model.RULES) else "no rule of the model"
    path, _, inside = name.partition("::")
    file = ROOT / path
    if not file.is_file():
        return "no such file"
    if inside and inside not in file.read_text(encoding="utf-8"):
        return f"nothing called {inside} in it"
    return None


def main():
    text = SPEC.read_text(encoding="utf-8")
    if "--number" in sys.argv[1:]:
        SPEC.write_text(numbered(text), encoding="utf-8")
        return 0
    faults = [] if numbered(text) == text else ["docs/spec.md: numbers are out of order: clauses.py --number"]
    found = clauses(text)
    listed = tomllib.loads((Path(__file__).parent / "clauses.toml").read_text(encoding="utf-8"))
    given = {section: list(entries) for section, entries in listed.items()}
    rules = {rule: 0 for rule in model.RULES}
    rows = []
    for number, beginning in found.items():
        section = given.get(f"section-{number.partition('.')[0]}", [])
        entry = next((entry for entry in section if beginning.startswith(entry["begins"])), None)
        evidence = [(kind, name) for kind in EVIDENCE for name in (entry or {}).get(kind, [])]
        if entry is None or not (evidence or entry.get("informs")):
            faults.append(f"{number}: nothing exercises \"{beginning[:50]}\"")
            continue
        section.remove(entry)
        for kind, name in evidence:
            why = missing(kind, name)
            if why:
                faults.append(f"{number}: {kind}: {name}: {why}")
        reached = {rule for kind, name in evidence if kind == "rules" for rule in rules if fnmatch.fnmatchcase(rule, name)}
        for rule in reached:
            rules[rule] += 1
        rows.append((number, beginning, len(reached), entry))
    for section, entries in given.items():
        faults += [f"{section}: no clause begins with \"{entry['begins']}\"" for entry in entries]
    faults += [f"rule \"{rule}\": belongs to no clause" for rule, count in rules.items() if count == 0]
    if "--report" in sys.argv[1:]:
        print(report(rows))
        return 0
    for fault in faults:
        print(fault)
    informing = sum("informs" in entry for *_, entry in rows)
    print(f"{len(found)} clauses, {informing} of them inform, {len(faults)} faults; {len(rules)} rules of the model")
    return 1 if faults else 0


def report(rows):
    """Returns a table of all clauses."""
    lines = ["| clause | begins | rules of the model | tests and proofs | logic |", "| --- | --- | --- | --- | --- |"]
    for number, beginning, reached, entry in rows:
        if "informs" in entry:
            lines.append(f"| {number} | {beginning[:48]} | informs | | |")
            continue
        tests = ", ".join(f"`{name}`" for name in entry.get("tests", []) + entry.get("proofs", []))
        logic = ", ".join(f"`{Path(name.partition('::')[0]).stem}`" for name in entry.get("logic", []))
        lines.append(f"| {number} | {beginning[:48]} | {reached or ''} | {tests} | {logic} |")
    return "\n".join(lines)


if __name__ == "__main__":
    sys.exit(main())
