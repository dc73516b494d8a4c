#!/usr/bin/env bash
# Checks the Python package: formats, lints and types; wheel and sdist; ten lines on the wheel in an empty virtual
# environment; the tests on the installed wheel. Everything that it installs is in the target folder.
#
#   python/test.sh           all of it
#   python/test.sh sdist     the same, and a build from the sdist, which takes as long as a first build
#
# Ends with 3 if a part could not run, and says which.
set -euo pipefail
cd "$(dirname "$0")/.."
target="${CARGO_TARGET_DIR:-$PWD/target}"
work="$target/python-test"
skipped=0

skip() { echo "skipped: $*"; skipped=1; }

say() { printf -- '-- %s\n' "$*"; }

python3 -c 'import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 9))' 2>/dev/null ||
    { skip "python3 of 3.9 or newer with venv is not installed"; exit 3; }
rm -rf "$work"
mkdir -p "$work"
# Environments and caches of what comes from the package registry are kept between calls.
tools="$target/python-tools"
[ -x "$tools/bin/pip" ] || python3 -m venv "$tools"
pip() { "$tools/bin/pip" --disable-pip-version-check --quiet "$@"; }
pip install 'maturin>=1.9,<2' numpy pytest || { skip "maturin, numpy and pytest cannot be had from the package registry"; exit 3; }
further="dask[distributed] pyarrow duckdb pillow opencv-python-headless matplotlib nbclient ipykernel ruff mypy"
# shellcheck disable=SC2086 # One word each.
pip install $further || skip "$further cannot be had from the package registry: what needs them is not tested"

if [ -x "$tools/bin/ruff" ] && [ -x "$tools/bin/mypy" ]; then
    say "format, lints and types"
    "$tools/bin/ruff" format --no-cache --check --quiet python
    "$tools/bin/ruff" check --no-cache --quiet python
    "$tools/bin/mypy" --cache-dir "$work/mypy" --ignore-missing-imports python/galpix
fi

say "wheel and sdist"
"$tools/bin/maturin" build --quiet --locked --manifest-path python/Cargo.toml --out "$work/dist"
"$tools/bin/maturin" sdist --manifest-path python/Cargo.toml --out "$work/dist"
ls -sh "$work/dist"
wheel=("$work"/dist/*.whl)

say "ten lines in an empty environment, from the wheel"
started=$SECONDS
python3 -m venv "$work/empty"
"$work/empty/bin/pip" --disable-pip-version-check --quiet install "${wheel[0]}"
"$work/empty/bin/python" python/examples/moving_picture.py
took=$((SECONDS - started))
echo "$took s"
[ "$took" -lt 60 ] || { echo "a moving picture took $took s from an empty environment: a minute is promised" >&2; exit 1; }

if [ "${1:-}" = sdist ]; then
    say "from the sdist, with one command"
    python3 -m venv "$work/source"
    CARGO_TARGET_DIR="$target" "$work/source/bin/pip" --disable-pip-version-check --quiet install "$work"/dist/*.tar.gz
    "$work/source/bin/python" python/examples/moving_picture.py
fi

say "tests"
pip install --force-reinstall --no-deps "${wheel[0]}"
# Not from the folder of the sources: that would be imported, and has no extension module.
"$tools/bin/pytest" -q -p no:cacheprovider python/tests -rs
[ "$skipped" = 0 ] || exit 3
