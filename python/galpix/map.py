"""Galpixmaps: load arrays, make frames, read arrays."""

from __future__ import annotations

from dataclasses import dataclass
from types import SimpleNamespace
from typing import NamedTuple, Optional

import numpy as np

from . import _check, _galpix
from .budget import Budget, Layout


class Tally(NamedTuple):
    """The counts of a frame."""

    moved: int
    """Galpixels and debris that were propagated."""
    lost: int
    """Of these, those that left the map."""
    collided: int
    """Of these, those that were discarded at an occupied cell."""
    saturated: int
    """Fields that were clamped to their range; no field wraps."""
    edges: int
    """Cells on the edge of a surface, in the map before."""
    holes: int
    """Cells at which nothing arrived."""
    bullets: int
    """Holes that were filled inside a surface."""
    debris: int
    """Just-unobscured holes that hold debris without motion."""
    galdebris: int
    """Just-unobscured holes that hold a galpixel."""
    empty: int
    """Holes that stay empty."""


class Loaded(NamedTuple):
    """What entered with an update."""

    galpixels: int
    """Cells with a galpixel."""
    empty: int
    """Cells that start empty, because depth or motion is not finite or not known."""
    saturated: int
    """Fields that were clamped to their range."""


@dataclass(frozen=True)
class Disocclusion:
    """Which hidden samples an update needs, as the disocclusion map says."""

    extents: np.ndarray
    """uint8, shape (rows, columns, 4): how many cells are uncovered left of, right of, above and below a cell, the cell
    itself included; all 0 where nothing is uncovered, 127 for that many and more."""
    edges: int
    """Pairs of neighbours of which one leaves the other."""
    saturated: int
    """Those of them that uncover 127 cells or more to a side."""
    covered: int
    """Cells whose hidden samples may be uncovered."""

    @property
    def needed(self) -> np.ndarray:
        """bool, shape (rows, columns): where a hidden sample may be uncovered."""
        return np.asarray(self.extents.any(axis=2))


def update_arrays(
    colour: np.ndarray,
    depth: Optional[np.ndarray],
    velocity: Optional[np.ndarray],
    acceleration: Optional[np.ndarray],
    rest: dict[str, Optional[np.ndarray]],
) -> SimpleNamespace:
    """Check the arrays of an update and flatten them for the extension module."""
    colour = _check.picture(colour, "colour")
    shape = colour.shape[:2]
    velocity, velocity_components = _check.vectors(velocity, "velocity", shape)
    acceleration, acceleration_components = _check.vectors(acceleration, "acceleration", shape)
    known = rest.get("known")
    return SimpleNamespace(
        shape=shape,
        colour=colour,
        depth=_check.floats(depth, "depth", shape),
        velocity=velocity,
        velocity_components=velocity_components,
        acceleration=acceleration,
        acceleration_components=acceleration_components,
        luminosity_rate=_check.floats(rest.get("luminosity_rate"), "luminosity_rate", shape),
        tag=_check.tags(rest.get("tag"), "tag", shape),
        known=None if known is None else _check.mask(known, "known", shape),
    )


