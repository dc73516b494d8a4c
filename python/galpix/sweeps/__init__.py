"""Sweeps of budgets over captures: one task for each pair, each with a file of its own.

A task is a function of its arguments alone and writes its file whole or not at all, so that it can be done anywhere, by
anyone, as often as it likes: what is there is not done twice, and a worker that is lost costs its task only.

    python -m galpix.sweeps ball drift --budgets budgets.json --out sweep --shard 3/16

does every sixteenth task, for an array of jobs. `sweep` does the same on Dask, or in this process.
"""

from __future__ import annotations

import hashlib
import itertools
import json
import os
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Optional, Union

import numpy as np

from .. import _galpix
from ..sources import open as open_source

SCHEMA = 1
"""The version of the columns and of the names of the files."""

TIMES = ("ns_per_galpixel",)
"""Columns that differ from run to run; all others are the same bits wherever a task is done."""

_BUDGET = (
    "extent",
    "recog",
    "prop",
    "position_frac_bits",
    "velocity_int_bits",
    "velocity_frac_bits",
    "acceleration_int_bits",
    "acceleration_frac_bits",
    "stored_bytes_per_galpixel",
)
_COUNTS = ("holes", "filled", "bullets", "debris", "galdebris", "lost", "collided", "saturated", "edges")
_POSITION = ("worst_px", "mean_px", "truth_worst_px", "truth_mean_px")
_TRUTH = ("psnr_db", "psnr_hold_db", "psnr_known_db", "psnr_inside_db", "ssim", "flip", "missing_percent")

Capture = Union[str, os.PathLike]
Budget = Mapping[str, Any]


def _pyarrow() -> Any:
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError as error:
        raise ImportError(
            "a sweep writes Parquet, and pyarrow is not installed: pip install 'galpix[sweep]'"
        ) from error
    return pyarrow


def shard(text: str) -> tuple[int, int]:
    """Return k and n of a text `k/n`: the k-th of n parts, counted from 1.

    >>> shard("3/16")
    (3, 16)
    """
    parts = text.split("/")
    if len(parts) != 2 or not all(part.isascii() and part.isdigit() for part in parts):
        raise ValueError(f"`{text}` is no shard: give k/n, as 3/16 for the third of sixteen")
    k, n = map(int, parts)
    if not 1 <= k <= n:
        raise ValueError(f"`{text}` is no shard: k counts from 1 to n")
    return k, n


def _digest(capture: Capture) -> str:
    """Return what tells a capture from others of its name: a hash of all files of its folder; of a scene its name."""
    path = Path(os.fspath(capture))
    if not path.exists():
        return f"scene:{path}"
    folder = path if path.is_dir() else path.parent
    digest = hashlib.sha256()
    for file in sorted(file for file in folder.rglob("*") if file.is_file()):
        digest.update(str(file.relative_to(folder)).encode() + b"\0")
        digest.update(hashlib.sha256(file.read_bytes()).digest())
    return digest.hexdigest()


def file_name(capture: Capture, budget: Budget, digest: Optional[str] = None) -> str:
    """Return the name of the file of a task: another one if capture, budget or version of galpix differ."""
    identity = [SCHEMA, _galpix.__version__, digest or _digest(capture), dict(sorted(budget.items()))]
    key = hashlib.sha256(json.dumps(identity, sort_keys=True).encode()).hexdigest()[:16]
    stem = Path(os.fspath(capture).removesuffix("/capture.toml")).name or "capture"
    return f"{stem}-{key}.parquet"


def rows(capture: Capture, budget: Budget) -> list[dict[str, Any]]:
    """Run a capture under a budget; return a row for each frame.

    Parameters
    ----------
    capture : str or path
        As for `galpix.open`.
    budget : mapping
        Options of `Source.report`: frames, extent, recog, prop, fields, rounding, fill, scheme and so on.

    Examples
    --------
    >>> row = rows("drift", {"frames": 2, "recog": 8, "perceptual": False})[1]
    >>> row["capture"], row["frame"], row["worst_px"] <= row["certified_px"]
    ('drift', 2, True)
    """
    report = open_source(capture).report(**budget)
    made = []
    for frame in report["frames"]:
        row = {"capture": report["source"], "frame": frame["frame"]}
        row["budget"] = json.dumps(dict(sorted(budget.items())))
        row.update({name: report["budget"][name] for name in _BUDGET})
        row.update({name: report[name] for name in ("rounding", "fill", "scheme", "scan_out")})
        row.update({name: frame[name] for name in _COUNTS})
        row["certified_px"] = frame["certified_px"]
        row.update({name: (frame["position"] or {}).get(name) for name in _POSITION})
        row.update({name: (frame["truth"] or {}).get(name) for name in _TRUTH})
        row["ns_per_galpixel"] = frame["ns_per_galpixel"]
        made.append(row)
    return made


def _table(made: list[dict[str, Any]]) -> Any:
    pa = _pyarrow()
    texts = ("capture", "budget", "rounding", "fill", "scheme", "scan_out")
    whole = ("frame", *_BUDGET, *_COUNTS)
    kinds = [
        (name, pa.string() if name in texts else pa.int64() if name in whole else pa.float64()) for name in made[0]
    ]
    return pa.Table.from_pylist(made, schema=pa.schema(kinds))


