#!/usr/bin/env bash
# Checks the firmware: builds it for each processor, proves by linking that it cannot panic, reads its machine code,
# runs it in an emulator. Installs what is missing, goes on after a step that fails, and ends with one line a step. Ends
# with 1 if a step failed, and with 3 if none did but some could not run.
#
#   firmware/test.sh               all steps
#   firmware/test.sh proof cost    only these
#   firmware/test.sh --list        their names
#   firmware/test.sh --write-cost  counts instructions and writes them into cost.csv
#   firmware/test.sh --write-text  measures code and writes its bytes into text.csv
#   OFFLINE=1 firmware/test.sh     downloads no target and no emulator
set -euo pipefail
cd "$(dirname "$0")"
export CARGO_TERM_COLOR="${CARGO_TERM_COLOR:-auto}"
export CARGO_INCREMENTAL="${CARGO_INCREMENTAL:-0}"
export CARGO_TARGET_DIR="$PWD/target"

# The same emulated machine runs what is compiled for all three.
COST_TARGETS=(thumbv6m-none-eabi thumbv7m-none-eabi thumbv7em-none-eabi)
PROOF_TARGETS=("${COST_TARGETS[@]}" riscv32imac-unknown-none-elf)
OLED_TARGET=thumbv7m-none-eabi
PICO_TARGET=thumbv6m-none-eabi
LCD_TARGET=armv7a-none-eabi
TARGETS=("${PROOF_TARGETS[@]}" "$LCD_TARGET")
# One of each kind of instructions.
TEXT_TARGETS=(thumbv6m-none-eabi thumbv7em-none-eabi riscv32imac-unknown-none-elf)
STEPS=(format clippy build proof machine-code text kernels cost screens faults pace)

source ../tests/steps.sh
write_cost=()
write_text=()

# Ends what hangs, where there is a command for it.
limited() { if command -v timeout >/dev/null; then timeout "$@"; else shift; "$@"; fi; }

# --- what is missing -------------------------------------------------------------------------------------------------

# How a target is built: "installed" with its own core library, "source" with one built from the compiler's sources,
# "absent".
way() {
    # The folder's name is printed whether or not there is anything in it.
    if compgen -G "$(rustc --print target-libdir --target "$1")/libcore-*.rlib" >/dev/null; then
        echo installed
    elif [ -d "$(rustc --print sysroot)/lib/rustlib/src/rust/library" ]; then
        echo source
    else
        echo absent
    fi
}

# The targets of a list that cannot be built.
absent() {
    local target
    for target; do [ "$(way "$target")" != absent ] || printf '%s ' "$target"; done
}

# Cargo for a package and some targets: `on COMMAND PACKAGE "OPTIONS" TARGET...`. All that are installed in one call, so
# that they are compiled side by side.
on() {
    local command="$1" package="$2" options="$3" target together=()
    shift 3
    for target; do
        if [ "$(way "$target")" = installed ]; then
            together+=(--target "$target")
        else
            # The compiler takes the sources for its own only if it is told that it is one that may use unstable
            # features. shellcheck disable=SC2086
            RUSTC_BOOTSTRAP=1 CARGO_UNSTABLE_BUILD_STD=core,compiler_builtins \
                cargo "$command" --locked --quiet -p "$package" --target "$target" $options || return
        fi
    done
    # shellcheck disable=SC2086
    [ "${#together[@]}" = 0 ] || cargo "$command" --locked --quiet -p "$package" "${together[@]}" $options
}

install_missing() {
    local target
    command -v cargo >/dev/null || { echo "cargo is missing: install Rust with rustup, then call this" >&2; exit 1; }
    for target in "${TARGETS[@]}"; do
        [ "$(way "$target")" != installed ] || continue
        if [ -n "${OFFLINE:-}" ] || ! command -v rustup >/dev/null; then
            say "the target $target is missing"
        else
            say "the target $target is missing: rustup target add"
            limited 300 rustup target add "$target" || echo "$target could not be installed" >&2
        fi
        case "$(way "$target")" in
            source) echo "$target: its core library is built from the component rust-src" ;;
            absent) echo "$target: to be had with: rustup target add $target" >&2 ;;
        esac
    done
}

# QEMU for Arm, if need be installed.
have_qemu() {
    command -v qemu-system-arm >/dev/null && return
    [ -z "${OFFLINE:-}" ] || return 1
    if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
        say "qemu-system-arm is missing: apt-get install"
        apt-get update -qq && apt-get install -y -qq --no-install-recommends qemu-system-arm || true
    elif command -v brew >/dev/null; then
        say "qemu-system-arm is missing: brew install qemu"
        brew install qemu || true
    fi
    command -v qemu-system-arm >/dev/null
}

# --- the steps -------------------------------------------------------------------------------------------------------

