#!/usr/bin/env bash
# Arms through their vendors' libraries, which are emulated: they are listed, opened, and play a lesson.
# arms.sh BIN SOURCES, on a screen (with_screen.sh).
. "$(dirname "$0")/checks.sh"
arm=force-dimension:0
library=lib/release/lin-x86_64-gcc/libdrd.so.3
mkdir -p "sdk/${library%/*}" "old/${library%/*}" "broken/${library%/*}"
cp "${bin%/bin}/emulated/force_dimension/libdrd.so.3" "sdk/$library"
cp "$(ldd "$bin/boltwright" | sed -n 's/.*libm\.so\.6 => \([^ ]*\).*/\1/p')" "old/$library"  # without the functions
yes nonsense | head -c 4096 >"broken/$library"

export FDSDK=$work/sdk
expect 0 "$arm +Force Dimension arm" "$bin/boltwright" devices
expect 4 'has to move by itself to find its position, and may not; expected free room around it' "$bin/boltwright" devices --device $arm
expect 0 'renders force along 3 axes, 12 N at most' "$bin/boltwright" devices --device $arm --yes --seconds 0.2
expect 0 'renders force along 3 axes' "$bin/boltwright" devices --device $arm --may-move --seconds 0.2
expect 4 'and may not; .*`boltwright devices --device force-dimension:0 --yes`' "$bin/boltwright" doctor cover-m8 --device $arm --seconds 0.5
check 'doctor --yes answers too' grep -q 'May it move? yes (--yes)' <("$bin/boltwright" doctor cover-m8 --device $arm --yes --seconds 0.5 2>&1)
answers() {  # answers TEXT command...: on a terminal, where the text is typed after a second
    local text=$1
    shift
    (sleep 1; echo "$text") | script -qec "$*" /dev/null
}
expect 0 'Keep hands and things clear. May it move\? \[y/N\]' answers y "$bin/boltwright" devices --device $arm --seconds 0.2
expect 4 'and may not' answers n "$bin/boltwright" devices --device $arm --seconds 0.2
expect 4 'there is no device' env FDSDK="$work/nowhere" "$bin/boltwright" doctor cover-m8 --device $arm --seconds 0.2
export EMULATED_ARM_INITIALIZED=1
expect 0 'senses the pose of the hand in six degrees of freedom' "$bin/boltwright" devices --device $arm --seconds 0.2
expect 0 'model omega.6, serial number 1234' "$bin/boltwright" devices --device $arm --seconds 0.2
expect 0 '  calibrated' "$bin/boltwright" devices --device $arm --seconds 0.2

# Measurements of doctor. The exit code is that of the station's trial, which a busy computer may fail.
doctor() { "$bin/boltwright" doctor cover-m8 --device $arm --seconds 0.5 "$@" 2>&1; }
says() {  # says 'pattern' OUTPUT
    grep -qE -- "$1" <<<"$2"
}
lacks() { ! says "$@"; }
output=$(doctor)
check 'doctor measures rate and age of samples' says 'sent [0-9]+ samples a second' "$output"
check 'doctor measures the age of samples' says 'until a servo tick takes it: [0-9.]+ ms' "$output"
check 'nobody is pushed without consent' says 'stiffness not measured: it pushes the hand, which needs permission: use a terminal or --yes' "$output"
check 'nobody is pushed without the button' says 'not measured: its button was not held' "$(doctor --yes)"
output=$(answers n "$bin/boltwright" doctor cover-m8 --device $arm --seconds 0.5)
check 'a terminal asks before the arm pushes' says 'pushes the hand with 2.4 N at most.*May it push\? \[y/N\]' "$output"
check 'no is no' says 'stiffness not measured: it may not push the hand' "$output"
# The stable stiffness depends on how late this computer is just now; lateness only lowers it. tests/station/stiffness_trial.cpp
# checks the figures, in simulated time.
output=$(EMULATED_ARM_BUTTONS=1 doctor --yes)
check 'with the button held the stiffness is measured' says 'stable on this computer (up to|at any stiffness)' "$output"
output=$(EMULATED_ARM_DELAY=0.03 EMULATED_ARM_BUTTONS=1 doctor --yes)
check 'that of a delayed arm too' says 'stable on this computer (up to|at any stiffness)' "$output"
check 'but it cannot be the full one' lacks 'the full reported stiffness' "$output"

