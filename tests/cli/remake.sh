#!/usr/bin/env bash
# Every model and picture that a program makes is what the program makes, byte for byte. $1: programs, $2: sources.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$2/tools/remake-content.sh" "$1" "$work" >/dev/null
made=0
failed=0
while read -r file; do
    made=$((made + 1))
    cmp "$work/$file" "$2/content/$file" || failed=1
done < <(cd "$work" && find . -type f | sort)
# And nothing is shipped that no program made.
while read -r file; do
    [[ -e $work/$file ]] || { echo "FAILED: no program makes content/$file"; failed=1; }
done < <(cd "$2/content" && find . -name '*.glb' -o -name '*.step' -o -name '*.hdr')
[[ $made -ge 28 ]] || { echo "FAILED: only $made files were made"; failed=1; }
echo "$made files made again"
exit $failed
