"""What exercises each section of the specification: rules of the model that vectors reach, other tests, the design in logic.

`table` is printed by check_vectors.py with --coverage. A section without anything is an error, and so is a test that is
named here and is not there. The unit within a section is a rule of the model (`galpix_model.RULES`), not a sentence.
"""

import re
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent

# Sections that no vector can exercise, or not alone: files with a function that does.
TESTS = {
    2: [("tests/tests/all/exhaustive/budget.rs", None), ("tests/proofs/prove.py", None)],
    12: [("tests/tests/all/memory.rs", "what_is_stored_is_loaded_to_the_last_bit_of_the_budget")],
    13: [("tests/tests/all/objects.rs", "an_object_is_replaced_as_the_reference_says")],
    19: [("tests/tests/all/overlay.rs", "rows_show_what_is_pinned_and_else_the_map")],
}
# Benches and proofs of the design in logic, by the sections that they exercise.
LOGIC = {
    4: ["bench/propagate.sv"],
    5: ["bench/step.sv", "bench/propagate.sv", "proof/step_proof.sv"],
    6: ["bench/frame.sv", "bench/panel.sv"],
    7: ["bench/resolve.sv", "bench/frame.sv", "proof/band_proof.sv"],
    8: ["bench/edges.sv"],
    9: ["bench/panel.sv"],
    10: ["bench/fill.sv", "bench/frame.sv"],
    11: ["bench/frame.sv", "bench/pace.sv"],
}
# What only says how the text is to be read.
NOTATION = {1}


def table(rules, reached):
    """Lines of the report, and sentences on what is missing."""
    text = (ROOT / "docs/spec.md").read_text(encoding="utf-8")
    sections = [(int(number), name) for number, name in re.findall(r"^## (\d+)\. (.+)$", text, re.MULTILINE)]
    all_of, reached_of = Counter(), Counter()
    for rule in rules:
        section = int(rule.split()[0])
        all_of[section] += 1
        reached_of[section] += bool(reached[rule])
    lines, missing = [], []
    for number, name in sections:
        tests, logic = TESTS.get(number, []), LOGIC.get(number, [])
        for path, function in tests:
            file = ROOT / path
            if not file.is_file() or (function and f"fn {function}(" not in file.read_text(encoding="utf-8")):
                missing.append(f"section {number}: {path} has no {function or 'content'}")
        missing += [f"section {number}: there is no firmware/rtl/{path}" for path in logic
                    if not (ROOT / "firmware/rtl" / path).is_file()]
        if not all_of[number] and not tests and number not in NOTATION:
            missing.append(f"section {number}, {name}: nothing exercises it")
        by = [f"{reached_of[number]} of {all_of[number]} rules"] if all_of[number] else []
        by += [function or path for path, function in tests] + logic
        lines.append(f"{number:>3} {name:<28} {', '.join(by) or 'notation'}")
    for number in sorted(set(all_of) - {number for number, _ in sections}):
        missing.append(f"rules name section {number}, which the specification has not")
    return lines, missing
