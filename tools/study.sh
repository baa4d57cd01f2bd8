#!/usr/bin/env bash
# What the guiding force does to simulated trainees: the same lessons with it and without, over seeds, and a page that compares.
#   tools/study.sh OUT                                   20 seeds of novice and clumsy on zq350 and cover-m8
#   SEEDS=5 TRAINEES="expert" tools/study.sh OUT zq350   fewer, or others
# BIN: where the programs are (build/release/bin); JOBS: lessons at a time. Sessions stay in OUT/sessions, 10 MB each for zq350.
set -euo pipefail
if [[ $# -lt 1 ]]; then
    sed -n '2,5s/^# \?//p' "$0" >&2
    exit 2
fi
out=$1
shift
cd "$(dirname "$0")/.."
[[ $out = /* ]] || out=$OLDPWD/$out
bin=${BIN:-build/release/bin}
export BOLTWRIGHT_CONTENT=${BOLTWRIGHT_CONTENT:-content}
assemblies=("$@")
[[ $# -gt 0 ]] || assemblies=(cover-m8 zq350)
mkdir -p "$out/sessions"

# A lesson that is not finished (exit 1) is a result like any other.
play() {
    local name=$4-$5-$6${7:-}
    "$1" train "$4" --headless --quiet --no-pictures --operator "$5" --seed "$6" ${7:+"$7"} \
        --out "$2/sessions/$name" >"$2/sessions/$name.txt" 2>&1 || [[ $? -eq 1 ]] || cat "$2/sessions/$name.txt" >&2
}
export -f play
sessions=()
for assembly in "${assemblies[@]}"; do
    for trainee in ${TRAINEES:-novice clumsy}; do
        for seed in $(seq "${SEEDS:-20}"); do
            for guide in "" --no-guide; do
                printf '%s\0' "$bin/boltwright" "$out" - "$assembly" "$trainee" "$seed" "$guide"
            done
        done
    done
done | xargs -0 -n 7 -P "${JOBS:-$(nproc)}" bash -c 'play "$@"' play
mapfile -d '' sessions < <(find "$out/sessions" -name session.boltwright -print0 | sort -zV)
"$bin/boltwright" report --overview "${sessions[@]}" --html "$out/study.html"
