"""What is wrong gets one sentence: what, where, and how to mend it."""

import re

import numpy as np
import pytest

import galpix
from galpix import Budget, Galpixmap, Layout

IMAGE = np.zeros((4, 6, 3), np.uint8)
MASK = np.zeros((4, 6), bool)
MAP = Galpixmap((4, 6))


def load(**arrays):
    MAP.load(**{"colour": IMAGE, **arrays})


@pytest.mark.parametrize(
    ("call", "error", "sentence"),
    [
        (lambda: galpix.inpaint(IMAGE.tolist(), MASK), TypeError, "`image` is of type list: give a numpy array"),
        (lambda: galpix.inpaint(IMAGE.astype(float), MASK), TypeError, "`image` is of dtype float64: give uint8"),
        (
            lambda: galpix.inpaint(IMAGE[..., :2], MASK),
            ValueError,
            "`image` has shape (4, 6, 2): give (rows, columns)",
        ),
        (lambda: galpix.inpaint(IMAGE[:0], MASK[:0]), ValueError, "`image` has shape (0, 6, 3)"),
        (
            lambda: galpix.inpaint(IMAGE, MASK[:3]),
            ValueError,
            "`mask` has shape (3, 6) where the picture needs (4, 6)",
        ),
        (lambda: galpix.inpaint(IMAGE, MASK.astype(int)), TypeError, "`mask` is of dtype int64: give bool or uint8"),
        (
            lambda: galpix.inpaint(IMAGE, MASK, method="telea"),
            ValueError,
            "`method` is 'telea': give one of push-pull",
        ),
        (lambda: galpix.inpaint(IMAGE, MASK, gamma="2"), ValueError, "`gamma` is '2': give one of 0, 1/2, 1"),
        (lambda: galpix.inpaint(IMAGE, MASK, dst=IMAGE[:2]), ValueError, "`dst` has shape (2, 6, 3)"),
        (
            lambda: galpix.inpaint(IMAGE, MASK, dst=np.zeros((4, 12, 3), np.uint8)[:, ::2]),
            ValueError,
            "`dst` cannot be",
        ),
        (lambda: galpix.inpaint(IMAGE, MASK, depth=MASK), TypeError, "`depth` is of dtype bool: give float32"),
        (lambda: galpix.fill(IMAGE, MASK, "best"), ValueError, "`method` is 'best': give one of none, hold"),
        (lambda: galpix.fill(IMAGE[..., 0], MASK), ValueError, "`image` has shape (4, 6): give (rows, columns, 3)"),
        (lambda: galpix.fill(IMAGE, MASK, motion=np.zeros((4, 6))), ValueError, "`motion` has shape (4, 6): give"),
        (lambda: galpix.fill(IMAGE, MASK, motion=np.zeros((4, 6, 3))), ValueError, "`motion` has three components"),
        (lambda: galpix.fill(IMAGE, MASK, reach=-1), ValueError, "`reach` is -1: give 0 to"),
        (lambda: load(colour=IMAGE[:2]), ValueError, "`colour` has (2, 6) pixels where the map has (4, 6)"),
        (lambda: load(velocity=np.zeros((4, 6, 4))), ValueError, "`velocity` has shape (4, 6, 4): give (4, 6, 2)"),
        (lambda: load(depth=np.zeros((6, 4))), ValueError, "`depth` has shape (6, 4) where the picture needs (4, 6)"),
        (lambda: load(tag=np.zeros((4, 6))), TypeError, "`tag` is of dtype float64: give integers"),
        (lambda: load(offset=np.zeros((4, 6))), ValueError, "`offset` has shape (4, 6)"),
        (lambda: MAP.run(0), ValueError, "`frames` is 0: give 1 to"),
        (lambda: MAP.run(1.5), TypeError, "`frames` is of type float: give a whole number"),
        (lambda: MAP.run(1, np.zeros((4, 6, 3), np.uint8)), ValueError, "`out` has shape (4, 6, 3) where the result"),
        (lambda: MAP.run(1, np.zeros((1, 4, 6, 3))), TypeError, "`out` is of dtype float64: give uint8"),
        (lambda: MAP.inpaint(mask=MASK), TypeError, "`mask` is no row of uint32"),
        (lambda: Galpixmap((0, 4)), ValueError, "`shape` is 0: give 1 to 32768"),
        (lambda: Galpixmap((4, 4), fill="x"), ValueError, "`fill` is 'x': give one of none, hold, debris"),
        (lambda: Galpixmap((4, 4), fill="hold", gamma="1"), ValueError, "`gamma` is for push-pull and metamer"),
        (lambda: Galpixmap((4, 4), rounding="x"), ValueError, "`rounding` is 'x': give one of truncate, nearest"),
        (lambda: Galpixmap((4, 4), layout=Layout(acceleration=True)), ValueError, "acceleration needs velocity"),
        (lambda: Budget.derive(1024, prop=1), ValueError, "prop = 1 extrapolates nothing"),
        (lambda: Budget.derive("large"), TypeError, "`extent` is of type str: give a whole number"),
        (lambda: galpix.smallest_budget(1e-9, extent=64), ValueError, "no budget certifies"),
        (lambda: galpix.smallest_budget(-1, extent=64), ValueError, "`max_error` is -1: give a positive number"),
        (
            lambda: galpix.psnr(IMAGE, IMAGE[:2]),
            ValueError,
            "`shown` has shape (4, 6, 3) where the truth needs (2, 6",
        ),
        (lambda: galpix.psnr(IMAGE, IMAGE, MASK), ValueError, "no pixel counts"),
        (lambda: galpix.ssimulacra2(IMAGE, IMAGE), ValueError, "sides of at least 8 pixels"),
        (lambda: galpix.open("bal"), ValueError, "is neither a built-in scene nor a capture"),
        (lambda: galpix.open("ball").run(fill="bullet"), ValueError, "stationary sources do not have"),
        (lambda: galpix.open("ball").run(speed=1), TypeError, "`speed` is no option of an extrapolation"),
        (lambda: galpix.open("ball").run(fields="all"), ValueError, "`fields` is 'all': give one of still"),
        (lambda: galpix.ddoc(IMAGE), ValueError, "`depth` has shape (4, 6, 3): give (rows, columns)"),
        (lambda: galpix.ddoc(np.zeros((4, 6)), radius=0), ValueError, "`radius` is 0: give 1 to 255"),
    ],
)
def test_sentences(call, error, sentence):
    with pytest.raises(error, match=re.escape(sentence)) as raised:
        call()
    text = str(raised.value)
    assert "\n" not in text and "Traceback" not in text
