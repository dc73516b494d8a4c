#!/usr/bin/env bash
# Checks everything, on a machine that has nothing but rustup: installs what is missing, then runs the steps below, goes
# on after one that fails, and ends with one line a step. Ends with 1 if a step failed.
#
#   ./test.sh             all steps
#   ./test.sh quick       format, width, clippy, unit tests and golden hashes: what to run between two edits
#   ./test.sh tests docs  only these
#   ./test.sh --list      their names
set -euo pipefail
cd "$(dirname "$0")"
export CARGO_TERM_COLOR="${CARGO_TERM_COLOR:-auto}"
# Each crate is built once here: what incremental builds write would be half of the disk that the whole takes.
export CARGO_INCREMENTAL="${CARGO_INCREMENTAL:-0}"

BARE_TARGETS=(thumbv6m-none-eabi riscv32imac-unknown-none-elf)
FIRMWARE_TARGETS=(thumbv7m-none-eabi thumbv7em-none-eabi)
STEPS=(format width clippy docs tests no-std codegen constant-time clauses model proofs rtl python benches msrv package fuzz
    firmware)
QUICK=(format width clippy unit golden)

source tests/steps.sh

installed() { compgen -G "$(rustc --print target-libdir --target "$1")/libcore-*.rlib" >/dev/null; }

# --- what is missing -------------------------------------------------------------------------------------------------

install_missing() {
    local target
    command -v cargo >/dev/null || { echo "cargo is missing: install Rust with rustup, then call ./test.sh again" >&2; exit 1; }
    if ! command -v c++ >/dev/null && ! command -v g++ >/dev/null; then
        if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
            say "a C++ compiler is missing: installing g++"
            apt-get update -qq && apt-get install -y -qq --no-install-recommends g++ || echo "g++ could not be installed" >&2
        else
            echo "a C++ compiler is missing: install one, for example with: sudo apt-get install g++" >&2
        fi
    fi
    if ! command -v valgrind >/dev/null; then
        if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
            say "valgrind is missing: installing it"
            apt-get update -qq && apt-get install -y -qq --no-install-recommends valgrind libc6-dbg ||
                echo "valgrind could not be installed" >&2
        else
            echo "valgrind is missing: install it, for example with: sudo apt-get install valgrind" >&2
        fi
    fi
    if ! command -v iverilog >/dev/null || ! command -v verilator >/dev/null || ! command -v yosys >/dev/null; then
        if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
            say "tools for logic are missing: installing iverilog, verilator, yosys and nextpnr-ice40"
            apt-get update -qq && apt-get install -y -qq --no-install-recommends iverilog verilator yosys nextpnr-ice40 ||
                echo "they could not be installed" >&2
        else
            echo "tools for logic are missing: install them, for example with: sudo apt-get install iverilog verilator yosys" >&2
        fi
    fi
    for target in "${BARE_TARGETS[@]}" "${FIRMWARE_TARGETS[@]}"; do
        installed "$target" && continue
        say "the target $target is missing: rustup target add"
        timeout 300 rustup target add "$target" || echo "$target could not be installed" >&2
    done
    cargo fmt --version >/dev/null 2>&1 || { say "rustfmt is missing: rustup component add"; timeout 300 rustup component add rustfmt || true; }
    cargo clippy --version >/dev/null 2>&1 || { say "clippy is missing: rustup component add"; timeout 300 rustup component add clippy || true; }
}

# The targets of a list that are not there.
absent() {
    local target
    for target; do installed "$target" || printf '%s ' "$target"; done
}

# Runs a script that ends with 3 if it, or a part of it, cannot run here: then the step is skipped, as `why` says.
by_script() {
    local why="$1" status=0
    shift
    "$@" || status=$?
    [ "$status" != 3 ] || { skip "$why"; return; }
    return "$status"
}

# --- the steps -------------------------------------------------------------------------------------------------------

step_format() {
    cargo fmt --version >/dev/null 2>&1 || { skip "rustfmt is not installed"; return; }
    cargo fmt --all -- --check
    cargo fmt --manifest-path tests/codegen/Cargo.toml -- --check
    cargo fmt --manifest-path tests/fuzz/Cargo.toml -- --check
    bash -n tests/proofs/run.sh
    bash -n firmware/rtl/test.sh
}

