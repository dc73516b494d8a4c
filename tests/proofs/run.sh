#!/usr/bin/env bash
# Proofs by machine, in addition to the exhaustive tests: a solver on the step kernel, and mutants of the passes.
#
#   tests/proofs/run.sh           the solver on all budgets; every mutant of the four stages with cargo-mutants (hours)
#   tests/proofs/run.sh --quick   the solver on the paper's example; a planted mutant for each stage
#   tests/proofs/run.sh --solver  the solver on all budgets alone
#
# Ends with 1 if a proof fails or a mutant survives, with 3 if what it needs cannot be had.
set -euo pipefail
cd "$(dirname "$0")/../.."

venv=target/proofs/venv
vectors=target/proofs/vectors

solver() {
    command -v python3 >/dev/null || { echo "python3 is missing: install it to run the solver" >&2; exit 3; }
    if ! "$venv/bin/python" -c 'import bitwuzla, jsonschema' 2>/dev/null; then
        echo "installing the solver into $venv"
        { python3 -m venv "$venv" && timeout 300 "$venv/bin/pip" install --quiet -r tests/proofs/requirements.txt; } >&2 ||
            { echo "the solver could not be installed" >&2; exit 3; }
    fi
    # The same flags as the tests, so that nothing is built twice.
    cargo run --locked --quiet --release -- vectors --out "$vectors" >/dev/null
    export PYTHONDONTWRITEBYTECODE=1
    "$venv/bin/python" tests/proofs/schema.py "$vectors"
    "$venv/bin/python" tests/proofs/prove.py "$@" "$vectors"
}

case "${1:-}" in
    --solver) solver ;;
    --quick)
        solver --quick
        python3 tests/proofs/planted.py
        ;;
    "")
        solver
        cargo mutants --version >/dev/null 2>&1 || cargo install --locked cargo-mutants
        files=()
        for stage in frame/step frame/resolve frame/edge fast/fill; do files+=(--file "galpix-core/src/$stage.rs"); done
        cargo mutants --package galpix-core --test-package galpix-golden --profile mutants --output target/proofs \
            --minimum-test-timeout 20 "${files[@]}"
        ;;
    *)
        echo "\"$1\" is not understood: give nothing, --quick or --solver" >&2
        exit 2
        ;;
esac
