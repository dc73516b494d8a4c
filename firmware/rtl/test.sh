#!/usr/bin/env bash
# Checks the reference design: lint, benches over the golden vectors, proofs, synthesis. One line a step; goes on after
# one that fails. Ends with 1 if a step failed, and with 3 if none did but some could not run.
#
#   firmware/rtl/test.sh                all steps
#   firmware/rtl/test.sh lint proof     only these
#   firmware/rtl/test.sh --list         their names
#   firmware/rtl/test.sh rotate-all     that step for all layouts (not among the steps)
#   firmware/rtl/test.sh table          the table of README.md, with place and route (not among the steps)
#   GALPIX=PATH firmware/rtl/test.sh    with this galpix, which is else built
set -euo pipefail
cd "$(dirname "$0")"
export PYTHONDONTWRITEBYTECODE=1
STEPS=(lint benches rotate netlist panel pace proof mutants synthesis)
BUILD="$(cd ../.. && pwd)/target/rtl"
VECTORS="$BUILD/vectors"
LAYOUTS=(paper shaded uneven flat565 velocity565 gray8 gray4 coarse straddle bright565 still)
KINDS=(step propagate resolve edge fill frame)

source ../../tests/steps.sh
label="rtl "

needs() {
    local tool
    for tool; do command -v "$tool" >/dev/null || { skip "$tool is not installed"; return 1; }; done
}

galpix() {
    if [ -n "${GALPIX:-}" ]; then "$GALPIX" "$@"; else (cd ../.. && cargo run --locked --quiet --release -- "$@"); fi
}

# The vectors that the benches need, written once a run.
vectors() {
    [ ! -f "$BUILD/written" ] || return 0
    rm -rf "$VECTORS"
    mkdir -p "$BUILD"
    galpix --quiet vectors --stages --out "$VECTORS" "${KINDS[@]/#/--kind=}" >/dev/null
    touch "$BUILD/written"
}

# The package of a layout, from a case of the vectors.
package() {
    local case_of
    case_of="$(compgen -G "$VECTORS/frame-$1-*/params.svh" | head -n 1)"
    mkdir -p "$BUILD/$1"
    { echo "package galpixel;"; sed '/^$/,$d' "$case_of"; echo "endpackage"; } >"$BUILD/$1/galpixel.sv"
}

# Every layout with every fill mode that leaves something out of the design.
step_lint() {
    local layout richest
    needs verilator || return 0
    vectors
    for layout in "${LAYOUTS[@]}"; do
        package "$layout"
        # A package has parameters for all modules; no module uses all of them.
        for richest in 0 1 3 4 5; do
            verilator --lint-only -Wall -Wno-UNUSEDPARAM "-GRICHEST=$richest" --top-module galpix_frame \
                "$BUILD/$layout/galpixel.sv" src/*.sv
        done
        verilator --lint-only -Wall -Wno-UNUSEDPARAM --top-module galpix_panel "$BUILD/$layout/galpixel.sv" src/*.sv
    done
    echo "${#LAYOUTS[@]} layouts"
}

# All vectors of the six kinds.
step_benches() {
    needs iverilog python3 || return 0
    vectors
    python3 bench.py "$VECTORS" "$BUILD/benches"
}

# Frames in a band that is smaller than the map, with a display that stops: of the layout with the most fields.
step_rotate() {
    needs iverilog python3 || return 0
    vectors
    python3 bench.py "$VECTORS" "$BUILD/benches" --rotate --stall --only frame-shaded
}

# Not among the steps: the same of all layouts.
step_rotate-all() {
    needs iverilog python3 || return 0
    vectors
    python3 bench.py "$VECTORS" "$BUILD/benches" --rotate --stall
}

# What yosys reads in the sources is what the benches saw: the two read SystemVerilog each in their own way.
step_netlist() {
    needs iverilog yosys python3 || return 0
    vectors
    python3 bench.py "$VECTORS" "$BUILD/benches" --netlist --kind propagate
    python3 bench.py "$VECTORS" "$BUILD/benches" --netlist --kind frame --only frame-gray4
}

# Camera to panel: the picture on the panel is the one of the golden vectors.
step_panel() {
    needs iverilog python3 || return 0
    vectors
    python3 panel.py "$VECTORS" "$BUILD/panel"
}

# The clocks of a frame of 1024 x 768 at a reach of eight rows.
step_pace() {
    needs verilator || return 0
    packages
    verilator --binary --timing -O3 -Wno-fatal -Wno-WIDTH -Wno-UNUSEDPARAM -Wno-TIMESCALEMOD --top-module pace \
        --Mdir "$BUILD/pace" -j 2 "$BUILD/packages/velocity565/galpixel.sv" src/*.sv bench/pace.sv >"$BUILD/pace.log" 2>&1 ||
        { cat "$BUILD/pace.log"; return 1; }
    "$BUILD/pace/Vpace"
}

step_proof() {
    needs yosys python3 || return 0
    python3 proof.py
}

step_mutants() {
    needs iverilog python3 || return 0
    vectors
    python3 mutants.py "$VECTORS" "$BUILD/mutants" --quick
}

# Packages as a user makes them, from budgets.
packages() {
    local name layout limit
    while read -r name layout limit; do
        mkdir -p "$BUILD/packages/$name"
        galpix budget --json --layout "$layout" $limit >"$BUILD/packages/$name/budget.json" </dev/null
        galpix --quiet rtl --budget "$BUILD/packages/$name/budget.json" --out "$BUILD/packages/$name" >/dev/null </dev/null
    done <<'LIST'
velocity565 velocity565 --limit-y=8
gray4 velocity-gray4 --limit-y=8
full full
LIST
}

# No multiplier anywhere. Place and route takes long: `firmware/rtl/test.sh table` does it too.
step_synthesis() {
    needs yosys python3 || return 0
    packages
    python3 synth.py "$BUILD/packages" "$BUILD/synth" --synthesis --only lane
    python3 synth.py "$BUILD/packages" "$BUILD/synth" --synthesis --only "128 x 64, extend velocity565 ecp5"
}

# Not among the steps: the table of README.md, with place and route.
step_table() {
    local status=0
    needs yosys python3 || return 0
    packages
    python3 synth.py "$BUILD/packages" "$BUILD/synth" || status=$?
    [ "$status" != 3 ] || { skip "a tool for place and route is not installed"; return 0; }
    return "$status"
}

main() {
    local name chosen=("$@")
    [ "${1:-}" != --list ] || { printf '%s\n' "${STEPS[@]}"; return; }
    [ "$#" -gt 0 ] || chosen=("${STEPS[@]}")
    for name in "${chosen[@]}"; do
        [[ " ${STEPS[*]} table rotate-all " == *" $name "* ]] || { echo "there is no step \"$name\": --list names them" >&2; exit 2; }
    done
    mkdir -p "$BUILD"
    rm -f "$BUILD/written"
    for name in "${chosen[@]}"; do run_step "$name"; done
    finish
}

main "$@"
