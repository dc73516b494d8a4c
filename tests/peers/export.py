"""An export of `galpix fills --out DIR`, read and checked.

    DIR/index.json
    DIR/<source>/<frame>/truth.png    the picture as it should be
    DIR/<source>/<frame>/mask.png     255 = a disoccluded cell that is not connected with the border, else 0
    DIR/<source>/<frame>/mask_all.png 255 = a cell that nothing reached, at the border or not; may be absent, then it is the mask
    DIR/<source>/<frame>/warped.png   the picture as it arrives, the cells that nothing reached black
    DIR/<source>/<frame>/<fill>.png   the same picture with its holes filled

What is not as it should be ends the script with one sentence and the exit code 2.
"""

import json
import re
import sys
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

# The fills of galpix in the order of the tables; those of an export that are not named here come after them.
FILLS = ["none", "hold", "debris", "bullet", "galdebris", "extend", "push-pull-classic", "push-pull", "metamer"]

# The fills that `peers.py` adds.
PEERS = ["telea", "navier-stokes", "gortler"]

GIVEN = {"truth", "mask", "warped"}

# What an export may hold besides its fills.
NO_FILLS = GIVEN | {"mask_all"}


def refuse(sentence):
    print(sentence, file=sys.stderr)
    raise SystemExit(2)


def read_rgb(path):
    """The picture at `path` as height x width x 3 bytes, red first."""
    picture = cv2.imread(str(path), cv2.IMREAD_COLOR) if path.is_file() else None
    if picture is None:
        refuse(f"{path} is not there or is not a picture.")
    return cv2.cvtColor(picture, cv2.COLOR_BGR2RGB)


def write_rgb(path, picture):
    if not cv2.imwrite(str(path), cv2.cvtColor(picture, cv2.COLOR_RGB2BGR)):
        refuse(f"{path} cannot be written.")


def read_mask(path):
    """The mask at `path` as height x width truth values."""
    mask = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE) if path.is_file() else None
    if mask is None:
        refuse(f"{path} is not there or is not a picture.")
    if not np.isin(mask, (0, 255)).all():
        refuse(f"{path} has values other than 0 and 255.")
    return mask == 255


@dataclass
class Frame:
    folder: Path
    truth: np.ndarray
    mask: np.ndarray
    # All cells of which nothing is known: a fill must not take the black of those at the border for a colour.
    unknown: np.ndarray = None

    def picture(self, name):
        picture = read_rgb(self.folder / f"{name}.png")
        if picture.shape != self.truth.shape:
            refuse(f"{self.folder / name}.png has another size than truth.png in its folder.")
        return picture

    def scored(self, name):
        """The picture `name`, with the truth in all cells but the disoccluded ones: so that nothing but the fill is compared."""
        return np.where(self.mask[..., None], self.picture(name), self.truth)


@dataclass
class Source:
    name: str
    folders: list
    methods: list

    def frames(self, most=None):
        """The frames in order; with `most` so many of them at most, spread evenly."""
        for folder in evenly(self.folders, most):
            truth, mask = read_rgb(folder / "truth.png"), read_mask(folder / "mask.png")
            everything = folder / "mask_all.png"
            unknown = read_mask(everything) if everything.is_file() else mask
            for name, cells in (("mask.png", mask), ("mask_all.png", unknown)):
                if truth.shape[:2] != cells.shape:
                    refuse(f"{folder / name} has another size than truth.png in its folder.")
            yield Frame(folder, truth, mask, unknown)


def evenly(items, most):
    if most is None or len(items) <= most:
        return items
    return [items[i * len(items) // most] for i in range(most)]


def in_order(path):
    """Frame 10 comes after frame 9, whether or not the names have leading zeros."""
    return [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", path.name)]


def folders(path):
    return sorted((entry for entry in path.iterdir() if entry.is_dir()), key=in_order)


def read_export(root, only=None):
    """The sources of the export at `root`; with `only` those of these names."""
    if not root.is_dir():
        refuse(f"There is no folder {root}: make it with `cargo run --release -- fills --out {root}`.")
    try:
        json.loads((root / "index.json").read_text())
    except OSError:
        refuse(f"{root} is not an export of `galpix fills`: it has no index.json.")
    except ValueError:
        refuse(f"{root / 'index.json'} is not JSON.")
    found = [read_source(folder) for folder in folders(root) if folders(folder)]
    if not found:
        refuse(f"{root} has no frame of any source.")
    missing = set(only or []) - {source.name for source in found}
    if missing:
        refuse(f"{root} has no source {' and no source '.join(sorted(missing))}.")
    return [source for source in found if not only or source.name in only]


def read_source(folder):
    frames = folders(folder)
    for frame in frames:
        for name in sorted(GIVEN):
            if not (frame / f"{name}.png").is_file():
                refuse(f"{frame} has no {name}.png.")
    names = [{path.stem for path in frame.glob("*.png")} - NO_FILLS for frame in frames]
    everywhere = set.intersection(*names)
    for frame, here in zip(frames, names):
        # The peers are ours to write again; a fill of galpix that only some frames have is a broken export.
        if here - everywhere - set(PEERS):
            refuse(f"{sorted(here - everywhere)[0]}.png is in {frame}, but not in every frame of {folder.name}.")
    known = [name for name in FILLS + PEERS if name in everywhere]
    return Source(folder.name, frames, known + sorted(everywhere - set(known)))


def methods_of(sources, only=None):
    """The fills that at least one source has, in the order of the tables."""
    every = {name for source in sources for name in source.methods}
    missing = set(only or []) - every
    if missing:
        refuse(f"No source has the fill {' or '.join(sorted(missing))}.")
    order = FILLS + [name for name in sorted(every) if name not in FILLS + PEERS] + PEERS
    return [name for name in order if name in every and (not only or name in only)]


def table(title, methods, rows, digits):
    """A table in Markdown: a source a row, a method a column, and the mean of the rows. `rows` maps a source to {method: number}."""
    lines = [f"### {title}", "", "| source | " + " | ".join(methods) + " |", "| --- |" + " ---: |" * len(methods)]
    for source, numbers in rows.items():
        lines.append(line(source, [numbers.get(method) for method in methods], digits))
    # A source without a disoccluded cell has no numbers and no part in the mean. A fill that lacks a source which
    # others have gets no mean: it would not compare with theirs.
    scored = [numbers for numbers in rows.values() if any(numbers.get(m) is not None for m in methods)]
    columns = [[numbers.get(m) for numbers in scored] for m in methods]
    means = [float(np.mean(column)) if column and None not in column else None for column in columns]
    return "\n".join([*lines, line("mean", means, digits), ""])


def line(name, numbers, digits):
    return f"| {name} | " + " | ".join("–" if n is None else f"{n:.{digits}f}" for n in numbers) + " |"
