#!/usr/bin/env bash
# Compares frames of the benchmark model with three.js on the same rasteriser: elapsed times, CPU time of all threads per frame
# (reliable on a busy machine too), and ratios; below 1 our renderer is faster. Writes out/bench/peer.json. Needs the Debian
# packages chromium and npm, and the npm registry on the first run.
#   tools/bench/peer/compare.sh [BUILD]      BUILD: build/release by default
set -euo pipefail
cd "$(dirname "$0")/../../.."
bench=${1:-build/release}/bin/bolt-bench
peer=tools/bench/peer
for program in npm node chromium "$bench"; do
    command -v "$program" >/dev/null || { echo "$program: not found" >&2; exit 1; }
done
required=$(sed -n 's/.*"three": "\(.*\)".*/\1/p' $peer/package.json)
installed=$(sed -n 's/^ *"version": "\(.*\)".*/\1/p' $peer/node_modules/three/package.json 2>/dev/null || true)
[[ $installed == "$required" ]] || (cd $peer && npm ci --no-audit --no-fund --loglevel=error)
mkdir -p out/bench
"$bench" --machine out/bench/machine.glb
# Measure ours before and after three.js to detect a change of the load.
for turn in before after; do
    [[ $turn == before ]] || node $peer/run.mjs out/bench/machine.glb --out out/bench/three.json --picture out/bench/three.png >/dev/null
    "$bench" --benchmark_filter=frame_machine/as_peer --benchmark_min_time=4 --benchmark_out=out/bench/ours-$turn.json \
        --benchmark_out_format=json >/dev/null 2>&1
done
node $peer/join.mjs out/bench/three.json out/bench/ours-before.json out/bench/ours-after.json out/bench/peer.json
