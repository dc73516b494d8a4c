# What the scripts of checks share: running steps, each in a subshell of its own, and one line for each at the end.
# Sourced by test.sh, firmware/test.sh and firmware/rtl/test.sh; `label` stands before the names of their steps.
# shellcheck shell=bash
label="" summary=() passed=0 failed=0 skipped=0

say() { printf '\n== %s\n' "$*"; }

# A step calls this and returns: it could not run. Never to be mistaken for "passed".
skip() { skip_reason="$*"; }

# Runs step_NAME; sets `word`, how it ended, and `took`, its seconds.
run_step() {
    local name="$1" started=$SECONDS reason status=0
    skip_reason=""
    say "$label$name"
    # In a subshell of its own, so that its first failing command ends it and not the others.
    reason="$(mktemp)"
    set +e
    ( set -e; "step_$name"; printf '%s' "$skip_reason" >"$reason" )
    status=$?
    set -e
    skip_reason="$(cat "$reason")"
    rm -f "$reason"
    if [ "$status" != 0 ]; then
        word="FAILED" failed=$((failed + 1))
    elif [ -n "$skip_reason" ]; then
        word="skipped: $skip_reason" skipped=$((skipped + 1))
    else
        word="passed" passed=$((passed + 1))
    fi
    took=$((SECONDS - started))
    summary+=("$(printf '%-13s %4d s  %s' "$label$name" "$took" "$word")")
}

# Prints the line of each step, and how many ended in which way.
print_summary() {
    printf '\n'
    printf '%s\n' "${summary[@]}"
    printf '%d passed, %d failed, %d skipped\n' "$passed" "$failed" "$skipped"
}

# Ends a script that runs as a step of another: with 1 if a step failed, with 3 if none did but some could not run.
finish() {
    print_summary
    [ "$failed" = 0 ] || exit 1
    [ "$skipped" = 0 ] || exit 3
}