FDSDK=$work/old expect 0 'has no dhdGetDeviceCount, drdOpenID' "$bin/boltwright" devices
FDSDK=$work/old expect 4 'has no dhdGetDeviceCount, drdOpenID' "$bin/boltwright" devices --device $arm
FDSDK=$work/nowhere expect 4 'there is no device force-dimension:0' "$bin/boltwright" devices --device $arm
FDSDK=$work/broken expect 0 'cannot be used: libdrd.so.3 cannot be loaded: .*invalid ELF header; expected the vendor' "$bin/boltwright" devices
FDSDK=$work/broken expect 4 'invalid ELF header' "$bin/boltwright" devices --device $arm

# OpenHaptics finds an arm only by reserving it, so the arm is listed wherever the library is present.
hd=openhaptics:0
mkdir -p oh/lib oh_old/lib oh_broken/lib
cp "${bin%/bin}/emulated/open_haptics/libHD.so.3.4" oh/lib
cp "old/$library" oh_old/lib/libHD.so.3.4
cp "broken/$library" oh_broken/lib/libHD.so.3.4
OH_SDK_BASE=$work/oh expect 0 "$hd +OpenHaptics arm" "$bin/boltwright" devices
OH_SDK_BASE=$work/oh expect 0 'force along 3 axes, 3.3 N at most, as stiff as 0.4 N/mm' "$bin/boltwright" devices --device $hd --seconds 0.2
OH_SDK_BASE=$work/oh expect 0 'renders 0.88 N without a break' "$bin/boltwright" devices --device $hd --seconds 0.2
EMULATED_ARM_NEEDS_INKWELL=1 OH_SDK_BASE=$work/oh expect 4 'is not calibrated; expected its stylus in the inkwell' "$bin/boltwright" devices --device $hd
OH_SDK_BASE=$work/oh_old expect 0 'has no hdInitDevice, hdDisableDevice' "$bin/boltwright" devices
OH_SDK_BASE=$work/oh_old expect 4 'has no hdInitDevice, hdDisableDevice' "$bin/boltwright" devices --device $hd
OH_SDK_BASE=$work/oh_broken expect 4 'invalid ELF header' "$bin/boltwright" devices --device $hd
OH_SDK_BASE=$work/nowhere expect 4 'there is no device openhaptics:0' "$bin/boltwright" devices --device $hd
# Haply's service on a free port.
haply() {  # haply OPTIONS...: starts the service and names it in BOLTWRIGHT_HAPLY
    : >address
    "$bin/bolt-emulate" haply --port 0 "$@" >address &
    player=$!
    check 'the emulated Haply service starts' eventually grep -q : address
    BOLTWRIGHT_HAPLY=$(head -1 address)
    export BOLTWRIGHT_HAPLY
}
stop_haply() { kill $player; wait $player; player=; }
lists() { "$bin/boltwright" devices | grep -qE -- "$1"; }  # a listing waits only briefly for the service
haply
check 'the arm of the service is listed' eventually lists 'haply:0 +Haply Inverse3 049D'
expect 0 'renders force along 3 axes, 10 N at most' "$bin/boltwright" devices --device haply:0 --seconds 0.2
stop_haply
haply --grip none --version 3.4.0
expect 0 'has no VerseGrip, so it senses no rotation' "$bin/boltwright" devices --device haply:0 --seconds 0.2
stop_haply
expect 4 'there is no device haply:0' "$bin/boltwright" devices --device haply:0
haply --uncalibrated
check 'an arm that is not calibrated is listed with the remedy' eventually lists 'Haply Inverse3 049D is not calibrated; expected an arm that was placed into its inkwell'
expect 4 'is not calibrated' "$bin/boltwright" devices --device haply:0
stop_haply
BOLTWRIGHT_HAPLY=nowhere expect 0 "BOLTWRIGHT_HAPLY is 'nowhere'; expected ADDRESS:PORT" "$bin/boltwright" devices
unset BOLTWRIGHT_HAPLY

