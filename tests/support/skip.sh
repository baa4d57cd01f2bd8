# For test scripts, sourced with the test's name: reports what a script does not check on this machine or in this build, as
# skip.hpp does for programs.
skip_name=$1

# skip_part 'what is left out: reason'; the script continues.
skip_part() { report_skip "SKIPPED IN PART: $skip_name: $1"; }

# skip_all 'reason'; ends the script. ctest reports it as Skipped (SKIP_RETURN_CODE).
skip_all() {
    report_skip "SKIPPED: $skip_name: $1"
    exit 77
}

report_skip() {
    echo "$1"
    [[ -z ${BOLT_SKIPPED:-} ]] || echo "$1" >> "$BOLT_SKIPPED"
}
