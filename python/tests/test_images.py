"""Fills of plain images, metrics, and the occlusion camera."""

import numpy as np
import pytest

import galpix


def texture(rows=48, columns=64):
    y, x = np.mgrid[:rows, :columns]
    return (
        np.stack([128 + 100 * np.sin(x / 5), 128 + 100 * np.cos(y / 7), x + y], axis=-1).clip(0, 255).astype(np.uint8)
    )


def holes(shape, share=0.04, seed=1):
    rng = np.random.default_rng(seed)
    mask = np.zeros(shape, bool)
    while mask.mean() < share:
        y, x = rng.integers(0, shape[0]), rng.integers(0, shape[1])
        mask[y : y + 4, x : x + 5] = True
    return mask


@pytest.mark.parametrize("method", galpix.INPAINTING)
def test_inpainting_leaves_what_is_known_and_comes_near_to_what_is_not(method):
    truth = texture()
    mask = holes(truth.shape[:2])
    given = truth.copy()
    given[mask] = 0
    before = given.copy()
    filled = galpix.inpaint(given, mask, method=method)
    assert (given == before).all() and (filled[~mask] == truth[~mask]).all()
    assert galpix.psnr(filled, truth, mask) > galpix.psnr(given, truth, mask) + 12
    # What is in the holes does not matter.
    given[mask] = 255
    assert (galpix.inpaint(given, mask, method=method) == filled).all()


def test_inpainting_takes_what_cv2_takes():
    truth = texture()
    mask = holes(truth.shape[:2])
    filled = galpix.inpaint(truth, mask)
    assert (galpix.inpaint(truth, mask.astype(np.uint8) * 255, 3, 1) == filled).all()
    assert (galpix.inpaint(truth, mask[..., None]) == filled).all()
    assert (galpix.inpaint(truth[..., ::-1], mask)[..., ::-1] == filled).all()
    in_place = truth.copy()
    assert galpix.inpaint(in_place, mask, dst=in_place) is in_place
    assert (in_place == filled).all()
    for channel in range(3):
        grey = galpix.inpaint(truth[..., channel], mask)
        assert grey.shape == mask.shape and (grey == filled[..., channel]).all()
    assert galpix.inpaint(truth[..., :1], mask).shape == (*mask.shape, 1)


def test_metamers_have_a_seed_and_an_order_of_channels():
    truth = texture()
    mask = holes(truth.shape[:2])
    made = [galpix.inpaint(truth, mask, method="metamer", seed=seed) for seed in (0, 0, 1)]
    assert (made[0] == made[1]).all() and (made[0] != made[2]).any()
    turned = galpix.inpaint(truth[..., ::-1], mask, method="metamer", bgr=True)[..., ::-1]
    assert (turned == made[0]).all()


def test_depth_keeps_the_foreground_out():
    image = np.zeros((16, 32, 3), np.uint8)
    image[:, 16:] = 255
    mask = np.zeros((16, 32), bool)
    mask[:, 12:16] = True
    depth = np.where(np.arange(32) < 16, 0.9, 0.1) * np.ones((16, 1))
    assert galpix.inpaint(image, mask, depth=depth)[mask].max() == 0
    assert galpix.inpaint(image, mask)[mask].max() > 0


@pytest.mark.parametrize("method", galpix.FILL_MODES)
def test_fill_modes_of_an_image(method):
    image = texture()
    mask = holes(image.shape[:2])
    motion = np.ones((*mask.shape, 2), np.float32)
    filled = galpix.fill(image, mask, method, motion=motion)
    assert (filled.image[~mask] == image[~mask]).all()
    assert filled.tally.holes == mask.sum()
    if method == "none":
        assert filled.image[mask].max() == 0
    if method in ("hold", "debris"):
        assert (filled.image[mask] == image[mask]).all()
    if method == "debris":
        assert (filled.motion[mask] == 0).all()
    if method == "extend":
        assert (filled.motion == 1).all() and filled.tally.empty == 0
    assert (motion == 1).all()


def test_fill_mode_extend_continues_the_farther_surface():
    image = np.zeros((4, 12, 3), np.uint8)
    image[:, 8:] = 255
    mask = np.zeros((4, 12), bool)
    mask[:, 5:8] = True
    depth = np.where(np.arange(12) < 8, 0.9, 0.1) * np.ones((4, 1))
    assert galpix.fill(image, mask, "extend", depth=depth).image[mask].max() == 0


def test_metrics_agree_with_their_formulas():
    rng = np.random.default_rng(5)
    one, other = rng.integers(0, 256, (2, 32, 40, 3), np.uint8)
    mask = rng.random((32, 40)) < 0.5
    error = ((one.astype(float) - other) ** 2)[mask].mean()
    assert galpix.psnr(one, other, mask) == pytest.approx(10 * np.log10(255**2 / error), abs=1e-9)
    assert galpix.flip(one, one) == 0 and 0 < galpix.flip(one, other, mask) < 1
    assert galpix.ssim(one, one) == pytest.approx(1) and galpix.ssim(one, other) < 0.3
    assert galpix.ssimulacra2(one, one) == pytest.approx(100, abs=1e-3)


def test_the_occlusion_camera_looks_around_both_sides():
    depth = np.full((40, 40), 0.9)
    depth[12:28, 12:28] = 0.1
    found = galpix.ddoc(depth, radius=4)
    assert found.displacement.shape == (40, 40, 2) and found.distorted > 100
    assert found.displacement[20, 26, 0] > 0 > found.displacement[20, 13, 0]
    assert (galpix.ddoc(np.ones((8, 8), np.float32)).displacement == 0).all()
