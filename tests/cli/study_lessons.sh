#!/usr/bin/env bash
# The lessons of a study in a window: a killed program continues a lesson at the point reached, and a damaged recording makes it
# begin again. study_lessons.sh BIN SOURCES, on a screen (with_screen.sh).
. "$(dirname "$0")/checks.sh"
export XDG_DATA_HOME=$work/data
study=("$bin/boltwright" study)

# A study of one condition without forms before it, whose participant has done everything up to the first lesson.
make_study() {  # make_study FOLDER CONDITIONS
    mkdir "$1"
    cat > "$1/study.json" <<END
{
  "format": "boltwright study 1", "id": "small",
  "title": { "en": "Small" }, "information": { "en": "Purpose." }, "consent": { "en": ["I take part."] },
  "design": { "subjects": "within", "participants": 1 },
  "lesson": { "assembly": "first-nut" },
  "conditions": [$2]
}
END
}
to_first_lesson() {  # to_first_lesson FOLDER: adds the entries of the pages before the lesson
    python3 - "$1/participants/P01/journal.db" <<'PYTHON'
import sqlite3, sys
journal = sqlite3.connect(sys.argv[1])
last, time = journal.execute("SELECT max(n), max(time) FROM study_journal_1").fetchone()
entries = [("language", "", "en"), ("step_done", "language", ""), ("step_done", "information", ""), ("step_done", "consent", "")]
for n, (kind, step, text) in enumerate(entries, last + 1):
    journal.execute("INSERT INTO study_journal_1 VALUES (?, ?, ?, ?, '', NULL, ?)", (n, kind, time, step, text))
journal.commit()
PYTHON
}
lead() { "${study[@]}" run "$@" --silent --size 760x480 2> log & player=$!; }  # lead FOLDER OPTION...
logged() { grep -qE "$1" log; }
press() { xdotool key --window "$(xdotool search --pid $player 2>/dev/null | tail -1)" "$@" 2>/dev/null; }
click() { xdotool mousemove "$1" "$2"; sleep 0.3; xdotool mousedown 1; sleep 0.3; xdotool mouseup 1; sleep 0.3; }
start_button=(643 384) end_button=(379 304) quit_button=(379 337)  # in px; the buttons of other sizes lie elsewhere
# Presses the page's button until the lesson has started.
started() {
    logged '^lesson (begun|continued)' && return
    click "${start_button[@]}"
    sleep 1
    logged '^lesson (begun|continued)'
}
taken() {
    logged 'the wrench is in the hand' && return
    press t
    sleep 2  # a second press would lay it down again
    logged 'the wrench is in the hand'
}
stop() { kill "-$1" $player; wait $player 2> /dev/null; player=; }
recorded() { "$bin/boltwright" export "$1/session.boltwright" --csv - | tail -n +2 | wc -l; }
begin() {  # begin FOLDER: enrols, and leads to the first lesson
    lead "$1" --trainee Ada
    check "$1: a participant is enrolled" eventually test -f "$1/progress.html"
    stop KILL
    to_first_lesson "$1"
    lead "$1" --participant P01
}

# Killed in a lesson, with the wrench in the hand.
make_study killed '{ "id": "a", "title": { "en": "A" } }'
own=killed/participants/P01
begin killed
check 'the lesson begins' eventually started
check 'T takes the wrench' eventually taken
stop KILL
first=$(recorded $own/part-1-lesson-1)
check "the killed lesson has kept $first ticks" test "$first" -gt 500
expect 0 'part-1/lesson-1' "${study[@]}" status killed
lead killed --participant P01
check 'the lesson is continued' eventually started
check 'at the point reached' logged "^lesson continued after $(awk -v n="$first" 'BEGIN { printf "%.1f", n / 1000 }') s"
check 'the wrench can be taken again' eventually taken
press Escape
left() {
    kill -0 $player 2> /dev/null || return 0
    click "${quit_button[@]}"
    ! kill -0 $player 2> /dev/null
}
check 'the participant leaves by the pause menu' bash -c "$(declare -f left click); quit_button=(${quit_button[*]}); for i in \$(seq 60); do player=$player; left && exit 0; done; exit 1"
wait $player
player=
second=$(recorded $own/part-1-lesson-1-2)
check "the second recording has both parts: $second ticks" test "$second" -gt "$first"
expect 0 "all as they were recorded; interrupted and continued after" "$bin/boltwright" replay $own/part-1-lesson-1-2/session.boltwright
expect 0 'ticks \([0-9.]+ s\), all as they were recorded$' "$bin/boltwright" replay $own/part-1-lesson-1/session.boltwright
"$bin/boltwright" export $own/part-1-lesson-1/session.boltwright --csv first.csv > /dev/null
"$bin/boltwright" export $own/part-1-lesson-1-2/session.boltwright --csv second.csv > /dev/null
check 'which begin with the same ticks' cmp <(head -n $((first + 1)) first.csv) <(head -n $((first + 1)) second.csv)

# The participant ends the continued lesson, whose measures count all parts.
lead killed --participant P01
check 'the lesson is continued again' eventually started
press Escape
ended() {
    logged '^lesson ended' && return
    click "${end_button[@]}"
    logged '^lesson ended'
}
check 'the participant ends it' eventually ended
check 'it is counted' eventually bash -c "'$bin/boltwright' study status killed | grep -q ' comment'"
stop INT
third=$(recorded $own/part-1-lesson-1-3)
expect 0 . "${study[@]}" results killed
check 'the duration counts all parts, and not the pauses' awk -F, -v n="$third" -v least="$second" \
    '$7 == "duration_s" { found = $8 * 1000 > n - 2 && $8 * 1000 < n + 2 && n > least } END { exit !found }' killed/results.csv
check 'the methods tell of the interruption' grep -q '1 lesson was interrupted. 2 times, a lesson was continued at the point reached' killed/results.html
check 'the report of the session too' grep -q 'interrupted and continued' $own/part-1-lesson-1-3/report.html

# A recording that is torn begins again, and says so.
make_study torn '{ "id": "a", "title": { "en": "A" } }'
begin torn
check 'another lesson begins' eventually started
sleep 2
stop INT
truncate -s 20000 torn/participants/P01/part-1-lesson-1/session.boltwright
lead torn --participant P01
check 'it begins again' eventually started
check 'and the reason is printed' logged '^the interrupted lesson cannot be continued and begins again: .*part-1-lesson-1/session.boltwright'
stop INT
check 'and is in the journal' grep -q 'part-1-lesson-1/session.boltwright: ' torn/participants/P01/journal.db
expect 0 . "${study[@]}" results torn
check 'the methods say that it began again' grep -q 'Once, a lesson began again; only the last attempt counts' torn/results.html
finish_checks
