#!/usr/bin/env bash
# Frames of the machine beside three.js on the same rasteriser: times, what all threads computed for a frame (which holds on a
# busy machine too), and our ratios: below 1 we are faster. Writes out/bench/peer.json. Needs chromium and npm (Debian packages
# of those names), and the npm registry the first time.
#   tools/bench/peer/compare.sh [BUILD]      BUILD: build/release by default
set -euo pipefail
cd "$(dirname "$0")/../../.."
bench=${1:-build/release}/bin/bolt-bench
peer=tools/bench/peer
for program in npm node chromium "$bench"; do
    command -v "$program" >/dev/null || { echo "$program is not there" >&2; exit 1; }
done
wanted=$(sed -n 's/.*"three": "\(.*\)".*/\1/p' $peer/package.json)
there=$(sed -n 's/^ *"version": "\(.*\)".*/\1/p' $peer/node_modules/three/package.json 2>/dev/null || true)
[[ $there == "$wanted" ]] || (cd $peer && npm ci --no-audit --no-fund --loglevel=error)
mkdir -p out/bench
"$bench" --machine out/bench/machine.glb
# Before and after the other, so that a machine that grows busier is noticed.
for turn in before after; do
    [[ $turn == before ]] || node $peer/run.mjs out/bench/machine.glb --out out/bench/three.json --picture out/bench/three.png >/dev/null
    "$bench" --benchmark_filter=frame_machine/as_peer --benchmark_min_time=4 --benchmark_out=out/bench/ours-$turn.json \
        --benchmark_out_format=json >/dev/null 2>&1
done
node $peer/join.mjs out/bench/three.json out/bench/ours-before.json out/bench/ours-after.json out/bench/peer.json
