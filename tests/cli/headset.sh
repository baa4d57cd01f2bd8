#!/usr/bin/env bash
# A lesson in a headset, on the mock runtime of tests/mock_openxr: headset.sh BIN SOURCES, on a screen (with_screen.sh).
. "$(dirname "$0")/checks.sh"
manifest=${bin%/bin}/mock_openxr/mock_openxr.json
train=("$bin/boltwright" train --start --silent --validate --full-resolution --size 160x120)

expect 4 'no OpenXR runtime: .*expected an active runtime .*XR_RUNTIME_JSON' env XR_RUNTIME_JSON=/nonexistent.json "${train[@]}" --hmd --out never
expect 2 'a simulated trainee wears no headset' "$bin/boltwright" train --headless --hmd --out never
expect 2 'mirror: all not in .*left,right,both,panel' "${train[@]}" --hmd --mirror all --out never
expect 2 '"maybe"; expected optional, or no value' "$bin/boltwright" train cover-m8 --hmd maybe --out never

export XR_RUNTIME_JSON=$manifest
violations() { grep -c '^violation' "$1"; }
# The user stands, looks down, closes the right hand, takes the headset off for a moment, and ends the program in the
# headset's menu.
cat >script <<END
0 config width 96
0 config height 90
0 report $work/report
1 head 0 1.65 0 -0.2164 0 0 0.9763
6 hand right active 1
6 hand right grip 0.05 1.15 -0.35 0 0 0 1
12 picture $work/before.ppm
14 hand right squeeze 1
16 event stopping
40 event ready
60 picture $work/after.ppm
66 exit
END
export MOCK_OPENXR_SCRIPT=$work/script
expect 0 'headset: Mock headset with Mock runtime' timeout 200 "${train[@]}" --hmd first-nut --mirror both --out lesson
check 'the lesson was recorded' test -s lesson/session.boltwright
check 'the runtime was used correctly' test "$(violations report)" = 0
check 'frames were shown until the user ended the program' grep -qE 'drawn [1-9][0-9]' report
for picture in before after; do
    check "both eyes see the workplace ($picture)" python3 - $picture.ppm <<'END'
import sys
data = open(sys.argv[1], 'rb').read()
kind, width, height, most, rest = data.split(maxsplit=4)
assert (kind, width, height) == (b'P6', b'192', b'90'), data[:20]
rest = data[-3 * 192 * 90:]
rows = [rest[3 * 192 * y:3 * 192 * (y + 1)] for y in range(90)]
left, right = b''.join(r[:288] for r in rows), b''.join(r[288:] for r in rows)
assert left != right                       # parallax
assert len(set(left)) > 60                 # a scene, not a colour
END
done

# The headset lies on a table when the program begins, then its user puts it on; later the user turns round and presses the headset's
# button that moves the seated space only, and a moment later takes it off: the runtime senses that and keeps the session's focus.
cat >script <<END
0 config width 240
0 config height 220
0 config with XR_EXT_user_presence
0 report $work/report
1 head 0.5 0.78 0.4 0 0.7071 0 0.7071
8 head 0 1.65 0 -0.1 0 0 0.995
24 picture $work/worn.ppm
28 head 0 1.65 0 0 1 0 0
32 picture $work/turned.ppm
34 event recentre seated
44 picture $work/recentred.ppm
48 event not_worn
52 exit
END
rm -f report
expect 0 'headset: Mock headset' timeout 200 "$bin/boltwright" train --silent --validate --full-resolution --size 160x120 --hmd first-nut --mirror panel --out placed
check 'the runtime was used correctly' test "$(violations report)" = 0
check 'the menu is in front of the user, before and after' python3 - worn.ppm turned.ppm recentred.ppm <<'END'
import sys
def shows_panel(name):  # the menu is dark with bright text; without it the empty room has few edges
    data = open(name, 'rb').read()[-3 * 480 * 220:]
    gray = [sum(data[i:i + 3]) for i in range(0, len(data), 3)]
    edges = sum(abs(gray[y * 480 + x] - gray[y * 480 + x + 1]) > 120 for y in range(70, 150) for x in range(60, 180))
    return edges
worn, turned, recentred = [shows_panel(name) for name in sys.argv[1:]]
assert worn > 100 and recentred > 100 and turned < 50, (worn, turned, recentred)
END

# The user wants to see the real room, with headsets that can show it by blending or as a layer, and with one that cannot.
echo '{"format": "boltwright settings 1", "trainee": "Ada", "language": "en", "volume": 1, "captions": false, "palette": "usual",
 "left_handed": false, "force_scale": 1, "surroundings": true, "seated_height_m": null, "keys": {}}' >settings.json
