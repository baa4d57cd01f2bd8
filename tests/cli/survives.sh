#!/usr/bin/env bash
# The session of a lesson in a window survives a killed program, a full disk and a lost display.
# survives.sh BIN SOURCES, on a screen (with_screen.sh); the last case starts another screen.
. "$(dirname "$0")/checks.sh"

logged() { grep -q "$2" "$1.log"; }
play() { exec "$bin/boltwright" train cover-m8 --start --silent --size 320x200 --out "$1" 2>"$1.log" >"$1.out"; }
ticks() { "$bin/boltwright" export "$1/session.boltwright" --csv - | tail -n +2 | wc -l; }
whole() { [[ ! -e $1/session.boltwright-wal && ! -e $1/session.boltwright.lock && -s $1/summary.json && -s $1/report.html ]]; }
replays() { "$bin/boltwright" replay "$1/session.boltwright" | grep -q 'all as they were recorded'; }
reports() { "$bin/boltwright" report "$1/session.boltwright" --html "$1.html" 2>"$1.complaint" && [[ -s $1.html ]]; }

# Killed. The wrench is taken before, because this prints the time in the lesson.
(play killed) &
victim=$!
taken() {
    logged killed 'in the hand' && return
    xdotool key --window "$(xdotool search --pid $victim | tail -1)" t 2>/dev/null
    sleep 1  # a second press would put it down again
    logged killed 'in the hand'
}
check 'a lesson begins' eventually logged killed step_begin
check 'T takes the wrench' eventually taken
kill -9 $victim
wait $victim 2>/dev/null
at=$(sed -n 's/^ *\([0-9.]*\) s  the wrench is in the hand.*/\1/p' killed.log | head -1)
kept=$(ticks killed)
check "killed after $at s it has kept $kept ticks" awk -v at="${at:-1e9}" -v kept="$kept" 'BEGIN { exit !(kept >= 1000 * (at - 1)) }'
check 'a killed session is replayed' replays killed
check 'a killed session is reported' reports killed
check 'the report states that the session was cut short' grep -q 'cut short' killed.complaint

# The file size limit of 120 KB allows some seconds of recording. Newer software drivers keep their memory in files too, and end
# the program with SIGBUS (135) when these cannot grow.
(ulimit -f 120 && exec "$bin/boltwright" render cover-m8 --size 1920x1080 --png limited.png >/dev/null 2>&1)
if [ $? = 135 ]; then
    skip_part 'a full disk during a lesson in a window: this driver ends the program where a file may not grow'
else
    (ulimit -f 120 && play full)
    status=$?
    check "a full disk gives exit code 1, not $status" [ $status = 1 ]
    check 'a full disk is reported, with the time that is kept' grep -Eq 'full/session.boltwright: cannot be written: .*the recording up to [0-9.]+ s is kept' full.log
    up_to=$(sed -n 's/.*recording up to \([0-9.]*\) s is kept.*/\1/p' full.log)
    kept=$(ticks full)
    check "the recording has $kept ticks, for the reported $up_to s" awk -v s="${up_to:-0}" -v kept="$kept" 'BEGIN { exit !(s >= 1 && kept == 1000 * s) }'
    check 'the session of the full disk is replayed' replays full
    check 'the session of the full disk is reported' reports full
fi

# The display is lost: its X server, started by with_screen.sh, is killed.
BIN=$bin BOLTWRIGHT_CONTENT=$BOLTWRIGHT_CONTENT "$sources/tests/with_screen.sh" bash -c '
    "$BIN/boltwright" train cover-m8 --start --silent --size 320x200 --out gone 2>gone.log >gone.out &
    lesson=$!
    for _ in $(seq 1200); do grep -q step_begin gone.log && [[ -s gone/session.boltwright-wal ]] && break; sleep 0.1; done
    kill "$(pgrep -P $PPID -x Xvfb)"
    wait $lesson
    echo $? >gone.status'
check "a lost display gives exit code 1, not $(cat gone.status)" [ "$(cat gone.status)" = 1 ]
check 'the lost display is reported' logged gone 'the display has ended'
check 'no message of Xlib is printed' [ "$(grep -ci 'xlib\|X connection' gone.log)" = 0 ]
check 'the lesson was ended, its session completed, and a report written' whole gone
check 'the session of the lost display is replayed' replays gone
check 'the session of the lost display is reported' reports gone
[[ ! -s gone.complaint ]] || check "nothing is missing: $(cat gone.complaint)" false
finish_checks
