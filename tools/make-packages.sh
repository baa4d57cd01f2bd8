#!/usr/bin/env bash
# Builds the Debian packages of this system into OUT (default: build/package/packages): tools/make-packages.sh [OUT]
set -euo pipefail
cd "$(dirname "$0")/.."
tools/install-packages.sh build package
out=${1:-build/package/packages}
cmake --preset package >/dev/null
cmake --build --preset package -- --quiet
rm -rf build/package/cpack
cpack --config build/package/CPackConfig.cmake -B build/package/cpack >build/package/cpack.log || { cat build/package/cpack.log; exit 1; }
mkdir -p "$out"
cp build/package/cpack/*.deb "$out"
find build/package/cpack -name '*.ddeb' -exec cp {} "$out" \;
ls -l "$out"
