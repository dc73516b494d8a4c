"""Entries: sample-and-hold, forward warps in floats, an integer splat, and galpix in both schemes with every fill.

An entry is called with a case and the frames that are wanted. Those of this file but galpix with hidden layers see the
update alone; what joins from outside always does.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Optional

import numpy as np

from ..inpainting import inpaint
from ..sources import Update
from .suite import Case

Pictures = Mapping[int, np.ndarray]
"""uint8, shape (rows, columns, 3) of the display, by frame."""
Entry = Callable[[Case, Sequence[int]], Pictures]
"""An entry of the benchmark."""
Predictor = Callable[[Update, Sequence[int]], Pictures]
"""What others write: a function of the update and of the frames that are wanted."""


def display(array: np.ndarray, update: Update) -> np.ndarray:
    """Return the part of an array of the update that the display shows."""
    left, right, top, bottom = update.margin
    rows, columns = array.shape[:2]
    return np.ascontiguousarray(array[top : rows - bottom, left : columns - right])


def of_update(predictor: Predictor) -> Entry:
    """Make an entry of a function of the update."""

    def entry(case: Case, frames: Sequence[int]) -> Pictures:
        return predictor(case.update(), frames)

    return entry


def hold(update: Update, frames: Sequence[int]) -> Pictures:
    """Show the update's picture until the next update: sample-and-hold."""
    picture = display(update.colour, update)
    return {frame: picture for frame in frames}


