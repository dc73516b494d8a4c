"""Results: a line of JSON for each entry, scene and frame; a table and a page of them."""

from __future__ import annotations

import html
import json
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, Optional

import numpy as np

from .. import _galpix
from .entries import Entry
from .scores import SCORES, classes, score
from .suite import FRAMES, SUITE, Case

Row = dict[str, Any]


def rows_of(case: Case, entries: Sequence[tuple[str, Entry]]) -> Iterator[Row]:
    """Score entries in a case; make a row for each of its frames that an entry made."""
    frames = case.frames()
    wanted = sorted({frame for scored in frames for frame in (scored - 1, scored) if frame > 0})
    parts = classes(case, frames)
    digest = case.digest()
    seen = set(case.source.truth_frames(max(frames)))
    truths = {frame: case.truth(frame) for frame in (0, *wanted) if frame == 0 or frame in seen}
    for name, entry in entries:
        made = dict(entry(case, wanted))
        made[0] = truths[0].picture
        for frame in frames:
            if frame not in made:
                continue
            shown, truth = np.asarray(made[frame]), truths[frame]
            if shown.dtype != np.uint8 or shown.shape != truth.picture.shape:
                raise ValueError(
                    f"entry `{name}` made {shown.dtype} of shape {shown.shape} of scene `{case.name}`: give uint8 of "
                    f"shape {truth.picture.shape}"
                )
            known = frame - 1 in made and frame - 1 in truths
            before = (np.asarray(made[frame - 1]), truths[frame - 1].picture) if known else None
            row: Row = {"suite": SUITE, "entry": name, "version": _galpix.__version__, "scene": case.name}
            row.update({"scene_sha256": digest, "second_order": case.second_order, "frame": frame})
            row.update(score(np.ascontiguousarray(shown), truth, parts[frame], before))
            yield row


def read(files: Iterable[Path]) -> list[Row]:
    """Return the rows of some files of results; of rows of one entry, scene and frame the last one counts."""
    last: dict[tuple, Row] = {}
    for file in files:
        for number, line in enumerate(Path(file).read_text().splitlines(), 1):
            try:
                row = json.loads(line)
                key = (row["suite"], row["entry"], row["scene"], row["scene_sha256"], row["frame"])
            except (ValueError, KeyError, TypeError) as error:
                raise ValueError(f"line {number} of `{file}` is no row of results: remove it") from error
            last[key] = row
    return list(last.values())


def _means(
    rows: Sequence[Row], measure: str
) -> tuple[list[str], dict[tuple[str, int], tuple[float, float, float, int]]]:
    """Return the entries, the best first at 4 frames, and mean, least, largest and number of scenes by entry and
    frame. A mean is over the scenes that every entry has at that frame."""
    entries = list(dict.fromkeys(row["entry"] for row in rows))
    means: dict[tuple[str, int], tuple[float, float, float, int]] = {}
    for frame in FRAMES:
        by_entry = {
            entry: {
                (row["scene"], row["scene_sha256"]): row[measure]
                for row in rows
                if row["entry"] == entry and row["frame"] == frame and row[measure] is not None
            }
            for entry in entries
        }
        present = [set(values) for values in by_entry.values() if values]
        common = set.intersection(*present) if present else set()
        for entry, values in by_entry.items():
            kept = [values[scene] for scene in sorted(common) if scene in values]
            if kept:
                means[entry, frame] = (sum(kept) / len(kept), min(kept), max(kept), len(kept))
    sign = -1 if measure in ("psnr_db", "psnr_reached_db", "psnr_uncovered_db", "psnr_entering_db", "ssim") else 1
    entries.sort(key=lambda entry: sign * means.get((entry, 4), means.get((entry, 1), (0.0,)))[0])
    return entries, means


def table(rows: Sequence[Row], measure: str = "psnr_db") -> str:
    """Return a table in Markdown: means over the scenes that all entries have, with the range, by frames ahead."""
    entries, means = _means(rows, measure)
    digits = 2 if measure.endswith("_db") or measure.endswith("percent") or measure == "flicker" else 4
    lines = ["| entry | " + " | ".join(f"{frame}" for frame in FRAMES) + " |", "| --- |" + " ---: |" * len(FRAMES)]
    for entry in entries:
        cells = []
        for frame in FRAMES:
            mean = means.get((entry, frame))
            cells.append(
                "" if mean is None else f"{mean[0]:.{digits}f} ({mean[1]:.{digits}f} to {mean[2]:.{digits}f})"
            )
        lines.append(f"| {entry} | " + " | ".join(cells) + " |")
    counts = (
        [means[entries[0], frame][3] if (entries[0], frame) in means else 0 for frame in FRAMES] if entries else []
    )
    lines.append("| *scenes* | " + " | ".join(str(count) for count in counts) + " |")
    return "\n".join(lines)


