#!/usr/bin/env bash
# Compares lessons of simulated trainees with and without the guiding force (or the view help) over several seeds, and writes a
# page with the comparison. docs/performance.md needs such lessons, of stated trainees that differ in the help alone; `boltwright
# study simulate` draws the kind of trainee at random for each participant and seeds each lesson by itself.
#   tools/study.sh OUT                                   20 seeds of novice and clumsy on zq350 and cover-m8
#   SEEDS=5 TRAINEES="expert" tools/study.sh OUT zq350   other seeds, trainees and assemblies
#   STUDY=view tools/study.sh OUT                        the view help, in guided lessons
# BIN: folder of the programs (build/release/bin); JOBS: parallel lessons (number of cores). On 2 cores the 160 lessons take about
# a quarter of an hour. Sessions stay in OUT/sessions, 10 MB each for zq350; lessons that are complete are not played again.
set -euo pipefail
if [[ $# -lt 1 ]]; then
    sed -n '2,11s/^# \?//p' "$0" >&2
    exit 2
fi
out=$1
shift
root=$(cd "$(dirname "$0")/.." && pwd)
bin=$(cd "${BIN:-$root/build/release/bin}" && pwd)
export BOLTWRIGHT_CONTENT=${BOLTWRIGHT_CONTENT:-$root/content}
assemblies=("$@")
[[ $# -gt 0 ]] || assemblies=(cover-m8 zq350)
case ${STUDY:-guiding} in
    guiding) variants=("" --no-guide) ;;
    view) variants=("" --view-help) ;;
    *) echo "STUDY: is '$STUDY'; expected guiding or view" >&2; exit 2 ;;
esac
mkdir -p "$out/sessions"

# An unfinished lesson (exit status 1) counts as a result.
play() {
    local name folder status=0
    name=$(basename "$3")-$4-$5$6
    folder=$2/sessions/$name
    [[ -e $folder.played ]] && return  # .played marks a complete run; an interrupted run may have a summary too
    "$1" train "$3" --headless --quiet --no-pictures --operator "$4" --seed "$5" ${6:+"$6"} --out "$folder" \
        >"$folder.txt" 2>&1 || status=$?
    [[ $status -le 1 ]] && touch "$folder.played" || cat "$folder.txt" >&2
    echo "$name: $(grep -E ' s, score ' "$folder.txt" || echo "exit $status")" >&2
}
export -f play
for assembly in "${assemblies[@]}"; do
    for trainee in ${TRAINEES:-novice clumsy}; do
        for seed in $(seq "${SEEDS:-20}"); do
            for variant in "${variants[@]}"; do
                printf '%s\0' "$bin/boltwright" "$out" "$assembly" "$trainee" "$seed" "$variant"
            done
        done
    done
done | xargs -0 -n 6 -P "${JOBS:-$(nproc)}" bash -c 'play "$@"' play
mapfile -d '' sessions < <(find "$out/sessions" -name session.boltwright -print0 | sort -zV)
"$bin/boltwright" report --overview "${sessions[@]}" --html "$out/study.html"
