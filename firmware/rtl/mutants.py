#!/usr/bin/env python3
"""Plant faults in the reference design and see whether the golden vectors notice them.

    mutants.py VECTORS BUILD [--quick]

One line a fault: who noticed it, or why nothing can. --quick plants every third one. Exit code 0: each fault is noticed by
the cases that are named for it, and each that is listed as equivalent by none; 1: not so; 2: a fault could not be planted
or does not compile.
"""

import argparse
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent

# File, what stands there once, what is planted, the kind of cases and the text in their names that notice it, and,
# where nothing can notice it, why.
FAULTS = [
    ("galpix_threshold.sv", "frame[BITS-1-bit_of]", "frame[bit_of]", "step", "low-discrepancy", ""),
    ("galpix_threshold.sv", "{1'b1, {(BITS - 1) {1'b0}}}", "'0", "step", "nearest", ""),
    ("galpix_threshold.sv", "64'hcf3b748847b3fc0", "64'hcf3b748847b3fc1", "step", "searched", ""),
    ("galpix_threshold.sv", "TABLE_6[9'(frame) * 9'd6 +: 6]", "reversed", "step", "searched", ""),
    ("galpix_step.sv", "W'(a) <<< A_UP", "W'(a)", "step", "fine", ""),
    ("galpix_step.sv", "H'($signed({1'b0, threshold}))", "H'($signed(threshold))", "step", "paper", ""),
    ("galpix_step.sv", "{(V - 1) {!w[W-1]}}", "{(V - 1) {w[W-1]}}", "step", "tiny", ""),
    ("galpix_step.sv", "N'($signed(s[S-1:DOWN])) <<< UP", "N'($signed(s[S-1:DOWN]))", "step", "fine", ""),
    ("galpix_step.sv", "r_next <= n[R-1:0] ^ HALF;", "r_next <= n[R-1:0];", "step", "tiny", ""),
    ("galpix_step.sv", "n[R-1:0];\n        r_saturated <= below || above;", "n[R-1:0];\n        r_saturated <= below;",
     "propagate", "paper", ""),
    ("galpix_step.sv", "below ? '0 : above ? '1 : n[R-1:0]", "n[R-1:0]", "propagate", "paper", ""),
    ("galpix_lane.sv", "class_3 == 2'd1 ? 2'd2 : class_3", "class_3", "propagate", "gray4", ""),
    ("galpix_lane.sv", "3'(z_clamped) + 3'(depth_clamped)", "3'(z_clamped)", "propagate", "shaded", ""),
    ("galpix_lane.sv", "before_3 & galpixel::USED & ~CHANGED", "before_3 & ~CHANGED", "propagate", "",
     "words of the vectors have no bits outside of their fields, and no field is written there"),
    ("galpix_channel.sv", "(SUM'(steps) <<< UP)", "SUM'(steps)", "propagate", "bright565", ""),
    ("galpix_channel.sv", "|sum[SUM-2:BITS] ? '1", "1'b0 ? '1", "propagate", "shaded", ""),
    ("galpix_edge.sv", "has[3] ? left : centre", "left", "edge", "random", ""),
    ("galpix_edge.sv", "curvature > limit ||", "curvature >= limit ||", "edge", "any-bend", ""),
    ("galpix_edge.sv", "|threshold[31:LAPLACIAN-1] ? MOST : threshold[LAPLACIAN-1:0]", "threshold[LAPLACIAN-1:0]", "edge",
     "class-alone", ""),
    ("galpix_edge.sv", "&centre[DEPTH+:2] ||", "", "edge", "random", ""),
    ("galpix_window.sv", "one_wide ? beside_right : above_2", "above_2", "frame", "1x9", ""),
    ("galpix_band.sv", "new_2 < old", "new_2 <= old", "frame", "collide", ""),
    ("galpix_band.sv", "same[3] && won[3] ? rank_3 :", "", "resolve", "collide", ""),
    ("galpix_band.sv", "wire wins = arriving[2] && (!taken || new_2 < old);", "wire wins = arriving[2] && !taken;", "resolve",
     "random", ""),
    ("galpix_band.sv", "wire free = valid && out_a_2 != out_b_2;", "wire free = 1'b0;", "frame", "gray4-zoom", ""),
    ("galpix_bullets.sv", "sides == 0 && all_vacant", "sides == 0", "frame", "gray8", ""),
    ("galpix_bullets.sv", "if (&counts_1) {p, q, r, s} <= {a, b, c, d};\n      else if", "if", "fill", "varied", ""),
    ("galpix_bullets.sv", "else if (&counts_1[1:0])", "else if (&counts_1[1:0] && counts_1[3:2] == 0)", "frame", "paper", ""),
    ("galpix_bullets.sv", "final_round ? FRESH : INSIDE", "FRESH", "frame", "velocity565", ""),
    ("galpix_bullets.sv", "(mean & ~CLASS) | DEBRIS", "mean", "fill", "varied", ""),
    ("galpix_mean_field.sv", "+ (BITS + 2)'(2)", "+ (BITS + 2)'(1)", "fill", "varied", ""),
    *(("galpix_mean.sv", f".BITS(galpixel::{name}_BITS), .LSB(galpixel::{name}_LSB), .SIGNED(1)",
       f".BITS(0), .LSB(galpixel::{name}_LSB), .SIGNED(1)", "fill", "shaded-varied", "")
      for name in ("ACCELERATION_X", "ACCELERATION_Y", "ACCELERATION_DEPTH", "VELOCITY_DEPTH", "LUMINOSITY_RATE")),
    ("galpix_mean.sv", "assign mean = (first_2 & ~mask) | averaged;",
     "assign mean = ((first_2 & ~mask) | averaged) & ~(RECORD'(1) << galpixel::LUMINOSITY_LSB);", "fill", "shaded-varied", ""),
    ("galpix_mean.sv", "galpixel::VELOCITY_X_LSB), .SIGNED(1)", "galpixel::VELOCITY_X_LSB), .SIGNED(0)", "fill", "varied", ""),
    ("galpix_holes.sv", "right_depth > left_depth", "right_depth >= left_depth", "frame", "uncover", ""),
    ("galpix_holes.sv", "first_2 ? right_before : nearest_right_2", "nearest_right_2", "frame", "velocity565", ""),
    ("galpix_holes.sv", "fill_mode == 3'd2 ? 2'd2 : 2'd1", "2'd1", "frame", "debris", ""),
    ("galpix_holes.sv", "held = state_of != HOLE && state_of != FRESH;", "held = state_of != HOLE;", "frame", "extend", ""),
    ("galpix_stream.sv", "!y_to[Y_SUM-1] && y_to", "y_to", "frame", "gray8", ""),
    ("galpix_stream.sv", "edge_2 <= edge_1;", "edge_2 <= 1'b0;", "frame", "gray8", ""),
]


