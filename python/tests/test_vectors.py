"""The golden vectors, run from Python: every word must be the one that is written down."""

import hashlib
import json

import numpy as np
import pytest

import galpix
from galpix import Budget, Component, Galpixmap, Layout

KINDS = ("frame", "inpaint", "edge", "disocclusion", "subcell")


def cases(vectors, kind):
    manifest = json.loads((vectors / "manifest.json").read_text())
    for entry in manifest["cases"]:
        if entry["kind"] == kind:
            yield json.loads((vectors / entry["name"] / "case.json").read_text())


def galpixmap(case, **options):
    given = dict(case["budget"])
    names = Component._fields
    x, y, z = (Component(*(widths[name] for name in names)) for widths in given.pop("components"))
    grid = case["grid"]
    margin = tuple(grid[side] for side in ("left", "right", "top", "bottom"))
    shape = (grid["height"], grid["width"])
    map = Galpixmap(shape, Budget(x, y, z, **given), Layout(**case["layout"]), margin=margin, **options)
    if "front" in case:
        map.words = words(case["front"], map)
    return map


def words(flat, map):
    return np.array(flat, np.uint32).reshape(-1, *map.cells)


def sha256(words):
    return hashlib.sha256(words.astype("<u4").tobytes()).hexdigest()


def test_what_is_written_is_what_the_project_keeps(vectors, hashes):
    written = dict(line.split(maxsplit=1)[::-1] for line in (vectors / "hashes.txt").read_text().splitlines())
    assert written == hashes
    assert len(written) > 500


@pytest.mark.parametrize("constant_time", [False, True])
def test_frames(vectors, constant_time):
    made = 0
    for case in cases(vectors, "frame"):
        map = galpixmap(
            case,
            fill=case["rung"],
            rounding=case["rounding"],
            reach=case["reach"],
            edge_threshold=case["threshold"],
            constant_time=constant_time,
        )
        map.frame = case["frame"]
        for number, frame in enumerate(case["frames"]):
            tally = map.step()
            assert sha256(map.words) == frame["sha256"], (case["name"], number)
            assert tally._asdict() == frame["counts"], (case["name"], number)
            made += 1
    assert made > 100


def test_inpainting(vectors):
    made = 0
    for case in cases(vectors, "inpaint"):
        map = galpixmap(
            case, fill="extend", rounding=case["rounding"], reach=case["reach"], edge_threshold=case["threshold"]
        )
        if not case["edges"]:
            continue  # Made without an edge map, which a map of this package always has.
        map.frame = case["frame"]
        map.step()
        assert (map.words == words(case["after"], map)).all(), case["name"]
        assert map.edges.tolist() == case["edges"], case["name"]
        map.inpaint(
            gamma=case["gamma"],
            threshold=case["inpaint_threshold"],
            background=case["background"],
            motion=case["motion"],
            mask=np.array(case["mask"], np.uint32) if case["mask"] else None,
        )
        assert (map.words == words(case["map"], map)).all(), case["name"]
        made += 1
    assert made > 30


def test_edges(vectors):
    made = 0
    for case in cases(vectors, "edge"):
        map = galpixmap(case, fill="bullet", edge_threshold=case["threshold"])
        assert map.step().edges == case["counts"]["edges"], case["name"]
        assert map.edges.tolist() == case["edges"], case["name"]
        made += 1
    assert made > 10


def test_disocclusion(vectors):
    made = 0
    for case in cases(vectors, "disocclusion"):
        map = galpixmap(case)
        found = map.disocclusion(
            case["frames"],
            separation=case["separation"],
            continues=case["border"] == "continues",
            tears=case["tears"],
            through=case["through"],
        )
        extents = np.ascontiguousarray(found.extents).reshape(-1, 4).astype(np.uint32)
        assert (extents << np.array([0, 8, 16, 24], np.uint32)).sum(axis=1).tolist() == case["spread"], case["name"]
        assert [found.edges, found.saturated, found.covered] == list(case["counts"].values()), case["name"]
        assert found.needed.sum() == found.covered, case["name"]
        made += 1
    assert made > 10


def eight_bits(words, colour):
    """The code values of colour words, 8 bits a channel, by the rule of the specification."""
    channels = {"rgb888": (8, 8, 8), "rgb565": (5, 6, 5), "gray8": (8,), "gray4": (4,)}[colour]
    planes = []
    for bits in reversed(channels):
        level = words & ((1 << bits) - 1)
        words = words >> bits
        wide = level << (8 - bits)
        filled = wide | wide >> bits
        planes.append(filled)
    planes = planes[::-1] if len(planes) == 3 else planes * 3
    return np.stack(planes, axis=-1).astype(np.uint8)


def test_sub_cell_scan_out(vectors):
    made = 0
    for case in cases(vectors, "subcell"):
        map = galpixmap(case, scan_out="sub-cell", edge_threshold=case["threshold"])
        shown = np.array(case["shown"], np.uint32).reshape(map.shape)
        assert (map.picture() == eight_bits(shown, case["layout"]["colour"])).all(), case["name"]
        made += 1
    assert made > 20


def test_a_wrong_bit_is_noticed(vectors):
    for case in cases(vectors, "frame"):
        if case["rung"] == "hold" and case["layout"]["velocity"]:
            break
    map = galpixmap(case, fill=case["rung"], rounding=case["rounding"], edge_threshold=case["threshold"])
    map.frame = case["frame"]
    map.words ^= np.uint32(1)
    map.step()
    assert sha256(map.words) != case["frames"][0]["sha256"]


def test_another_seed_gives_other_vectors(tmp_path, vectors):
    galpix.write_vectors(tmp_path, seed=1)
    assert (tmp_path / "hashes.txt").read_text() != (vectors / "hashes.txt").read_text()
