#!/usr/bin/env python3
"""Writes a small capture with the buffers of XR_FB_space_warp and XR_EXT_frame_synthesis.

    python3 docs/space_warp.py FOLDER && galpix run FOLDER

A near square moves over a far plane that the camera passes. Colour is 64x48; motion and depth are 32x24, as such
buffers usually are smaller. Two display frames pass in a frame of the application. Needs nothing but Python.
"""

import pathlib
import struct
import sys
import zlib

WIDTH, HEIGHT, NEAR = 64, 48, 0.1
FRAMES = 2
# Pixels in a frame of the application, x to the right and y down, and distance.
FAR_PLANE = ((-2, 0), 8.0)
SQUARE = ((4, 2), 2.0)


def surface(x, y, t):
    """What is seen at a pixel, t frames of the application after the update: the surface, and its own place there."""
    (dx, dy), _ = SQUARE
    own_x, own_y = x - dx * t, y - dy * t
    if 16 <= own_x < 32 and 12 <= own_y < 28:
        return SQUARE, (own_x, own_y)
    (dx, dy), _ = FAR_PLANE
    return FAR_PLANE, (x - dx * t, y - dy * t)


def colour(x, y, t):
    which, (u, v) = surface(x, y, t)
    noise = zlib.crc32(struct.pack("<iii", int(u), int(v), which is SQUARE)) & 0x3F3F3F
    base = (160, 96, 32) if which is SQUARE else (32, 96, 160)
    return bytes(b + (noise >> (8 * i) & 63) for i, b in enumerate(base))


def png(path, t):
    rows = b"".join(b"\0" + b"".join(colour(x, y, t) for x in range(WIDTH)) for y in range(HEIGHT))

    def chunk(tag, data):
        return struct.pack(">I", len(data)) + tag + data + struct.pack(">I", zlib.crc32(tag + data))

    header = struct.pack(">IIBBBBB", WIDTH, HEIGHT, 8, 2, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) +
                     chunk(b"IEND", b""))


def exr(path, width, height, channels, form):
    """Writes an OpenEXR of one part without compression; `channels`: name -> number of each pixel; `form`: e or f."""
    names = sorted(channels)
    kind = {"e": 1, "f": 2}[form]
    listed = b"".join(n.encode() + b"\0" + struct.pack("<iB3xii", kind, 0, 1, 1) for n in names) + b"\0"
    window = struct.pack("<iiii", 0, 0, width - 1, height - 1)
    attributes = [
        ("channels", "chlist", listed), ("compression", "compression", b"\0"), ("dataWindow", "box2i", window),
        ("displayWindow", "box2i", window), ("lineOrder", "lineOrder", b"\0"),
        ("pixelAspectRatio", "float", struct.pack("<f", 1)), ("screenWindowCenter", "v2f", struct.pack("<ff", 0, 0)),
        ("screenWindowWidth", "float", struct.pack("<f", 1)),
    ]
    head = struct.pack("<II", 20000630, 2)
    for name, of, value in attributes:
        head += name.encode() + b"\0" + of.encode() + b"\0" + struct.pack("<i", len(value)) + value
    head += b"\0"
    lines = []
    for y in range(height):
        body = b"".join(struct.pack(f"<{width}{form}", *(channels[n](x, y) for x in range(width))) for n in names)
        lines.append(struct.pack("<ii", y, len(body)) + body)
    offsets, at = [], len(head) + 8 * height
    for line in lines:
        offsets.append(at)
        at += len(line)
    path.write_bytes(head + struct.pack(f"<{height}Q", *offsets) + b"".join(lines))


def main(folder):
    folder.mkdir(parents=True, exist_ok=True)
    for t in range(5):
        png(folder / f"{t}.png", t)

    def at(x, y):
        return surface(2 * x, 2 * y, 0)[0]

    # Now less a frame ago, in normalised device coordinates: 2 is the width, y up. Stored four times as large.
    motion = {
        "R": lambda x, y: 4 * 2 * at(x, y)[0][0] / WIDTH,
        "G": lambda x, y: 4 * -2 * at(x, y)[0][1] / HEIGHT,
        "B": lambda x, y: 0.0,
        "A": lambda x, y: 0.0,
    }
    exr(folder / "motion.exr", WIDTH // 2, HEIGHT // 2, motion, "e")
    exr(folder / "depth.exr", WIDTH // 2, HEIGHT // 2, {"D": lambda x, y: 1 - NEAR / at(x, y)[1]}, "f")
    truths = "".join(f'\n[[truth]]\nframe = {FRAMES * t}\ncolor = "{t}.png"\n' for t in range(1, 5))
    (folder / "capture.toml").write_text(f"""name = "space-warp"
frames = {4 * FRAMES}

[update]
color = "0.png"
depth = {{ kind = "buffer", file = "depth.exr", planes = [{NEAR}, inf], resize = true }}
motion = {{ kind = "space-warp", file = "motion.exr", frames = {FRAMES}, scale = 0.25, resize = true }}
{truths}""")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]))
