#!/usr/bin/env bash
# Draws the golden pictures anew, after a change that is meant to change them. Look at every one that git says has changed, and
# at `bolt-imagediff OLD NEW`, before you commit it. $1: the build to take, build/release by default.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=${1:-build/release}
cmake --build "$build" --target test_golden
rm -f tests/golden/pictures/*.png tests/golden/pictures/driver.txt
BOLTWRIGHT_CONTENT=$PWD/content BOLT_GOLDEN_UPDATE=1 "$build/bin/test_golden" --source-file='*/tests/golden/scenes_*'
git status --short tests/golden/pictures
