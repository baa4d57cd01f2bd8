#!/usr/bin/env bash
# From the start of the program to the wrench in the hand, by following the instructions on the screen: Enter in the menu, T
# for the wrench. walk.sh BIN SOURCES PICTURES, on a screen (with_screen.sh); writes screenshots to the folder PICTURES.
. "$(dirname "$0")/checks.sh"
pictures=$3
mkdir -p "$pictures"
rm -f "$pictures"/*
logged() { grep -q "$1" log; }
picture() { cp "$BOLT_SCREEN" "$pictures/$1.xwd"; }
key() { xdotool key --window "$(xdotool search --pid $player | tail -1)" "$1"; }

HOME=$work XDG_DATA_HOME=$work "$bin/boltwright" train cover-m8 --silent --size 640x400 --out out 2>log >/dev/null &
player=$!
shown() { [[ -n $(xdotool search --pid $player 2>/dev/null) ]]; }
check 'a window opens' eventually shown
began() {
    logged 'lesson begun' && return
    key Return 2>/dev/null
    sleep 1
    logged 'lesson begun'
}
sleep 2
picture 1-menu
check 'Enter begins the lesson' eventually began
sleep 2
picture 2-lesson
holds() {
    logged 'in the hand' && return
    key t 2>/dev/null
    sleep 3  # a second press would put it down again
    logged 'in the hand'
}
check 'T takes the wrench' eventually holds
sleep 1
picture 3-wrench
after=$(sed -n 's/^ *\([0-9.]*\) s  the wrench is in the hand.*/\1/p' log | head -1)
echo "holds the wrench $after s after the lesson has begun, by two keys"
check 'the wrench is in the hand within a minute of the lesson' awk -v after="${after:-1e9}" 'BEGIN { exit !(after <= 60) }'
kill -INT $player
check 'an interrupt ends the program with exit code 0' wait $player
player=
check 'the interrupted lesson has a report' test -s out/report.html
finish_checks