class Galpixmap:
    """A map of galpixels that moves: each step is one frame of the display, in fixed point.

    Parameters
    ----------
    shape : (int, int)
        Rows and columns of the display, each 1 to 32768.
    budget : Budget, optional
        Widths; those that the larger side gives if absent.
    layout : Layout
        Fields of a galpixel.
    margin : (int, int, int, int)
        Columns left and right of the display, rows above and below it, that the map has besides.
    fill : str
        What is put into holes: none, hold, debris, bullet, galdebris, extend, push-pull or metamer.
    gamma : str, optional
        For push-pull and metamer: 0, 1/2 or 1.
    rounding : str
        truncate, nearest, low-discrepancy or searched.
    reach : int
        Rounds of bullet filling, clamped to 1 to 16.
    edge_threshold : int, optional
        The largest absolute Laplacian of depths inside a surface, in units of the depth's last bit.
    scan_out : str
        How cells become pixels: nearest or sub-cell.
    constant_time : bool
        Whether frames are made by instructions that do not depend on the picture; the result is the same.

    Raises
    ------
    ValueError
        If no such map exists; the sentence says what to change.

    Examples
    --------
    >>> import numpy
    >>> colour = numpy.zeros((4, 64, 3), numpy.uint8)
    >>> colour[2, 10] = 255
    >>> velocity = numpy.zeros((4, 64, 2), numpy.float32)
    >>> velocity[2, 10, 0] = 0.75
    >>> map = Galpixmap((4, 64), fill="hold")
    >>> map.load(colour, velocity=velocity)
    Loaded(galpixels=256, empty=0, saturated=0)
    >>> frames, tallies = map.run(4)
    >>> frames.shape, frames.dtype.name, tallies[0].moved
    ((4, 4, 64, 3), 'uint8', 256)
    >>> map.galpixels()["velocity"][2, 13, :2].tolist()
    [0.75, 0.0]
    """

    def __init__(
        self,
        shape: tuple[int, int],
        budget: Optional[Budget] = None,
        layout: Layout = Layout.FULL,
        *,
        margin: tuple[int, int, int, int] = (0, 0, 0, 0),
        fill: str = "extend",
        gamma: Optional[str] = None,
        rounding: str = "low-discrepancy",
        reach: int = 1,
        edge_threshold: Optional[int] = None,
        scan_out: str = "nearest",
        constant_time: bool = False,
    ) -> None:
        rows, columns = (_check.whole(side, "shape", 1, 32768) for side in shape)
        left, right, top, bottom = margin = _check.margin(margin)
        if budget is None:
            extent = 1 << (max(rows, columns) - 1).bit_length()
            budget = Budget.derive(max(extent, 16), acceleration=layout.acceleration)
        making = SimpleNamespace(
            rounding=rounding,
            fill=fill,
            gamma=gamma,
            reach=_check.whole(reach, "reach", 0, 2**32 - 1),
            edge_threshold=edge_threshold,
            scan_out=scan_out,
            constant_time=constant_time,
        )
        self._map = _galpix.Map(budget, layout, SimpleNamespace(shape=(rows, columns), margin=margin), making)
        self.budget = budget
        self.layout = layout
        self.shape = (rows, columns)
        self.margin = margin
        self.cells = (rows + top + bottom, columns + left + right)
        """Rows and columns of the map, margin included."""

    def load(
        self,
        colour: np.ndarray,
        *,
        depth: Optional[np.ndarray] = None,
        velocity: Optional[np.ndarray] = None,
        acceleration: Optional[np.ndarray] = None,
        tag: Optional[np.ndarray] = None,
        luminosity_rate: Optional[np.ndarray] = None,
        known: Optional[np.ndarray] = None,
        offset: Optional[np.ndarray] = None,
    ) -> Loaded:
        """Replace all galpixels by an update, and count frames from 0 again.

        Shapes are those of the map, margin included: `map.cells`. A cell whose depth or motion is not finite starts
        empty. Fields that the layout lacks are ignored.

        Parameters
        ----------
        colour : uint8, shape (rows, columns, 3)
            Red, green, blue.
        depth : float32 or float64, shape (rows, columns)
            0 nearest to 1 farthest, linear in inverse distance.
        velocity : float32 or float64, shape (rows, columns, 2) or (rows, columns, 3)
            Pixels per frame in x and y, depth range per frame.
        acceleration : float32 or float64, shape as that of `velocity`
            Pixels per frame squared.
        tag : integers, shape (rows, columns)
            Object tags; low bits are stored.
        luminosity_rate : float32 or float64, shape (rows, columns)
            8-bit code values per frame.
        known : bool or uint8, shape (rows, columns)
            Where depth and motion are known; everywhere if absent.
        offset : float32 or float64, shape (rows, columns, 2)
            Where in its cell a galpixel is, in cells from the centre, -1/2 to 1/2.
        """
        rest = {"tag": tag, "luminosity_rate": luminosity_rate, "known": known}
        arrays = update_arrays(colour, depth, velocity, acceleration, rest)
        if arrays.shape != self.cells:
            raise ValueError(f"`colour` has {arrays.shape} pixels where the map has {self.cells}: crop or pad it")
        offset = _check.floats(offset, "offset", (*self.cells, 2))
        saturated, empty = self._map.load(arrays, offset)
        return Loaded(self.cells[0] * self.cells[1] - empty, empty, saturated)

    def step(self) -> Tally:
        """Make one frame; return its counts."""
        return Tally(*self._map.step())

    def skip(self, frames: int) -> list[Tally]:
        """Make frames that are not shown, at least 1; return their counts."""
        return [Tally(*counts) for counts in self._map.skip(_check.whole(frames, "frames", 1, 1 << 20))]

    def run(self, frames: int, out: Optional[np.ndarray] = None) -> tuple[np.ndarray, list[Tally]]:
        """Make frames; return what the display shows of each, and their counts.

        Parameters
        ----------
        frames : int
            How many, at least 1.
        out : uint8, shape (frames, rows, columns, 3), optional
            Where the pictures are written; a new array if absent.

        Returns
        -------
        uint8, shape (frames, rows, columns, 3), and a list of `Tally`
        """
        frames = _check.whole(frames, "frames", 1, 1 << 20)
        pictures = _check.out(out, "out", (frames, *self.shape, 3))
        return pictures, [Tally(*counts) for counts in self._map.run(pictures)]

    def picture(self, out: Optional[np.ndarray] = None) -> np.ndarray:
        """Return what the display shows: uint8, shape (rows, columns, 3)."""
        picture = _check.out(out, "out", (*self.shape, 3))
        self._map.show(picture)
        return picture

    def galpixels(self) -> dict[str, np.ndarray]:
        """Return all galpixels, margin included, by the names of the fields.

        `class` (uint8: 0 galpixel, 1 just unobscured, 2 debris, 3 empty), `colour` (uint8, 3), `depth`, `offset` (2),
        `velocity` (3), `acceleration` (3), `luminosity_rate` (float64, units as for `load`), `tag` (uint32), each of
        shape (rows, columns) or with the last side named.
        """
        return self._map.galpixels()

    def inpaint(
        self,
        *,
        gamma: str = "0",
        threshold: int = 2**32 - 1,
        background: bool = True,
        motion: bool = True,
        mask: Optional[np.ndarray] = None,
    ) -> int:
        """Inpaint what the last step uncovered, by push-pull; return the number of cells.

        With `fill="push-pull"` each step does that by itself. The map must have `fill="extend"`.

        Parameters
        ----------
        gamma : str
            The power of the share that is known, by which partly known areas count: 0, 1/2 or 1.
        threshold : int
            How much nearer than the background foreground is at least, in units of the depth's last bit; the default
            makes no difference between them.
        background : bool
            Whether holes get the depth of the background first.
        motion : bool
            Whether motion is inpainted with the colour.
        mask : uint32, shape (words,), optional
            Which cells are filled: bit c mod 32 of word c / 32; all if absent.
        """
        if mask is not None and (_check.array(mask, "mask").dtype != np.uint32 or mask.ndim != 1):
            raise TypeError("`mask` is no row of uint32: give one bit a cell, 32 in each word")
        painting = SimpleNamespace(gamma=gamma, threshold=threshold, background=background, motion=motion, mask=mask)
        return self._map.inpaint(painting)

    def disocclusion(
        self,
        frames: int,
        *,
        separation: Optional[int] = None,
        continues: bool = False,
        tears: bool = True,
        through: bool = False,
    ) -> Disocclusion:
        """Find which hidden samples may be uncovered within so many frames.

        Parameters
        ----------
        frames : int
            Frames until the next update; more than 255 count as that.
        separation : int, optional
            The difference of depths from which on neighbours are of two surfaces, in units of the depth's last bit.
        continues : bool
            Whether what is at the border continues beyond it.
        tears : bool
            Whether neighbours of one surface that part count.
        through : bool
            Whether what a surface uncovers goes through to farther surfaces.

        Examples
        --------
        >>> import numpy
        >>> colour, depth = numpy.zeros((1, 8, 3), numpy.uint8), numpy.ones((1, 8), numpy.float32)
        >>> velocity = numpy.zeros((1, 8, 2), numpy.float32)
        >>> depth[0, 2:4], velocity[0, 2:4, 0] = 0.1, 1.0
        >>> map = Galpixmap((1, 8), Budget.derive(64))
        >>> _ = map.load(colour, depth=depth, velocity=velocity)
        >>> map.disocclusion(2, continues=True).needed[0].tolist()
        [False, False, True, True, False, False, False, False]
        """
        frames = _check.whole(frames, "frames", 0, 2**32 - 1)
        uncovered = SimpleNamespace(
            frames=frames, separation=separation, continues=continues, tears=tears, through=through
        )
        words, counts = self._map.disocclusion(uncovered)
        extents = words.view(np.uint8) if np.little_endian else words.byteswap().view(np.uint8)
        return Disocclusion(extents.reshape(*self.cells, 4), *counts)

    @property
    def words(self) -> np.ndarray:
        """The stored form, uint32, shape (words, rows, columns), margin included: a copy, which can be assigned."""
        return self._map.words()

    @words.setter
    def words(self, words: np.ndarray) -> None:
        words = _check.array(words, "words")
        if words.dtype != np.uint32:
            raise TypeError(f"`words` is of dtype {words.dtype}: give uint32, as words.astype(numpy.uint32)")
        shape = (self.budget.words(self.layout), *self.cells)
        self._map.set_words(np.ascontiguousarray(_check.shaped(words, "words", shape, "the map")))

    @property
    def edges(self) -> np.ndarray:
        """The edge map of the map before the last step, uint32, shape (words,): bit c mod 32 of word c / 32."""
        return self._map.edges()

    @property
    def frame(self) -> int:
        """Frames since the update, which select the thresholds of the rounding; can be assigned."""
        return self._map.frame

    @frame.setter
    def frame(self, frame: int) -> None:
        self._map.frame = _check.whole(frame, "frame", 0, 2**32 - 1)

    @property
    def edge_threshold(self) -> int:
        """The edge threshold in use, in units of the depth's last bit."""
        return self._map.edge_threshold