step_format() {
    cargo fmt --version >/dev/null 2>&1 || { skip "rustfmt is not installed"; return; }
    cargo fmt -- --check
    bash -n test.sh
}

# Each board for its own processor, and what runs on the host with its tests.
step_clippy() {
    cargo clippy --version >/dev/null 2>&1 || { skip "clippy is not installed"; return; }
    local missing
    missing="$(absent thumbv7em-none-eabi)"
    [ -z "$missing" ] || { skip "not installed: $missing"; return; }
    cargo clippy --locked --quiet -p galpix-check --all-targets -- -D warnings
    on clippy galpix-proof "--all-features -- -D warnings" thumbv7em-none-eabi
    on clippy galpix-cost "-- -D warnings" thumbv7em-none-eabi
    missing="$(absent "$OLED_TARGET" "$LCD_TARGET")"
    [ -z "$missing" ] || { skip "not installed: $missing"; return; }
    cargo clippy --locked --quiet -p galpix-link -p galpix-controller -p galpix-kernels -- -D warnings
    on clippy galpix-uart "-- -D warnings" "$OLED_TARGET"
    on clippy lm3s6965evb "-- -D warnings" "$OLED_TARGET"
    on clippy lm3s6965evb "--no-default-features --features probe -- -D warnings" "$OLED_TARGET"
    on clippy vexpress-a9 "-- -D warnings" "$LCD_TARGET"
    on clippy rp2040 "-- -D warnings" "$PICO_TARGET"
    on clippy rp2040 "--features probe -- -D warnings" "$PICO_TARGET"
    on clippy lm3s6965evb "--features push-pull -- -D warnings" "$OLED_TARGET"
    on clippy vexpress-a9 "--features push-pull -- -D warnings" "$LCD_TARGET"
}

step_build() {
    local missing
    missing="$(absent "${TARGETS[@]}")"
    [ -z "$missing" ] || { skip "not installed: $missing"; return; }
    on build galpix-proof "--release --bin galpix-proof" "${PROOF_TARGETS[@]}"
    on build galpix-cost --release "${COST_TARGETS[@]}"
    boards
}

# The programs of the boards with a panel, each without and with push-pull, and what they take of flash and RAM. A
# program of no size was linked without its linker script.
boards() {
    local board target programs=()
    for board in lm3s6965evb vexpress-a9; do
        target="$OLED_TARGET"
        [ "$board" = lm3s6965evb ] || target="$LCD_TARGET"
        programs+=("target/$target/release/$board" "target/$target/release/$board-push-pull")
        # Under the same name as the other one: it is put aside.
        on build "$board" "--release --features push-pull" "$target"
        cp "target/$target/release/$board" "target/$target/release/$board-push-pull"
        on build "$board" --release "$target"
    done
    on build rp2040 --release "$PICO_TARGET"
    programs+=("target/$PICO_TARGET/release/rp2040")
    cargo run --locked --quiet -p galpix-check -- size "${programs[@]}"
}

# The tool that talks to the boards in the emulator: part of the workspace above, for it needs the simulator.
device() {
    (cd .. && CARGO_TARGET_DIR="$PWD/target" cargo run --locked --quiet --release -p galpix-device -- "$@")
}

# What a step needs that runs the boards' programs. Skips it if that cannot be had.
have_boards() {
    local missing
    missing="$(absent "$OLED_TARGET" "$PICO_TARGET" "$LCD_TARGET")"
    [ -z "$missing" ] || { skip "not installed: $missing"; return 1; }
    have_qemu || { skip "not installed: qemu-system-arm, to be had with: apt-get install qemu-system-arm"; return 1; }
    boards >/dev/null
}

# It links: no panic can be reached. With one planted it must not, and must say why.
step_proof() {
    local missing target answer
    missing="$(absent "${PROOF_TARGETS[@]}")"
    [ -z "$missing" ] || { skip "not installed: $missing"; return; }
    on build galpix-proof "--release --bin galpix-proof" "${PROOF_TARGETS[@]}"
    for target in "${PROOF_TARGETS[@]}"; do
        if answer="$(on build galpix-proof "--release --bin galpix-proof --features bad" "$target" 2>&1)"; then
            echo "$target: a program that can panic was linked" >&2
            return 1
        fi
        grep -q 'undefined symbol: galpix_proof_failed_because_a_panic_can_be_reached' <<<"$answer" || {
            printf '%s: failed for another reason than the panic that was planted:\n%s\n' "$target" "$answer" >&2
            return 1
        }
        echo "$target: links without a panic, and not with one"
    done
}