def _groups(rows: Sequence[Row]) -> list[tuple[str, list[Row]]]:
    groups = [
        ("Scenes whose motion is of second order", [row for row in rows if row["second_order"] is True]),
        ("Scenes whose motion is not", [row for row in rows if row["second_order"] is False]),
        ("Captures", [row for row in rows if row["second_order"] is None]),
    ]
    return [(name, group) for name, group in groups if group]


def _plot(rows: Sequence[Row], measure: str) -> str:
    entries, means = _means(rows, measure)
    values = [mean[0] for mean in means.values()]
    low, high = min(values), max(values)
    span = (high - low) or 1.0
    width, height, left, top = 560, 260, 46, 10
    x = lambda frame: left + FRAMES.index(frame) * (width - left - 10) / (len(FRAMES) - 1)  # noqa: E731
    y = lambda value: top + (high - value) / span * (height - 40)  # noqa: E731
    parts = [f'<svg viewBox="0 0 {width} {height}" role="img" aria-label="{html.escape(measure)} by frames ahead">']
    for frame in FRAMES:
        parts.append(f'<text x="{x(frame):.1f}" y="{height - 8}" text-anchor="middle">{frame}</text>')
    for value in (low, high):
        parts.append(f'<text x="{left - 6}" y="{y(value) + 4:.1f}" text-anchor="end">{value:.2f}</text>')
    for entry in entries:
        points = [(x(frame), y(means[entry, frame][0])) for frame in FRAMES if (entry, frame) in means]
        path = " ".join(f"{px:.1f},{py:.1f}" for px, py in points)
        kind = "galpix" if entry.startswith("galpix") else "other"
        parts.append(f'<polyline class="{kind}" points="{path}"><title>{html.escape(entry)}</title></polyline>')
    return "".join(parts) + "</svg>"


def _html_table(rows: Sequence[Row], measure: str) -> str:
    lines = [line.strip("| ").split(" | ") for line in table(rows, measure).splitlines()]
    body = "".join(
        "<tr>" + "".join(f"<td>{html.escape(cell.strip('*'))}</td>" for cell in line) + "</tr>" for line in lines[2:]
    )
    head = "".join(f"<th>{html.escape(cell)}</th>" for cell in lines[0])
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


_STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; margin: 2rem auto; max-width: 70rem; padding: 0 1rem }
table { border-collapse: collapse; font-size: 13px } td, th { padding: .15rem .6rem; text-align: right }
td:first-child, th:first-child { text-align: left } tr:nth-child(even) { background: #8881 }
svg { max-width: 36rem } svg text { font-size: 11px; fill: currentColor }
polyline { fill: none; stroke: #888; stroke-width: 1.5 } polyline.galpix { stroke: #d9480f }
"""


def write_page(
    rows: Sequence[Row], path: Path, measures: Sequence[str] = ("psnr_db", "flip", "wrong_percent")
) -> None:
    """Write a page of its own: for each group of scenes a plot and a table of each measure."""
    parts = [f"<!doctype html><html lang=en><meta charset=utf-8><title>{SUITE}</title><style>{_STYLE}</style>"]
    parts.append(
        f"<h1>{SUITE}</h1><p>Means over the scenes that all entries have, and their range, by frames ahead of the"
    )
    parts.append(" update. Lines of galpix are coloured; each line says its name.</p>")
    for name, group in _groups(rows):
        parts.append(f"<h2>{html.escape(name)}</h2>")
        for measure in measures:
            parts.append(
                f"<h3>{html.escape(SCORES[measure])}</h3>{_plot(group, measure)}{_html_table(group, measure)}"
            )
    Path(path).write_text("".join(parts) + "</html>\n")


def parquet(rows: Sequence[Row], path: Path) -> None:
    """Write rows as Parquet."""
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError as error:
        raise ImportError(
            "Parquet is written by pyarrow, which is not installed: pip install 'galpix[sweep]'"
        ) from error
    texts, whole = ("suite", "entry", "version", "scene", "scene_sha256"), ("frame",)
    kind = lambda name: (  # noqa: E731
        pyarrow.string()
        if name in texts
        else pyarrow.int64()
        if name in whole
        else pyarrow.bool_()
        if name == "second_order"
        else pyarrow.float64()
    )
    names = list(rows[0]) if rows else []
    schema = pyarrow.schema([(name, kind(name)) for name in names])
    pyarrow.parquet.write_table(pyarrow.Table.from_pylist(list(rows), schema=schema), path)


def tables(rows: Sequence[Row], measure: str) -> str:
    """Return the table of each group of scenes, in Markdown."""
    return "\n\n".join(f"{name}, {SCORES[measure]}:\n\n{table(group, measure)}" for name, group in _groups(rows))


def missing(rows: Sequence[Row]) -> Optional[str]:
    """Return a sentence if there is nothing to show, else None."""
    return None if rows else "there is no row of results: run the suite first"
