"""The speed script runs, and what it measures is what it says."""

import numpy as np
import pytest

from galpix import speed


def test_the_table_beside_cv2(capsys):
    pytest.importorskip("cv2", reason="cv2 is not installed: inpainting is not timed beside it")
    assert speed.main(["--sizes", "96", "--rounds", "1"]) == 0
    out = capsys.readouterr().out
    rows = [line.split("|") for line in out.splitlines() if line.startswith("| 96 |")]
    assert [row[2].split(",")[0].strip() for row in rows] == ["strips", "strips", "warp", "warp"]
    for row in rows:
        assert float(row[3]) > 0 and all(float(cell) > 5 for cell in row[6:9])


def test_a_call_adds_microseconds():
    """Far below 2 % of a frame of 512 x 512 galpixels; the bound is loose, for machines that do other things."""
    assert speed.per_call(200) < 0.02 * speed.frame(512, 4)


def test_holes_have_their_share():
    for _, picture, mask in speed.cases(128):
        assert picture.shape == (128, 128, 3) and picture.flags.c_contiguous
        assert 0.015 < np.count_nonzero(mask) / mask.size < 0.1
