#!/usr/bin/env python3
"""Prove the step and the resolution of the reference design equal to the specification's formulas, with yosys.

    proof.py [--quick]

The step: all inputs, from any state, for components that have each form of the arithmetic. Resolution: all sequences of
four sources in a map of four cells, with its readout. Then a fault is planted at each of the places below, and the proof
must refuse it. One line each. --quick leaves out the resolution, which takes minutes. Exit code 0: all proved and all
faults refused; 1: not so.
"""

import argparse
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
# name, P, VI, VF, AI, AF, DEPTH, STORED, CELLS: what the layouts of docs/vectors.md have, and the ends of the formula.
COMPONENTS = [
    ("paper, x and y", 4, 10, 7, 8, 7, 0, 4, 12),
    ("paper, depth", 10, 10, 7, 8, 7, 1, 20, 1),
    ("velocity565", 4, 7, 4, 0, 0, 0, 4, 9),
    ("position finer than the step", 7, 6, 4, 4, 2, 0, 7, 8),
    ("acceleration coarser than the velocity", 3, 6, 5, 4, 3, 0, 3, 8),
    ("position without a fraction", 0, 5, 3, 3, 3, 0, 0, 7),
    ("position as fine as the step", 4, 5, 3, 3, 3, 0, 4, 7),
    ("widest", 16, 14, 16, 14, 16, 0, 16, 16),
]
NAMES = ("P", "VI", "VF", "AI", "AF", "DEPTH", "STORED", "CELLS")
# file, as it is, as it is planted.
STEP_FAULTS = [
    ("galpix_step.sv", "w <= W'(v) + raised;", "w <= W'(v) - raised;"),
    ("galpix_step.sv", "{(V - 1) {!w[W-1]}}", "{(V - 1) {w[W-1]}}"),
    ("galpix_step.sv", "assign n = N'($signed({1'b0, r_2 ^ HALF})) + delta;",
     "assign n = N'($signed(r_2)) + delta;"),
    ("galpix_step.sv", "s <= S'(w) + S'(h);", "s <= S'(w) + S'(h) + S'(&w[3:0] & !h[0]);"),
]
BAND_FAULTS = [
    ("galpix_band.sv", "new_2 < old", "new_2 <= old"),
    ("galpix_band.sv", "same[5] && won[5] ? rank_5 : rank_2", "rank_2"),
    ("galpix_band.sv", "wire new_a = !wiping && !bit_b_3;", "wire new_a = !wiping && bit_b_3;"),
]
SMALL = """package galpixel;
  localparam int WORDS = 1, RECORD = 3, CLASS_BITS = 2, CLASS_LSB = 1, DEPTH_BITS = 1, DEPTH_LSB = 0;
endpackage
"""


def yosys(script, folder):
    """Whether yosys proves what the script asks; anything but a refused proof is an error."""
    done = subprocess.run(["yosys", "-p", script], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode == 0 and "SAT proof finished - no model found: SUCCESS!" in done.stdout:
        return True
    if "proof did fail" in done.stdout + done.stderr:
        return False
    raise RuntimeError((done.stdout + done.stderr)[-800:])


def step(folder, component):
    """The proof of a component's step."""
    values = " ".join(f"-set {name} {value}" for name, value in zip(NAMES, component[1:]))
    return yosys("read_verilog -sv -formal galpix_step.sv step_proof.sv; " + f"chparam {values} step_proof; "
                 "prep -flatten -top step_proof; opt -full; "
                 "sat -verify -prove-asserts -seq 4 -prove-skip 3 step_proof", folder)


def band(folder):
    """The proof of resolution: 6 clocks to empty the band, 4 sources, 5 until they are written, 7 to read out."""
    return yosys("read_verilog -sv -formal small.sv galpix_ram.sv galpix_band.sv band_proof.sv; "
                 "prep -flatten -top band_proof; memory_map; opt -full; "
                 "sat -verify -prove-asserts -seq 22 -set-at 1 reset 1 -set-at 2 reset 0 band_proof", folder)


def planted(folder, fault):
    """Plants a fault; returns how to take it out again."""
    name, good, bad = fault
    text = (folder / name).read_text()
    if text.count(good) != 1:
        raise RuntimeError(f"{name} no longer has {good!r} once")
    (folder / name).write_text(text.replace(good, bad))
    return lambda: (folder / name).write_text(text)


def main():
    parser = argparse.ArgumentParser(description="Prove the reference design's step and resolution.")
    parser.add_argument("--quick", action="store_true", help="the step alone")
    options = parser.parse_args()
    failed = 0

    def report(what, good, started):
        nonlocal failed
        failed += not good
        print(f"{'ok    ' if good else 'FAILED'} {what} ({time.monotonic() - started:.1f} s)", flush=True)

    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for path in [*(HERE / "src").glob("*.sv"), *(HERE / "proof").glob("*.sv")]:
            (folder / path.name).write_text(path.read_text())
        (folder / "small.sv").write_text(SMALL)
        for component in COMPONENTS:
            started = time.monotonic()
            report(f"step is the formula: {component[0]}", step(folder, component), started)
        for fault in STEP_FAULTS:
            started, undo = time.monotonic(), planted(folder, fault)
            report(f"refused: {fault[2]}", not step(folder, COMPONENTS[0]), started)
            undo()
        if not options.quick:
            started = time.monotonic()
            report("resolution is the smallest by class, depth, source", band(folder), started)
            for fault in BAND_FAULTS:
                started, undo = time.monotonic(), planted(folder, fault)
                report(f"refused: {fault[2]}", not band(folder), started)
                undo()
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
