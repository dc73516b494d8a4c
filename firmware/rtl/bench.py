#!/usr/bin/env python3
"""Run golden vectors through the reference design under Icarus Verilog.

    bench.py VECTORS BUILD [--kind KIND]... [--only TEXT] [--rotate] [--stall] [--netlist] [--jobs N] [--source DIR]

VECTORS is a folder of `galpix vectors`, BUILD one for what is compiled. One line a kind, and one for each case that
differs. Exit code 0: all agree; 1: some differ; 2: the folder or the tools cannot be used.

--rotate   frame cases in the smallest band of rows that their motion allows, so that it turns
--stall    the display stops at random
--netlist  what yosys reads in the sources, in their place: for the kinds propagate and frame
--source   another folder of sources, for mutants
--stop     end at the first case that differs
"""

import argparse
import hashlib
import json
import re
import subprocess
import sys
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

HERE = Path(__file__).resolve().parent
KINDS = ("step", "propagate", "resolve", "edge", "fill", "frame")
MANY_ROUNDS = 16


def bits(number):
    """The bits that count `number` things from 0."""
    return max(1, (number - 1).bit_length())


class Case:
    """A case of the vectors: its record's parameters as text, and its own as numbers."""

    def __init__(self, folder, name, kind):
        self.name, self.kind, self.folder = name, kind, folder / name
        text = (self.folder / "params.svh").read_text()
        self.record, own = text.split("\n\n", 1)
        self.own = {key: int(value) for key, value in re.findall(r"(\w+) = 32'd(\d+);", own)}
        self.of_record = {key: int(value) for key, value in re.findall(r"int (\w+) = (\d+);", self.record)}
        grid = [self.own.get(key, 0) for key in ("LEFT", "WIDTH", "RIGHT", "TOP", "HEIGHT", "BOTTOM")]
        self.columns, self.rows = sum(grid[:3]), sum(grid[3:])

    def rounds(self):
        """Rounds of bullets, section 10."""
        return min(max(self.own["REACH"], 1), MANY_ROUNDS) if self.own["FILL_MODE"] >= 3 else 1

    def rows_moved(self):
        """The most rows by which an arrival of the case moves: from the stages of its frames."""
        most = 0
        for n in range(1, self.own["FRAMES"] + 1):
            words = [[int(line, 16) for line in (self.folder / f"{array}_{n}.hex").read_text().splitlines()[1:]]
                     for array in ("source", "cell")]
            for source, cell in zip(*words):
                if cell != 0xFFFFFFFF:
                    most = max(most, abs(cell // self.columns - source // self.columns))
        return most


def configuration(case, rotate):
    """The parameters of the bench that a case needs, and its arguments."""
    own, size = case.own, {"COLUMN": bits(case.columns), "ROW": bits(case.rows)}
    arguments = {"folder": case.folder, "columns": case.columns, "rows": case.rows}
    if case.kind == "step":
        widths = {key: case.of_record[key] for key in ("P", "VI", "VF", "AI", "AF")}
        return widths, {"folder": case.folder, "steps": own["STEPS"], "rounding": own["ROUNDING"]}
    if case.kind == "propagate":
        return {}, {"folder": case.folder, "galpixels": own["GALPIXELS"], "rounding": own["ROUNDING"]}
    # Few builds: all cases but the wide one have the same bits of a column and of a row.
    size = {"COLUMN": max(7, size["COLUMN"]), "ROW": max(4, size["ROW"])}
    if case.kind == "resolve":
        return size, {**arguments, "arrivals": own["ARRIVALS"]}
    if case.kind == "edge":
        return size, {**arguments, "threshold": own["THRESHOLD"]}
    rounds = case.rounds()
    size["ROUNDS"] = 1 if rounds == 1 else 3 if rounds <= 3 else MANY_ROUNDS
    arguments.update(rounds=rounds, fill_mode=own["FILL_MODE"])
    if case.kind == "fill":
        return size, arguments
    reach = min(case.of_record["Y_REACH"], case.rows)
    size.update(BAND=size["ROW"], FRONT=size["ROW"])
    if rotate:
        reach = case.rows_moved()
        size.update(BAND=bits(2 * reach + 3), FRONT=bits(reach + size["ROUNDS"] + 6))
        if min(size["BAND"], size["FRONT"]) >= size["ROW"]:
            return None, None
        size.update(BAND=min(size["BAND"], size["ROW"]), FRONT=min(size["FRONT"], size["ROW"]))
    arguments.update(rounding=own["ROUNDING"], threshold=own["THRESHOLD"], frame=own["FRAME"], frames=own["FRAMES"],
                     reach=reach)
    return size, arguments


class Builds:
    """Benches by their parameters, each compiled once."""

    def __init__(self, folder, source, netlist):
        self.folder, self.source, self.netlist, self.made = folder, source, netlist, {}

    def read_by_yosys(self, kind, place, parameters):
        """Writes the netlist of what the bench looks at."""
        top = {"propagate": "galpix_lane", "frame": "galpix_frame"}[kind]
        values = " ".join(f"-set {name} {value}" for name, value in parameters.items())
        sources = " ".join(map(str, [place / "galpixel.sv", *sorted(self.source.glob("*.sv"))]))
        # The thresholds of a lane stand in the bench.
        own = f"read_verilog -sv {sources}; " + (f"chparam {values} {top}; " if values else "")
        done = subprocess.run(["yosys", "-q", "-p", own + f"hierarchy -top {top}; proc; opt; memory -nomap; "
                               f"write_verilog -noattr {place / 'netlist.v'}"], capture_output=True, text=True, check=False)
        if done.returncode:
            raise RuntimeError(f"yosys reads {top} not: {done.stderr[-400:]}")
        return [place / "netlist.v", *([self.source / "galpix_threshold.sv"] if kind == "propagate" else [])]

    def compile(self, kind, record, parameters):
        """Starts nothing: returns the file, compiled if it is not there."""
        key = hashlib.sha256(repr((kind, record if kind != "step" else "", sorted(parameters.items()))).encode())
        place = self.folder / f"{kind}-{'netlist-' if self.netlist else ''}{key.hexdigest()[:12]}"
        image = place / "bench.vvp"
        if key.hexdigest() in self.made:
            return image
        place.mkdir(parents=True, exist_ok=True)
        top = "edges" if kind == "edge" else kind      # a word of the language
        sources = sorted(self.source.glob("*.sv"))
        if kind == "step":
            sources = [self.source / "galpix_threshold.sv", self.source / "galpix_step.sv"]
        else:
            (place / "galpixel.sv").write_text(f"package galpixel;\n{record}\nendpackage\n")
            if self.netlist:
                sources = self.read_by_yosys(kind, place, parameters)
            sources.insert(0, place / "galpixel.sv")
        command = ["iverilog", "-g2012", *(["-DNETLIST"] if self.netlist else []), "-o", str(image), "-s", top,
                   *(f"-P{top}.{name}={value}" for name, value in parameters.items()),
                   *map(str, sources), str(HERE / "bench" / f"{top}.sv")]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        said = [line for line in (done.stdout + done.stderr).splitlines() if "sorry: constant selects" not in line]
        if done.returncode or said:
            raise RuntimeError(f"{kind} does not compile: " + "\n".join(said[:8]))
        self.made[key.hexdigest()] = image
        return image


def run(image, arguments, stall):
    """Runs a case; returns the numbers that agree, those that differ and what was said of these."""
    plus = [f"+{key}={value}" for key, value in arguments.items()] + (["+stall"] if stall else [])
    try:
        done = subprocess.run(["vvp", "-n", str(image), *plus], capture_output=True, text=True, timeout=600, check=False)
    except subprocess.TimeoutExpired:
        return 0, 1, ["it does not end"]
    said = (done.stdout + done.stderr).splitlines()
    result = [line.split() for line in said if line.startswith("RESULT")]
    if done.returncode or len(result) != 1:
        return 0, 1, said[-4:] or ["it says nothing"]
    return int(result[0][1]), int(result[0][2]), [line for line in said if not line.startswith("RESULT")]


def main():
    parser = argparse.ArgumentParser(description="Run golden vectors through the reference design.")
    parser.add_argument("vectors", type=Path)
    parser.add_argument("build", type=Path)
    parser.add_argument("--kind", action="append", choices=KINDS)
    parser.add_argument("--only", default="")
    parser.add_argument("--rotate", action="store_true")
    parser.add_argument("--stall", action="store_true")
    parser.add_argument("--netlist", action="store_true")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--source", type=Path, default=HERE / "src")
    parser.add_argument("--stop", action="store_true", help="end at the first case that differs")
    options = parser.parse_args()
    try:
        entries = json.loads((options.vectors / "manifest.json").read_text())["cases"]
    except (OSError, ValueError) as error:
        print(f"bench.py: {options.vectors} holds no vectors: {error}", file=sys.stderr)
        return 2
    kinds = options.kind or (["frame"] if options.rotate else KINDS)
    cases = [Case(options.vectors, entry["name"], entry["kind"]) for entry in entries
             if entry["kind"] in kinds and options.only in entry["name"]]
    if options.netlist and not set(kinds) <= {"propagate", "frame"}:
        print("bench.py: --netlist takes the kinds propagate and frame", file=sys.stderr)
        return 2
    builds = Builds(options.build, options.source, options.netlist)
    right, wrong, differ, ran = Counter(), Counter(), 0, Counter()
    plans = [(case, *configuration(case, options.rotate)) for case in cases]
    plans = [plan for plan in plans if plan[1] is not None]
    try:
        keys = {(case.kind, case.record, tuple(sorted(size.items()))): None for case, size, _ in plans}
        with ThreadPoolExecutor(options.jobs) as pool:
            for key, image in zip(keys, pool.map(lambda key: builds.compile(key[0], key[1], dict(key[2])), keys)):
                keys[key] = image

            def one(plan):
                case, size, arguments = plan
                return run(keys[case.kind, case.record, tuple(sorted(size.items()))], arguments, options.stall)

            for (case, _, _), (good, bad, said) in zip(plans, pool.map(one, plans)):
                ran[case.kind] += 1
                right[case.kind] += good
                wrong[case.kind] += bad
                if bad:
                    differ += 1
                    print(f"{case.name}: {bad} differ", *said[:4], sep="\n    ")
                    if options.stop:
                        pool.shutdown(cancel_futures=True)
                        return 1
    except (RuntimeError, OSError) as error:
        print(f"bench.py: {error}", file=sys.stderr)
        return 2
    for kind in kinds:
        print(f"{kind}: {ran[kind]} cases, {right[kind]} numbers agree, {wrong[kind]} differ")
    if not all(ran[kind] and right[kind] for kind in kinds):
        print("bench.py: nothing was compared for a kind", file=sys.stderr)
        return 2
    return 1 if differ else 0


if __name__ == "__main__":
    sys.exit(main())
