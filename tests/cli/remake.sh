#!/usr/bin/env bash
# All generated models and pictures in content equal the output of their generators byte for byte. $1: programs, $2: sources.
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
# All shipped models and pictures are generated.
while read -r file; do
    [[ -e $work/$file ]] || { echo "FAILED: content/$file has no generator"; failed=1; }
done < <(cd "$2/content" && find . -name '*.glb' -o -name '*.step' -o -name '*.hdr')
[[ $made -ge 28 ]] || { echo "FAILED: only $made files were generated"; failed=1; }
"$1/bolt-icon" -o "$work/boltwright.svg"
cmp "$work/boltwright.svg" "$2/tools/package/boltwright.svg" || failed=1
echo "$made files generated"
exit $failed
