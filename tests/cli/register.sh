#!/usr/bin/env bash
# Registration of a station's frames: from files, with the tip of an emulated arm, and with a controller of the mock OpenXR
# runtime. register.sh BIN SOURCES.
. "$(dirname "$0")/checks.sh"
arm=force-dimension:0
library=lib/release/lin-x86_64-gcc/libdrd.so.3
mkdir -p "sdk/${library%/*}"
cp "${bin%/bin}/emulated/force_dimension/libdrd.so.3" "sdk/$library"
run=("$bin/boltwright" station register)

# From a file: the frame is turned by 90 degrees about z and moved by (1, 2, 3).
cat > old.json <<'END'
{"format": "boltwright station 1", "name": "Lab 2", "arm": {"device": "force-dimension:0", "scale": 2.5,
 "buttons": {"dead_man": 3, "clutch": []}}, "wheel": {"device": "1209:ffb0", "reversed": true},
 "glove": {"port": "/dev/ttyUSB0"}}
END
turned() { awk -F, 'BEGIN { print "ax,ay,az,bx,by,bz" } NR > 1 { printf "%s,%s,%s,%.6f,%.6f,%.6f\n", $1, $2, $3, 1 - $2, 2 + $1, 3 + $3 }' "$1"; }
cat > points.csv <<'END'
x,y,z
-0.04,-0.03,-0.04
0.05,-0.03,-0.04
0.05,0.04,-0.03
-0.04,0.04,0.05
0.05,0,0.05
-0.03,-0.04,0.04
0.01,0.02,0.03
END
turned points.csv > pairs.csv
cp old.json s.json
expect 0 'tracker -> room, 6 points' "${run[@]}" s.json --points pairs.csv
check 'the date is that of today' grep -q "\"date\": \"$(date -u +%Y-%m-%dT)" s.json
for kept in '"name": "Lab 2"' '"scale": 2.5' '"dead_man": 3' '"clutch": \[\]' '"reversed": true' ttyUSB0; do
    check "the file keeps $kept" grep -q -- "$kept" s.json
done
check 'the rms is zero' grep -qE '"rms_m": [0-9.]+e-1|"rms_m": 0.0' s.json
expect 0 'off by 0.0 mm' "${run[@]}" s.json --check --points pairs.csv
expect 0 'check point 0.0 mm' "${run[@]}" s.json --points pairs.csv --from workpiece
check 'another pair is added' test "$(grep -c '"from":' s.json)" = 2
expect 0 stored "${run[@]}" s.json --points pairs.csv --from room --to tracker
check 'the same pair is replaced' test "$(grep -c '"from":' s.json)" = 2

# Refused, and stored with --force; the file stays as it is.
awk -F, -v OFS=, 'NR == 6 { $4 += 0.015 } 1' pairs.csv > wrong.csv
cp s.json before.json
expect 1 'error: tracker -> room: the rms is .* mm; expected at most 4 mm; measure point 5 again, or --force' "${run[@]}" s.json --points wrong.csv
awk -F, -v OFS=, 'NR == 8 { $5 += 0.006 } 1' pairs.csv > off.csv
expect 1 'the check point is off by 6.0 mm; expected at most 5 mm' "${run[@]}" s.json --points off.csv
expect 1 'distances in the second frame are 1000 times' "${run[@]}" s.json --points <(awk -F, -v OFS=, 'NR > 1 { for (i = 4; i < 7; i++) $i *= 1000 } 1' pairs.csv)
expect 1 'mirror image' "${run[@]}" s.json --points <(awk -F, -v OFS=, 'NR > 1 { $6 = -$6 } 1' pairs.csv)
expect 1 'lie near a line' "${run[@]}" s.json --points <(awk -F, 'NR == 1; NR > 1 { print NR ",0,0," NR ",0,0" }' pairs.csv)
expect 1 '3 points are too few; expected at least 4' "${run[@]}" s.json --points <(head -4 pairs.csv)
expect 3 'bad.csv:3:4: "nan" is not a coordinate; expected a number of metres' bash -c 'sed "3s/.*/1,2,nan,4,5,6/; 3s/1,2,nan/1, nan,2/" pairs.csv > bad.csv; "$@"' - "${run[@]}" s.json --points bad.csv
expect 3 'is not the title of the columns; expected "ax,ay,az,bx,by,bz"' "${run[@]}" s.json --points points.csv
expect 3 'nowhere.json' "${run[@]}" nowhere.json --points pairs.csv
check 'a refused registration changes nothing' cmp -s s.json before.json
expect 1 'off by .* mm; expected at most 5 mm; register it again' "${run[@]}" s.json --check --points wrong.csv
expect 0 'warning: tracker -> room: the rms is' "${run[@]}" s.json --points wrong.csv --force
check 'with --force it is stored' bash -c '! cmp -s s.json before.json'
expect 2 'is not a frame; did you mean "tracker"' "${run[@]}" s.json --points pairs.csv --from trakcer
for frames in '--from wheel' '--from room --to wheel'; do
    expect 2 'between ".*" and ".*" is not used: a wheel turns one bolt after the other.*; expected a registration of the workpiece or the arm' "${run[@]}" s.json --points pairs.csv $frames
