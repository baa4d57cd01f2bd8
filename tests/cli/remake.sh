#!/usr/bin/env bash
# All generated models and pictures in content equal the output of their generators byte for byte. $1: programs, $2: sources,
# $3: versions of libraries that give other bytes; empty: those with which the content is made. With other versions the models are
# compared within a tolerance, and STEP files, whose entities have other numbers, are not compared.
set -euo pipefail
. "$2/tests/support/skip.sh" remake
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$2/tools/remake-content.sh" "$1" "$work" >/dev/null
made=0
failed=0
same() {  # same FILE
    cmp "$work/$1" "$2/$1" && return
    [[ -n $3 ]] || return 1
    case $1 in
        *.glb) "$4" "$work/$1" "$2/$1" ;;
        *.step) ;;
        *) false ;;
    esac
}
while read -r file; do
    made=$((made + 1))
    same "$file" "$2/content" "${3:-}" "$1/test_model_difference" || { echo "FAILED: content/$file"; failed=1; }
done < <(cd "$work" && find . -type f | sort)
# All shipped models and pictures are generated.
while read -r file; do
    [[ -e $work/$file ]] || { echo "FAILED: content/$file has no generator"; failed=1; }
done < <(cd "$2/content" && find . -name '*.glb' -o -name '*.step' -o -name '*.hdr')
[[ $made -ge 32 ]] || { echo "FAILED: only $made files were generated"; failed=1; }
"$1/bolt-icon" -o "$work/boltwright.svg"
cmp "$work/boltwright.svg" "$2/tools/package/boltwright.svg" || failed=1
[[ -z ${3:-} ]] || skip_part "equal bytes: $3"
echo "$made files generated"
exit $failed
