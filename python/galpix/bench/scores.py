"""Scores of one picture."""

from __future__ import annotations

from typing import Optional

import numpy as np

from ..metrics import flip, psnr, ssim
from ..sources import Truth
from .suite import Case

SCORES = {
    "psnr_db": "PSNR of the whole picture, dB",
    "psnr_reached_db": "PSNR where a sample of the update is seen, dB",
    "psnr_uncovered_db": "PSNR of what was uncovered inside of the picture, dB",
    "psnr_entering_db": "PSNR of what entered over the border, dB",
    "ssim": "structural similarity of the whole picture",
    "flip": "mean FLIP of the whole picture; less is better",
    "wrong_percent": "pixels off by more than 48 code values from the truth's pixels within one pixel around",
    "flicker": "mean |change shown - true change| of luma since the frame before, in code values",
    "uncovered_percent": "of the picture, what was uncovered inside of it: the same for all entries",
    "entering_percent": "of the picture, what entered over the border: the same for all entries",
}
"""What each score is. Scores are over the pixels that the truth counts."""

WRONG = 48
"""A pixel that differs from all true pixels within one pixel around by more shows a wrong surface, in code values."""


def classes(case: Case, frames: list[int]) -> dict[int, tuple[np.ndarray, np.ndarray]]:
    """Return for each frame which pixels were uncovered inside of the picture, and which entered over its border.

    A pixel is reached if a sample of the update would be seen there: what stationary sources in 32 frames' budget show.
    Pixels that are not reached entered if they are connected with the border by such pixels; else they were uncovered.
    """
    reached = case.source.run(frames=max(frames), prop=32, fill="none").reached
    parted = {}
    for frame in frames:
        missing = ~reached[frame - 1]
        entered = np.zeros_like(missing)
        entered[[0, -1]], entered[:, [0, -1]] = missing[[0, -1]], missing[:, [0, -1]]
        while True:
            wide = np.pad(entered, 1)
            grown = missing & (entered | wide[:-2, 1:-1] | wide[2:, 1:-1] | wide[1:-1, :-2] | wide[1:-1, 2:])
            if (grown == entered).all():
                break
            entered = grown
        parted[frame] = (missing & ~entered, entered)
    return parted


def luma(picture: np.ndarray) -> np.ndarray:
    """Return Rec. 709 luma of code values, float64."""
    return picture.astype(np.float64) @ np.array([0.2126, 0.7152, 0.0722])


def wrong(shown: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """Return where a picture shows a wrong surface: bool, shape (rows, columns).

    >>> import numpy
    >>> truth = numpy.zeros((3, 4, 3), numpy.uint8)
    >>> truth[:, 3] = 200
    >>> wrong(numpy.full_like(truth, 200), truth)[0].tolist()
    [True, True, False, False]
    """
    rows, columns = truth.shape[:2]
    wide = np.pad(truth, ((1, 1), (1, 1), (0, 0)), mode="edge").astype(np.int16)
    best = np.full((rows, columns), 255, np.int16)
    for dy in range(3):
        for dx in range(3):
            off = np.abs(wide[dy : dy + rows, dx : dx + columns] - shown).max(axis=2)
            np.minimum(best, off, out=best)
    return best > WRONG


def _part(shown: np.ndarray, truth: Truth, part: np.ndarray) -> Optional[float]:
    part = part if truth.mask is None else part & truth.mask
    return psnr(shown, truth.picture, part) if part.any() else None


def score(
    shown: np.ndarray,
    truth: Truth,
    parts: tuple[np.ndarray, np.ndarray],
    before: Optional[tuple[np.ndarray, np.ndarray]] = None,
) -> dict[str, Optional[float]]:
    """Return the scores of a picture.

    Parameters
    ----------
    shown : uint8, shape (rows, columns, 3)
        What an entry made.
    truth : Truth
        The true picture, and where it counts.
    parts : (bool, bool), shape (rows, columns) each
        What was uncovered and what entered.
    before : (uint8, uint8), shape (rows, columns, 3) each, optional
        What was shown in the frame before, and its truth.
    """
    uncovered, entered = parts
    counted = np.ones_like(uncovered) if truth.mask is None else truth.mask
    flicker = None
    if before is not None:
        change = luma(shown) - luma(before[0]) - (luma(truth.picture) - luma(before[1]))
        flicker = float(np.abs(change)[counted].mean())
    percent = lambda part: float(100.0 * (part & counted).sum() / counted.sum())  # noqa: E731
    return {
        "psnr_db": psnr(shown, truth.picture, truth.mask),
        "psnr_reached_db": _part(shown, truth, ~uncovered & ~entered),
        "psnr_uncovered_db": _part(shown, truth, uncovered),
        "psnr_entering_db": _part(shown, truth, entered),
        "ssim": ssim(shown, truth.picture, truth.mask),
        "flip": flip(shown, truth.picture, truth.mask),
        "wrong_percent": percent(wrong(shown, truth.picture)),
        "flicker": flicker,
        "uncovered_percent": percent(uncovered),
        "entering_percent": percent(entered),
    }