done
expect 2 'are both "room"' "${run[@]}" s.json --points pairs.csv --from room
expect 2 'excludes' "${run[@]}" s.json --points pairs.csv --device $arm
expect 2 'an arm touches the points; expected --from arm' "${run[@]}" s.json --from tracker
expect 2 'the points to touch are not given; expected --targets FILE' "${run[@]}" s.json
expect 2 'excludes' "${run[@]}" s.json --controller right --targets points.csv
expect 2 'requires --controller' "${run[@]}" s.json --targets points.csv --count 8
expect 2 'not in \{left,right\}' "${run[@]}" s.json --controller both
expect 2 'not in range' "${run[@]}" s.json --controller left --count 3
expect 2 'a controller measures points in the room; expected --to room' "${run[@]}" s.json --controller left --to workpiece
expect 2 'excludes' "${run[@]}" s.json --controller left --find-tip --controller-tip 0,0,-0.1
expect 4 'no OpenXR runtime' env XR_RUNTIME_JSON=/nowhere.json "${run[@]}" s.json --controller left
echo '{"format": "boltwright station 1"}' > armless.json
expect 3 'armless.json: the station has no "arm"' "${run[@]}" armless.json --controller left
expect 3 'few.csv: 3 points are too few' bash -c 'head -4 points.csv > few.csv; "$@"' - "${run[@]}" s.json --targets few.csv
expect 3 'has no registration between "arm" and "room"' "${run[@]}" s.json --check
expect 2 'the station.s "arm" is force-dimension:0; expected that device' "${run[@]}" s.json --targets points.csv --device haply:0
expect 4 'there is no device force-dimension:0' "${run[@]}" s.json --targets points.csv
expect 3 '/registrations/0/orientation_wxyz: the quaternion has the length' "${run[@]}" <(tr -d '\n' < s.json | sed -E 's/"orientation_wxyz": *\[ *[^,]*/"orientation_wxyz": [0.1/') --points pairs.csv

# With the tip of an arm. Its axes are x to the user, y to the right, z up; those of the frame "arm" y, z, x.
export FDSDK=$work/sdk EMULATED_ARM_INITIALIZED=1 EMULATED_ARM_HAND=$work/hand
place() {  # place X Y Z BUTTONS: holds the handle at a point of the frame "arm"
    echo "$3 $1 $2 $4" > hand.new
    mv hand.new hand
}
turned points.csv | awk -F, 'BEGIN { print "x,y,z" } NR > 1 { print $4 "," $5 "," $6 }' > targets.csv
asked() { grep -q "^Point $1 of" log; }
touch_points() {  # touch_points FILE: touches each point of the table when it is asked for
    local number=0 x y z
    while IFS=, read -r x y z; do
        number=$((number + 1))
        place "$x" "$y" "$z" 0
        check "point $number is asked for" eventually asked $number
        sleep 0.1
        place "$x" "$y" "$z" 1
        check "point $number is measured" eventually grep -q "^Point $number: measured" log
    done < <(tail -n +2 "$1")
}
place 0 0 0 0
cp old.json s.json
: > log
"${run[@]}" s.json --targets targets.csv --device $arm < /dev/null > out.txt 2> log &
player=$!
touch_points points.csv
check 'the arm is registered' wait $player
player=
check 'its points fit' grep -q 'arm -> room, 6 points' out.txt
check 'the rms is below the resolution of the encoders' grep -qE 'rms 0\.0 mm' out.txt
check 'the check point is stored' grep -q '"check_point"' s.json

