#!/usr/bin/env bash
# Feeds each importer with what a coverage-guided fuzzer makes of small files that are right. No crash, no sentence of
# more than one line, no case beyond a second of the processor, no more than 1 GiB.
#
#   tests/fuzz/run.sh               two minutes or so: as many executions of each as below, the same ones in each run
#   tests/fuzz/run.sh 3600          so many seconds in all
#   tests/fuzz/run.sh 60 exr npy    these importers alone
#
# What a run finds worth keeping stays in target/fuzz/<importer>; a case that fails is kept as target/fuzz/<importer>-*.
# Each run adds its executions to target/fuzz/executions.txt. Ends with 1 if a case fails, with 3 if the fuzzer cannot
# be built here.
set -euo pipefail
cd "$(dirname "$0")/../.."

# Executions of an importer in a run without a number of seconds, from one seed: a run that passed passes again.
RUNS=300000
seconds="${1:-0}"
[[ "$seconds" = 0 || "$seconds" =~ ^[1-9][0-9]*$ ]] || { echo "$0: the first argument is a number of seconds" >&2; exit 2; }
shift || true
importers=("$@")
[ "$#" -gt 0 ] || importers=(manifest png jpeg exr npy npz pfm pieh poses obj)
work="$PWD/target/fuzz"
cores="$(nproc)"

command -v c++ >/dev/null || command -v g++ >/dev/null || { echo "the fuzzer needs a C++ compiler" >&2; exit 3; }
# What the fuzzer's runtime wants of the compiler: counters at edges, and what is compared. These flags are stable.
coverage="-Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 -Cllvm-args=-sanitizer-coverage-inline-8bit-counters"
coverage+=" -Cllvm-args=-sanitizer-coverage-pc-table -Cllvm-args=-sanitizer-coverage-trace-compares --cfg fuzzing"
# With a target named, build scripts and macros are built without them.
host="$(rustc -vV | sed -n 's/^host: //p')"
RUSTFLAGS="$coverage" CARGO_TARGET_DIR="$work/build" cargo build --locked --release --quiet --target "$host" \
    --manifest-path tests/fuzz/Cargo.toml
binary="$work/build/$host/release/importers"

# Fuzzes one importer; prints a line.
one() {
    local importer="$1" log="$work/$1.log" status=0 runs
    mkdir -p "$work/$importer"
    IMPORTER="$importer" SEEDS="$work/$importer" "$binary" "${limit[@]}" -timeout=60 -rss_limit_mb=1024 \
        -max_len=4096 -print_final_stats=1 -artifact_prefix="$work/$importer-" "$work/$importer" >"$log" 2>&1 || status=$?
    runs="$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")"
    printf '%s %s\n' "$importer" "${runs:-0}" >>"$work/executions.txt"
    printf '%-9s %9s executions, %5s features, peak %4s MiB  %s\n' "$importer" "${runs:-0}" \
        "$(sed -n 's/.* ft: \([0-9]*\).*/\1/p' "$log" | tail -n 1)" \
        "$(sed -n 's/^stat::peak_rss_mb: *//p' "$log")" "$([ "$status" = 0 ] && echo "no failure" || echo "FAILED, see $log")"
    return "$status"
}

each=$((seconds * cores / ${#importers[@]}))
limit=(-max_total_time="$((each > 0 ? each : 1))")
[ "$seconds" != 0 ] || limit=(-runs="$RUNS" -seed=1)
failed=0 running=()
collect() { wait "${running[0]}" || failed=1; running=("${running[@]:1}"); }
for importer in "${importers[@]}"; do
    [ "${#running[@]}" -lt "$cores" ] || collect
    one "$importer" &
    running+=($!)
done
while [ "${#running[@]}" -gt 0 ]; do collect; done
awk '{ n += $2 } END { printf "%d executions so far, of all runs\n", n }' "$work/executions.txt"
exit "$failed"
