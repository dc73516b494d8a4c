"""Galpixmaps in fixed point: pixels that carry their own motion, over numpy arrays.

>>> import galpix
>>> made = galpix.open("ball").run(frames=8)
>>> made.frames.shape, made.frames.dtype.name
((8, 144, 192, 3), 'uint8')
"""

from ._galpix import __version__
from .budget import Budget, Certificate, Component, Layout, certificate, smallest_budget
from .inpainting import FILL_MODES, INPAINTING, Filled, fill, inpaint
from .map import Disocclusion, Galpixmap, Loaded, Tally
from .metrics import flip, pooled_psnr, psnr, ssim, ssimulacra2
from .sources import (
    Distortion,
    Extrapolated,
    Source,
    Truth,
    Update,
    ddoc,
    extrapolate,
    open,
    scenes,
    write_vectors,
)
from .sweeps import sweep

__all__ = [
    "FILL_MODES",
    "INPAINTING",
    "Budget",
    "Certificate",
    "Component",
    "Disocclusion",
    "Distortion",
    "Extrapolated",
    "Filled",
    "Galpixmap",
    "Layout",
    "Loaded",
    "Source",
    "Tally",
    "Truth",
    "Update",
    "__version__",
    "certificate",
    "ddoc",
    "extrapolate",
    "fill",
    "flip",
    "inpaint",
    "open",
    "pooled_psnr",
    "psnr",
    "scenes",
    "smallest_budget",
    "ssim",
    "ssimulacra2",
    "sweep",
    "write_vectors",
]