def main():
    parser = argparse.ArgumentParser(description="Plant faults in the reference design.")
    parser.add_argument("vectors", type=Path)
    parser.add_argument("build", type=Path)
    parser.add_argument("--quick", action="store_true", help="every third fault")
    options = parser.parse_args()
    faults = FAULTS[::3] if options.quick else FAULTS
    noticed, equivalent, failed = 0, 0, 0
    for name, good, bad, kind, only, why in faults:
        source = options.build / "src"
        shutil.rmtree(options.build, ignore_errors=True)
        shutil.copytree(HERE / "src", source)
        text = (source / name).read_text()
        if text.count(good) != 1:
            print(f"mutants.py: {name} has {good!r} {text.count(good)} times, not once", file=sys.stderr)
            return 2
        (source / name).write_text(text.replace(good, bad))
        done = subprocess.run([sys.executable, str(HERE / "bench.py"), str(options.vectors), str(options.build / "benches"),
                               "--source", str(source), "--kind", kind, "--only", only, "--stop"],
                              capture_output=True, text=True, check=False)
        first = (done.stdout.splitlines() or [""])[0]
        what = f"{name}: {' '.join(good.split())} -> {' '.join(bad.split()) or 'nothing'}"
        if done.returncode not in (0, 1):
            print(f"mutants.py: {what}: {done.stderr[-400:]}", file=sys.stderr)
            return 2
        if done.returncode == 1 and not why:
            noticed += 1
            print(f"noticed    {what} (by {first.split(':')[0]})", flush=True)
        elif done.returncode == 0 and why:
            equivalent += 1
            print(f"equivalent {what}: {why}", flush=True)
        else:
            failed += 1
            print(f"FAILED     {what}: {'noticed by ' + first if why else 'noticed by nothing'}", flush=True)
    print(f"{noticed} faults noticed, {equivalent} equivalent, {failed} wrong")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
