"""Fills of plain images: with the calling convention of `cv2.inpaint`, and by every fill mode."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, NamedTuple, Optional

import numpy as np

from . import _check, _galpix
from .budget import Budget, Layout
from .map import Tally

INPAINTING = ("push-pull", "metamer")
"""Methods that blend what is known all around a hole."""
FILL_MODES = ("none", "hold", "debris", "bullet", "galdebris", "extend")
"""Fill modes of the core, from cheap to rich."""


def inpaint(
    image: np.ndarray,
    mask: np.ndarray,
    radius: Any = None,
    flags: Any = None,
    dst: Optional[np.ndarray] = None,
    *,
    method: str = "push-pull",
    depth: Optional[np.ndarray] = None,
    gamma: Optional[str] = None,
    levels: int = 4,
    seed: int = 0,
    coloured: bool = False,
    bgr: bool = False,
) -> np.ndarray:
    """Fill the holes of an image from what surrounds them, in the calling convention of `cv2.inpaint`.

    Parameters
    ----------
    image : uint8, shape (rows, columns), (rows, columns, 1) or (rows, columns, 3)
        8-bit code values. The order of three channels does not matter to push-pull.
    mask : bool or uint8, shape (rows, columns)
        Not 0 where a pixel is a hole.
    radius, flags : optional
        Taken so that calls of `cv2.inpaint` need no change. Neither has a meaning here: push-pull reaches as far as the
        hole needs, and `method` says which algorithm.
    dst : uint8, shape of `image`, optional
        Where the result is written; `image` itself fills it in place, without a copy.
    method : str
        push-pull, or metamer: push-pull with a texture.
    depth : float32 or float64, shape (rows, columns), optional
        0 nearest to 1 farthest, of the holes too; keeps what is nearer than a hole out of it.
    gamma : str, optional
        The power of the share that is known, by which partly known areas count: 0 (default of push-pull), 1/2 (of
        metamer) or 1.
    levels, seed, coloured : int, int, bool
        For metamer: levels with a texture (1 to 8), which noise, and whether chroma gets noise of its own.
    bgr : bool
        For metamer: whether blue comes first, as in images that cv2 reads.

    Returns
    -------
    uint8, shape of `image`
        The image with its holes filled; other pixels are unchanged. Without any known pixel nothing is filled.

    Examples
    --------
    >>> import numpy
    >>> image = numpy.array([[16, 0, 0, 48]], numpy.uint8)
    >>> inpaint(image, image == 0).tolist()
    [[16, 24, 40, 48]]
    """
    image = _check.array(image, "image")
    if image.dtype != np.uint8:
        raise TypeError(f"`image` is of dtype {image.dtype}: give uint8 from 0 to 255, as image.astype(numpy.uint8)")
    if image.ndim not in (2, 3) or (image.ndim == 3 and image.shape[2] not in (1, 3)) or 0 in image.shape:
        raise ValueError(f"`image` has shape {image.shape}: give (rows, columns), or (rows, columns, 3) for colours")
    if method not in INPAINTING:
        names = ", ".join(INPAINTING)
        raise ValueError(f"`method` is {method!r}: give one of {names}, or call galpix.fill for the fill modes")
    shape = image.shape[:2]
    holes = _check.mask(mask, "mask", shape)
    if dst is not image:
        dst = _check.out(dst, "dst", image.shape)
        np.copyto(dst, image)
    dst = _check.out(dst, "dst", image.shape)
    way = SimpleNamespace(
        method=method,
        gamma=gamma,
        levels=_check.whole(levels, "levels", 1, 8),
        seed=_check.whole(seed, "seed", 0, 2**32 - 1),
        coloured=coloured,
        bgr=bgr,
    )
    _galpix.inpaint(SimpleNamespace(image=dst, mask=holes, depth=_check.floats(depth, "depth", shape)), way)
    return dst


class Filled(NamedTuple):
    """An image with its holes filled."""

    image: np.ndarray
    """uint8, shape (rows, columns, 3)."""
    motion: Optional[np.ndarray]
    """float64, shape (rows, columns, 2), pixels per frame: what the fill mode gave the holes, too; None if there was
    none, or if the method leaves it."""
    tally: Optional[Tally]
    """What was counted; None for push-pull and metamer."""


def fill(
    image: np.ndarray,
    mask: np.ndarray,
    method: str = "extend",
    *,
    depth: Optional[np.ndarray] = None,
    motion: Optional[np.ndarray] = None,
    budget: Optional[Budget] = None,
    reach: int = 1,
    edge_threshold: Optional[int] = None,
) -> Filled:
    """Fill the holes of an image by any fill mode of the core, or by inpainting.

    The image is taken as the frame before that stood still: a pixel of `mask` is a cell at which nothing arrived, and
    its colour, depth and motion in the arrays are those of the frame before, which hold, debris and galdebris show.

    Parameters
    ----------
    image : uint8, shape (rows, columns, 3)
        Red, green, blue.
    mask : bool or uint8, shape (rows, columns)
        Not 0 where a pixel is a hole.
    method : str
        none, hold, debris, bullet, galdebris, extend, push-pull or metamer.
    depth : float32 or float64, shape (rows, columns), optional
        0 nearest to 1 farthest; tells surfaces apart. All pixels are of one surface if absent.
    motion : float32 or float64, shape (rows, columns, 2), optional
        Pixels per frame in x and y.
    budget : Budget, optional
        The widths in which depth and motion are stored.
    reach : int
        Rounds of bullet filling, clamped to 1 to 16.
    edge_threshold : int, optional
        The largest absolute Laplacian of depths inside a surface, in units of the depth's last bit (16 bits).

    Examples
    --------
    >>> import numpy
    >>> image = numpy.full((3, 3, 3), 40, numpy.uint8)
    >>> mask = numpy.zeros((3, 3), bool)
    >>> mask[1, 1] = True
    >>> image[1, 1] = 7
    >>> [fill(image, mask, method).image[1, 1, 0].item() for method in ("none", "hold", "bullet", "push-pull")]
    [0, 7, 40, 40]
    """
    image = _check.picture(image, "image")
    if method in INPAINTING:
        return Filled(inpaint(image, mask, method=method, depth=depth), motion, None)
    if method not in FILL_MODES:
        raise ValueError(f"`method` is {method!r}: give one of {', '.join(FILL_MODES + INPAINTING)}")
    shape = image.shape[:2]
    holes = _check.mask(mask, "mask", shape)
    filled = image.copy()
    moves = motion is not None
    if moves:
        motion, components = _check.vectors(motion, "motion", shape)
        if components != 2:
            raise ValueError("`motion` has three components: give x and y only, as motion[..., :2]")
        motion = np.array(motion, np.float64)
    layout = Layout(depth_bits=16, velocity=moves)
    if budget is None:
        budget = Budget.derive(max(16, 1 << (max(shape) - 1).bit_length()), acceleration=False)
    arrived = SimpleNamespace(
        budget=budget,
        layout=layout,
        fill=method,
        reach=_check.whole(reach, "reach", 0, 2**32 - 1),
        edge_threshold=edge_threshold,
        image=filled,
        mask=holes,
        depth=_check.floats(depth, "depth", shape),
        velocity=motion,
    )
    tally = Tally(*_galpix.fill_mode(arrived))
    return Filled(filled, None if motion is None else motion.reshape(*shape, 2), tally)
