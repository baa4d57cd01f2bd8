#!/usr/bin/env bash
# A lesson and the test pattern on projection walls, in three windows of a screen of 1280x800. walls.sh BIN SOURCES PICTURES, on a
# screen (with_screen.sh); writes screenshots to the folder PICTURES.
. "$(dirname "$0")/checks.sh"
pictures=$3
mkdir -p "$pictures"
rm -f "$pictures"/*
# Front and right wall and floor, 100 pixels per m; the right wall in stereo.
cat > walls.json <<'END'
{
  "format": "boltwright displays 1",
  "head": { "tracker": "file", "recording": "head.csv", "hold_s": 0.2, "fade_s": 0.3, "fixed": { "position_m": [0, 1.65, 0.3] } },
  "walls": [
    { "name": "front", "lower_left_m": [-1.5, 0, -1.5], "lower_right_m": [1.5, 0, -1.5], "upper_right_m": [1.5, 2.4, -1.5],
      "output": { "position_px": [0, 200], "resolution_px": [300, 240] } },
    { "name": "right", "lower_left_m": [1.5, 0, -1.5], "lower_right_m": [1.5, 0, 1.5], "upper_right_m": [1.5, 2.4, 1.5],
      "stereo": "side_by_side", "output": { "position_px": [300, 200], "resolution_px": [600, 240] } },
    { "name": "floor", "lower_left_m": [-1.5, 0, 1.5], "lower_right_m": [1.5, 0, 1.5], "upper_right_m": [1.5, 0, -1.5],
      "output": { "position_px": [0, 440], "resolution_px": [300, 300] } }
  ]
}
END
printf 't_s,x_m,y_m,z_m,qw,qx,qy,qz\n0,0,1.65,0.3,1,0,0,0\n0.05,0,1.65,0.3,1,0,0,0\n' > head.csv
take() { "$bin/test_screenshot" "$@"; }
# A wall shows something: its picture as PNG is larger than one of a single colour.
shows() {  # shows NAME X Y WIDTH HEIGHT BYTES
    take "$pictures/$1.png" "${@:2:4}" && [[ $(stat -c %s "$pictures/$1.png") -gt $6 ]]
}
logged() { grep -q "$1" log; }
window() { xdotool search --name "^$1\$" 2>/dev/null | tail -1; }
opened() { [[ -n $(window "$1") ]]; }
place_of() { xdotool getwindowgeometry --shell "$(window "$1")" | grep -E '^(X|Y|WIDTH|HEIGHT)=' | paste -sd' '; }
is_at() { [[ $(place_of "$1") == "X=$2 Y=$3 WIDTH=$4 HEIGHT=$5" ]]; }

# The test pattern, until Escape.
"$bin/boltwright" displays test walls.json --validate >/dev/null 2>log &
player=$!
check 'the window of a wall opens' eventually opened 'Boltwright: floor'
check 'it covers its area' eventually is_at 'Boltwright: right' 300 200 600 240
check 'the front wall shows the pattern' eventually shows pattern-front 0 200 300 240 1500
check 'the right wall too' eventually shows pattern-right 300 200 600 240 2000
check 'and the floor' eventually shows pattern-floor 0 440 300 300 1500
ends() {
    xdotool key --window "$(window 'Boltwright: test pattern')" Escape 2>/dev/null
    sleep 0.5
    ! kill -0 $player 2>/dev/null
}
check 'Escape ends it' bash -c "$(declare -f ends window); for i in \$(seq 100); do player=$player; ends && exit 0; done; exit 1"
check 'without an error or a message of the validation layers' wait $player
player=

# A lesson by mouse: the walls show it; the recording of the head ends, which is reported.
"$bin/boltwright" train first-nut --start --silent --validate --size 280x180 --displays walls.json --out out 2>log >/dev/null &
player=$!
check 'the lesson begins' eventually logged 'lesson begun'
check 'the head is tracked' eventually logged '^head: tracked'
check 'the front wall shows the room' eventually shows lesson-front 0 200 300 240 8000
check 'the right wall shows it to two eyes' eventually shows lesson-right 300 200 600 240 8000
check 'the floor shows the bench' eventually shows lesson-floor 0 440 300 300 8000
check 'the loss of the head is told' eventually logged '^head: not tracked; the fixed pose'
kill -INT $player
check 'an interrupt ends the program with exit code 0' wait $player
player=
check 'the interrupted lesson has a report' test -s out/report.html

# Mistakes: before any window opens.
train=("$bin/boltwright" train first-nut --start --silent --out out --displays)
expect 3 'crossed.json:[0-9]+:' bash -c "sed '0,/\[1.5, 0, -1.5\]/s//[1.5, 0.4, -1.5]/' walls.json > crossed.json; $(printf '%q ' "${train[@]}") crossed.json"
expect 3 'far.json:[0-9]+:[0-9]+: wall "front": the window 300x240\+9000\+200 is not on the monitors; expected' \
    bash -c "sed 's/\[0, 200\]/[9000, 200]/' walls.json > far.json; $(printf '%q ' "${train[@]}") far.json"
expect 3 'none.csv' bash -c "sed 's/head.csv/none.csv/' walls.json > none.json; $(printf '%q ' "${train[@]}") none.json"
expect 4 'OpenXR' env XR_RUNTIME_JSON=/nowhere.json \
    bash -c "sed 's/\"tracker\": \"file\", \"recording\": \"head.csv\"/\"tracker\": \"openxr\"/' walls.json > openxr.json; $(printf '%q ' "${train[@]}") openxr.json"
expect 4 'there is no display' env -u DISPLAY "${train[@]}" walls.json
expect 2 'displays without --headless and --hmd' "${train[@]}" walls.json --headless
expect 2 'displays without --headless and --hmd' "${train[@]}" walls.json --hmd
finish_checks
