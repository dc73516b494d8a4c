"""Measures the package on this machine: inpainting beside cv2, and what a call from Python adds.

    python -m galpix.speed                 sizes 512 to 4096, with 2 and 5 % holes
    python -m galpix.speed --sizes 512     one size

Times are those of the thread's own processor time, so that other work on the machine hardly counts; contenders take
turns, and each figure is the median of the rounds with their range. cv2 is set to one thread, galpix has one.
"""

from __future__ import annotations

import argparse
import statistics
import sys
import time
from collections.abc import Callable, Sequence
from typing import Any, Optional

import numpy as np

from .inpainting import inpaint
from .map import Galpixmap
from .metrics import psnr
from .sources import open as open_source

RATIOS = {"Navier-Stokes": 25.0, "Telea": 40.0}
"""By how much inpainting is meant to be faster than cv2."""
LOSS_DB = 0.2
"""By how much its PSNR may be lower."""
OVERHEAD_PERCENT = 2.0
"""What a call from Python may add to a frame of 512 x 512 galpixels."""


def tiled(tile: np.ndarray, side: int) -> np.ndarray:
    """Return a picture or a mask, mirrored and repeated to a square.

    >>> tiled(image(1), 300).shape
    (300, 300, 3)
    """
    whole = np.concatenate([tile, tile[:, ::-1]], axis=1)
    whole = np.concatenate([whole, whole[::-1]], axis=0)
    times = (-(-side // whole.shape[0]), -(-side // whole.shape[1]))
    return np.ascontiguousarray(np.tile(whole, times + (1,) * (tile.ndim - 2))[:side, :side])


def image(frame: int) -> np.ndarray:
    """Return the true picture of a frame of the scene `fovea`: uint8, shape (192, 256, 3).

    >>> image(1).shape
    (192, 256, 3)
    """
    truth = open_source("fovea").truth(frame)
    assert truth is not None
    return truth.picture


def strips(side: int, share: float, seed: int = 0) -> np.ndarray:
    """Return thin upright and level holes of 1 to 6 by 4 to 40 pixels.

    uint8, shape (side, side), 255 in a hole; at least `share` of all pixels.

    >>> bool(strips(64, 0.05).mean() / 255 >= 0.05)
    True
    """
    rng = np.random.default_rng(seed)
    mask = np.zeros((side, side), np.uint8)
    missing = int(np.ceil(share * side * side))
    while np.count_nonzero(mask) < missing:
        for _ in range(max(1, (missing - int(np.count_nonzero(mask))) // 120)):
            thin, long = rng.integers(1, 7), rng.integers(4, 41)
            height, width = (int(long), int(thin)) if rng.random() < 0.5 else (int(thin), int(long))
            y, x = rng.integers(0, side, 2)
            mask[y : y + height, x : x + width] = 255
    return mask


def warped(frame: int) -> np.ndarray:
    """Return what a forward warp of the scene `fovea` leaves open after some frames: cracks and uncovered areas.

    uint8, shape (192, 256), 255 in a hole.

    >>> bool(0.02 < warped(1).mean() / 255 < warped(2).mean() / 255 < 0.06)
    True
    """
    made = open_source("fovea").run(frames=frame, scheme="map", fill="none")
    return np.where(made.reached[-1], 0, 255).astype(np.uint8)


def cases(side: int) -> list[tuple[str, np.ndarray, np.ndarray]]:
    """Return the name, the true picture and the holes of each case of a size."""
    made = [("strips", tiled(image(1), side), strips(side, share)) for share in (0.02, 0.05)]
    return made + [("warp", tiled(image(frame), side), tiled(warped(frame), side)) for frame in (1, 2)]


def race(contenders: dict[str, Callable[[], Any]], rounds: int) -> tuple[dict[str, list[float]], dict[str, Any]]:
    """Return the seconds of each contender in each round, and what it returned. They take turns, after a round that
    does not count."""
    seconds: dict[str, list[float]] = {name: [] for name in contenders}
    returned: dict[str, Any] = {}
    for number in range(rounds + 1):
        for name, call in contenders.items():
            started = time.thread_time()
            returned[name] = call()
            took = time.thread_time() - started
            if number:
                seconds[name].append(took)
    return seconds, returned


def _ratio(slow: list[float], fast: list[float]) -> tuple[float, float, float]:
    ratios = [a / b for a, b in zip(slow, fast)]
    return statistics.median(ratios), min(ratios), max(ratios)


def inpainting(cv2: Any, sizes: Sequence[int], rounds: int) -> list[str]:
    """Return the lines of a table: times and PSNR of the holes, galpix beside both algorithms of cv2."""
    cv2.setNumThreads(1)
    lines = [
        "| pixels | holes | galpix ms | x Navier-Stokes | x Telea | PSNR: galpix | Navier-Stokes | Telea | reached |",
        "| ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | --- |",
    ]
    for side in sizes:
        lines += [_row(cv2, side, case, rounds) for case in cases(side)]
    return lines


def _row(cv2: Any, side: int, case: tuple[str, np.ndarray, np.ndarray], rounds: int) -> str:
    kind, picture, mask = case
    given = picture.copy()
    given[mask > 0] = 0
    contenders: dict[str, Callable[[], np.ndarray]] = {
        "galpix": lambda: inpaint(given, mask),
        "Navier-Stokes": lambda: cv2.inpaint(given, mask, 3, cv2.INPAINT_NS),
        "Telea": lambda: cv2.inpaint(given, mask, 3, cv2.INPAINT_TELEA),
    }
    seconds, made = race(contenders, rounds)
    decibels = {name: psnr(result, picture, mask > 0) for name, result in made.items()}
    ratios = {name: _ratio(seconds[name], seconds["galpix"]) for name in RATIOS}
    short = [name for name, goal in RATIOS.items() if ratios[name][0] < goal]
    short += ["PSNR"] if decibels["galpix"] < max(decibels.values()) - LOSS_DB else []
    cells = [f"{side}", f"{kind}, {100 * np.count_nonzero(mask) / mask.size:.1f} %"]
    cells.append(f"{1e3 * statistics.median(seconds['galpix']):.2f}")
    cells += [f"{middle:.1f} ({low:.1f} to {high:.1f})" for middle, low, high in ratios.values()]
    cells += [f"{decibels[name]:.2f}" for name in contenders]
    cells.append(f"not {', '.join(short)}" if short else "all")
    return "| " + " | ".join(cells) + " |"


def _moving(side: int) -> Galpixmap:
    """Return a map of which a part moves in front of the rest."""
    velocity = np.zeros((side, side, 2), np.float32)
    velocity[side // 4 : side // 2, side // 4 : side // 2] = 0.75, 0.25
    depth = np.where(velocity[..., 0] > 0, np.float32(0.2), np.float32(0.9))
    map = Galpixmap((side, side))
    map.load(tiled(image(0), side), depth=depth, velocity=velocity)
    return map


def overhead(side: int = 512, frames: int = 40, rounds: int = 7) -> tuple[float, float, float]:
    """Return what calling `Galpixmap.step` adds to a frame, in per cent: median, least and largest of the rounds.

    So many frames are made by as many calls, and as many more inside of one call, in turns; both from the same
    picture.
    """
    percent = []
    for number in range(rounds + 1):
        calls, once = _moving(side), _moving(side)
        by_calls, inside = _seconds(calls.step, frames), _seconds(lambda: once.skip(frames), 1) / frames
        if number:
            percent.append(100.0 * (by_calls / inside - 1.0))
    return statistics.median(percent), min(percent), max(percent)


def per_call(calls: int = 2000) -> float:
    """Return the seconds of a call of `Galpixmap.step` for a map of one cell: all of it is what a call adds."""
    map = Galpixmap((1, 1))
    return min(_seconds(map.step, calls) for _ in range(5))


def _seconds(call: Callable[[], Any], calls: int) -> float:
    started = time.thread_time()
    for _ in range(calls):
        call()
    return (time.thread_time() - started) / calls


def frame(side: int = 512, frames: int = 40) -> float:
    """Return the seconds of a frame of so many galpixels without Python: many of them in one call."""
    maps = [_moving(side) for _ in range(3)]
    return min(_seconds(lambda: map.skip(frames), 1) for map in maps) / frames


def main(arguments: Optional[Sequence[str]] = None) -> int:
    """Print the tables; end with 3 if cv2 is not there to compare with."""
    parser = argparse.ArgumentParser(prog="python -m galpix.speed", description=main.__doc__)
    parser.add_argument("--sizes", type=int, nargs="+", default=[512, 1024, 2048, 4096], help="sides in pixels")
    parser.add_argument("--rounds", type=int, default=3)
    given = parser.parse_args(arguments)
    call, alone = per_call(), frame()
    middle, low, high = overhead()
    print(
        f"A call of `step` adds {1e6 * call:.1f} us: {100 * call / alone:.2f} % of a frame of 512 x 512 galpixels "
        f"({1e6 * alone:.0f} us), where less than {OVERHEAD_PERCENT} % is wanted. Frames by as many calls against as "
        f"many in one call, in turns: {middle:+.2f} % ({low:+.2f} to {high:+.2f})."
    )
    try:
        import cv2
    except ImportError:
        print("skipped: cv2 is not installed (pip install opencv-python-headless)", file=sys.stderr)
        return 3
    print(f"\nInpainting beside cv2 {cv2.__version__}, radius 3, PSNR of the holes in dB:\n")
    print("\n".join(inpainting(cv2, given.sizes, given.rounds)))
    wanted = ", ".join(f"{ratio:.0f} times {name}" for name, ratio in RATIOS.items())
    print(f"\n`reached`: at least {wanted}, and at most {LOSS_DB} dB less than the better of them.")
    return 0


if __name__ == "__main__":
    sys.exit(main())