# Comments and text wrap at 120 columns: rustfmt does not look at them. Tables, pictures, links and code blocks do not
# count.
wide_lines() {
    case "$1" in
        *.md) awk '/^ *```/ { fence = !fence } !fence && !/^ *[|!]/ && !/https?:/' "$1" ;;
        *.rs | *.sv) grep -E '^ *//' "$1" ;;
        *) grep -E '^ *#' "$1" ;;
    esac | LC_ALL=C.UTF-8 grep -E '^.{121,}$'
}

step_width() {
    local file lines status=0
    while IFS= read -r file; do
        lines="$(wide_lines "$file" || true)"
        [ -z "$lines" ] || { printf '%s, beyond 120 columns:\n%s\n' "$file" "$lines"; status=1; }
    done < <(git ls-files '*.rs' '*.sv' '*.md' '*.sh' '*.py' '*.toml')
    return "$status"
}

step_clippy() {
    cargo clippy --version >/dev/null 2>&1 || { skip "clippy is not installed"; return; }
    cargo clippy --locked --workspace --all-targets --all-features -- -D warnings
}

# Once, as docs.rs builds the core, and the other crates with what they have by default.
step_docs() {
    RUSTDOCFLAGS="-D warnings" cargo doc --locked --workspace --no-deps
    RUSTDOCFLAGS="-D warnings" cargo doc --locked -p galpix-core --features embedded-graphics,defmt --no-deps
}

# Unit tests, tests across the crates and doctests, with every fast pass compared with its reference (feature `check`).
# The machine code has a step of its own.
step_tests() {
    cargo test --locked --workspace --all-features --no-fail-fast -- --skip codegen
}

# For `quick`: the same build as in `tests`.
step_unit() {
    cargo test --locked --workspace --all-features --lib
}

# For `quick`: no bit of any golden vector has changed.
step_golden() {
    cargo test --locked -p galpix-golden --test golden
}

# The core as firmware takes it: by default, with each feature alone, and with all.
step_no-std() {
    local target features missing
    missing="$(absent "${BARE_TARGETS[@]}")"
    [ -z "$missing" ] || { skip "not installed: $missing"; return; }
    for target in "${BARE_TARGETS[@]}"; do
        for features in "" embedded-graphics defmt embedded-graphics,defmt; do
            echo "galpix-core for $target with features: ${features:-none}"
            cargo check --locked --quiet -p galpix-core --lib --target "$target" --features "$features"
        done
    done
}

step_codegen() {
    local missing
    missing="$(absent "${BARE_TARGETS[@]}")"
    [ -z "$missing" ] || { skip "not installed: $missing"; return; }
    # The same features as in the step `tests`: else all is built anew.
    cargo test --locked --workspace --all-features --test all -- codegen
}

# Every clause of the specification is exercised, and what docs/assurance.md claims is checked by what exists.
step_clauses() {
    python3 -c 'import tomllib' 2>/dev/null || { skip "python3 of 3.11 or newer is not installed"; return; }
    python3 -B tests/clauses/clauses.py
    python3 -B tests/assurance/assurance.py
}

# The golden vectors, and two more sets of random maps, compared with the second model, which was written from
# docs/spec.md alone.
step_model() {
    command -v python3 >/dev/null || { skip "python3 is not installed"; return; }
    local seed check checks=()
    for seed in 0 1 2; do
        cargo run --locked --quiet --release -- vectors --seed "$seed" --out "target/vectors/$seed"
        PYTHONDONTWRITEBYTECODE=1 python3 tests/model/check_vectors.py "target/vectors/$seed" \
            $([ "$seed" != 0 ] || echo --require-all-rules) &
        checks+=($!)
    done
    for check in "${checks[@]}"; do wait "$check"; done
}

# The quick form of tests/proofs/run.sh: a solver on the paper's example, and a planted fault for each stage.
step_proofs() {
    by_script "python3, or the solver from its package registry, cannot be had here" tests/proofs/run.sh --quick
}

# The reference design in logic: lint, all vectors of its kinds, proofs, planted faults, synthesis.
step_rtl() {
    by_script "some steps of firmware/rtl/test.sh could not run, see above" firmware/rtl/test.sh
}

# The Python package: wheel, sdist, ten lines in an empty environment, its tests on the wheel.
step_python() {
    by_script "some parts of python/test.sh could not run, see above" python/test.sh
}

