"""Sweeps 3 scenes under 40 budgets by one worker process and by two, in turns, and prints the ratio of their times.

The first ratio is of the time that passed, which whatever else runs on the machine changes; the second of the processor
time of the busiest worker, which it hardly does.

python sweep_workers.py [ROUNDS]
"""

import statistics
import sys
import tempfile
import time

from distributed import Client, LocalCluster

import galpix
from galpix.sweeps import equal_but_for_times, grid, read

SCENES = ["ball", "crossing", "pillars"]
BUDGETS = grid(
    frames=[4],
    perceptual=[False],
    recog=[4, 8],
    prop=[8, 16, 32, 64, 128],
    rounding=["nearest", "low-discrepancy"],
    fields=["velocity", "full"],
)


def sweep(workers: int, folder: str) -> tuple[float, float]:
    """Return the seconds of a sweep, and those of the processor time of the busiest worker. Starting the workers does
    not count."""
    # One thread each, so that workers and not threads share the processors.
    environment = {"RAYON_NUM_THREADS": "1"}
    with (
        LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None, env=environment) as cluster,
        Client(cluster) as client,
    ):
        client.run(galpix.open, "drift")
        before, started = client.run(time.process_time), time.perf_counter()
        galpix.sweep(SCENES, BUDGETS, folder, client=client)
        took, after = time.perf_counter() - started, client.run(time.process_time)
        return took, max(after[worker] - before[worker] for worker in after)


def main() -> None:
    """Print the ratio."""
    passed, busiest = [], []
    for _ in range(int(sys.argv[1]) if len(sys.argv) > 1 else 3):
        with tempfile.TemporaryDirectory() as one, tempfile.TemporaryDirectory() as two:
            alone, together = sweep(1, one), sweep(2, two)
            assert equal_but_for_times(read(one), read(two))
            passed.append(together[0] / alone[0])
            busiest.append(together[1] / alone[1])
    for what, ratios in (("time", passed), ("processor time of the busiest worker", busiest)):
        middle, low, high = statistics.median(ratios), min(ratios), max(ratios)
        print(f"two workers, {what}: {middle:.2f} of one's ({low:.2f} to {high:.2f})")


if __name__ == "__main__":
    main()
