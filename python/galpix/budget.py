"""Bit budgets, layouts, and the certificate of the position error."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, NamedTuple, Optional

import numpy as np

from . import _galpix
from ._check import whole

_MOST = 2**32 - 1


class Component(NamedTuple):
    """The widths of the fields of one component, in bits. Integer bits include the sign.

    The equations are those of the paper; `docs/spec.md` of galpix has them.
    """

    position_frac: int
    """Fraction bits of the position, equation (11)."""
    velocity_int: int
    """Integer bits of the velocity, equation (8)."""
    velocity_frac: int
    """Fraction bits of the velocity, equation (13)."""
    acceleration_int: int
    """Integer bits of the acceleration, equation (9); 0 without acceleration."""
    acceleration_frac: int
    """Fraction bits of the acceleration, equation (12); 0 without acceleration."""

    @property
    def motion_bits(self) -> int:
        """Bits that motion adds to this component of each pixel, equation (14)."""
        return sum(self)


@dataclass(frozen=True)
class Layout:
    """Which fields a galpixel carries besides its class of 2 bits. An absent field takes no bits and no work.

    >>> Layout.FULL.acceleration, Layout.VELOCITY565.colour
    (True, 'rgb565')
    """

    colour: str = "rgb888"
    """rgb888, rgb565, gray8 or gray4."""
    depth_bits: int = 0
    """Bits of the z-buffer; 0 leaves the depth out."""
    velocity: bool = False
    """Fractional position and velocity in x and y."""
    acceleration: bool = False
    """Acceleration, in each component that has a velocity."""
    depth_motion: bool = False
    """Velocity of the depth; with `acceleration` also its acceleration."""
    luminosity: bool = False
    """Rate of the luminosity (shading inertia)."""
    tag_bits: int = 0
    """Bits of the object tag; 0 leaves it out."""

    STILL: ClassVar[Layout]
    """Colour only: a picture that does not move."""
    FULL: ClassVar[Layout]
    """The paper's galpixel: x, y, z with velocity and acceleration, rgb888, 16-bit z."""
    TAGGED: ClassVar[Layout]
    """The paper's galpixel with an object tag of 8 bits."""
    VELOCITY565: ClassVar[Layout]
    """x and y with velocity only, rgb565, 16-bit z that does not move."""
    VELOCITY_GRAY8: ClassVar[Layout]
    """x and y with velocity only, gray8, 8-bit z that does not move."""


Layout.STILL = Layout()
Layout.FULL = Layout(depth_bits=16, velocity=True, acceleration=True, depth_motion=True)
Layout.TAGGED = Layout(depth_bits=16, velocity=True, acceleration=True, depth_motion=True, tag_bits=8)
Layout.VELOCITY565 = Layout(colour="rgb565", depth_bits=16, velocity=True)
Layout.VELOCITY_GRAY8 = Layout(colour="gray8", depth_bits=8, velocity=True)


@dataclass(frozen=True)
class Budget:
    """The widths of the fields of all three components.

    `Budget.derive` gives those of the paper's equations; the widths can be given one by one, too.

    >>> budget = Budget.derive(extent=1024, recog=8, prop=16)
    >>> budget.x
    Component(position_frac=4, velocity_int=10, velocity_frac=7, acceleration_int=8, acceleration_frac=7)
    >>> budget.x.motion_bits, budget.bytes_per_galpixel(Layout.FULL)
    (36, 20)
    """

    x: Component
    y: Component
    z: Component
    """In depth."""
    depth_int: int
    """Base-2 logarithm of the number of depth bins in the whole depth range."""
    luminosity_int: int = 1
    """Integer bits of the luminosity rate, with the sign."""
    luminosity_frac: int = 0
    """Fraction bits of the luminosity and of its rate."""
    prop: Optional[int] = None
    """Frames to survive without an update, where the widths were derived for so many."""

    @classmethod
    def derive(cls, extent: int, recog: int = 8, prop: int = 16, *, acceleration: bool = True) -> Budget:
        """Derive all widths from the three design numbers.

        Parameters
        ----------
        extent : int
            D, the extent of the display in pixels.
        recog : int
            tau_recog, the shortest time in frames in which an object can be recognised.
        prop : int
            tau_prop, the frames to survive without an update, at least 2.
        acceleration : bool
            Without acceleration two integer bits of the velocity are saved, too.

        Raises
        ------
        ValueError
            If no such budget exists; the sentence says what to change.
        """
        extent, recog = whole(extent, "extent", 0, _MOST), whole(recog, "recog", 0, _MOST)
        prop = whole(prop, "prop", 0, _MOST)
        widths, depth_int, luminosity_int, luminosity_frac = _galpix.derive(extent, recog, prop, bool(acceleration))
        component = Component(*widths)
        return cls(component, component, component, depth_int, luminosity_int, luminosity_frac, prop)

    def words(self, layout: Layout) -> int:
        """Return the 32-bit words of a galpixel of a layout."""
        return _galpix.record(self, layout)[0]

    def bits(self, layout: Layout) -> int:
        """Return the bits of a galpixel of a layout that are in use."""
        return _galpix.record(self, layout)[1]

    def bytes_per_galpixel(self, layout: Layout) -> int:
        """Return the bytes of a galpixel of a layout, in whole words."""
        return 4 * self.words(layout)


