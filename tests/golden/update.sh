#!/usr/bin/env bash
# Redraws the golden pictures after an intended change of their appearance. Before you commit, inspect every picture that git
# lists as changed, and the output of `bolt-imagediff OLD NEW`. $1: the build folder, build/release by default.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=${1:-build/release}
cmake --build "$build" --target test_golden
rm -f tests/golden/pictures/*.png tests/golden/pictures/driver.txt
BOLTWRIGHT_CONTENT=$PWD/content BOLT_GOLDEN_UPDATE=1 "$build/bin/test_golden" --source-file='*/tests/golden/scenes_*'
git status --short tests/golden/pictures