def write(table: Any, path: Path) -> None:
    """Write a table as a Parquet file, whole or not at all."""
    pa = _pyarrow()
    # What a killed process leaves is no Parquet file by its name.
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.stem}-", suffix=".part")
    os.close(handle)
    try:
        pa.parquet.write_table(table, name)
        os.replace(name, path)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise


def task(capture: Capture, budget: Budget, folder: Union[str, os.PathLike], digest: Optional[str] = None) -> str:
    """Do one task unless its file is there; return the file's path.

    Dask, Ray and arrays of jobs call this function. It needs the capture and the folder at the same paths everywhere.
    """
    path = Path(folder) / file_name(capture, budget, digest)
    if not path.exists():
        path.parent.mkdir(parents=True, exist_ok=True)
        write(_table(rows(capture, budget)), path)
    return str(path)


def grid(**axes: Iterable[Any]) -> list[dict[str, Any]]:
    """Return every combination of some options, as a list of budgets.

    >>> grid(recog=(4, 8), rounding=["nearest"])
    [{'recog': 4, 'rounding': 'nearest'}, {'recog': 8, 'rounding': 'nearest'}]
    """
    return [dict(zip(axes, values)) for values in itertools.product(*axes.values())]


def sweep(
    captures: Sequence[Capture],
    budgets: Sequence[Budget],
    folder: Union[str, os.PathLike],
    *,
    client: Any = None,
    shard: tuple[int, int] = (1, 1),
) -> list[str]:
    """Run every capture under every budget; return the Parquet files, one for each pair.

    Parameters
    ----------
    captures : sequence of str or path
        Names of scenes or paths of captures.
    budgets : sequence of mappings
        Options of `Source.report`, see `rows`; `grid` makes all combinations.
    folder : str or path
        Where the files are; what is there is not done again.
    client : dask.distributed.Client, optional
        The tasks run on its workers; a task whose worker is lost is done by another one. In this process if absent.
    shard : (int, int)
        k and n: the k-th of n parts of the tasks, counted from 1.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     files = sweep(["drift"], grid(frames=[2], recog=[4, 8], perceptual=[False]), folder)
    ...     read(folder).num_rows
    4
    """
    k, n = shard
    digests = {os.fspath(capture): _digest(capture) for capture in captures}
    pairs = [(os.fspath(capture), dict(budget)) for capture in captures for budget in budgets][k - 1 :: n]
    if client is None:
        return [task(capture, budget, folder, digests[capture]) for capture, budget in pairs]
    arguments = [(capture, budget, os.fspath(folder), digests[capture]) for capture, budget in pairs]
    futures = client.map(_call, arguments, key="galpix", pure=False, retries=3)
    return client.gather(futures)


def _call(arguments: tuple) -> str:
    return task(*arguments)


def read(folder: Union[str, os.PathLike]) -> Any:
    """Return all rows of a folder as a `pyarrow.Table`, in the order of capture, budget and frame."""
    pa = _pyarrow()
    files = sorted(Path(folder).glob("*.parquet"))
    if not files:
        raise ValueError(f"`{folder}` has no Parquet file: give the folder of a sweep")
    table = pa.concat_tables([pa.parquet.read_table(file) for file in files])
    return table.sort_by([(name, "ascending") for name in ("capture", "budget", "frame")])


def equal_but_for_times(one: Any, other: Any) -> bool:
    """Return whether two tables have the same bits in every column but those of times."""

    def bits(table: Any) -> list[Any]:
        kept = [name for name in table.column_names if name not in TIMES]
        return [kept, *(_bits(table.column(name)) for name in kept)]

    return bits(one) == bits(other)


def _bits(column: Any) -> list[Any]:
    values = column.to_pylist()
    if any(isinstance(value, float) for value in values):
        return [None if value is None else np.float64(value).tobytes() for value in values]
    return values


def points(document: Mapping[str, Any]) -> Any:
    """Return what `galpix error --json` printed as a `pyarrow.Table`, a row for each frame of each point.

    Nothing of the program needs a library for Parquet, so that it builds as quickly as without.
    """
    pa = _pyarrow()
    made: list[dict[str, Any]] = []
    for source in document["sources"]:
        for point in source["points"]:
            bits = point["bits"] or [None] * 5
            for frame in point["frames"]:
                row = {"source": source["source"], "id": point["id"]}
                row.update({name: point.get(name) for name in ("scheme", "lanes", "budget", "rounding", "rung")})
                row.update(
                    dict(
                        zip(
                            (
                                "position_frac",
                                "velocity_int",
                                "velocity_frac",
                                "acceleration_int",
                                "acceleration_frac",
                            ),
                            bits,
                        )
                    )
                )
                row.update({name: point[name] for name in ("bytes", "used_bits", "saturated")})
                for name, time in (("run_time", point["run_time"]), ("compile_time", point["compile_time"])):
                    row[f"{name}_frame_us"] = (time or {}).get("frame_us")
                row.update(_flat(frame))
                made.append(row)
    if not made:
        raise ValueError("the document has no point: give what `galpix error --json` printed")
    names = list(dict.fromkeys(name for row in made for name in row))
    columns = {name: [row.get(name) for row in made] for name in names}
    return pa.table(
        {
            name: pa.array(values, pa.null() if not any(v is not None for v in values) else None)
            for name, values in columns.items()
        }
    )


def _flat(value: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    flat: dict[str, Any] = {}
    for name, item in value.items():
        if isinstance(item, Mapping):
            flat.update(_flat(item, f"{prefix}{name}_"))
        elif not isinstance(item, list):
            flat[prefix + name] = item
    return flat