step_machine-code() {
    local missing target status=0
    missing="$(absent "${PROOF_TARGETS[@]}")"
    [ -z "$missing" ] || { skip "not installed: $missing"; return; }
    on build galpix-proof "--release --bin galpix-proof" "${PROOF_TARGETS[@]}"
    for target in "${PROOF_TARGETS[@]}"; do
        echo "$target:"
        cargo run --locked --quiet -p galpix-check -- machine-code "target/$target/release/galpix-proof" || status=$?
    done
    return "$status"
}

# Bytes of a frame's code by layout, within 5 % of text.csv.
step_text() {
    local missing target files=()
    missing="$(absent "${TEXT_TARGETS[@]}")"
    [ -z "$missing" ] || { skip "not installed: $missing"; return; }
    on build galpix-proof "--release --bin galpix-text" "${TEXT_TARGETS[@]}"
    for target in "${TEXT_TARGETS[@]}"; do files+=("target/$target/release/galpix-text"); done
    cargo run --locked --quiet -p galpix-check -- text ${write_text[@]+"${write_text[@]}"} "${files[@]}"
}

step_cost() {
    local missing target runs=() files=() run
    missing="$(absent "${COST_TARGETS[@]}")"
    [ -z "$missing" ] || { skip "not installed: $missing"; return; }
    have_qemu || { skip "not installed: qemu-system-arm, to be had with: apt-get install qemu-system-arm"; return; }
    cargo test --locked --quiet -p galpix-check
    on build galpix-cost --release "${COST_TARGETS[@]}"
    mkdir -p target/cost
    for target in "${COST_TARGETS[@]}"; do
        limited 300 qemu-system-arm -M mps2-an386 -icount shift=6 -display none -monitor none -serial none \
            -semihosting-config enable=on,target=native -kernel "target/$target/release/galpix-cost" \
            >"target/cost/$target.csv" &
        runs+=($!)
        files+=("target/cost/$target.csv")
    done
    for run in "${runs[@]}"; do wait "$run"; done
    cargo run --locked --quiet -p galpix-check -- cost ${write_cost[@]+"${write_cost[@]}"} "${files[@]}"
}

# All states of a tiny budget, on the processors and on the host: the same hash.
step_kernels() {
    local missing target
    missing="$(absent "${COST_TARGETS[@]}")"
    [ -z "$missing" ] || { skip "not installed: $missing"; return; }
    have_qemu || { skip "not installed: qemu-system-arm, to be had with: apt-get install qemu-system-arm"; return; }
    on build galpix-cost --release "${COST_TARGETS[@]}"
    for target in "${COST_TARGETS[@]}"; do
        printf '%s: ' "$target"
        limited 120 qemu-system-arm -M mps2-an386 -display none -monitor none -serial none \
            -semihosting-config enable=on,target=native -kernel "target/$target/release/galpix-kernels-on-target"
    done
    cargo test --locked --quiet --release -p galpix-kernels
}

# The emulator of the Pico, if need be installed: a package of Node, by its lock file.
have_pico() {
    local folder=emulators/rp2040 wanted
    command -v node >/dev/null || return 1
    wanted="$(sed -n 's/.*"rp2040js": "\(.*\)".*/\1/p' "$folder/package.json")"
    grep -qs "\"version\": \"$wanted\"" "$folder/node_modules/rp2040js/package.json" && return
    [ -z "${OFFLINE:-}" ] && command -v npm >/dev/null || return 1
    say "the emulator of the Pico is missing: npm ci"
    limited 300 npm ci --prefix "$folder" --no-audit --no-fund || return 1
}

# Runs a command of the tool for each board that has its emulator here. Skips the Pico if it has none.
devices() {
    have_boards || return 0
    if have_pico; then
        device "$@"
    else
        device "$@" --board lm3s6965evb --board vexpress-a9
        skip "the others passed; rp2040 needs node and npm, to be had with: apt-get install nodejs npm"
    fi
}

# Every pixel of the emulated screens against the simulator, and all against the kept hashes.
step_screens() { devices screens; }

# Random and corrupted frames over the line.
step_faults() { devices faults; }

# Frames a second, missed vsyncs, busy time and stack at stated speeds.
step_pace() { devices pace --check; }

# --- running them ----------------------------------------------------------------------------------------------------

main() {
    local name chosen=("$@")
    case "${1:-}" in
        --list) printf '%s\n' "${STEPS[@]}"; return ;;
        --write-cost) write_cost=(--write) chosen=(cost) ;;
        --write-text) write_text=(--write) chosen=(text) ;;
    esac
    [ "${#chosen[@]}" -gt 0 ] || chosen=("${STEPS[@]}")
    for name in "${chosen[@]}"; do
        [[ " ${STEPS[*]} " == *" $name "* ]] || { echo "there is no step \"$name\": --list names them" >&2; exit 2; }
    done
    install_missing
    for name in "${chosen[@]}"; do run_step "$name"; done
    finish
}

main "$@"
