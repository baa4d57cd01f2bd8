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
expect 0 'renders force along 3 axes, 12 N at most' "$bin/boltwright" devices --device $arm --may-move --seconds 0.2
export EMULATED_ARM_INITIALIZED=1
expect 0 'senses the pose of the hand in six degrees of freedom' "$bin/boltwright" devices --device $arm --seconds 0.2
FDSDK=$work/old expect 0 'has no dhdGetDeviceCount, drdOpenID' "$bin/boltwright" devices
FDSDK=$work/old expect 4 'has no dhdGetDeviceCount, drdOpenID' "$bin/boltwright" devices --device $arm
FDSDK=$work/nowhere expect 4 'there is no device force-dimension:0' "$bin/boltwright" devices --device $arm
FDSDK=$work/broken expect 0 'cannot be used: libdrd.so.3 cannot be loaded: .*invalid ELF header; expected the vendor' "$bin/boltwright" devices
FDSDK=$work/broken expect 4 'invalid ELF header' "$bin/boltwright" devices --device $arm

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
arm_process() {  # of the programs that boltwright has started
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