# One touch checks the registration: with Enter on the standard input, at the check point and 10 mm beside it.
checked() {  # checked X Y Z: exit code of a check that touches this point
    place "$1" "$2" "$3" 0
    : > log
    (eventually asked 1; sleep 0.2; echo; sleep 3) | "${run[@]}" s.json --check > out.txt 2> log
}
check 'a touch of the check point is right' checked 0.01 0.02 0.03
check 'its error is stated' grep -q 'arm -> room of 20.*: off by 0.0 mm' out.txt
checked 0.02 0.02 0.03
check 'exit code 1 for a touch beside it' test $? = 1
check 'with the distance' grep -q 'off by 10.0 mm; expected at most 5 mm; register it again' log

# If the hand moves, the touch is requested again; an interruption ends the registration.
: > log
place 0 0 0 0
"${run[@]}" s.json --targets targets.csv < /dev/null > out.txt 2> log &
player=$!
check 'a point is asked for' eventually asked 1
sleep 0.2
place 0 0 0 1
sleep 0.1
place 0.01 0 0 1
moved() { grep -q 'the hand moved by .* Once more' log; }
check 'a hand that moves is asked again' eventually moved
kill -INT $player
wait $player
check 'its exit code is 1' test $? = 1
player=
check 'and is stated' grep -q 'the registration was interrupted' log

# With a controller and the arm. The tip of the controller is 0.1 m before its grip, which is turned by 90 degrees about y, so the grip is
# 0.1 m behind the point along x. The frame of the arm is turned and moved as above.
export XR_RUNTIME_JSON=${bin%/bin}/mock_openxr/mock_openxr.json
cat > lacking.txt <<< '0 config without XR_MND_headless'
MOCK_OPENXR_SCRIPT=lacking.txt expect 4 'cannot track without a headset.s pictures: it lacks XR_MND_headless' "${run[@]}" s.json --controller right
cat > script.txt <<END
0 report $work/report.txt
0 follow $work/controller
END
export MOCK_OPENXR_SCRIPT=$work/script.txt
control() {  # control COMMAND...: commands of the mock runtime, one an argument
    printf '%s\n' "$@" > controller.new
    mv controller.new controller
}
hold() {  # hold X Y Z TRIGGER: the tip of the right controller at a point of the room
    control 'hand right active 1' "hand right grip $(awk "BEGIN { print $1 + 0.1 }") $2 $3 0 0.7071067811865476 0 0.7071067811865476" "hand right trigger $4"
}
asked_for() { grep -q "^Point $1 of .*: touch .* with the tip of the $2" log; }
touch_with_both() {  # touch_with_both NUMBER X Y Z AX AY AZ: a point of the room with the controller, one of the arm with the arm
    place 0 0 0 0
    check "point $1 is asked for with the controller" eventually asked_for "$1" controller
    hold "$2" "$3" "$4" 0
    sleep 0.1
    hold "$2" "$3" "$4" 1
    check "point $1 is measured with the controller" eventually grep -q "^Point $1: measured with the controller" log
    check "point $1 is asked for with the arm" eventually asked_for "$1" arm
    place "$5" "$6" "$7" 0
    sleep 0.1
    place "$5" "$6" "$7" 1
    check "point $1 is measured with the arm" eventually grep -qx "Point $1: measured." log
}
start() {  # start OPTION...: registers in the background
    : > log
    place 0 0 0 0
    "${run[@]}" s.json --controller right "${tip[@]}" "$@" < /dev/null > out.txt 2> log &
    player=$!
}
tip=(--controller-tip 0,0,-0.1)
cp old.json s.json
control 'hand right active 0'
start
check 'a controller that is switched off is reported' eventually grep -q 'The controller is not tracked' log
hold 0 0 0 0
check 'and waited for' eventually grep -q 'The controller is tracked again' log
number=0
while IFS=, read -r x y z tx ty tz; do
    number=$((number + 1))
    touch_with_both $number "$tx" "$ty" "$tz" "$x" "$y" "$z"
