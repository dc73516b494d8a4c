"""Built-in scenes with exact truth, captures, extrapolation in both schemes, and the occlusion camera."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any, NamedTuple, Optional, Union

import numpy as np

from . import _check, _galpix
from .budget import Budget, Layout
from .map import Tally, update_arrays


class Update(NamedTuple):
    """A rendered picture with the motion of each pixel. Arrays have the margin, too."""

    colour: np.ndarray
    """uint8, shape (rows, columns, 3)."""
    depth: np.ndarray
    """float64, shape (rows, columns): 0 nearest to 1 farthest, linear in inverse distance."""
    velocity: np.ndarray
    """float64, shape (rows, columns, 3): pixels per frame in x and y, depth range per frame."""
    acceleration: np.ndarray
    """float64, shape (rows, columns, 3): the same per frame squared."""
    luminosity_rate: np.ndarray
    """float64, shape (rows, columns): 8-bit code values per frame."""
    tag: np.ndarray
    """uint8, shape (rows, columns)."""
    known: np.ndarray
    """bool, shape (rows, columns): where depth and motion are known."""
    margin: tuple[int, int, int, int]
    """Columns left and right of the display, rows above and below it."""
    depth_kind: str
    """Where the depth came from: z, disparity or speed."""


class Truth(NamedTuple):
    """A true later picture."""

    picture: np.ndarray
    """uint8, shape (rows, columns, 3)."""
    mask: Optional[np.ndarray]
    """bool, shape (rows, columns): where a comparison counts; None for everywhere."""


@dataclass(frozen=True)
class Extrapolated:
    """Frames that were made of one update."""

    frames: np.ndarray
    """uint8, shape (frames, rows, columns, 3): frame 1 first."""
    reached: np.ndarray
    """bool, shape (frames, rows, columns): where a sample of the update is shown, and nothing that was filled."""
    tallies: list[Tally]
    """Counts of each frame."""


def _wanted(options: dict[str, Any]) -> SimpleNamespace:
    known = {
        "frames": None,
        "extent": None,
        "recog": None,
        "prop": None,
        "position_frac": 0,
        "rounding": "low-discrepancy",
        "fill": None,
        "gamma": None,
        "reach": 1,
        "edge_threshold": None,
        "scheme": "source",
        "scan_out": None,
        "perceptual": True,
        "hidden": "none",
    }
    for name in options:
        if name not in known:
            raise TypeError(f"`{name}` is no option of an extrapolation: give some of {', '.join(known)}")
    wanted = SimpleNamespace(**{**known, **options})
    for name in ("frames", "extent", "recog", "prop"):
        value = getattr(wanted, name)
        if value is not None:
            _check.whole(value, name, 1, 1 << 20)
    return wanted


class Source:
    """A built-in scene or a capture: an update, and the true pictures of later frames. `galpix.open` makes one.

    >>> import galpix
    >>> ball = galpix.open("ball")
    >>> ball.name, ball.frames, ball.update().colour.shape
    ('ball', 24, (144, 192, 3))
    """

    def __init__(self, name: str, acceleration: str = "given") -> None:
        self._source = _galpix.Source(name, acceleration)
        self._opened = (name, acceleration)

    def __reduce__(self) -> tuple:
        return Source, self._opened

    def __repr__(self) -> str:
        return f"<galpix.Source {self.name!r}>"

    @property
    def name(self) -> str:
        """The scene's or the capture's name."""
        return self._source.name

    @property
    def about(self) -> str:
        """What it shows."""
        return self._source.about

    @property
    def frames(self) -> int:
        """How many frames it is meant to be extrapolated."""
        return self._source.frames

    @property
    def second_order(self) -> Optional[bool]:
        """Whether velocity and acceleration say all of the motion of a scene; None for a capture."""
        return self._source.second_order

    def update(self) -> Update:
        """Return the arrays of the update."""
        return Update(**self._source.update())

    def truth(self, frame: int) -> Optional[Truth]:
        """Return the true picture of a frame after the update (frame 0), or None where it is not known."""
        truth = self._source.truth(_check.whole(frame, "frame", 0, 1 << 20))
        return None if truth is None else Truth(*truth)

    def truth_frames(self, frames: Optional[int] = None) -> list[int]:
        """Return those of the frames 1 to `frames` whose true picture is known."""
        return self._source.truth_frames(self.frames if frames is None else frames)

    def run(self, *, fields: Optional[str] = None, **options: Any) -> Extrapolated:
        """Extrapolate the update; return its frames.

        Parameters
        ----------
        fields : str, optional
            Which fields a galpixel carries: still, velocity, velocity-depth, acceleration, full or luminosity.
        frames, extent, recog, prop : int
            Frames to make, and the design numbers of the budget; the source's own if absent.
        scheme : str
            source (stationary sources, the default) or map (the paper's galpixmap).
        fill, gamma, rounding, reach, edge_threshold, scan_out, position_frac
            As the options of `galpix run`; edge_threshold is a part of the depth range.
        hidden : str
            Which hidden samples are handed over: none, second, ddoc or unlimited, where the source has them.
        """
        frames, reached, counts = self._source.extrapolate(_wanted(options), fields)
        return Extrapolated(frames, reached, [Tally(*count) for count in counts])

    def report(self, *, fields: Optional[str] = None, **options: Any) -> dict[str, Any]:
        """Extrapolate the update and compare each frame with the truth and with the exact path.

        Options are those of `run`, and `perceptual` (bool): whether SSIM and FLIP are worked out. Returns the document
        of `galpix run --json`, whose keys `galpix schema run` explains, without the call and the paths of the files.
        """
        return json.loads(self._source.report(_wanted(options), fields))


def open(name: Union[str, os.PathLike], *, acceleration: str = "given") -> Source:
    """Open a built-in scene by its name, or a capture by the path of its `capture.toml` or its folder.

    Parameters
    ----------
    name : str or path
        `galpix.scenes()` lists the scenes.
    acceleration : str
        What is done with the accelerations of a capture: given, off, clamp or smooth.

    Raises
    ------
    ValueError
        One sentence that says what cannot be read, where, and how to mend it.
    """
    return Source(os.fspath(name), acceleration)


def scenes() -> dict[str, str]:
    """Return the names of the built-in scenes, and what each stresses.

    >>> "ball" in scenes()
    True
    """
    return dict(_galpix.scenes())


def extrapolate(
    colour: np.ndarray,
    velocity: np.ndarray,
    *,
    frames: int,
    depth: Optional[np.ndarray] = None,
    acceleration: Optional[np.ndarray] = None,
    known: Optional[np.ndarray] = None,
    luminosity_rate: Optional[np.ndarray] = None,
    margin: tuple[int, int, int, int] = (0, 0, 0, 0),
    depth_kind: str = "z",
    budget: Optional[Budget] = None,
    layout: Layout = Layout.FULL,
    **options: Any,
) -> Extrapolated:
    """Keep a picture moving, by stationary sources with push-pull unless told otherwise.

    Parameters
    ----------
    colour, velocity, depth, acceleration, known, luminosity_rate
        As for `Galpixmap.load`.
    frames : int
        How many frames.
    margin : (int, int, int, int)
        Columns left and right of the display, rows above and below it, that the arrays have besides.
    depth_kind : str
        z, disparity or speed: decides the default threshold of edges.
    budget, layout : Budget, Layout
        Widths and fields; derived from the size and from `extent`, `recog` and `prop` if no budget is given.
    options
        Those of `Source.run`.

    Examples
    --------
    >>> import galpix
    >>> update = galpix.open("drift").update()
    >>> made = extrapolate(update.colour, update.velocity, frames=4, depth=update.depth)
    >>> made.frames.shape
    (4, 144, 192, 3)
    """
    rest = {"known": known, "luminosity_rate": luminosity_rate}
    arrays = update_arrays(colour, depth, velocity, acceleration, rest)
    wanted = _wanted({**options, "frames": frames})
    form = None if budget is None else (budget, layout)
    made, reached, counts = _galpix.extrapolate(arrays, _check.margin(margin), depth_kind, (wanted, form))
    return Extrapolated(made, reached, [Tally(*count) for count in counts])


@dataclass(frozen=True)
class Distortion:
    """The distortion map of a depth discontinuity occlusion camera (DDOC)."""

    displacement: np.ndarray
    """float64, shape (rows, columns, 2): by how much what is hidden behind a pixel is moved in x and y, in pixels, to
    where the camera sees it."""
    edges: int
    """Pixels on the near side of an edge."""
    splats: int
    """Of these, pixels that became the centre of a splat."""
    dropped: int
    """Of these, pixels for whose splat there was no memory."""
    shrunk: int
    """Splats that a conflict made smaller."""
    orphans: int
    """Pixels whose distortion was deleted, because their splat had become too small."""
    distorted: int
    """Pixels that are distorted."""


def ddoc(
    depth: np.ndarray, *, radius: int = 16, asymmetry: int = 16, window: int = 3, threshold: Optional[int] = None
) -> Distortion:
    """Find how a depth discontinuity occlusion camera looks around the edges of a depth image.

    Parameters
    ----------
    depth : float32 or float64, shape (rows, columns)
        0 nearest to 1 farthest, linear in inverse distance; what is not finite is infinitely far.
    radius : int
        How far behind an edge it reaches, 1 to 255 pixels.
    asymmetry : int
        16 to 255 sixteenths: hidden pixels per pixel of the visible side.
    window : int
        Pixels to each side in which the direction of an edge is found, 1 to 15.
    threshold : int, optional
        The second difference of depths of 24 bits above which a pixel is on an edge.

    Examples
    --------
    >>> import numpy
    >>> depth = numpy.full((16, 32), 0.9)
    >>> depth[:, :16] = 0.1
    >>> ddoc(depth, radius=4).displacement[8, 13].tolist()
    [3.0, 0.0]
    """
    depth = _check.array(depth, "depth")
    if depth.ndim != 2:
        raise ValueError(f"`depth` has shape {depth.shape}: give (rows, columns)")
    camera = SimpleNamespace(
        radius=_check.whole(radius, "radius", 1, 255),
        asymmetry=_check.whole(asymmetry, "asymmetry", 16, 255),
        window=_check.whole(window, "window", 1, 15),
        threshold=threshold,
    )
    displacement, counts = _galpix.distortion(_check.given_floats(depth, "depth", depth.shape), depth.shape, camera)
    return Distortion(displacement, *counts)


def write_vectors(folder: Union[str, os.PathLike], seed: int = 0) -> None:
    """Write the golden vectors, inputs and outputs of every kernel and of whole frames, into a folder."""
    _galpix.write_vectors(os.fspath(folder), seed)