for passthrough in 1 layer 0; do
    kind="passthrough $passthrough"
    [[ $passthrough != layer ]] || kind='with XR_FB_passthrough'
    cat >script <<END
0 config width 64
0 config height 60
0 config $kind
0 report $work/report
1 head 0 1.65 0 -0.2164 0 0 0.9763
12 picture $work/room-$passthrough.ppm
20 exit
END
    rm -f report
    expect 0 'headset: Mock headset' timeout 200 "${train[@]}" --settings settings.json --hmd first-nut --out "room-$passthrough"
    check 'the runtime was used correctly' test "$(violations report)" = 0
    [[ $passthrough = 0 ]] || check 'the room is requested from a headset that can show it' grep -q '^blended [1-9]' report
done
check 'a headset that cannot show the room shows the workshop' grep -q '^blended 0$' report
check 'in one that can, most of the picture is the real room' python3 - room-1.ppm room-layer.ppm room-0.ppm <<'END'
import sys
def black(name):
    data = open(name, 'rb').read()[-3 * 128 * 60:]
    return sum(data[i:i + 3] == b'\0\0\0' for i in range(0, len(data), 3)) / (128 * 60)
assert black(sys.argv[1]) > 0.4 and black(sys.argv[2]) > 0.4 and black(sys.argv[3]) < 0.05, [black(name) for name in sys.argv[1:]]
END

# The headset's session ends in the middle of a lesson: the lesson goes on in the window, and the headset is found again.
cat >script <<END
0 config width 64
0 config height 60
0 report $work/report
1 head 0 1.65 0 -0.2164 0 0 0.9763
10 event instance_loss
END
rm -f report
"${train[@]}" --hmd first-nut --out lost >log 2>&1 &
player=$!
found_twice() { [[ $(grep -c "^headset: 2 eye" log 2>/dev/null) -ge 2 ]]; }
check 'the headset is found again' eventually found_twice
kill -INT $player
check 'the program ends in order' wait $player
player=
check 'the loss is told' grep -q 'the headset is lost: ' log
check 'nothing was done wrong meanwhile' test "$(violations report)" = 0
check 'the lesson was recorded until the end' test -s lost/session.boltwright

# Until there is a headset, the window is used.
export XR_RUNTIME_JSON=$work/later.json
cat >script <<END
0 config width 64
0 config height 60
END
: >log
"${train[@]}" --hmd optional first-nut --out optional >log 2>&1 &
player=$!
check 'its absence is told' eventually grep -qs 'no OpenXR runtime' log
check 'the lesson begins in the window' eventually grep -q 'lesson begun' log
cp "$manifest" later.json
check 'it is used when it appears' eventually grep -q '^headset: 2 eye' log
kill -INT $player
check 'the program ends in order' wait $player
player=
check 'one line tells of the absence' test "$(grep -c 'no OpenXR runtime' log)" = 1

# A headset that appears during a lesson and fails leaves the lesson in the window, with one line; it is used when it works.
refused='the headset cannot be used, and the window is used without it'
expect_refusal() {  # expect_refusal REASON OUT LINE: the script has this line
    printf '0 config width 64\n0 config height 60\n%s\n' "$3" >script
    rm -f later.json
    : >log  # the earlier program's lines must not answer for this one
    "${train[@]}" --hmd optional first-nut --out "$2" >log 2>&1 &
    player=$!
    check "the lesson begins in the window ($3)" eventually grep -qs 'lesson begun' log
    cp "$manifest" later.json
    check "one line says why the headset is not used ($3)" eventually grep -q "$refused: .*$1" log
    [[ $3 = *foreign* ]] || check "it is used when it works ($3)" eventually grep -q '^headset: 2 eye' log
    check "the program still runs ($3)" kill -0 $player
    kill -INT $player
    check "the program ends in order ($3)" wait $player
    player=
    check "the reason is told once ($3)" test "$(grep -c "$refused" log)" = 1
    check "the lesson was recorded ($3)" test -s "$2/session.boltwright"
}
expect_refusal 'xrCreateVulkanInstanceKHR returned' fails1 '0 fail xrCreateVulkanInstanceKHR -2 1'
expect_refusal 'xrGetVulkanGraphicsDevice2KHR returned' fails2 '0 fail xrGetVulkanGraphicsDevice2KHR -38 2'
expect_refusal 'xrCreateVulkanDeviceKHR returned' fails3 '0 fail xrCreateVulkanDeviceKHR -2 1'
expect_refusal 'xrCreateSession returned' fails4 '0 fail xrCreateSession -2 1'
expect_refusal 'connected to a GPU that Vulkan does not list' fails5 '0 config foreign_gpu 1'

