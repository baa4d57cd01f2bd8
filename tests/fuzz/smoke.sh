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
smoke assembly 20000 -dict="$here/assembly.dict" "$bin/../corpus/assembly"
smoke chunk 50000
smoke measured 100000 "$bin/../corpus/measured"
smoke gltf 20000 -dict="$here/gltf.dict" -max_len=16384 "$bin/../corpus/gltf"
smoke glove 100000 -max_len=4096 -dict="$here/glove.dict"
smoke cal 100000 "$bin/../corpus/cal"
smoke calibration 50000 -dict="$here/calibration.dict" -max_len=8192 "$bin/../corpus/calibration"
smoke settings 50000 -dict="$here/settings.dict" -max_len=4096 "$bin/../corpus/settings"
smoke station 50000 -dict="$here/station.dict" -max_len=4096 "$bin/../corpus/station"
smoke points 100000 -max_len=2048 "$bin/../corpus/points"
smoke displays 30000 -dict="$here/displays.dict" -max_len=4096 "$bin/../corpus/displays"
smoke pvx 50000 -dict="$here/pvx.dict" -max_len=4096 "$bin/../corpus/pvx"
smoke dtrack 200000 -dict="$here/dtrack.dict" -max_len=1024 "$bin/../corpus/dtrack"
smoke report 200000 -max_len=512
smoke force_device 200000 -max_len=1024 "$bin/../corpus/force_device"
smoke haply 30000 -max_len=4096 -dict="$here/haply.dict" "$bin/../corpus/haply"
smoke words 10000 -max_len=32768 "$bin/../corpus/words"
failed=0
for i in "${!pids[@]}"; do
    wait "${pids[i]}" || { echo "FAILED: ${names[i]}"; cat "$work/${names[i]}.log"; failed=$((failed + 1)); }
done
echo "$((${#pids[@]} - failed)) passed, $failed failed"
exit $((failed > 0))