done < <(tail -n +2 pairs.csv)
check 'the arm is registered with the controller' wait $player
player=
check 'its points fit too' grep -q 'arm -> room, 6 points' out.txt
check 'their rms is zero' grep -qE 'rms 0\.0 mm' out.txt
check 'the position of the arm is that in the room' python3 - s.json <<'END'
import json, sys
one = json.load(open(sys.argv[1]))["registrations"][0]
assert (one["from"], one["to"]) == ("arm", "room"), one
assert all(abs(a - b) < 1e-4 for a, b in zip(one["position_m"], (1, 2, 3))), one
assert abs(one["orientation_wxyz"][0] - 0.5 ** 0.5) < 1e-3 and abs(one["orientation_wxyz"][3] - 0.5 ** 0.5) < 1e-3, one
END

# One point of the user's choice checks the registration.
start --check
touch_with_both 1 0.98 2.01 3.02 0.01 0.02 0.02
check 'a point that both touch is right' wait $player
check 'with its error' grep -q 'off by 0.0 mm' out.txt
start --check
touch_with_both 1 0.98 2.01 3.02 0.01 0.02 0.026
wait $player
check 'exit code 1 for two points' test $? = 1
check 'with their distance' grep -q 'off by 6.0 mm; expected at most 5 mm; register it again' log

# The tip of the controller is found by turning the controller about it.
cat > turn.py <<'END'
import math, os, sys, time
# Turns about x, then about y; the tip, 0.1 m before the grip, stays at a point.
begin = time.monotonic()
while (now := time.monotonic() - begin) < float(sys.argv[1]):
    a, b = 0.3 * math.sin(3 * now), 0.3 * math.cos(2 * now)  # half angles
    w, x, y, z = math.cos(a) * math.cos(b), math.sin(a) * math.cos(b), math.cos(a) * math.sin(b), math.sin(a) * math.sin(b)
    d = (-0.1 * 2 * (x * z + w * y), -0.1 * 2 * (y * z - w * x), -0.1 * (1 - 2 * (x * x + y * y)))
    place = [p - q for p, q in zip((0.5, 1.0, 0.2), d)]
    with open("controller.new", "w") as out:
        out.write("hand right active 1\nhand right grip %.9f %.9f %.9f %.9f %.9f %.9f %.9f\n" % (*place, x, y, z, w))
        out.write("hand right trigger %d\n" % (now > 0.5))
    os.rename("controller.new", "controller")
    time.sleep(0.01)
END
tip=(--find-tip)
hold 0 0 0 0
start --check
check 'the user is asked to turn the controller' eventually grep -q 'turn the controller about the tip in all directions' log
python3 turn.py 7
check 'the tip is found' eventually grep -qE 'The tip is at -?0\.0000,-?0\.0000,-0\.1000 m in the frame of the grip; rms 0\.0 mm' log
touch_with_both 1 0.98 2.01 3.02 0.01 0.02 0.02
check 'and points that it touches are right' wait $player
check 'to a tenth of a millimetre' grep -q 'off by 0.0 mm' out.txt
tip=(--controller-tip 0,0,-0.1)