def _arrivals(update: Update, frame: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return the known samples' numbers, their places x and y after some frames, and their depths there."""
    rows, columns = update.depth.shape
    samples = np.flatnonzero(update.known)
    velocity, acceleration = update.velocity.reshape(-1, 3)[samples], update.acceleration.reshape(-1, 3)[samples]
    way = velocity * frame + acceleration * (0.5 * frame * frame)
    depth = update.depth.reshape(-1)[samples] + way[:, 2]
    return samples, samples % columns + way[:, 0], samples // columns + way[:, 1], depth


def _nearest(update: Update, frame: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the colours of the nearest sample that arrives at each cell, and where one does. Ties go to the first."""
    rows, columns = update.depth.shape
    samples, x, y, depth = _arrivals(update, frame)
    x, y = np.floor(x + 0.5).astype(np.int64), np.floor(y + 0.5).astype(np.int64)
    inside = (x >= 0) & (x < columns) & (y >= 0) & (y < rows)
    samples, cells, depth = samples[inside], (y * columns + x)[inside], depth[inside]
    order = np.lexsort((samples, depth))[::-1]
    winner = np.full(rows * columns, -1, np.int64)
    winner[cells[order]] = samples[order]
    colours = update.colour.reshape(-1, 3)[np.maximum(winner, 0)].reshape(rows, columns, 3)
    return colours, (winner >= 0).reshape(rows, columns)


def float_nearest(update: Update, frames: Sequence[int]) -> Pictures:
    """Move every sample in floats to the nearest cell; the nearer wins; holes keep the update's colour."""
    made = {}
    for frame in frames:
        colours, arrived = _nearest(update, frame)
        made[frame] = display(np.where(arrived[..., None], colours, update.colour), update)
    return made


def float_nearest_inpainted(update: Update, frames: Sequence[int]) -> Pictures:
    """Move every sample in floats to the nearest cell; holes are filled by push-pull without depth."""
    made = {}
    for frame in frames:
        colours, arrived = _nearest(update, frame)
        made[frame] = display(inpaint(colours, ~arrived), update)
    return made


NEAR = 1.0 / 64.0
"""Depths that differ by less, as a part of the depth range, are of one surface."""


def float_bilinear(update: Update, frames: Sequence[int]) -> Pictures:
    """Spread every sample in floats over four cells by bilinear weights; of each cell the nearest surface counts; what
    gets less than a quarter of a sample keeps the update's colour."""
    rows, columns = update.depth.shape
    made = {}
    for frame in frames:
        samples, x, y, depth = _arrivals(update, frame)
        left, top = np.floor(x).astype(np.int64), np.floor(y).astype(np.int64)
        corners = []
        for dy in (0, 1):
            for dx in (0, 1):
                weight = np.abs(1 - dx - (x - left)) * np.abs(1 - dy - (y - top))
                cx, cy = left + dx, top + dy
                inside = (cx >= 0) & (cx < columns) & (cy >= 0) & (cy < rows) & (weight > 1 / 64)
                corners.append(((cy * columns + cx)[inside], weight[inside], depth[inside], samples[inside]))
        cells, weights, depths, sources = (np.concatenate(parts) for parts in zip(*corners))
        front = np.full(rows * columns, np.inf)
        # A sample that touches a cell with a corner alone does not hide what fills it.
        counts = weights >= 0.25
        np.minimum.at(front, cells[counts], depths[counts])
        seen = depths <= front[cells] + NEAR
        cells, weights, sources = cells[seen], weights[seen], sources[seen]
        sums = [
            np.bincount(cells, weights * update.colour.reshape(-1, 3)[sources, channel], rows * columns)
            for channel in range(3)
        ]
        total = np.bincount(cells, weights, rows * columns)
        with np.errstate(invalid="ignore", divide="ignore"):
            mean = np.stack(sums, axis=-1) / total[:, None]
        arrived = (total >= 0.25)[:, None]
        colours = np.where(arrived, np.floor(mean + 0.5), update.colour.reshape(-1, 3)).astype(np.uint8)
        made[frame] = display(colours.reshape(rows, columns, 3), update)
    return made


_STEPS = 8
"""Parts of a pixel in which the splat keeps a displacement."""


def _catmull_rom(fraction: np.ndarray) -> np.ndarray:
    """Return the weights of four neighbours of the cubic convolution with a = -1/2; shape (4, ...)."""
    t = fraction
    return np.stack(
        [
            ((-0.5 * t + 1.0) * t - 0.5) * t,
            (1.5 * t - 2.5) * t * t + 1.0,
            ((-1.5 * t + 2.0) * t + 0.5) * t,
            (0.5 * t - 0.5) * t * t,
        ]
    )


def splat(update: Update, frames: Sequence[int]) -> Pictures:
    """Splat displacements as integers, then sample the update's picture at where each cell came from.

    The scheme of Mob-FGSR (SIGGRAPH 2024), in our own words and without its super-resolution: each sample writes one
    32-bit word to the cell nearest to where it arrives, 11 bits of depth above 11 and 10 bits of its displacement in x
    and y (here in eighths of a pixel, so that ways of up to 128 and 64 pixels fit), and the smallest word stays. A cell
    without one takes the word of the farthest of its neighbours, ring by ring. Then every cell samples the picture
    where its word says that it came from, by cubic convolution over 4 x 4 pixels.
    """
    rows, columns = update.depth.shape
    source = update.colour.astype(np.float64)
    gy, gx = np.mgrid[:rows, :columns]
    made = {}
    for frame in frames:
        samples, x, y, depth = _arrivals(update, frame)
        step_x = np.floor((x - samples % columns) * _STEPS + 0.5).astype(np.int64)
        step_y = np.floor((y - samples // columns) * _STEPS + 0.5).astype(np.int64)
        x, y = np.floor(x + 0.5).astype(np.int64), np.floor(y + 0.5).astype(np.int64)
        fits = (np.abs(step_x) < 1024) & (np.abs(step_y) < 512)
        fits &= (x >= 0) & (x < columns) & (y >= 0) & (y < rows)
        deep = (np.clip(depth, 0, 1) * 2047 + 0.5).astype(np.int64)
        word = (deep << 21 | (step_x + 1024) << 10 | (step_y + 512))[fits]
        words = np.full(rows * columns, -1, np.int64)
        empty = np.int64(2**32)
        words[:] = empty
        np.minimum.at(words, (y * columns + x)[fits], word)
        words = words.reshape(rows, columns)
        # Farther words are larger, but a cell without any is none of them.
        known = np.where(words == empty, -1, words)
        while (known < 0).any():
            if (known < 0).all():
                known[:] = 1024 << 10 | 512
                break
            wide = np.pad(known, 1, constant_values=-1)
            ring = np.maximum.reduce([wide[:-2, 1:-1], wide[2:, 1:-1], wide[1:-1, :-2], wide[1:-1, 2:]])
            known = np.where(known < 0, ring, known)
        from_x = gx - ((known >> 10 & 2047) - 1024) / _STEPS
        from_y = gy - ((known & 1023) - 512) / _STEPS
        left, top = np.floor(from_x).astype(np.int64), np.floor(from_y).astype(np.int64)
        weights_x, weights_y = _catmull_rom(from_x - left), _catmull_rom(from_y - top)
        colour = np.zeros((rows, columns, 3))
        for j in range(4):
            row = np.clip(top + j - 1, 0, rows - 1)
            for i in range(4):
                column = np.clip(left + i - 1, 0, columns - 1)
                colour += (weights_y[j] * weights_x[i])[..., None] * source[row, column]
        made[frame] = display(np.clip(np.floor(colour + 0.5), 0, 255).astype(np.uint8), update)
    return made


def galpix(**options: Any) -> Entry:
    """Make an entry of the engine with some options of `Source.run`."""

    def entry(case: Case, frames: Sequence[int]) -> Pictures:
        made = case.source.run(frames=max(frames), prop=32, **options).frames
        return {frame: made[frame - 1] for frame in frames}

    return entry


def folder(path: Path) -> Entry:
    """Make an entry of a folder of PNG files: `SCENE/0001.png` is frame 1 of a scene, 8 bits, of the display's size."""

    def entry(case: Case, frames: Sequence[int]) -> Pictures:
        made = {}
        for frame in frames:
            file = path / case.name / f"{frame:04}.png"
            if file.exists():
                made[frame] = _png(file)
        return made

    return entry


def _png(file: Path) -> np.ndarray:
    try:
        from PIL import Image
    except ImportError as error:
        raise ImportError("PNG files are read by Pillow, which is not installed: pip install pillow") from error
    with Image.open(file) as image:
        return np.asarray(image.convert("RGB"))


def named(text: str) -> tuple[str, Entry]:
    """Return the entry of a text: a name of `ENTRIES`, NAME=FOLDER of PNG files, or NAME=MODULE:FUNCTION.

    >>> named("hold")[0]
    'hold'
    """
    if text in ENTRIES:
        return text, ENTRIES[text]
    name, equals, where = text.partition("=")
    if equals and Path(where).is_dir():
        return name, folder(Path(where))
    module, colon, function = where.partition(":")
    if equals and colon:
        return name, of_update(getattr(importlib.import_module(module), function))
    known = ", ".join(ENTRIES)
    raise ValueError(f"`{text}` is no entry: give NAME=FOLDER, NAME=MODULE:FUNCTION, or one of {known}")


def applies(name: str, case: Case) -> Optional[str]:
    """Return why an entry cannot be made for a case, or None if it can."""
    if name.endswith((", second layer", ", DDOC")) and case.second_order is None:
        return "a capture has no hidden samples of this kind"
    return None


ENTRIES: dict[str, Entry] = {
    "hold": of_update(hold),
    "float nearest": of_update(float_nearest),
    "float nearest, push-pull": of_update(float_nearest_inpainted),
    "float bilinear": of_update(float_bilinear),
    "integer splat": of_update(splat),
    "galpix": galpix(),
    "galpix, second layer": galpix(hidden="second"),
    "galpix, DDOC": galpix(hidden="ddoc"),
}
"""The entries of the project, by name. `galpix` is stationary sources with push-pull and sub-cell scan-out."""
ENTRIES.update({f"galpix, {fill}": galpix(fill=fill) for fill in ("none", "hold", "extend", "metamer")})
ENTRIES.update(
    {
        f"galpix map, {fill}": galpix(scheme="map", fill=fill)
        for fill in ("none", "hold", "debris", "bullet", "galdebris", "extend", "push-pull", "metamer")
    }
)
