#!/usr/bin/env bash
# Prints the tests that were skipped, wholly or in part, from the files that they left in the folder $1 ($BOLT_SKIPPED); $2 names
# the build. It prints no line if no test was skipped.
set -euo pipefail
shopt -s nullglob
files=("$1"/*.txt)
[[ ${#files[@]} -gt 0 ]] || exit 0
echo "== $2: skipped, not passed"
LC_ALL=C sort -u "${files[@]}"
