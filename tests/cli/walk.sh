#!/usr/bin/env bash
# From start to holding the wrench, by somebody who has read nothing and does what the screen says: Enter in the menu, T for
# the wrench. walk.sh BIN SOURCES PICTURES, on a screen of its own (with_screen.sh). What it saw is in PICTURES.
set -uo pipefail
bin=$1
export BOLTWRIGHT_CONTENT=$2/content
pictures=$3
mkdir -p "$pictures"
rm -f "$pictures"/*
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0
fail() {
    echo "FAILED: $1"
    failed=1
}
eventually() {
    for _ in $(seq 1200); do
        "$@" && return
        sleep 0.1
    done
    return 1
}
said() { grep -q "$1" "$work/log"; }
picture() { cp "$BOLT_SCREEN" "$pictures/$1.xwd"; }
key() { xdotool key --window "$(xdotool search --pid $player | tail -1)" "$1"; }

HOME=$work XDG_DATA_HOME=$work "$bin/boltwright" train cover-m8 --silent --size 640x400 --out "$work/out" 2>"$work/log" >/dev/null &
player=$!
shown() { [[ -n $(xdotool search --pid $player 2>/dev/null) ]]; }
eventually shown || fail 'a window opens'
began() {
    said 'lesson begun' && return
    key Return 2>/dev/null
    sleep 1
    said 'lesson begun'
}
sleep 2
picture 1-menu
eventually began || fail 'Enter begins the lesson'
sleep 2
picture 2-lesson
holds() {
    said 'in the hand' && return
    key t 2>/dev/null
    sleep 3  # a second press would lay it down again
    said 'in the hand'
}
eventually holds || fail 'T takes the wrench'
sleep 1
picture 3-wrench
after=$(sed -n 's/^ *\([0-9.]*\) s  the wrench is in the hand.*/\1/p' "$work/log" | head -1)
echo "holds the wrench $after s after the lesson has begun, by two keys"
awk -v after="${after:-1e9}" 'BEGIN { exit !(after <= 60) }' || fail 'within a minute of the lesson'
kill -INT $player
wait $player || fail "an orderly end, not $?"
[[ -s $work/out/report.html ]] || fail 'it leaves a report'
exit $failed
