# Functions for scripts that lead a participant of a study in a window at the corner of the screen: source it after checks.sh.
export XDG_DATA_HOME=$work/data
study=("$bin/boltwright" study)

# A study without forms, whose participant has done everything up to the first lesson.
make_study() {  # make_study FOLDER CONDITIONS
    mkdir "$1"
    cat > "$1/study.json" <<END
{
  "format": "boltwright study 1", "id": "small",
  "title": { "en": "Small" }, "information": { "en": "Purpose." }, "consent": { "en": ["I take part."] },
  "design": { "subjects": "within", "participants": 1, "seed": 2 },
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
lead() { : > log; "${study[@]}" run "$@" --silent --size 760x480 2>> log & player=$!; }  # lead FOLDER OPTION...
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
