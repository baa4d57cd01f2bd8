#!/usr/bin/env bash
# Skipped tests never count as passed: exit codes of a test program (probe.cpp), lines, and the list that ./test prints.
# $1: the program, $2: sources.
set -uo pipefail
probe=$1
support=$2/tests/support
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0
expect() {  # expect CODE LINE TESTS: the exit code and the only line in the file, or none
    local code=$1 line=$2 status
    rm -f "$work/probe.txt"
    BOLT_SKIPPED=$work/probe.txt "$probe" -tc="$3" > "$work/output" 2>&1
    status=$?
    [[ $status -eq $code ]] || { echo "FAILED: $3: exit code $status; expected $code"; failed=1; }
    [[ $(cat "$work/probe.txt" 2>/dev/null) == "$line" ]] || { echo "FAILED: $3: $(cat "$work/probe.txt"); expected $line"; failed=1; }
    [[ -z $line ]] || grep -qxF -- "$line" "$work/output" || { echo "FAILED: $3: the line is not printed"; failed=1; }
}
expect 0 '' 'Probe: checked'
expect 77 'SKIPPED: skip_probe: Probe: skipped: no reason at all' 'Probe: skipped'
expect 0 'SKIPPED IN PART: skip_probe: Probe: skipped in part: half a reason' 'Probe: skipped in part'
expect 0 "SKIPPED IN PART: skip_probe: Probe: skipped in one subcase: second: a subcase's reason" 'Probe: skipped in one subcase'
expect 1 'SKIPPED IN PART: skip_probe: Probe: failed and skipped: too late' 'Probe: failed and skipped'
expect 1 '' 'Probe: unchecked'
expect 0 'SKIPPED: skip_probe: Probe: skipped: no reason at all' 'Probe: skipped,Probe: checked'
expect 1 '' 'Probe: no such test'

mkdir "$work/skipped"
[[ -z $("$support/list_skipped.sh" "$work/skipped" asan) ]] || { echo "FAILED: a list without skipped tests"; failed=1; }
BOLT_SKIPPED=$work/skipped/probe.txt "$probe" -tc='Probe: skipped' > /dev/null
(BOLT_SKIPPED=$work/skipped/script.txt; . "$support/skip.sh" script; skip_all 'a script') > /dev/null
[[ $? -eq 77 ]] || { echo "FAILED: skip_all: exit code $?; expected 77"; failed=1; }
cat > "$work/expected" <<'END'
== asan: skipped, not passed
SKIPPED: script: a script
SKIPPED: skip_probe: Probe: skipped: no reason at all
END
"$support/list_skipped.sh" "$work/skipped" asan | diff "$work/expected" - || failed=1
exit $failed
