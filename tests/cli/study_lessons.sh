#!/usr/bin/env bash
# The lessons of a study in a window: a killed program continues a lesson at the point reached, and a damaged recording makes it
# begin again. study_lessons.sh BIN SOURCES, on a screen (with_screen.sh).
. "$(dirname "$0")/checks.sh"
. "$sources/tests/cli/study_window.sh"

# Killed in a lesson, with the wrench in the hand.
make_study killed '{ "id": "a", "title": { "en": "A" } }'
own=killed/participants/P01
begin killed
check 'the lesson begins' eventually started
check 'T takes the wrench' eventually taken
recorded_enough() { [[ $(recorded $own/part-1-lesson-1 2> /dev/null) -gt 500 ]]; }
check 'the recording has ticks' eventually recorded_enough
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
