#!/usr/bin/env bash
# Runs a board's program in its emulator: the cargo runner of the boards, `run.sh BOARD ELF`.
#
#   cd firmware/boards/lm3s6965evb && cargo run --release
#
# The panel is a window where there is a display. The serial line is TCP port 5331 (PORT=... changes it) of this
# machine, so that beside it `galpix send crossing --to tcp:127.0.0.1:5331` sends a picture. The log goes through
# defmt-print.
set -euo pipefail

[ "$#" -ge 2 ] || { echo "run.sh: a board and its program: run.sh BOARD ELF" >&2; exit 2; }
board="$1" elf="$2"
port="${PORT:-5331}"

# The Pico has another emulator, without a window and without a log.
if [ "$board" = rp2040 ]; then
    folder="$(cd "$(dirname "$0")" && pwd)/emulators/rp2040"
    command -v node >/dev/null || { echo "run.sh: node is missing: sudo apt-get install nodejs npm" >&2; exit 1; }
    [ -d "$folder/node_modules" ] || npm ci --prefix "$folder" --no-audit --no-fund >&2
    echo "run.sh: the line is tcp:127.0.0.1:$port; Ctrl-C ends" >&2
    exec node "$folder/run.mjs" "$elf" --listen "$port"
fi

command -v qemu-system-arm >/dev/null || {
    echo "run.sh: qemu-system-arm is missing: install it, for example with: sudo apt-get install qemu-system-arm" >&2
    exit 1
}

# What QEMU can show a window with, if there is a display for it.
window() {
    local kind kinds
    [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ] || [ "$(uname)" = Darwin ] || return 0
    kinds="$(qemu-system-arm -display help 2>/dev/null)"
    for kind in gtk sdl cocoa; do
        if grep -qx "$kind" <<<"$kinds"; then echo "$kind"; return 0; fi
    done
}

arguments=(-M "$board" -kernel "$elf" -monitor none -semihosting-config enable=on,target=native)
case "$board" in
    # A bench: it prints text, and ends by itself. An instruction takes 64 ns.
    mps2-an386) exec qemu-system-arm "${arguments[@]}" -display none -serial none -icount shift=6 ;;
    vexpress-a9) arguments+=(-audiodev "none,id=snd") ;;
esac

display="$(window)"
if [ -n "$display" ]; then
    arguments+=(-display "$display")
else
    echo "run.sh: no window: QEMU finds no display here; the program runs all the same" >&2
    arguments+=(-display none)
fi
echo "run.sh: the line is tcp:127.0.0.1:$port; Ctrl-C ends" >&2
arguments+=(-serial "tcp:127.0.0.1:$port,server=on,wait=off")

if command -v defmt-print >/dev/null; then
    # By a pipe with a name, so that the emulator's own end is this script's.
    folder="$(mktemp -d)"
    trap 'rm -rf "$folder"' EXIT
    mkfifo "$folder/log"
    defmt-print -e "$elf" <"$folder/log" &
    printer=$!
    qemu-system-arm "${arguments[@]}" </dev/null >"$folder/log" &
    emulator=$!
    trap 'kill "$emulator" 2>/dev/null' INT TERM HUP
    status=0
    wait "$emulator" || status=$?
    wait "$printer" || true
    exit "$status"
fi
echo "run.sh: no log: defmt-print is missing; install it with: cargo install defmt-print" >&2
exec qemu-system-arm "${arguments[@]}" </dev/null >/dev/null
