#!/usr/bin/env bash
# What the guiding force does to simulated trainees, or the help with the view: the same lessons with it and without, over seeds,
# and a page that compares.
#   tools/study.sh OUT                                   20 seeds of novice and clumsy on zq350 and cover-m8
#   SEEDS=5 TRAINEES="expert" tools/study.sh OUT zq350   fewer, or others
#   STUDY=view tools/study.sh OUT                        the help with the view, among guided lessons
# BIN: where the programs are (build/release/bin); JOBS: lessons at a time (as many as cores). On 2 cores the 160 lessons take
# about a quarter of an hour. Sessions stay in OUT/sessions, 10 MB each for zq350; lessons that are there already are not played again.
set -euo pipefail
if [[ $# -lt 1 ]]; then
    sed -n '2,9s/^# \?//p' "$0" >&2
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
    guiding) ways=("" --no-guide) ;;
    view) ways=("" --view-help) ;;
    *) echo "STUDY is guiding or view, not $STUDY" >&2; exit 2 ;;
esac
mkdir -p "$out/sessions"

# A lesson that is not finished (exit 1) is a result like any other.
play() {
    local name folder status=0
    name=$(basename "$3")-$4-$5$6
    folder=$2/sessions/$name
    [[ -e $folder.played ]] && return  # to its end: one that was stopped has a summary too
    "$1" train "$3" --headless --quiet --no-pictures --operator "$4" --seed "$5" ${6:+"$6"} --out "$folder" \
        >"$folder.txt" 2>&1 || status=$?
    [[ $status -le 1 ]] && touch "$folder.played" || cat "$folder.txt" >&2
    echo "$name: $(grep -E ' s, score ' "$folder.txt" || echo "exit $status")" >&2
}
export -f play
for assembly in "${assemblies[@]}"; do
    for trainee in ${TRAINEES:-novice clumsy}; do
        for seed in $(seq "${SEEDS:-20}"); do
            for way in "${ways[@]}"; do
                printf '%s\0' "$bin/boltwright" "$out" "$assembly" "$trainee" "$seed" "$way"
            done
        done
    done
done | xargs -0 -n 6 -P "${JOBS:-$(nproc)}" bash -c 'play "$@"' play
mapfile -d '' sessions < <(find "$out/sessions" -name session.boltwright -print0 | sort -zV)
"$bin/boltwright" report --overview "${sessions[@]}" --html "$out/study.html"
