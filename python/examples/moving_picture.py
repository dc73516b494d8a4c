"""A moving picture as a numpy array, in ten lines."""

import numpy

import galpix

colour = numpy.zeros((144, 192, 3), numpy.uint8)  # What a renderer drew ...
colour[48:96, 24:72] = 255, 160, 0
velocity = numpy.zeros((144, 192, 2), numpy.float32)  # ... and how it moves, in pixels per frame.
velocity[48:96, 24:72] = 2.5, 0.5
depth = numpy.where(velocity[..., 0] > 0, numpy.float32(0.2), numpy.float32(0.9))
frames = galpix.extrapolate(colour, velocity, depth=depth, frames=16).frames
assert (frames[15, 60:100, 68:108] == (255, 160, 0)).all()
print(f"{len(frames)} frames of {frames.shape[1]} x {frames.shape[2]}, {frames.dtype}")