# The wrist of a gloved hand at the controller that is fixed to it: the wearer turns the hand about each fingertip. The hand is flat, because
# its calibration has only the line of the wrist, which is not used. The wrist is at (0.02, -0.05, 0.07) of the grip, turned by 90 degrees about y.
"$bin/bolt-emulate" glove --period 0 --link "$work/worn" > /dev/null &
emulated=$!
player=
check 'the glove is there' eventually test -L worn
export XDG_DATA_HOME=$work/data
mkdir -p data/boltwright/gloves
echo '{"format": "boltwright glove calibration 1", "trainee": "T-7K3M9Q", "glove": "", "hand": "right", "sensors": 18, "date": "2026-11-22",
 "quality": 1, "hand_length_mm": 188.882, "lines": {"wrist_pitch": {"offset": 50, "gain": 0.013}}}' > data/boltwright/gloves/T-7K3M9Q.right.glove.json
cat > turn_hand.py <<'END'
import math, os, time
# Turns the hand about the fingertip that the program has asked for last; the fingertips of a flat hand, m.
tips = {"thumb": (-0.046210, -0.007, -0.118548), "index": (-0.024870, 0.001, -0.179098), "middle": (-0.004497, 0.001936, -0.188882),
        "little": (0.032198, -0.004245, -0.149149), "ring": (0.015095, -0.000018, -0.175839)}
def turned(q, v):
    w, x, y, z = q
    t = (2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0]))
    return (v[0] + w * t[0] + y * t[2] - z * t[1], v[1] + w * t[1] + z * t[0] - x * t[2], v[2] + w * t[2] + x * t[1] - y * t[0])
begin, finger, asked = time.monotonic(), None, 0.0
while not os.path.exists("turned") and (now := time.monotonic() - begin) < 300:
    words = [line.split(" on a fixed")[0] for line in open("log") if line.startswith("Hold the tip of the")]
    latest = words[-1].split()[5] if words else None
    if (len(words), latest) != finger:
        finger, asked = (len(words), latest), now
    a, b = 0.3 * math.sin(3 * now), 0.3 * math.cos(2 * now)
    q = (math.cos(a) * math.cos(b), math.sin(a) * math.cos(b), math.cos(a) * math.sin(b), math.sin(a) * math.sin(b))
    x, y, z = tips[latest] if latest else (0, 0, 0)
    tip = (0.02 + z, -0.05 + y, 0.07 - x)
    place = [p - d for p, d in zip((0.5, 1.0, 0.2), turned(q, tip))]
    with open("controller.new", "w") as out:
        out.write("hand right active 1\nhand right grip %.9f %.9f %.9f %.9f %.9f %.9f %.9f\n" % (*place, q[1], q[2], q[3], q[0]))
        out.write("hand right trigger %d\n" % (now - asked > 0.5))
    os.rename("controller.new", "controller")
    time.sleep(0.01)
END
cp old.json s.json
expect 3 's.json: the station has no "glove"' bash -c 'echo "{\"format\": \"boltwright station 1\"}" > gloveless.json; cp gloveless.json s.json; "$@"' - "${run[@]}" s.json --hand right --trainee T-7K3M9Q
expect 2 'requires --trainee' "${run[@]}" s.json --hand right
expect 2 'excludes' "${run[@]}" s.json --hand right --trainee T-7K3M9Q --controller left
echo "{\"format\": \"boltwright station 1\", \"glove\": {\"port\": \"$work/worn\"}}" > s.json
expect 2 'the glove is a right one; expected --hand right' "${run[@]}" s.json --hand left --trainee T-7K3M9Q
expect 3 'no calibration of T-7K3M9R.s right hand' "${run[@]}" s.json --hand right --trainee T-7K3M9R
: > log
python3 turn_hand.py &
turner=$!
check 'the wrist is registered' bash -c '"$@" > out.txt 2> log' - "${run[@]}" s.json --hand right --trainee T-7K3M9Q
touch turned
wait $turner
kill $emulated
check 'its fingertips fit' grep -q 'hand -> controller, 4 points' out.txt
check 'the place of the wrist is that on the hand' python3 - s.json <<'END'
import json, sys
one = json.load(open(sys.argv[1]))["registrations"][0]
assert (one["from"], one["to"]) == ("hand", "controller"), one
assert all(abs(a - b) < 5e-4 for a, b in zip(one["position_m"], (0.02, -0.05, 0.07))), one
assert abs(one["orientation_wxyz"][0] - 0.5 ** 0.5) < 5e-3 and abs(one["orientation_wxyz"][2] - 0.5 ** 0.5) < 5e-3, one
END