# A lesson with the first device that is found.
"$bin/boltwright" train cover-m8 --device auto --start --silent --size 320x200 --out lesson 2>log >/dev/null &
player=$!
begun() { grep -q 'lesson begun' log; }
check 'a lesson with the arm begins' eventually begun
sleep 2
kill -INT $player
check 'an interrupt ends it with exit code 0' wait $player
player=
check 'the session has the limits of the arm' grep -aq 'force_N=12 torque_Nm=0 ' lesson/session.boltwright
expect 0 'all as they were recorded' "$bin/boltwright" replay lesson/session.boltwright

# An arm that has to move asks in the window, and again after it was switched off.
logged() { [[ $(grep -c "$1" log 2>/dev/null) -ge ${2:-1} ]]; }
press() { xdotool key --window "$(xdotool search --pid $player | tail -1)" "$1" 2>/dev/null; }
answered() {  # answered COUNT: presses Enter until the arm moves for the COUNT-th time
    press Return
    sleep 1
    logged 'the arm may move by itself' "$1"
}
touch on
env -u EMULATED_ARM_INITIALIZED EMULATED_ARM_HOMING=2 EMULATED_ARM_SWITCH="$work/on" "$bin/boltwright" train cover-m8 --device $arm \
    --start --silent --size 320x200 --out homing 2>log >/dev/null &
player=$!
check 'the window asks whether the arm may move' eventually logged 'the arm asks whether it may move'
sleep 2
check 'the arm does not move without an answer' test "$(grep -c 'may move by itself$' log)-$(grep -c 'lesson begun' log)" = 1-0
check 'Enter lets it move' eventually answered 1
check 'then the lesson begins' eventually begun
sleep 1
rm on
sleep 2
touch on
check 'after it was switched off it asks again' eventually logged 'the arm asks whether it may move' 2
check 'Enter lets it move again' eventually answered 2
kill -INT $player
check 'an interrupt ends the lesson with exit code 0' wait $player
player=

# An arm of a plug-in, whose process crashes in the lesson.
unset FDSDK
mkdir plugins
cp "${bin%/bin}/plugins/sample_arm.so" plugins
export BOLTWRIGHT_ARM_PLUGINS=$work/plugins
expect 0 'plugin:sample_arm:0 +sample_arm, an arm of a plug-in' "$bin/boltwright" devices
expect 0 'renders force along 3 axes, 10 N at most' "$bin/boltwright" devices --device plugin:sample_arm:0 --seconds 0.2
cp "old/$library" plugins/other.so
expect 0 'cannot be used: the plug-in other: .*has no bw_arm_entry' "$bin/boltwright" devices
expect 4 'has no bw_arm_entry' "$bin/boltwright" devices --device plugin:other:0
rm log
"$bin/boltwright" train cover-m8 --device plugin:sample_arm:0 --start --silent --size 320x200 --out crash 2>log >/dev/null &
player=$!
check 'a lesson with the arm of a plug-in begins' eventually begun
arm_process() {  # process ids of bolt-arm-host below boltwright
    local child
    for child in $(cat /proc/$player/task/*/children 2>/dev/null); do
        [[ $(cat "/proc/$child/comm" 2>/dev/null) != bolt-arm-host ]] || echo "$child"
    done
}
has_process() { [[ -n $(arm_process) ]]; }
sleep 1
check 'the plug-in has a process of its own' eventually has_process
first=$(arm_process)
kill -SEGV "$first"
restarted() { [[ -n $(arm_process) && $(arm_process) != "$first" ]]; }
check 'after a crash the arm is opened again' eventually restarted
sleep 1
kill -INT $player
check 'the lesson ends with exit code 0' wait $player
player=
check 'no process of the plug-in is left' test -z "$(grep -l "$work/plugins/" /proc/[0-9]*/cmdline 2>/dev/null)"
expect 0 'all as they were recorded' "$bin/boltwright" replay crash/session.boltwright
finish_checks
