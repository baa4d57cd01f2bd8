#!/usr/bin/env bash
# Records a film of a whole lesson played in the window: film.sh BUILD FILM.mkv ASSEMBLY [MODE [TOOL]].
# BOLT_FILM_OVERDO=1: one nut is overtightened first. The session stays in BUILD/trainer/lesson.
set -euo pipefail
if [[ $# -lt 3 ]]; then
    sed -n 's/^# //p' "$0" >&2
    exit 2
fi
here=$(cd "$(dirname "$0")" && pwd)
build=$1 film=$2
export BOLT_FILM=$3 BOLT_FILM_MODE=${4:-guided} BOLT_FILM_TOOL=${5:-} BOLT_FILM_SIZE=${BOLT_FILM_SIZE:-960x600}
export BOLTWRIGHT_CONTENT=${BOLTWRIGHT_CONTENT:-$here/../../content} ASAN_OPTIONS=detect_leaks=0
record() {
    ffmpeg -loglevel error -y -f x11grab -framerate 10 -video_size "$BOLT_FILM_SIZE" -i "$DISPLAY" \
        -c:v libx264 -preset veryfast -pix_fmt yuv420p "$film" &
    local camera=$! rc=0
    "$build/bin/test_trainer_window" -tc='Window: a whole lesson*' || rc=$?
    kill -INT $camera
    wait $camera || true
    return $rc
}
export -f record
export build film
"$here/../with_screen.sh" bash -c record
