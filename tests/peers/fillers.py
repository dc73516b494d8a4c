"""The peers: hole fillers that others offer. Each takes a picture (height x width x 3 bytes) and a mask of truth values, and
gives the picture with the masked cells filled and all others as they were."""

import os

# Before the libraries are loaded: one thread, as the engine has.
for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(threads, "1")

import cv2
import numpy as np

cv2.setNumThreads(1)

RADIUS = 3


def telea(picture, mask):
    """Telea, "An image inpainting technique based on the fast marching method", 2004, as OpenCV has it."""
    return cv2.inpaint(picture, mask.astype(np.uint8), RADIUS, cv2.INPAINT_TELEA)


def navier_stokes(picture, mask):
    """Bertalmio, Bertozzi, Sapiro, "Navier-Stokes, fluid dynamics, and image and video inpainting", 2001, as OpenCV has it."""
    return cv2.inpaint(picture, mask.astype(np.uint8), RADIUS, cv2.INPAINT_NS)


def gortler(picture, mask):
    """Push-pull after Gortler, Grzeszczuk, Szeliski, Cohen, "The Lumigraph", 1996, in the textbook's form: 32-bit floats, every
    cell of every level. Pull: a cell is the mean of its valid children, and valid if one of them is. Push: a cell that is not
    valid takes the bilinear interpolation of the finished level above it."""
    known = ~mask
    levels = [(np.where(mask[..., None], 0, picture).astype(np.float32), known)]
    while levels[-1][1].size > 1:
        levels.append(pull(*levels[-1]))
    finished = levels.pop()[0]
    for own, valid in reversed(levels):
        finished = np.where(valid[..., None], own, bilinear(finished, *valid.shape))
    return np.floor(finished + 0.5).astype(np.uint8)


def pull(colour, valid):
    even = ((0, valid.shape[0] & 1), (0, valid.shape[1] & 1))
    colour, weight = np.pad(colour, (*even, (0, 0))), np.pad(valid, even).astype(np.float32)
    count = four(weight)
    return four(colour * weight[..., None]) / np.maximum(count, 1)[..., None], count > 0


def four(plane):
    return plane[::2, ::2] + plane[1::2, ::2] + plane[::2, 1::2] + plane[1::2, 1::2]


def bilinear(coarse, height, width):
    """Twice the size, cut to `height` x `width`: weights 9:3:3:1, since a child's centre is a quarter of a cell from its parent's."""
    for axis, size in ((0, height), (1, width)):
        last = [(0, 0)] * 3
        last[axis] = (1, 1)
        around = np.moveaxis(np.pad(coarse, last, "edge"), axis, 0)
        fine = np.empty((2 * (len(around) - 2), *around.shape[1:]), np.float32)
        fine[0::2] = 0.75 * around[1:-1] + 0.25 * around[:-2]
        fine[1::2] = 0.75 * around[1:-1] + 0.25 * around[2:]
        coarse = np.moveaxis(fine[:size], 0, axis)
    return coarse


def resized(picture, mask):
    """The same idea in the fewest calls of OpenCV: colours weighted by how much of a cell is known, halved and doubled by
    `cv2.resize`. What a user of Python writes for speed; a cell that is partly known takes its rest from above."""
    known = (~mask).astype(np.float32)
    levels = [cv2.merge([*cv2.split(picture.astype(np.float32) * known[..., None]), known])]
    while max(levels[-1].shape[:2]) > 1:
        height, width = levels[-1].shape[:2]
        levels.append(cv2.resize(levels[-1], ((width + 1) // 2, (height + 1) // 2), interpolation=cv2.INTER_AREA).reshape(
            (height + 1) // 2, (width + 1) // 2, 4))
    finished = levels[-1] / np.maximum(levels[-1][..., 3:], 1e-6)
    for own in levels[-2::-1]:
        above = cv2.resize(finished, own.shape[1::-1], interpolation=cv2.INTER_LINEAR)
        finished = own + (1 - own[..., 3:]) * above.reshape(own.shape)
    return np.clip(np.floor(finished[..., :3] + 0.5), 0, 255).astype(np.uint8)


BY_NAME = {"telea": telea, "navier-stokes": navier_stokes, "gortler": gortler}