@dataclass(frozen=True)
class Certificate:
    """The worst position error over all states of a component, for each frame up to tau_prop, in pixels."""

    total_px: float
    """The largest sum of quantisation and drift after any frame."""
    quantisation_px: float
    """From storing position, velocity and acceleration, after the last frame."""
    drift_px: float
    """The largest drift, which rounding causes in each frame, after any frame."""
    drift_any_phase_px: float
    """The same if the update enters at any frame of the counter."""
    method: str
    """`enumerated`: a state reaches the bound; `bounded`: there are too many states, the bound is not tight."""
    classes: int
    """Residue classes of velocity and acceleration."""
    phases: int
    """Phases of the frame counter."""
    quantisation: np.ndarray
    """float64, shape (prop,): the quantisation after frames 1 to prop, pixels."""
    drift: np.ndarray
    """float64, shape (prop,): the drift after frames 1 to prop, pixels."""

    @property
    def keeps_one_pixel(self) -> bool:
        """Whether the paper's promise holds: within one pixel for tau_prop frames."""
        return self.total_px <= 1.0


def certificate(budget: Budget, rounding: str = "low-discrepancy", *, prop: Optional[int] = None) -> Certificate:
    """Find the worst position error of a budget in x, by complete enumeration.

    Parameters
    ----------
    budget : Budget
        Its component `x` counts.
    rounding : str
        truncate, nearest, low-discrepancy or searched.
    prop : int, optional
        For how many frames; what the budget was derived for if absent.

    Examples
    --------
    >>> certificate(Budget.derive(extent=1024, recog=8, prop=16)).total_px
    0.84375
    >>> certificate(Budget.derive(extent=1024, recog=8, prop=16), "truncate").keeps_one_pixel
    False
    """
    frames = budget.prop if prop is None else whole(prop, "prop", 1, 4096)
    if frames is None:
        raise ValueError("`prop` is missing, and the budget was not derived for a number of frames: give prop")
    return Certificate(**_galpix.certify(budget.x, rounding, frames))


def smallest_budget(
    max_error: float,
    *,
    extent: int,
    recog: int = 8,
    prop: int = 16,
    acceleration: bool = True,
    rounding: str = "low-discrepancy",
) -> tuple[Budget, Certificate]:
    """Find the budget of the fewest motion bits whose certificate keeps an error.

    Parameters
    ----------
    max_error : float
        Pixels, for `prop` frames.
    extent, recog, prop, acceleration
        As for `Budget.derive`; they give the integer bits.
    rounding : str
        truncate, nearest, low-discrepancy or searched.

    Raises
    ------
    ValueError
        If no budget keeps the error; the sentence says how near one gets.

    Examples
    --------
    >>> budget, proof = smallest_budget(0.5, extent=1024)
    >>> budget.x.motion_bits, proof.total_px <= 1.0
    (39, True)
    """
    if not max_error > 0:
        raise ValueError(f"`max_error` is {max_error}: give a positive number of pixels")
    derived = Budget.derive(extent, recog, prop, acceleration=acceleration)
    widths, proof = _galpix.smallest(derived.x, rounding, prop, float(max_error))
    component = Component(*widths)
    budget = Budget(
        component,
        component,
        component,
        derived.depth_int,
        derived.luminosity_int,
        derived.luminosity_frac,
        derived.prop,
    )
    return budget, Certificate(**proof)
