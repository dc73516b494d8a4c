"""Scenes and captures."""

import pickle

import numpy as np
import pytest

import galpix
from conftest import PROJECT


def test_a_scene_is_run_and_compared():
    source = galpix.open("ball")
    made = source.run(frames=4)
    report = source.report(frames=4, perceptual=False)
    for number, frame in enumerate(report["frames"]):
        truth = source.truth(number + 1).picture
        assert galpix.psnr(made.frames[number], truth) == pytest.approx(frame["truth"]["psnr_db"], abs=1e-9)
        assert made.reached[number].sum() + frame["truth"]["missing"] == made.reached[number].size
    assert source.truth_frames(3) == [1, 2, 3]


def test_arrays_of_an_update_give_the_same_frames():
    source = galpix.open("crossing")
    update = source.update()
    for options in ({}, {"scheme": "map", "fill": "extend"}, {"scheme": "map", "fill": "metamer"}):
        made = galpix.extrapolate(
            update.colour,
            update.velocity,
            depth=update.depth,
            acceleration=update.acceleration,
            known=update.known,
            luminosity_rate=update.luminosity_rate,
            margin=update.margin,
            depth_kind=update.depth_kind,
            frames=source.frames,
            **options,
        )
        expected = source.run(fields="full", **options)
        assert (made.frames == expected.frames).all(), options
        assert made.tallies == expected.tallies


def test_the_map_makes_the_frames_of_a_run():
    source = galpix.open("crossing")
    update = source.update()
    expected = source.run(scheme="map", fill="extend", fields="full", frames=6)
    left, right, top, bottom = update.margin
    rows, columns = update.depth.shape
    budget = galpix.Budget.derive(256, 8, 16)
    map = galpix.Galpixmap((rows - top - bottom, columns - left - right), budget, margin=update.margin)
    map.load(
        update.colour,
        depth=update.depth,
        velocity=update.velocity,
        acceleration=update.acceleration,
        known=update.known,
    )
    frames, tallies = map.run(6)
    assert (frames == expected.frames).all() and tallies == expected.tallies


def test_a_capture_of_the_project():
    capture = galpix.open(PROJECT / "captures/marbles")
    assert capture.name == "marbles" and capture.update().known.mean() > 0.9
    frame = capture.truth_frames()[0]
    assert capture.truth(frame).picture.dtype == np.uint8
    assert capture.truth(10**6) is None
    report = capture.report(frames=frame, perceptual=False)
    assert report["source"] == "marbles" and len(report["frames"]) == frame


def test_sources_travel_between_processes():
    source = pickle.loads(pickle.dumps(galpix.open("drift", acceleration="off")))
    assert source.name == "drift"


def test_all_scenes_open():
    assert len(galpix.scenes()) >= 10
    for name, about in galpix.scenes().items():
        assert galpix.open(name).name == name and about
