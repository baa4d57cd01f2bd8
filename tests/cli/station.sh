#!/usr/bin/env bash
# A station file from the first one to a lesson, with an emulated arm. station.sh BIN SOURCES, on a screen (with_screen.sh).
. "$(dirname "$0")/checks.sh"
arm=force-dimension:0
library=lib/release/lin-x86_64-gcc/libdrd.so.3
mkdir -p "sdk/${library%/*}"
cp "${bin%/bin}/emulated/force_dimension/libdrd.so.3" "sdk/$library"
run=("$bin/boltwright")

# Without a device there is nothing to write, and a file is not overwritten.
expect 4 'no device is connected that a station can use' "${run[@]}" station new lab.json
check 'no file is written' test ! -e lab.json
export FDSDK=$work/sdk EMULATED_ARM_INITIALIZED=1
expect 4 'there is no device force-dimension:7; did you mean force-dimension:0' "${run[@]}" station new lab.json --device force-dimension:7
expect 4 'is the device.s adapter plugged in' "${run[@]}" station new lab.json --glove /dev/ttyNONE
expect 0 "arm +$arm" "${run[@]}" station new lab.json --name 'Lab 2'
expect 2 'lab.json exists already; expected a new file, or --force' "${run[@]}" station new lab.json
expect 0 "arm +$arm" "${run[@]}" station new lab.json --device $arm --force
check 'it has the limits that the arm reports' grep -q '"force_N": 12.0' lab.json
check 'its schema exists' test -f "$(sed -n 's/.*"$schema": "\(.*\)",/\1/p' lab.json)"
expect 2 'FILE is required' "${run[@]}" station check
expect 2 'subcommand is required' "${run[@]}" station

# check: a file that fits; limits above the device's, missing buttons, an unknown tool; another arm; bad content.
expect 0 'The file suits the devices' "${run[@]}" station check lab.json
change() { sed "$1" lab.json > "$2"; }
change 's/"force_N": 12.0/"force_N": 30/' high.json
expect 0 'warning: arm: the limit force_N is 30, above the device.s own 12: it has no effect' "${run[@]}" station check high.json
change 's/"stop": \[\]/"stop": 9/' stop.json
expect 1 'the button "stop" is number 9, and the device has 8 buttons' "${run[@]}" station check stop.json
change 's/"limits"/"tool": "torqe_wrench", "limits"/' tool.json
expect 1 'no assembly has a tool "torqe_wrench"; did you mean "torque_wrench"' "${run[@]}" station check tool.json
change 's/force-dimension:0/force-dimension:1/' other.json
expect 1 'arm: there is no device force-dimension:1; did you mean force-dimension:0' "${run[@]}" station check other.json
echo '{"format": "boltwright station 1", "wheel": {"device": "force-dimension:0"}}' > wheel.json
expect 1 'force-dimension:0 is the "wheel" of the station, but is another kind of device' "${run[@]}" station check wheel.json
change 's/"force_N": 12.0/"force": 12/' wrong.json
expect 3 '^wrong.json:[0-9]+:[0-9]+: /arm/limits/force: ' "${run[@]}" station check wrong.json
expect 3 'nowhere.json: ' "${run[@]}" station check nowhere.json

# try, and doctor with the same file. The speed of this machine is not tested.
tried() { "${run[@]}" "$@" --seconds 0.3 > tried.txt 2>&1; local code=$?; [[ $code -le 1 ]] && grep -q 'largest force .* of at most' tried.txt; }
change 's/"force_N": 12.0/"force_N": 5/; s/"yaw_deg": 0.0/"yaw_deg": 180/; s/"dead_man": 1/"dead_man": 3/' low.json
check 'a trial runs' tried station try low.json --assembly cover-m8
check 'it has the lower limit' grep -q 'of at most 5 N' tried.txt
check 'its dead-man switch is that of the file' grep -q 'only while button 3 of' tried.txt
check 'doctor tries it too' tried doctor cover-m8 --station low.json
check 'with the lower limit' grep -q 'of at most 5 N' tried.txt
"${run[@]}" doctor cover-m8 --station low.json --seconds 0.3 --yes > pushed.txt 2>&1
check 'its stiffness is tried with a fifth of the lower limit' grep -q 'pushes the hand with 1.0 N at most' pushed.txt
check 'while the button of the file is held' grep -q 'and its button 3' pushed.txt
check 'a limit above is reported' tried station try high.json --assembly cover-m8
check 'as a warning' grep -q 'warning: arm: the limit force_N is 30' tried.txt
expect 3 '/arm/limits/force' "${run[@]}" station try wrong.json
expect 4 'there is no device force-dimension:1' "${run[@]}" station try other.json
expect 3 'is the "wheel" of the station' "${run[@]}" doctor --station wheel.json

# train: refused before a window opens.
expect 3 '/arm/limits/force' "${run[@]}" train --station wrong.json
expect 4 'there is no device force-dimension:1' "${run[@]}" train --station other.json
expect 2 'the settings of the station.s "arm" are for force-dimension:1; expected that device' "${run[@]}" train --station other.json --device $arm
expect 2 '--device mouse: the station file names the devices' "${run[@]}" train --station lab.json --device mouse
expect 2 'a simulated trainee does not use devices' "${run[@]}" train --station lab.json --headless
expect 2 '--hand free: a device moves the hand' "${run[@]}" train --station lab.json --hand free
expect 3 'does not have the tool of the station.s arm, "torqe_wrench"; expected one of its tools: ' "${run[@]}" train cover-m8 --station tool.json

# A lesson has the limits of the file.
sed -i 's/"limits"/"tool": "torque_wrench", "limits"/' low.json
"${run[@]}" train cover-m8 --station low.json --start --silent --size 320x200 --out lesson 2>log >/dev/null &
player=$!
begun() { grep -q 'lesson begun' log; }
check 'a lesson with the station begins' eventually begun
sleep 2
kill -INT $player
check 'an interrupt ends it with exit code 0' wait $player
player=
check 'the session has the limits of the file' grep -aq 'force_N=5 torque_Nm=0 ' lesson/session.boltwright
check 'and its tool' grep -aq torque_wrench lesson/session.boltwright
expect 0 'all as they were recorded' "${run[@]}" replay lesson/session.boltwright
finish_checks
