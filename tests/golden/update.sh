#!/usr/bin/env bash
# Redraws the golden pictures of this version of the driver after an intended change of their appearance; BOLT_GOLDEN_UPDATE=1
# tests/debian13.sh redraws those of Debian 13. Before you commit, inspect every picture that git lists as changed, and the output
# of `bolt-imagediff OLD NEW`. $1: the build folder, build/release by default.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=${1:-build/release}
cmake --build "$build" --target test_golden
begun=$(mktemp)
trap 'rm "$begun"' EXIT
BOLTWRIGHT_CONTENT=$PWD/content BOLT_GOLDEN_UPDATE=1 "$build/bin/test_golden" --source-file='*/tests/golden/scenes_*'
folder=$(dirname "$(find tests/golden/pictures -name driver.txt -newer "$begun")")
[[ -f $folder/driver.txt ]]
find "$folder" -name '*.png' ! -newer "$begun" -delete # of scenes that are gone
if command -v git >/dev/null; then git status --short "$folder"; fi
