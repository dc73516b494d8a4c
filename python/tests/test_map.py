"""Galpixmaps over arrays."""

import threading
import time

import numpy as np
import pytest

import galpix
from galpix import Budget, Galpixmap, Layout


def square(dtype=np.float32):
    colour = np.zeros((24, 32, 3), np.uint8)
    colour[8:16, 4:12] = 200, 100, 50
    velocity = np.zeros((24, 32, 2), dtype)
    velocity[8:16, 4:12] = 1.5, 0.25
    depth = np.where(velocity[..., 0] > 0, 0.2, 0.9).astype(dtype)
    return colour, depth, velocity


def test_a_square_moves_and_uncovers_what_is_filled():
    colour, depth, velocity = square()
    map = Galpixmap(colour.shape[:2], fill="none")
    map.load(colour, depth=depth, velocity=velocity)
    frames, tallies = map.run(8)
    expected = np.zeros_like(colour)
    expected[10:18, 16:24] = 200, 100, 50
    assert (frames[7] == expected).all()
    assert tallies[0].collided > 0 and sum(tally.lost for tally in tallies) == 0
    assert map.frame == 8


def test_float32_and_float64_and_strided_arrays_give_the_same():
    words = []
    for dtype in (np.float32, np.float64):
        colour, depth, velocity = square(dtype)
        map = Galpixmap(colour.shape[:2])
        map.load(colour, depth=depth, velocity=velocity)
        words.append(map.words)
        wide = np.zeros((24, 64, 3), np.uint8)
        wide[:, ::2] = colour
        map.load(wide[:, ::2], depth=np.asfortranarray(depth), velocity=velocity)
        words.append(map.words)
    assert all((words[0] == other).all() for other in words[1:])


def test_galpixels_come_back():
    layout, rng = Layout.TAGGED, np.random.default_rng(1)
    map = Galpixmap((5, 7), Budget.derive(64), layout, margin=(1, 2, 0, 3))
    assert map.cells == (8, 10)
    shape = map.cells
    colour = rng.integers(0, 256, (*shape, 3), np.uint8)
    depth = rng.integers(0, 2**16, shape) / 2**16
    velocity = rng.integers(-64, 64, (*shape, 2)) / 16.0
    acceleration = rng.integers(-8, 8, (*shape, 2)) / 16.0
    tag = rng.integers(0, 256, shape, np.uint8)
    known = rng.random(shape) < 0.9
    velocity[0, 0, 0] = np.nan
    loaded = map.load(colour, depth=depth, velocity=velocity, acceleration=acceleration, tag=tag, known=known)
    galpixels = map.galpixels()
    known[0, 0] = False
    assert loaded == (known.sum(), (~known).sum(), 0)
    assert ((galpixels["class"] == 3) == ~known).all()
    assert (galpixels["colour"] == colour).all()
    for name, given in (("depth", depth), ("tag", tag)):
        assert (galpixels[name][known] == given[known]).all(), name
    for name, given in (("velocity", velocity), ("acceleration", acceleration)):
        assert (galpixels[name][known][:, :2] == given[known]).all(), name


def test_run_is_step_by_step():
    colour, depth, velocity = square()
    one, other = (Galpixmap(colour.shape[:2], fill="push-pull", scan_out="sub-cell") for _ in range(2))
    for map in (one, other):
        map.load(colour, depth=depth, velocity=velocity)
    out = np.empty((5, *colour.shape), np.uint8)
    frames, tallies = one.run(5, out)
    assert frames is out
    for frame, tally in zip(frames, tallies):
        assert other.step() == tally
        assert (other.picture() == frame).all()
    assert (one.words == other.words).all()


def test_two_maps_run_at_once():
    colour = np.zeros((256, 256, 3), np.uint8)
    velocity = np.ones((256, 256, 2), np.float32)
    maps = [Galpixmap((256, 256)) for _ in range(2)]
    for map in maps:
        map.load(colour, velocity=velocity)
    results = [None, None]

    def work(index):
        results[index] = maps[index].run(20)

    threads = [threading.Thread(target=work, args=(index,)) for index in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert (results[0][0] == results[1][0]).all() and results[0][1] == results[1][1]


def test_the_lock_is_released():
    """While one thread makes frames, another one that needs the interpreter gets on: it is never kept for long."""
    colour = np.zeros((1024, 1024, 3), np.uint8)
    map = Galpixmap((1024, 1024))
    map.load(colour, velocity=np.ones((1024, 1024, 2), np.float32))
    took = []

    def work():
        started = time.perf_counter()
        map.run(40)
        took.append(time.perf_counter() - started)

    thread = threading.Thread(target=work)
    seen = [time.perf_counter()]
    thread.start()
    seen.append(time.perf_counter())
    while thread.is_alive():
        time.sleep(1e-4)
        seen.append(time.perf_counter())
    longest = max(later - earlier for earlier, later in zip(seen, seen[1:]))
    assert longest < took[0] / 2, f"the interpreter was kept for {longest:.2f} of {took[0]:.2f} s"


def test_words_are_a_copy():
    map = Galpixmap((4, 4))
    words = map.words
    words[...] = 0
    assert (map.words != 0).any()
    with pytest.raises(TypeError):
        map.words = words.astype(np.int64)


def test_certificates():
    budget = Budget.derive(1024)
    proof = galpix.certificate(budget)
    assert (proof.quantisation + proof.drift).max() == proof.total_px == 0.84375
    assert proof.keeps_one_pixel and proof.method == "enumerated" and proof.drift.shape == (16,)
    assert [galpix.certificate(budget, name).total_px for name in ("searched", "nearest", "truncate")] == [
        0.59375,
        1.09375,
        1.46875,
    ]
    small, proof = galpix.smallest_budget(0.5, extent=320, acceleration=False)
    assert proof.total_px <= 0.5 and galpix.certificate(small).total_px == proof.total_px
    assert small.bytes_per_galpixel(Layout.VELOCITY565) <= 8
