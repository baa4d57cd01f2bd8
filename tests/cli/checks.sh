# For scripts that use the programs as people do: sourced with the folder of the programs and of the sources as $1 and $2.
# Goes to a folder of its own, which goes with the script, and counts what was so and what was not.
set -uo pipefail
bin=$1
sources=$2
. "$sources/tests/support/skip.sh" "$(basename "$0" .sh)"
export BOLTWRIGHT_CONTENT=$sources/content
work=$(mktemp -d)
player=  # a program that somebody is at
trap '[[ -z $player ]] || kill $player 2>/dev/null; rm -rf "$work"' EXIT
cd "$work" || exit 1
passed=0
failed=0

# Programs built with sanitizers take five times as long: what only repeats the same code on more data is left to the others.
sanitized() { grep -q __asan_init "$bin/boltwright"; }

check() {  # check 'what' command...
    local what=$1
    shift
    if "$@"; then passed=$((passed + 1)); else failed=$((failed + 1)); echo "FAILED: $what"; fi
}
expect() {  # expect CODE 'pattern of what it says' command...
    local code=$1 pattern=$2 said status
    shift 2
    said=$("$@" 2>&1)
    status=$?
    if [[ $status -eq $code ]] && grep -qE -- "$pattern" <<<"$said"; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        echo "FAILED: $* -> exit $status, wanted $code and /$pattern/"
        head -5 <<<"$said"
    fi
}
# A command, until it succeeds; for two minutes at most, and for as long as whoever is waited for lives.
eventually() {
    local i
    for ((i = 0; i < 1200; i++)); do
        "$@" && return
        [[ -z $player ]] || kill -0 "$player" 2>/dev/null || return 1
        sleep 0.1
    done
    return 1
}
# The way out of a script.
tell_and_leave() {
    echo "$passed passed, $failed failed"
    [[ $failed -eq 0 && $passed -gt 0 ]]
    exit
}
