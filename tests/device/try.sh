#!/usr/bin/env bash
# Compiles a driver and its test outside the tree with the flags of the tests, links the built libraries and runs the program.
# $1: the source; BUILD: the build folder, build/release by default.
set -euo pipefail
sources=$(cd "$(dirname "$0")/../.." && pwd)
build=${BUILD:-$sources/build/release}
program=$(mktemp)
trap 'rm -f "$program"' EXIT
# CMake's compiler, warnings and sanitizers for the tests of the devices.
flags=$(grep -m1 -oE '"command": ".* -o tests/[^ ]*/test_device\.dir/[^ ]*\.o ' "$build/compile_commands.json" |
    sed -E 's/^"command": "//; s/ -o .*//; s/ -Winvalid-pch//; s, -include [^ ]*cmake_pch[^ ]*,,g; s/\\"/"/g')
[[ -n $flags ]] || { echo "nothing is built in $build"; exit 1; }
read -ra libraries < <(sed -n '/^build bin\/test_device:/,/^$/s/^ *LINK_LIBRARIES = //p' "$build/build.ninja")
source=$(realpath "$1")
cd "$build"
$flags -o "$program" "$source" "${libraries[@]}" -pthread
"$program"
