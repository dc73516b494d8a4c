"""How far a picture is from the truth. Pictures are uint8, shape (rows, columns, 3); the truth comes second."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Optional

import numpy as np

from . import _check, _galpix


def _pair(shown: np.ndarray, truth: np.ndarray, mask: Optional[np.ndarray]) -> tuple:
    shown, truth = _check.picture(shown, "shown"), _check.picture(truth, "truth")
    _check.shaped(shown, "shown", truth.shape, "the truth")
    return shown, truth, None if mask is None else _check.mask(mask, "mask", truth.shape[:2])


def psnr(shown: np.ndarray, truth: np.ndarray, mask: Optional[np.ndarray] = None) -> float:
    """Return the peak signal-to-noise ratio in dB over the pixels of `mask` (bool, shape (rows, columns)), at most 100.

    >>> import numpy
    >>> black = numpy.zeros((2, 2, 3), numpy.uint8)
    >>> round(psnr(black, black + 1), 4), psnr(black, black)
    (48.1308, 100.0)
    """
    return _galpix.psnr(*_pair(shown, truth, mask))


def ssim(shown: np.ndarray, truth: np.ndarray, mask: Optional[np.ndarray] = None) -> float:
    """Return the mean structural similarity of luma over the pixels of `mask`; 1 for equal pictures.

    >>> import numpy
    >>> grey = numpy.full((8, 8, 3), 100, numpy.uint8)
    >>> round(ssim(grey, grey + 10), 6)
    0.995476
    """
    return _galpix.ssim(*_pair(shown, truth, mask))


def flip(shown: np.ndarray, truth: np.ndarray, mask: Optional[np.ndarray] = None) -> float:
    """Return the mean FLIP error over the pixels of `mask`, 0 to 1; 0 for equal pictures, at 67 pixels per degree.

    >>> import numpy
    >>> black = numpy.zeros((16, 16, 3), numpy.uint8)
    >>> round(flip(black, black + 255), 3)
    0.967
    """
    return _galpix.flip(*_pair(shown, truth, mask))


def ssimulacra2(shown: np.ndarray, truth: np.ndarray) -> float:
    """Return SSIMULACRA2 of whole pictures with sides of at least 8 pixels; 100 for equal pictures.

    >>> import numpy
    >>> grey = numpy.full((16, 16, 3), 100, numpy.uint8)
    >>> round(ssimulacra2(grey, grey), 6)
    100.0
    """
    return _galpix.ssimulacra2(*_pair(shown, truth, None)[:2])


def pooled_psnr(decibels: Iterable[float]) -> float:
    """Return the PSNR in dB of several pictures of one size taken together: that of their mean squared error.

    >>> round(pooled_psnr([30.0, 100.0]), 4)
    33.0103
    """
    return _galpix.pooled_db([float(value) for value in decibels])
