"""A benchmark of frame extrapolation that anyone can run again: one update in, later frames out, held against truth.

    python -m galpix.bench --out results.jsonl --page bench.html

An entry is a function of the update and of the numbers of the frames that are wanted: it sees no pixel of the truth.
The suite is frozen: `SUITE` names its version, and `suite-1.json` has a hash of every picture of its scenes, so that a
figure of today can stand beside one of next year.
"""

from .entries import ENTRIES, Entry
from .results import read, rows_of, table, write_page
from .scores import SCORES, score
from .suite import FRAMES, SUITE, Case, captures, scenes

__all__ = [
    "ENTRIES",
    "FRAMES",
    "SCORES",
    "SUITE",
    "Case",
    "Entry",
    "captures",
    "read",
    "rows_of",
    "scenes",
    "score",
    "table",
    "write_page",
]
