"""Times the peers on one picture: milliseconds, one thread.

    python3 speed.py --mask MASK.png [--picture PICTURE.png] [--rounds 15]

The mask has 255 where a cell is to be filled, else 0. Without a picture, one of the mask's size is made. Every round runs each peer
once, in another order, so that a slow moment of the machine does not fall on one of them; the table has the median and the least.
They are compared with a copy of 20 bytes per cell: milliseconds depend on the machine, the ratio much less.
"""

from fillers import gortler, navier_stokes, resized, telea  # first: it asks for one thread

import argparse
import time
from pathlib import Path
from statistics import median

import numpy as np

from export import read_mask, read_rgb, refuse


def made(height, width):
    """A picture with slow colours, edges and fine texture, the same each time."""
    y, x = np.mgrid[0:height, 0:width].astype(np.float32)
    slow = [127 + 90 * np.sin(x / a + y / b) for a, b in ((61, 97), (83, 53), (113, 71))]
    tiles = 20 * (((x // 32 + y // 32) % 2) - 0.5)
    noise = np.random.default_rng(1).normal(0, 8, (height, width))
    return np.clip(np.dstack([plane + tiles + noise for plane in slow]), 0, 255).astype(np.uint8)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mask", type=Path, required=True)
    parser.add_argument("--picture", type=Path)
    parser.add_argument("--rounds", type=int, default=15)
    options = parser.parse_args()
    if options.rounds < 1:
        parser.error("--rounds needs a number of at least 1")

    mask = read_mask(options.mask)
    picture = read_rgb(options.picture) if options.picture else made(*mask.shape)
    if picture.shape[:2] != mask.shape:
        refuse(f"{options.picture} has another size than {options.mask}.")
    if mask.all() or not mask.any():
        refuse(f"{options.mask} has no cell to fill, or no other.")
    picture = np.where(mask[..., None], 0, picture).astype(np.uint8)

    there, here = np.ones(20 * mask.size, np.uint8), np.zeros(20 * mask.size, np.uint8)
    runs = {
        "copy of 20 bytes a cell": lambda: np.copyto(here, there),
        "OpenCV Telea, radius 3": lambda: telea(picture, mask),
        "OpenCV Navier-Stokes, radius 3": lambda: navier_stokes(picture, mask),
        "push-pull, numpy, 32-bit floats": lambda: gortler(picture, mask),
        "push-pull, OpenCV resize": lambda: resized(picture, mask),
    }
    spent, shuffled = {name: [] for name in runs}, np.random.default_rng(0)
    for run in runs.values():
        run()
    for _ in range(options.rounds):
        for name in shuffled.permutation(list(runs)):
            start = time.perf_counter()
            runs[name]()
            spent[name].append(1000 * (time.perf_counter() - start))

    copy = median(spent["copy of 20 bytes a cell"])
    print(f"{mask.shape[1]} x {mask.shape[0]}, {100 * mask.mean():.1f} % to fill, {options.rounds} rounds\n")
    print("| | median, ms | least, ms | ns a cell | times the copy |\n| --- | ---: | ---: | ---: | ---: |")
    for name, times in spent.items():
        middle = median(times)
        print(f"| {name} | {middle:.2f} | {min(times):.2f} | {1e6 * middle / mask.size:.1f} | {middle / copy:.1f} |")


if __name__ == "__main__":
    main()
