#!/usr/bin/env python3
"""Simulate `galpix_panel`, from its test pattern to the panel, and compare each picture with the golden vectors'.

    panel.py VECTORS OUT

Writes OUT/panel_N.png, what the panel showed of frame N. Exit code 0: every pixel of every frame is that of the map after
it, without its margin, in the case `frame-…-pattern-…`; 1: not so.
"""

import struct
import subprocess
import sys
import zlib
from pathlib import Path

from bench import Case

HERE = Path(__file__).resolve().parent


def png(width, height, pixels):
    """A PNG of rows of 8-bit red, green and blue."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + b"".join(bytes.fromhex(pixels[y * width + x]) for x in range(width)) for y in range(height))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def shown(case, number):
    """The pixels that a display shows of a map of the vectors, section 9, as hexadecimal digits."""
    of, own = case.of_record, case.own
    cells = case.columns * case.rows
    words = [int(line, 16) for line in (case.folder / f"map_{number}.hex").read_text().splitlines()[1:]]
    pixels = []
    for y in range(own["TOP"], own["TOP"] + own["HEIGHT"]):
        for x in range(own["LEFT"], own["LEFT"] + own["WIDTH"]):
            record = 0
            for word in range(of["WORDS"]):
                record = record << 32 | words[word * cells + y * case.columns + x]
            colour = record >> of["COLOUR_LSB"] & ((1 << of["COLOUR_BITS"]) - 1)
            channels = []
            for index in range(of["CHANNELS"]):
                bits = of[f"CHANNEL_{index}_BITS"]
                channel = colour >> of[f"CHANNEL_{index}_LSB"] & ((1 << bits) - 1)
                channels.append((channel << 8 - bits) | (channel << 8 - bits >> bits))
            pixels.append("".join(f"{channel:02x}" for channel in (channels * 3)[:3]))
    return pixels


def main():
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    vectors, out = Path(sys.argv[1]), Path(sys.argv[2])
    folders = sorted(vectors.glob("frame-*-pattern-*"))
    if len(folders) != 1:
        print(f"panel.py: {vectors} has {len(folders)} cases of the pattern, not 1", file=sys.stderr)
        return 2
    case = Case(vectors, folders[0].name, "frame")
    out.mkdir(parents=True, exist_ok=True)
    (out / "galpixel.sv").write_text(f"package galpixel;\n{case.record}\nendpackage\n")
    subprocess.run(["iverilog", "-g2012", "-o", str(out / "panel.vvp"), "-s", "panel", str(out / "galpixel.sv"),
                    *map(str, sorted((HERE / "src").glob("*.sv"))), str(HERE / "bench" / "panel.sv")], check=True)
    said = subprocess.run(["vvp", "-n", str(out / "panel.vvp"), f"+out={out}"], check=True, capture_output=True, text=True)
    print(said.stdout, end="")
    wrong = 0
    for number in range(1, case.own["FRAMES"] + 1):
        pixels = (out / f"frame_{number}.txt").read_text().split()
        expected = shown(case, number)
        (out / f"panel_{number}.png").write_bytes(png(case.own["WIDTH"], case.own["HEIGHT"], pixels))
        same = (out / f"panel_{number}.png").read_bytes() == png(case.own["WIDTH"], case.own["HEIGHT"], expected)
        wrong += not same
        print(f"frame {number}: {'the same picture' if same else 'another picture'}, {len(pixels)} pixels")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
