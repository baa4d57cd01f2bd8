#!/usr/bin/env bash
# Compiles a driver and its test outside the tree, with the flags of the tests inside, against what is built, and runs it.
# $1: its source; BUILD: the build folder, build/release unless told.
set -euo pipefail
sources=$(cd "$(dirname "$0")/../.." && pwd)
build=${BUILD:-$sources/build/release}
program=$(mktemp)
trap 'rm -f "$program"' EXIT
# The flags with which CMake compiles the supervisor's test: compiler, warnings, sanitizers.
flags=$(grep -oE '"command": ".* -o tests/[^ ]*/device/supervisor\.cpp\.o ' "$build/compile_commands.json" |
    sed -E 's/^"command": "//; s/ -o .*//; s/ -Winvalid-pch//; s, -include [^ ]*cmake_pch[^ ]*,,g; s/\\"/"/g')
[[ -n $flags ]] || { echo "nothing is built in $build"; exit 1; }
libraries=(tests/libtest_main.a haptics/device/libdevice.a haptics/force/libforce.a haptics/hand/libhand.a engine/base/libbase.a)
$flags -o "$program" "$1" "${libraries[@]/#/$build/}" -lfmt -lhidapi-hidraw -pthread
"$program"
