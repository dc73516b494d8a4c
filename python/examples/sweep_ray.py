"""A sweep on Ray: the same task as everywhere. `pip install ray 'galpix[sweep]'`; captures and folder as all nodes see
them."""

import ray

from galpix.sweeps import grid, read, task

CAPTURES = ["ball", "crossing"]
BUDGETS = grid(frames=[8], recog=[4, 8], rounding=["nearest", "low-discrepancy"])

ray.init()
# A task whose node is lost is done again by another one, and finds what is there.
remote = ray.remote(max_retries=3)(task)
ray.get([remote.remote(capture, budget, "sweep") for capture in CAPTURES for budget in BUDGETS])
print(read("sweep").num_rows, "rows")
