"""Checks of arguments: each error says what is wrong, where, and how to mend it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Optional

import numpy as np


def array(value: Any, name: str) -> np.ndarray:
    """Return `value` if it is a numpy array; else raise TypeError."""
    if not isinstance(value, np.ndarray):
        raise TypeError(f"`{name}` is of type {type(value).__name__}: give a numpy array, as numpy.asarray makes one")
    return value


def shaped(value: np.ndarray, name: str, shape: Sequence[int], what: str) -> np.ndarray:
    """Return `value` if it has this shape; else raise ValueError."""
    if value.shape != tuple(shape):
        raise ValueError(f"`{name}` has shape {value.shape} where {what} needs {tuple(shape)}: reshape or crop it")
    return value


def picture(value: Any, name: str) -> np.ndarray:
    """Return a uint8 array of shape (rows, columns, 3) whose rows follow each other, copied only if they do not."""
    value = array(value, name)
    if value.dtype != np.uint8:
        raise TypeError(
            f"`{name}` is of dtype {value.dtype}: give uint8 from 0 to 255, as {name}.astype(numpy.uint8)"
        )
    if value.ndim != 3 or value.shape[2] != 3 or 0 in value.shape:
        raise ValueError(
            f"`{name}` has shape {value.shape}: give (rows, columns, 3), red, green and blue of each pixel"
        )
    return np.ascontiguousarray(value)


def mask(value: Any, name: str, shape: Sequence[int]) -> np.ndarray:
    """Return a bool or uint8 array of a shape as bytes that are not 0 where it is set, without a copy if possible."""
    value = array(value, name)
    if value.dtype != np.bool_ and value.dtype != np.uint8:
        raise TypeError(f"`{name}` is of dtype {value.dtype}: give bool or uint8, as {name} != 0")
    if value.shape == (*shape, 1):
        value = value[..., 0]
    shaped(value, name, shape, "the picture")
    return np.ascontiguousarray(value).view(np.uint8)


def floats(value: Any, name: str, shape: Sequence[int]) -> Optional[np.ndarray]:
    """Return a float32 or float64 array of a shape as one flat row, without a copy if possible; None stays None."""
    if value is None:
        return None
    value = array(value, name)
    if value.dtype != np.float32 and value.dtype != np.float64:
        raise TypeError(
            f"`{name}` is of dtype {value.dtype}: give float32 or float64, as {name}.astype(numpy.float32)"
        )
    return np.ascontiguousarray(shaped(value, name, shape, "the picture")).reshape(-1)


def given_floats(value: Any, name: str, shape: Sequence[int]) -> np.ndarray:
    """Return an array as `floats` does; None is no array."""
    flat = floats(array(value, name), name, shape)
    assert flat is not None
    return flat


def margin(value: Any) -> tuple[int, int, int, int]:
    """Return columns left and right of the display, rows above and below it."""
    cells = tuple(whole(number, "margin", 0, 32768) for number in value)
    if len(cells) != 4:
        raise ValueError(f"`margin` has {len(cells)} numbers: give left, right, above and below")
    return cells


def vectors(value: Any, name: str, shape: Sequence[int]) -> tuple[Optional[np.ndarray], int]:
    """Return an array of shape (*shape, 2) or (*shape, 3) as `floats` does, and its last side."""
    if value is None:
        return None, 0
    components = array(value, name).shape[-1] if array(value, name).ndim else 0
    if value.ndim != len(shape) + 1 or components not in (2, 3):
        raise ValueError(
            f"`{name}` has shape {value.shape}: give {(*shape, 2)}, x and y of each pixel, or {(*shape, 3)}, depth too"
        )
    return floats(value, name, (*shape, components)), components


def tags(value: Any, name: str, shape: Sequence[int]) -> Optional[np.ndarray]:
    """Return an array of integers of a shape as uint32; None stays None."""
    if value is None:
        return None
    value = array(value, name)
    if not np.issubdtype(value.dtype, np.integer):
        raise TypeError(f"`{name}` is of dtype {value.dtype}: give integers, as {name}.astype(numpy.uint8)")
    return np.ascontiguousarray(shaped(value, name, shape, "the picture"), dtype=np.uint32)


def out(value: Any, name: str, shape: Sequence[int]) -> np.ndarray:
    """Return a new uint8 array of a shape, or `value` if it is one that can be written in place."""
    if value is None:
        return np.empty(tuple(shape), np.uint8)
    value = array(value, name)
    if value.dtype != np.uint8:
        raise TypeError(
            f"`{name}` is of dtype {value.dtype}: give uint8, as numpy.empty({tuple(shape)}, numpy.uint8)"
        )
    shaped(value, name, shape, "the result")
    if not value.flags.c_contiguous or not value.flags.writeable:
        raise ValueError(
            f"`{name}` cannot be written in place: give a writeable array in C order, as numpy.empty makes"
        )
    return value


def whole(value: Any, name: str, low: int, high: int) -> int:
    """Return an integer of a range; else raise TypeError or ValueError."""
    if isinstance(value, bool) or not hasattr(value, "__index__"):
        raise TypeError(f"`{name}` is of type {type(value).__name__}: give a whole number")
    value = value.__index__()
    if not low <= value <= high:
        raise ValueError(f"`{name}` is {value}: give {low} to {high}")
    return value
