"""Fills the holes of an export with what others offer, and compares.

    python3 peers.py DIR [--sources NAME...] [--frames N] [--json FILE]

Writes `telea.png`, `navier-stokes.png` and `gortler.png` next to the fills of each frame, then prints tables in Markdown: PSNR,
FLIP, local variance and time. Only the disoccluded cells are compared; the README says what each number is.
"""

from fillers import BY_NAME  # first: it asks for one thread

import argparse
import json
import time
from pathlib import Path
from statistics import median

import cv2
import flip_evaluator
import numpy as np

from export import methods_of, read_export, table, write_rgb

WINDOW = 7


class Score:
    """Sums over the disoccluded cells of all frames of a source, so that a frame with many of them counts for as much."""

    def __init__(self):
        self.cells, self.squares, self.flip, self.variance, self.truth_variance = 0, 0, 0.0, 0.0, 0.0

    def add(self, frame, picture):
        mask = frame.mask
        self.cells += int(mask.sum())
        self.squares += int(np.square(picture[mask].astype(np.int64) - frame.truth[mask]).sum())
        self.flip += float(flip(frame.truth, picture)[mask].sum())
        self.variance += local_variance(picture, mask)
        self.truth_variance += local_variance(frame.truth, mask)

    def numbers(self):
        if self.cells == 0:
            return {}
        mean_square = self.squares / (3 * self.cells)
        return {
            "psnr": 10 * np.log10(255**2 / mean_square) if mean_square else float("inf"),
            "flip": self.flip / self.cells,
            "variance": self.variance / self.truth_variance if self.truth_variance else None,
        }


def flip(truth, picture):
    """The map of FLIP's error, 0 to 1, a number a cell; 67 pixels a degree, its own default."""
    floats = [np.ascontiguousarray(p, np.float32) / 255 for p in (truth, picture)]
    return flip_evaluator.evaluate(*floats, "LDR", applyMagma=False, computeMeanError=False)[0][..., 0]


def local_variance(picture, mask):
    """Over the masked cells, the sum of the variance of luma among the masked cells of the window around each."""
    luma, weight = cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY).astype(np.float64), mask.astype(np.float64)
    sums = [cv2.boxFilter(plane, -1, (WINDOW, WINDOW), normalize=False, borderType=cv2.BORDER_CONSTANT)[mask]
            for plane in (weight, weight * luma, weight * luma * luma)]
    return float((sums[2] / sums[0] - (sums[1] / sums[0]) ** 2).sum())


def fill(frame):
    """Writes the peers' fills of a frame; milliseconds of each, the median of three."""
    warped, milliseconds = frame.picture("warped"), {}
    for name, filler in BY_NAME.items():
        rounds = []
        for _ in range(3):
            start = time.perf_counter()
            picture = filler(warped, frame.unknown)
            rounds.append(1000 * (time.perf_counter() - start))
        write_rgb(frame.folder / f"{name}.png", picture)
        milliseconds[name] = median(rounds)
    return milliseconds


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, metavar="DIR")
    parser.add_argument("--sources", nargs="+", metavar="NAME", help="only these sources")
    parser.add_argument("--frames", type=int, metavar="N", help="score N frames of each source at most, spread evenly")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the numbers to FILE")
    options = parser.parse_args()
    if options.frames is not None and options.frames < 1:
        parser.error("--frames needs a number of at least 1")

    times, sizes = {}, {}
    for source in read_export(options.folder, options.sources):
        spent = []
        for frame in source.frames():
            spent.append(fill(frame))
            sizes[source.name] = f"{frame.truth.shape[1]} x {frame.truth.shape[0]}"
        times[source.name] = {name: float(np.mean([ms[name] for ms in spent])) for name in BY_NAME}

    sources = read_export(options.folder, options.sources)
    scores = {}
    for source in sources:
        score = {name: Score() for name in source.methods}
        for frame in source.frames(options.frames):
            if frame.mask.any():
                for name in source.methods:
                    score[name].add(frame, frame.scored(name))
        scores[source.name] = {name: one.numbers() for name, one in score.items()}

    methods = methods_of(sources)
    print("Over the disoccluded cells alone; sources:", ", ".join(f"{s} ({size})" for s, size in sizes.items()), "\n")
    for key, title, digits in (
        ("psnr", "PSNR, dB (more is closer to the truth)", 2),
        ("flip", "FLIP (less is closer to the truth)", 4),
        ("variance", "Local variance, as a share of the truth's (1 = as much texture)", 3),
    ):
        rows = {source: {m: n.get(key) for m, n in per.items()} for source, per in scores.items()}
        print(table(title, methods, rows, digits))
    print(table("Time of the peers, ms a frame, one thread", list(BY_NAME), times, 2))
    if options.json:
        options.json.write_text(json.dumps({"scores": scores, "milliseconds": times}, indent=1) + "\n")


if __name__ == "__main__":
    main()
