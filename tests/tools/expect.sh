# What the tests of the tools share: sourced by them, with the repository's root in $root and an empty folder $work.
failures=0

# fails_with PATTERN COMMAND...: the command must fail, and say something that matches the pattern.
fails_with() {
    pattern=$1
    shift
    if output=$("$@" 2>&1); then
        echo "FAILED: $* succeeded, but should have said: $pattern"
        failures=$((failures + 1))
    elif ! printf '%s\n' "$output" | grep -qE -- "$pattern"; then
        echo "FAILED: $* said the following instead of: $pattern"
        printf '%s\n' "$output"
        failures=$((failures + 1))
    fi
}

# succeeds_with PATTERN COMMAND...
succeeds_with() {
    pattern=$1
    shift
    if ! output=$("$@" 2>&1) || ! printf '%s\n' "$output" | grep -qE -- "$pattern"; then
        echo "FAILED: $* should have succeeded and said: $pattern"
        printf '%s\n' "$output"
        failures=$((failures + 1))
    fi
}

finish() {
    if [ "$failures" -gt 0 ]; then
        echo "$failures failed"
        exit 1
    fi
    echo "all passed"
    exit 0
}
