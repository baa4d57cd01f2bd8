# Functions for scripts that run the programs like users: source it with the folders of the programs and of the sources as $1
# and $2. It changes to a temporary folder, which it removes at the end, and counts passed and failed checks.
set -uo pipefail
bin=$1
sources=$2
. "$sources/tests/support/skip.sh" "$(basename "$0" .sh)"
export BOLTWRIGHT_CONTENT=$sources/content
work=$(mktemp -d)
player=  # process id of a program that runs in the background
trap '[[ -z $player ]] || kill $player 2>/dev/null; rm -rf "$work"' EXIT
cd "$work" || exit 1
passed=0
failed=0

# Programs with sanitizers take five times as long, so tests that only repeat the same code with more data skip them.
sanitized() { grep -q __asan_init "$bin/boltwright"; }

check() {  # check 'property' command...
    local what=$1
    shift
    if "$@"; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        echo "FAILED: $what"
        [[ ! -s log ]] || tail -5 log  # the output of the program that ran last in the background
    fi
}
expect() {  # expect EXIT_CODE 'pattern of its output' command...
    local code=$1 pattern=$2 output status
    shift 2
    output=$("$@" 2>&1)
    status=$?
    if [[ $status -eq $code ]] && grep -qE -- "$pattern" <<<"$output"; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        echo "FAILED: $* -> exit $status, expected $code and /$pattern/"
        head -5 <<<"$output"
    fi
}
# Repeats a command until it succeeds. Fails after two minutes, or when the background program has ended.
eventually() {
    local i
    for ((i = 0; i < 1200; i++)); do
        "$@" && return
        [[ -z $player ]] || kill -0 "$player" 2>/dev/null || return 1
        sleep 0.1
    done
    return 1
}
# Prints the counts and exits with the result; the last command of each script.
finish_checks() {
    echo "$passed passed, $failed failed"
    [[ $failed -eq 0 && $passed -gt 0 ]]
    exit
}
