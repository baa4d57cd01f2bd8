#!/usr/bin/env bash
# Runs every fuzzer with a fixed number of runs and a fixed seed on the shipped corpus. $1: folder of the programs.
set -euo pipefail
bin=$1
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
names=()
pids=()
smoke() {  # smoke NAME RUNS options...: in the background, two at a time
    local name=$1 runs=$2
    shift 2
    while (($(jobs -rp | wc -l) >= 2)); do sleep 0.1; done
    mkdir -p "$work/$name"
    "$bin/fuzz_$name" -runs="$runs" -seed=1 -verbosity=0 -artifact_prefix="$work/" "$@" "$work/$name" > "$work/$name.log" 2>&1 &
    names+=("$name")
    pids+=($!)
}
smoke assembly 10000 -dict="$here/assembly.dict" "$bin/../corpus/assembly"
smoke chunk 25000
smoke measured 50000 "$bin/../corpus/measured"
smoke gltf 10000 -dict="$here/gltf.dict" -max_len=16384 "$bin/../corpus/gltf"
smoke glove 50000 -max_len=4096 -dict="$here/glove.dict"
smoke cal 50000 "$bin/../corpus/cal"
smoke calibration 25000 -dict="$here/calibration.dict" -max_len=8192 "$bin/../corpus/calibration"
smoke settings 25000 -dict="$here/settings.dict" -max_len=4096 "$bin/../corpus/settings"
smoke names 25000 -dict="$here/names.dict" -max_len=4096 "$bin/../corpus/names"
smoke page_trainees 50000 -max_len=2048 -dict="$here/page_trainees.dict"
smoke station 25000 -dict="$here/station.dict" -max_len=4096 "$bin/../corpus/station"
smoke points 50000 -max_len=2048 "$bin/../corpus/points"
smoke displays 15000 -dict="$here/displays.dict" -max_len=4096 "$bin/../corpus/displays"
smoke pvx 25000 -dict="$here/pvx.dict" -max_len=4096 "$bin/../corpus/pvx"
smoke questionnaire 15000 -dict="$here/questionnaire.dict" -max_len=4096 "$bin/../corpus/questionnaire"
smoke study 10000 -dict="$here/study.dict" -max_len=4096 "$bin/../corpus/study"
smoke rig 15000 -max_len=4096 "$bin/../corpus/rig"
smoke dtrack 100000 -dict="$here/dtrack.dict" -max_len=1024 "$bin/../corpus/dtrack"
smoke scene_stream 50000 -max_len=2048
smoke report 100000 -max_len=512
smoke force_device 100000 -max_len=1024 "$bin/../corpus/force_device"
smoke haply 15000 -max_len=4096 -dict="$here/haply.dict" "$bin/../corpus/haply"
smoke words 5000 -max_len=32768 "$bin/../corpus/words"
failed=0
for i in "${!pids[@]}"; do
    wait "${pids[i]}" || { echo "FAILED: ${names[i]}"; cat "$work/${names[i]}.log"; failed=$((failed + 1)); }
done
echo "$((${#pids[@]} - failed)) passed, $failed failed"
exit $((failed > 0))