# With --hmd the program needs the headset.
export XR_RUNTIME_JSON=$manifest
for line in '0 fail xrCreateVulkanInstanceKHR -2 1' '0 fail xrGetVulkanGraphicsDevice2KHR -38 1' '0 fail xrCreateVulkanDeviceKHR -2 1' \
    '0 fail xrCreateSession -2 1' '0 config foreign_gpu 1'; do
    echo "$line" >script
    word=${line#0 }
    word=${word#* }
    word=${word%% *}
    expect 4 "${word/foreign_gpu/a GPU that Vulkan does not list}" timeout 100 "${train[@]}" --hmd first-nut --out never
done
# The GPU that the user chooses must be the headset's.
echo >script
expect 4 "the headset's GPU, .*, does not match \"nonesuch\"" timeout 100 "${train[@]}" --gpu nonesuch --hmd first-nut --out never
echo '30 exit' >script
expect 0 'headset: 2 eye' timeout 200 "${train[@]}" --gpu llvmpipe --hmd first-nut --mirror right --out chosen

printf '0 config width 64\n0 config height 60\n' >script

# A lesson with an arm that is registered to the room begins after a touch of the check point. The axes of the emulated arm are x to the
# user, y to the right, z up.
library=lib/release/lin-x86_64-gcc/libdrd.so.3
mkdir -p "sdk/${library%/*}"
cp "${bin%/bin}/emulated/force_dimension/libdrd.so.3" "sdk/$library"
export XR_RUNTIME_JSON=$manifest FDSDK=$work/sdk EMULATED_ARM_INITIALIZED=1 EMULATED_ARM_HAND=$work/hand
place() {  # place X Y Z BUTTONS: holds the handle at a point of the frame "arm"
    echo "$3 $1 $2 $4" > hand.new
    mv hand.new hand
}
cat >station.json <<'END'
{"format": "boltwright station 1", "arm": {"device": "force-dimension:0", "scale": 1},
 "registrations": [{"from": "arm", "to": "room", "date": "2026-03-02T09:15:00Z", "position_m": [0, 1, -0.5],
  "orientation_wxyz": [1, 0, 0, 0], "points": 6, "rms_m": 0.001,
  "check_point": {"from_m": [0.02, 0.01, 0.03], "to_m": [0.02, 1.01, -0.47]}}]}
END
# The user looks down at the check point, and reads the request on the panel.
cat >script <<END
0 config width 240
0 config height 200
0 follow $work/commands
1 head 0 1.65 0 -0.2164 0 0 0.9763
END
place 0.05 0.05 -0.04 0
: >log
"${train[@]}" --hmd first-nut --station station.json --out touched >log 2>&1 &
player=$!
check 'the arm is registered to the room' eventually grep -q 'picture and arm are aligned' log
shot() {  # shot FILE: a picture of the lesson as it is now
    sleep 2
    echo "picture $work/$1" >commands
    eventually test -s "$1"
    rm commands
    sleep 1  # until the pictures that were requested meanwhile are written
}
shot far.ppm
place 0.02 0.03 0.03 0
shot near.ppm
check 'the request shows the workshop, and the tip of the arm until it is near the check point' python3 - far.ppm near.ppm <<'END'
import sys
def pixels(name):
    data = open(name, 'rb').read()[-3 * 480 * 200:]
    return [tuple(data[i:i + 3]) for i in range(0, len(data), 3)]
far, near = [pixels(name) for name in sys.argv[1:]]
blue = [sum(b > 180 and r < 160 and b > r + 60 for r, g, b in picture) for picture in (far, near)]
assert blue[0] > blue[1] + 40, blue  # the arrow of the tip
assert all(len(set(picture)) > 2000 for picture in (far, near)), [len(set(picture)) for picture in (far, near)]
END
place 0.02 0.016 0.03 0
sleep 1
place 0.02 0.016 0.03 1
check 'a touch of the check point is measured' eventually grep -q "check point is off by 6.0 mm; register the arm again" log
kill -INT $player
check 'the program ends in order' wait $player
player=
check 'no tick of the lesson was played before' grep -q 'lesson ended: not finished' log
finish_checks
