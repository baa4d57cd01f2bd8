#!/usr/bin/env bash
# Regenerates all generated models and images into OUT, a copy of content/: tools/remake-content.sh BIN OUT
# BIN: the folder of the built programs. To update the content itself: tools/remake-content.sh build/release/bin content
set -euo pipefail
bin=$1
out=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
import() {  # STEP FOLDER options...: writes the models only and keeps the folder's assembly.json
    local name=${1##*/}
    name=${name%.step}
    "$bin/bolt-author" import-step "$1" -o "$scratch/$name" --no-joints "${@:3}" >"$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
    cp "$scratch/$name"/*.glb "$2"
}
"$bin/bolt-models" all -o "$out"
# The finest settings that stay within 250,000 triangles for the near level and 60,000 for the far level.
import "$out/assemblies/zq350/zq350.step" "$out/assemblies/zq350" --lod --deflection 0.25 --angle 32 --contact-deflection 0.35
# Added to the reducer in one variant, so both together stay within these numbers.
import "$out/assemblies/zq350/zq350-base.step" "$out/assemblies/zq350" --lod --deflection 0.25 --angle 32 --far-triangles 4000
import "$out/assemblies/dn200-pn16/dn200-pn16.step" "$out/assemblies/dn200-pn16" --lod --angle 20
import "$out/assemblies/cover-m8/cover-m8.step" "$out/assemblies/cover-m8" --lod --angle 20
import "$out/assemblies/pump-32-160/pump-32-160.step" "$out/assemblies/pump-32-160" --lod --angle 20
for tool in "$out"/tools/*.step; do import "$tool" "$out/tools" --angle 20; done
"$bin/bolt-sculpt" all -o "$out"
