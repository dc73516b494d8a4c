"""Runs the benchmark."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Optional

from ..sweeps import shard
from . import results
from .entries import ENTRIES, applies, named
from .scores import SCORES
from .suite import SCENES, captures, freeze, scenes


def main(arguments: Optional[Sequence[str]] = None) -> int:
    """Score entries in the scenes of the suite; print a table; append a line for each entry, scene and frame."""
    parser = argparse.ArgumentParser(prog="python -m galpix.bench", description=main.__doc__)
    parser.add_argument("--out", type=Path, help="a file of results, which is appended to")
    parser.add_argument(
        "--entry",
        action="append",
        default=[],
        help="a name, NAME=FOLDER of PNG files as "
        "SCENE/0001.png, or NAME=MODULE:FUNCTION of the update and the frames [default: all names]",
    )
    parser.add_argument("--scene", action="append", default=[], choices=SCENES, help="[default: all]")
    parser.add_argument("--captures", action="append", type=Path, default=[], help="a folder of captures, too")
    parser.add_argument("--no-scenes", action="store_true", help="captures alone")
    parser.add_argument(
        "--shard",
        type=shard,
        default=(1, 1),
        metavar="K/N",
        help="the K-th of N parts of all pairs of a scene and an entry",
    )
    parser.add_argument("--read", action="append", type=Path, default=[], help="show these results; run nothing")
    parser.add_argument("--measure", default="psnr_db", choices=SCORES, help="what the table shows")
    parser.add_argument("--page", type=Path, help="write a page")
    parser.add_argument("--parquet", type=Path, help="write the rows as Parquet")
    parser.add_argument("--list", action="store_true", help="print the names of the entries")
    parser.add_argument("--freeze", action="store_true", help="print the hashes of the scenes: for a new version")
    given = parser.parse_args(arguments)
    if given.list or given.freeze:
        print("\n".join(ENTRIES) if given.list else freeze(), end="\n" if given.list else "")
        return 0
    try:
        rows = results.read(given.read) if given.read else run(given)
        problem = results.missing(rows)
        if problem:
            raise ValueError(problem)
        if given.page:
            results.write_page(rows, given.page)
        if given.parquet:
            results.parquet(rows, given.parquet)
        print(results.tables(rows, given.measure))
    except (ValueError, OSError, ImportError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


def run(given: argparse.Namespace) -> list[results.Row]:
    """Run what is asked for; return its rows."""
    entries = [named(text) for text in given.entry or ENTRIES]
    cases = [] if given.no_scenes else list(scenes(given.scene or SCENES))
    cases += captures(given.captures)
    k, n = given.shard
    wanted = {(case.name, name) for case in cases for name, _ in entries}
    ordered = [(case.name, name) for case in cases for name, _ in entries]
    wanted = set(ordered[k - 1 :: n])
    rows: list[results.Row] = []
    for case in cases:
        mine = [(name, entry) for name, entry in entries if (case.name, name) in wanted and not applies(name, case)]
        for row in results.rows_of(case, mine):
            rows.append(row)
            if given.out:
                with given.out.open("a") as file:
                    file.write(json.dumps(row) + "\n")
        print(f"{case.name}: {len(mine)} entries", file=sys.stderr)
    return rows


if __name__ == "__main__":
    sys.exit(main())
