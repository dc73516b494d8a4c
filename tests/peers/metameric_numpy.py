"""The metameric loss of the library odak 0.2.7 (MPL-2.0), in numpy alone: how far two pictures are from being metamers,
by the mean and the deviation of each band of a steerable pyramid in the surroundings of each cell. Where exactly the
details of a texture are does not matter to it.

Written anew from what the loss is; nothing but numbers was taken. Those of the filters are the tables `sp1` of the
steerable pyramid of E. P. Simoncelli and W. T. Freeman (1995; odak has them from pyrtools, MIT), cut to the sizes that
odak cuts them to.

Two forms, as there. *Uniform*: the surroundings are 32 x 32 cells everywhere. *Gaze*: they grow with the square of the
angle from the place looked at, and where they are a single cell, squared differences of colours count. Also as there:

- The lowpass doubles all values from level to level: a level's squares weigh four times those of the level below it,
  and the last lowpass, four levels up, weighs 256 times. It is nearly all of the loss, and says how far the mean
  colours of 16 x 16 cells are. `parts` gives what the bands add.
- The loss is the mean over 19 maps: mean and deviation of the highpass and of both bands of four levels, and the last
  lowpass.

Not as there: a picture whose sizes cannot be halved five times is mirrored to the right and below. odak 0.2.7 mirrors
it above, and below by what its width lacks, which fails to give the sizes unless the width is a multiple of 32.
"""

import numpy as np

LEVELS = 5
POOLING = 32

# A picture is 0.2 wide and 0.7 away. Surroundings at the angle `a` from the place looked at have the diameter 0.2 a^2.
WIDTH, DISTANCE, GROWTH = 0.2, 0.7, 0.2

# The weight of squared differences of colours where one looks.
FOVEA = 20

# No variance is below this.
LEAST = 1e-7


def octants(*rows):
    """The filter, alike in all eight directions, whose row `i` holds these numbers from the diagonal to the middle."""
    quarter = np.zeros((len(rows), len(rows)))
    for i, row in enumerate(rows):
        quarter[i, i:] = quarter[i:, i] = row
    half = np.concatenate([quarter, quarter[:, -2::-1]], axis=1)
    return np.concatenate([half, half[-2::-1]], axis=0)


HIGHPASS = octants((0.01706347, 0.01094866, -0.00589778), (-0.0784137, -0.1562827), (0.7282593,))

BASE = octants((-0.00706129, -0.03769487, -0.03297137), (0.0438132, 0.1811603), (0.437625,))

LOWPASS = octants(
    (0.00146078, 0.00216054, 0.00376136, 0.00308098, 0.00411220, 0.00222122, 0.00055382),
    (0.00317578, 0.00318468, -0.00177748, -0.00743170, -0.00905692, -0.00963722),
    (-0.00353064, -0.01260420, -0.01884744, -0.01750818, -0.01648568),
    (-0.02022938, -0.01109170, 0.00395566, 0.01438512),
    (0.02190660, 0.06806584, 0.09058014),
    (0.14455, 0.1773651),
    (0.2120374,),
)

# What cutting takes away, the rest makes up for: the sums are 1 and 2.
BASE /= BASE.sum()
LOWPASS *= 2 / LOWPASS.sum()

ALONG = np.array([(-0.0238218, -0.01836909), (-0.05375324, 0.1265655), (-0.02076086, 0.2996168)])
ALONG = np.concatenate([ALONG, ALONG[1::-1]])
ALONG = np.concatenate([ALONG, np.zeros((5, 1)), -ALONG[:, ::-1]], axis=1)
BANDS = [ALONG, -ALONG.T]