step_benches() {
    cargo bench --locked -p galpix-bench --no-run
    # Small and quick: that it runs and ends, not how fast it is.
    cargo run --locked --profile bench -p galpix-bench --bin ratios -- 64x64 1
}

# The instructions of a frame, counted: in constant time they must not depend on the picture.
step_constant-time() {
    command -v valgrind >/dev/null || { skip "valgrind is not installed"; return; }
    # The same profile as in the step `benches`.
    cargo run --locked --profile bench -p galpix-bench --bin constant_time -- 96x64
}

# Clippy has already compared every call into the standard library with rust-version; the language itself it does not
# know.
step_msrv() {
    local least
    least="$(sed -n 's/^rust-version = "\(.*\)"/\1/p' Cargo.toml)"
    if ! rustup toolchain list 2>/dev/null | grep -q "^$least"; then
        timeout 300 rustup toolchain install "$least.0" --profile minimal ||
            { skip "Rust $least, the rust-version, cannot be installed here; $(rustc --version) is"; return; }
    fi
    CARGO_TARGET_DIR=target/msrv cargo "+$(rustup toolchain list | sed -n "s/^\($least[.0-9]*\).*/\1/p" | head -n 1)" \
        check --locked -p galpix-core -p galpix-sim --all-features
}

# What is published: the package is complete and builds by itself, from what is already fetched. Licences and bans where
# cargo-deny is installed.
step_package() {
    cargo package --locked --offline --allow-dirty -p galpix-core
    if cargo deny --version >/dev/null 2>&1; then
        cargo deny --offline check bans licenses sources
    else
        skip "the package is complete, but cargo-deny is not installed: cargo install cargo-deny"
    fi
}

# Two minutes of cases made by a coverage-guided fuzzer, for each importer.
step_fuzz() {
    by_script "the fuzzer cannot be built here, see above" tests/fuzz/run.sh
}

# The firmware in the emulator: build for each board, run, compare with the simulator.
step_firmware() {
    by_script "some steps of firmware/test.sh could not run, see above" firmware/test.sh
}

# --- running them ----------------------------------------------------------------------------------------------------

# Runs a step, and records for tests/assurance/assurance.py when it ran and how it ended.
record_step() {
    run_step "$1"
    mkdir -p target
    [ -f target/test-steps.csv ] || echo "step,seconds,result,date,commit" >target/test-steps.csv
    printf '%s,%d,%s,%s,%s\n' "$1" "$took" "${word%%:*}" "$(date -u +%F)" \
        "$(git rev-parse --short HEAD 2>/dev/null || echo unknown)" >>target/test-steps.csv
}

# Prints what a step printed while others ran, and counts how it ended.
collect() {
    local log="$1" line
    cat "$log"
    line="$(tail -n 1 "$log.summary" || echo "$concurrent: FAILED, it ended without a summary")"
    summary+=("$line")
    case "$line" in
        *passed) passed=$((passed + 1)) ;;
        *skipped:*) skipped=$((skipped + 1)) ;;
        *) failed=$((failed + 1)) ;;
    esac
}

main() {
    local name concurrent log chosen=("$@")
    if [ "${1:-}" = --list ]; then
        printf '%s\n' "${STEPS[@]}"
        return
    fi
    [ "$#" -gt 0 ] || chosen=("${STEPS[@]}")
    [ "${1:-}" != quick ] || chosen=("${QUICK[@]}")
    for name in "${chosen[@]}"; do
        [[ " ${STEPS[*]} ${QUICK[*]} " == *" $name "* ]] || { echo "there is no step \"$name\": ./test.sh --list names them" >&2; exit 2; }
    done
    install_missing
    # The firmware is a workspace of its own, with its own target folder: it runs while the others do.
    concurrent=""
    [[ "${#chosen[@]}" = 1 || " ${chosen[*]} " != *" firmware "* ]] || concurrent=firmware
    if [ -n "$concurrent" ]; then
        log="$(mktemp)"
        say "$concurrent: runs while the other steps do, and is printed after them"
        { record_step "$concurrent"; printf '%s\n' "${summary[@]}" >"$log.summary"; } >"$log" 2>&1 &
    fi
    for name in "${chosen[@]}"; do [ "$name" = "$concurrent" ] || record_step "$name"; done
    if [ -n "$concurrent" ]; then
        wait
        collect "$log"
        rm -f "$log" "$log.summary"
    fi
    print_summary
    [ "$failed" = 0 ]
}

main "$@"
