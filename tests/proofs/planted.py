"""Plants one fault in each stage of the core, and checks that the golden vectors notice.

The faults are planted in a copy of the tracked files. It ends with 1 if one is not noticed, or if its place is gone.
"""

import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TREE = ROOT / "target" / "proofs" / "tree"
BUILD = ROOT / "target" / "proofs" / "build"

# File of galpix-core/src, what stands there, what is planted.
MUTANTS = [
    ("format/rounding.rs", "1 << (shift - 1)", "1 << shift >> 2"),
    (
        "frame/step.rs",
        "let step = (v << 1) + (a << scale.acceleration_up);",
        "let step = (v << 1) + (a << scale.acceleration_up & !1);",
    ),
    ("frame/step.rs", "v.min(top).max(!top)", "v.min(top).max(-top)"),
    ("frame/resolve.rs", "challenger.source < incumbent.source", "challenger.source > incumbent.source"),
    ("fast/wide/mod.rs", "if key < incumbent {", "if key <= incumbent {"),
    ("fast/wide/edge.rs", "source < -threshold", "source <= -threshold"),
    ("fast/fill.rs", "winner >= FILLED + round)", "winner > FILLED + round)"),
    ("fast/fill.rs", "if depth(&right) > depth(&left)", "if depth(&right) >= depth(&left)"),
    ("inpaint/quads.rs", "across > LARGEST || down > LARGEST", "across >= LARGEST || down > LARGEST"),
    ("inpaint/kernel.rs", "if depth - child.depth > threshold { 0 }", "if depth - child.depth >= threshold { 0 }"),
]


def copy_tree():
    shutil.rmtree(TREE, ignore_errors=True)
    files = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True).stdout
    for name in files.decode().split("\0"):
        if name and (ROOT / name).is_file() and not name.startswith(("captures/", "docs/figures/")):
            (TREE / name).parent.mkdir(parents=True, exist_ok=True)
            # With the time of now: else cargo may take what it built of the last planted fault for the present text.
            shutil.copy(ROOT / name, TREE / name)


def test():
    """Whether the golden vectors have their hashes; what cargo printed."""
    command = ["cargo", "test", "--locked", "--quiet", "--package", "galpix-golden", "--profile", "mutants"]
    command += ["--target-dir", BUILD]
    run = subprocess.run(command, cwd=TREE, capture_output=True, text=True)
    return run.returncode == 0, run.stdout + run.stderr


def main():
    copy_tree()
    passed, output = test()
    if not passed:
        sys.exit(f"without a fault the golden vectors should pass:\n{output}")
    unnoticed = 0
    for name, before, after in MUTANTS:
        path = TREE / "galpix-core" / "src" / name
        source = path.read_text()
        if source.count(before) != 1:
            sys.exit(f"{name} does not hold `{before}` exactly once: correct the list in tests/proofs/planted.py")
        path.write_text(source.replace(before, after))
        passed, output = test()
        path.write_text(source)
        # A fault that does not compile shows nothing.
        noticed = not passed and "bits have changed" in output
        unnoticed += not noticed
        print(f"{'noticed ' if noticed else 'SURVIVED'}  {name}: {before} -> {after}", flush=True)
        if not passed and not noticed:
            print(output, file=sys.stderr)
    sys.exit(1 if unnoticed else 0)


if __name__ == "__main__":
    main()