# The same with a Vive tracker, which the station file then names, and a wearer who presses Enter.
"$bin/bolt-emulate" glove --period 0 --link "$work/worn" > /dev/null &
emulated=$!
expect 2 'not in \{handheld_object' "${run[@]}" s.json --hand right --trainee T-7K3M9Q --tracker wrist
expect 2 'requires --hand' "${run[@]}" s.json --tracker right_wrist --controller right
check 'the glove is there' eventually test -L worn
expect 4 'it lacks XR_HTCX_vive_tracker_interaction; expected a runtime' "${run[@]}" s.json --hand right --trainee T-7K3M9Q --tracker right_wrist
sed -i '1i 0 config with XR_HTCX_vive_tracker_interaction' script.txt
sed -i -e 's/hand right active 1.nhand right grip/tracker LHR-1 role right_wrist\\ntracker LHR-1 pose/' -e '/hand right trigger/d' turn_hand.py
rm turned
control 'hand right active 0' 'tracker LHR-1 role waist'
: > log
mkfifo enter
"${run[@]}" s.json --hand right --trainee T-7K3M9Q --tracker right_wrist < enter > out.txt 2> log &
player=$!
exec 3> enter
check 'Enter is asked for, because the tracker has no trigger' eventually grep -q 'Hold the tip of the thumb on a fixed point, press Enter, and turn the stiff hand' log
check 'a tracker with another role is reported' eventually grep -q 'No pose: no Vive tracker that is switched on has the role right_wrist; there are waist; expected' log
python3 turn_hand.py &
turner=$!
check 'and waited for' eventually grep -q 'The Vive tracker is tracked again' log
for finger in thumb index middle little ring; do
    check "the tip of the $finger is asked for" eventually grep -q "^Hold the tip of the $finger" log
    found=$(grep -c 'The tip is at' log)
    sleep 0.5
    echo >&3
    next() { [[ $(grep -c 'The tip is at' log) -gt $found ]]; }
    check 'and found' eventually next
done
check 'the wrist is registered with the tracker' wait $player
player=
exec 3>&-
touch turned
wait $turner
kill $emulated
check 'its fingertips fit too' grep -q 'hand -> wrist_tracker, 4 points' out.txt
check 'the tracker is stored, and the registration with the controller stays' python3 - s.json <<'END'
import json, sys
station = json.load(open(sys.argv[1]))
assert station["glove"]["wrist_tracker"] == "right_wrist", station
assert [one["to"] for one in station["registrations"]] == ["controller", "wrist_tracker"], station
one = station["registrations"][1]
assert all(abs(a - b) < 5e-4 for a, b in zip(one["position_m"], (0.02, -0.05, 0.07))), one
END
sed -i 1d script.txt
cp old.json s.json

# An interruption, or the end of the runtime, ends the registration, also while a controller is not tracked.
control 'hand right active 0'
start
check 'a hidden controller is reported' eventually grep -q 'The controller is not tracked' log
kill -INT $player
wait $player
check 'an interrupted registration has exit code 1' test $? = 1
check 'and says so' grep -q 'the registration was interrupted' log
hold 0 0 0 0
start
check 'a first point is requested' eventually asked_for 1 controller
control 'event recentre stage'
wait $player
check 'a recentred headset has exit code 1' test $? = 1
check 'with the reason: the points would be in two frames' grep -q 'the headset was recentred while points were measured' log
hold 0 0 0 0
start
check 'a first point is asked for' eventually asked_for 1 controller
control 'event instance_loss'
wait $player
check 'exit code 4 if the runtime ends' test $? = 4
player=
check 'with the reason' grep -q 'the OpenXR runtime has ended' log
check 'the rules of OpenXR are kept' bash -c '! grep violation report.txt'
finish_checks
