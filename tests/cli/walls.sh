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

# The menu is whole on a screen of a desk and on a wall of 2.4 m without a ceiling: the edges of their pictures are the dark room.
cat > edges.py <<'END'
import struct, sys, zlib
data = open(sys.argv[1], 'rb').read()
width, height, depth, kind = struct.unpack('>IIBB', data[16:26])
at, packed = 8, b''
while at < len(data):
    length, name = struct.unpack('>I4s', data[at:at + 8])
    if name == b'IDAT': packed += data[at + 8:at + 8 + length]
    at += 12 + length
raw, size = zlib.decompress(packed), {2: 3, 6: 4}[kind]
rows, before = [], bytes(width * size)
for y in range(height):
    filter_type, line = raw[y * (width * size + 1)], bytearray(raw[y * (width * size + 1) + 1:(y + 1) * (width * size + 1)])
    for i in range(len(line)):
        a, b, c = (line[i - size] if i >= size else 0), before[i], (before[i - size] if i >= size else 0)
        p = a + b - c
        paeth = a if abs(p - a) <= abs(p - b) and abs(p - a) <= abs(p - c) else b if abs(p - b) <= abs(p - c) else c
        line[i] = (line[i] + [0, a, b, (a + b) // 2, paeth][filter_type]) % 256
    rows.append(bytes(line))
    before = bytes(line)
pixel = lambda x, y: rows[y][x * size:x * size + 3]
edge = {pixel(x, y) for x in range(width) for y in (0, height - 1)} | {pixel(x, y) for x in (0, width - 1) for y in range(height)}
inside = {pixel(x, y) for x in range(width) for y in range(height)}
assert len(edge) == 1 and len(inside) > 50, (len(edge), len(inside))
END
for kind in desk tall; do
    if [[ $kind = desk ]]; then corners='"lower_left_m": [-0.72, 0.75, -0.3], "lower_right_m": [0.72, 0.75, -0.3], "upper_right_m": [0.72, 1.56, -0.3]' head='0, 1.2, 0.45'
    else corners='"lower_left_m": [-1.5, 0, -1.5], "lower_right_m": [1.5, 0, -1.5], "upper_right_m": [1.5, 2.4, -1.5]' head='0, 2.1, 0.3'; fi
    cat > $kind.json <<END
{ "format": "boltwright displays 1", "head": { "tracker": "fixed", "fixed": { "position_m": [$head] } },
  "walls": [ { "name": "screen", $corners, "output": { "position_px": [600, 300], "resolution_px": [576, $([[ $kind = desk ]] && echo 324 || echo 460)] } } ] }
END
    "$bin/boltwright" train first-nut --silent --validate --size 280x180 --displays $kind.json --out out 2>log >/dev/null &
    player=$!
    whole() { shows menu-$kind 600 300 576 $([[ $kind = desk ]] && echo 324 || echo 460) 8000 && python3 edges.py "$pictures/menu-$kind.png"; }
    check "the menu is whole ($kind)" eventually whole
    kill -INT $player
    check "the program ends ($kind)" wait $player
    player=
done

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
