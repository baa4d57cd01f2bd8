#!/usr/bin/env bash
# Runs every fuzzer with a fixed number of runs and a fixed seed on the shipped corpus. $1: folder of the programs.
set -euo pipefail
bin=$1
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
passed=0
smoke() {  # smoke NAME RUNS options...
    local name=$1 runs=$2
    shift 2
    mkdir -p "$work/$name"
    "$bin/fuzz_$name" -runs="$runs" -seed=1 -verbosity=0 -artifact_prefix="$work/" "$@" "$work/$name" \
        > "$work/log" 2>&1 || { cat "$work/log"; exit 1; }
    passed=$((passed + 1))
}
smoke assembly 20000 -dict="$here/assembly.dict" "$bin/../corpus/assembly"
smoke chunk 50000
smoke measured 100000 "$bin/../corpus/measured"
smoke gltf 20000 -dict="$here/gltf.dict" -max_len=16384 "$bin/../corpus/gltf"
smoke glove 100000 -max_len=4096 -dict="$here/glove.dict"
smoke cal 100000 "$bin/../corpus/cal"
smoke calibration 50000 -dict="$here/calibration.dict" -max_len=8192 "$bin/../corpus/calibration"
smoke settings 50000 -dict="$here/settings.dict" -max_len=4096 "$bin/../corpus/settings"
smoke report 200000 -max_len=512
smoke force_device 200000 -max_len=1024 "$bin/../corpus/force_device"
smoke words 10000 -max_len=32768 "$bin/../corpus/words"
echo "$passed passed, 0 failed"
