"""Runs a sweep, or a part of one."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Optional

from . import _pyarrow, points, shard, sweep, write


def main(arguments: Optional[Sequence[str]] = None) -> int:
    """Do the tasks of a shard in this process; or turn documents of `galpix error --json` into Parquet."""
    parser = argparse.ArgumentParser(prog="python -m galpix.sweeps", description=main.__doc__)
    parser.add_argument("captures", nargs="+", help="scenes or captures; with --points, documents")
    parser.add_argument("--budgets", type=Path, help="a JSON file: a list of objects of options of Source.report")
    parser.add_argument("--out", type=Path, required=True, help="the folder; with --points, the Parquet file")
    parser.add_argument("--shard", type=shard, default=(1, 1), metavar="K/N", help="the K-th of N parts of the tasks")
    parser.add_argument("--points", action="store_true", help="write what `galpix error --json` printed as Parquet")
    given = parser.parse_args(arguments)
    try:
        if given.points:
            pa = _pyarrow()
            tables = [points(json.loads(Path(name).read_text())) for name in given.captures]
            write(pa.concat_tables(tables, promote_options="permissive"), given.out)
            return 0
        if given.budgets is None:
            parser.error("--budgets is missing: give a JSON file with a list of budgets")
        for file in sweep(given.captures, json.loads(given.budgets.read_text()), given.out, shard=given.shard):
            print(file)
    except (ValueError, TypeError, OSError, ImportError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