class Metameric:
    """Of pictures (height x width x 3 bytes), by surroundings of `POOLING` cells, or by a place looked at (x, y; 0 to
    1)."""

    def __init__(self, gaze=None):
        self.gaze = gaze

    def features(self, picture):
        """What is compared: the colours, by how much each cell is looked at, and the maps of statistics, which become
        coarser."""
        colours = padded(ycrcb(picture.astype(np.float64) / 255))
        # What is mirrored beside the picture moves the place looked at.
        (height, width), (high, wide) = picture.shape[:2], colours.shape[:2]
        gaze = self.gaze and (self.gaze[0] * width / wide, self.gaze[1] * height / high)
        highpass, levels, lowpass = pyramid(colours)
        looked_at, aside = None, 1
        if gaze:
            size = octaves(gaze, high, wide)
            looked_at = ((1 - size / size.max()) ** 10)[..., None]
            aside = 1 - looked_at
        maps = []
        for level, bands in enumerate([[highpass, *levels[0]], *levels[1:]]):
            pool = pooling(gaze, level, *bands[0].shape[:2])
            for band in bands:
                mean = pool(band)
                variance = pool(band * band) - mean * mean
                maps += [mean * aside, np.sqrt(np.maximum(variance, LEAST)) * aside]
            if gaze:
                aside = area(aside, aside.shape[0] // 2, aside.shape[1] // 2)
        return (None if looked_at is None else colours * looked_at), [*maps, lowpass * aside]

    def distance(self, one, other):
        """The loss of two pictures, given their features."""
        return sum(self.parts(one, other).values())

    def parts(self, one, other):
        """What the bands' means, their deviations, the last lowpass and the colours looked at add to the loss."""
        (colours, maps), (others, other_maps) = one, other
        squares = [float(np.square(a - b).mean()) / len(maps) for a, b in zip(maps, other_maps)]
        fovea = 0.0 if colours is None else FOVEA * float(np.square(colours - others).mean())
        bands = {"means": sum(squares[:-1:2]), "deviations": sum(squares[1:-1:2])}
        return {**bands, "lowpass": squares[-1], "fovea": fovea}


def pooling(gaze, level, height, width):
    """What takes the mean over the surroundings of each cell of a level."""
    if gaze:
        size = octaves(gaze, height, width)
        return lambda plane: blurred(plane, size)
    cells = POOLING >> level
    return lambda plane: bilinear(area(plane, height // cells, width // cells), height, width)


def ycrcb(colours):
    red, green, blue = np.moveaxis(colours, 2, 0)
    luma = 0.299 * red + 0.587 * green + 0.114 * blue
    return np.dstack([luma, 0.5 + 0.713 * (red - luma), 0.5 + 0.564 * (blue - luma)])


def padded(plane):
    """Mirrored to the right and below until both sizes can be halved as often as there are levels."""
    right, below = (-plane.shape[axis] % (1 << LEVELS) for axis in (1, 0))
    return np.pad(plane, ((0, below), (0, right), (0, 0)), "reflect")


def pyramid(colours):
    """The highpass, the two bands of each level but the last, and the last level's lowpass."""
    lowpass, levels = filtered(colours, BASE), []
    for _ in range(LEVELS - 1):
        levels.append([filtered(lowpass, band) for band in BANDS])
        lowpass = filtered(lowpass, LOWPASS, 2)
    return filtered(colours, HIGHPASS), levels, lowpass


def filtered(plane, kernel, stride=1):
    """The kernel's response at every, or every second, place in each direction; the border mirrors."""
    apron = len(kernel) // 2
    height, width = (length // stride for length in plane.shape[:2])
    plane = np.pad(plane, ((apron, apron), (apron, apron), (0, 0)), "reflect")
    total = np.zeros((height, width, plane.shape[2]))
    for y, row in enumerate(kernel):
        for x, weight in enumerate(row):
            if weight:
                total += weight * plane[y : y + stride * height : stride, x : x + stride * width : stride]
    return total


def area(plane, height, width):
    """The means of `height` x `width` parts; parts that do not come out even share cells."""
    for axis, parts in ((0, height), (1, width)):
        cells = plane.shape[axis]
        starts = np.arange(parts) * cells // parts
        ends = -(-(np.arange(parts) + 1) * cells // parts)
        sums = np.concatenate([np.zeros_like(plane.take([0], axis)), plane.cumsum(axis)], axis)
        shape = [-1 if i == axis else 1 for i in range(3)]
        plane = (sums.take(ends, axis) - sums.take(starts, axis)) / (ends - starts).reshape(shape)
    return plane


def bilinear(plane, height, width):
    for axis, parts in ((0, height), (1, width)):
        cells = plane.shape[axis]
        place = np.maximum((np.arange(parts) + 0.5) * cells / parts - 0.5, 0)
        first = place.astype(int)
        share = (place - first).reshape([-1 if i == axis else 1 for i in range(3)])
        plane = plane.take(first, axis) * (1 - share) + plane.take(np.minimum(first + 1, cells - 1), axis) * share
    return plane


def octaves(gaze, height, width):
    """For each cell the logarithm of the diameter of its surroundings in cells, 0 for a cell or less."""
    tall = WIDTH * height / width
    x, y = np.meshgrid(np.linspace(-0.5, 0.5, width) * WIDTH, np.linspace(-0.5, 0.5, height) * tall)
    distance = np.sqrt(x * x + y * y + DISTANCE**2)

    def angle(to_x, to_y):
        cosine = (x * to_x + y * to_y + DISTANCE**2) / distance / np.sqrt(to_x**2 + to_y**2 + DISTANCE**2)
        return np.arccos(np.minimum(cosine, 1))

    angle_across = GROWTH * angle((gaze[0] - 0.5) * WIDTH, (gaze[1] - 0.5) * tall) ** 2
    outward = angle(0, 0)
    # On the flat picture the surroundings are an ellipse; the diameter is that of a square of its area.
    longer = (np.tan(outward + angle_across / 2) - np.tan(outward - angle_across / 2)) * DISTANCE
    shorter = 2 * distance * np.tan(angle_across / 2)
    cells = np.sqrt(np.pi / 4 * longer * shorter) * width / WIDTH
    return np.maximum(np.log2(1e-6 + cells), 0)


def blurred(plane, size):
    """The mean over 2^`size` cells: linearly between the two nearest of means of 1, 2, 4, ... cells in each
    direction."""
    height, width = size.shape
    whole = size.astype(int)
    share = (size - whole)[..., None]
    coarse, finer, total = plane, plane, np.zeros_like(plane)
    for level in range(whole.max() + 1):
        coarse = area(coarse, max(coarse.shape[0] // 2, 1), max(coarse.shape[1] // 2, 1))
        coarser = bilinear(coarse, height, width)
        total = np.where((whole == level)[..., None], (1 - share) * finer + share * coarser, total)
        finer = coarser
    return total
