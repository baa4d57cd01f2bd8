#!/usr/bin/env bash
# From start to holding the wrench, by somebody who has read nothing and does what the screen says: Enter in the menu, T for
# the wrench. walk.sh BIN SOURCES PICTURES, on a screen of its own (with_screen.sh). What it saw is in PICTURES.
. "$(dirname "$0")/checks.sh"
pictures=$3
mkdir -p "$pictures"
rm -f "$pictures"/*
said() { grep -q "$1" log; }
picture() { cp "$BOLT_SCREEN" "$pictures/$1.xwd"; }
key() { xdotool key --window "$(xdotool search --pid $player | tail -1)" "$1"; }

HOME=$work XDG_DATA_HOME=$work "$bin/boltwright" train cover-m8 --silent --size 640x400 --out out 2>log >/dev/null &
player=$!
shown() { [[ -n $(xdotool search --pid $player 2>/dev/null) ]]; }
check 'a window opens' eventually shown
began() {
    said 'lesson begun' && return
    key Return 2>/dev/null
    sleep 1
    said 'lesson begun'
}
sleep 2
picture 1-menu
check 'Enter begins the lesson' eventually began
sleep 2
picture 2-lesson
holds() {
    said 'in the hand' && return
    key t 2>/dev/null
    sleep 3  # a second press would lay it down again
    said 'in the hand'
}
check 'T takes the wrench' eventually holds
sleep 1
picture 3-wrench
after=$(sed -n 's/^ *\([0-9.]*\) s  the wrench is in the hand.*/\1/p' log | head -1)
echo "holds the wrench $after s after the lesson has begun, by two keys"
check 'within a minute of the lesson' awk -v after="${after:-1e9}" 'BEGIN { exit !(after <= 60) }'
kill -INT $player
check 'an orderly end' wait $player
player=
check 'it leaves a report' test -s out/report.html
tell_and_leave
