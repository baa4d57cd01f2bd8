#!/usr/bin/env bash
# A study as its users run it: made, checked, tried with simulated participants, run in a window that is killed, and
# analysed. study.sh BIN SOURCES, on a screen (with_screen.sh).
. "$(dirname "$0")/checks.sh"
export XDG_DATA_HOME=$work/data
study=("$bin/boltwright" study)

# new and check: the shipped studies; nothing is overwritten; mistakes have their place.
expect 2 'subcommand is required' "${study[@]}"
expect 2 'there is no study "papper-2018"; did you mean "paper-2018"' "${study[@]}" new lab --from papper-2018
for name in guiding paper-2018; do
    expect 0 "boltwright study check $name" "${study[@]}" new $name --from $name
    expect 0 'languages in which everything can be read: de, en' "${study[@]}" check $name
done
expect 2 'guiding: there is a study already; expected a new folder' "${study[@]}" new guiding
check 'the schema of the copy exists' test -f "$(sed -n 's/.*"$schema": "\(.*\)",/\1/p' guiding/study.json)"
change() { cp -r guiding "$2" && sed -i "$1" "$2/study.json"; }
change 's/"williams"/"wiliams"/' order
expect 3 '^order/study.json:[0-9]+:[0-9]+: /design/order: .*; did you mean "williams"' "${study[@]}" check order
change 's/"id": "view"/"id": "force"/' twice
expect 3 'there is another condition "force"' "${study[@]}" check twice
change 's/"cover-m8"/"cover-m9"/' assembly
expect 3 'cover-m9' "${study[@]}" check assembly
change 's/"form": "sus"/"form": "ssq"/' texts
expect 3 'texts/questionnaires/ssq.json: .*No such file' "${study[@]}" check texts
cp "$sources/content/questionnaires/ssq.json" texts/questionnaires/
expect 3 'to add: texts/questionnaires/ssq.json: 16 of 16 items have no text in "de"' "${study[@]}" check texts
expect 3 'no language of the program in which everything can be read' "${study[@]}" run texts --trainee Ada
expect 3 'nowhere/study.json: ' "${study[@]}" status nowhere
change 's/"participants": 20/"participants": 18/; s/"cover-m8"/"first-nut"/' uneven
"${study[@]}" simulate uneven --participants 1 --quiet > /dev/null
expect 0 'consider: 18 participants do not balance the design; expected a multiple of 4' "${study[@]}" check uneven

change 's/"lesson": { "guide": true }/"lesson": { "guide": true, "devices": ["novint-falcon"] }/' device
expect 4 '^device/study.json:[0-9]+:[0-9]+: .*there is no device novint-falcon; expected one that `boltwright devices` lists' "${study[@]}" check device
expect 4 'there is no device novint-falcon' "${study[@]}" run device --trainee Ada
check 'nobody is enrolled without the device' test ! -e device/participants/P01
change 's/"assembly": "cover-m8"/"assembly": "cover-m8", "tool": "hammer"/' tool
expect 3 '^tool/study.json:[0-9]+:[0-9]+: .*cover-m8 has no tool "hammer"' "${study[@]}" check tool
change 's/{ "measure": "bumps", "factor": "force" }/{ "measure": "paper.guidance", "factor": "force" }/' again
expect 0 '^consider: again/study.json:[0-9]+:[0-9]+: .*comparison 3 repeats comparison 1' "${study[@]}" check again
change 's/"measure": "bumps", "factor": "force"/"measure": "bumps", "factor": "force", "interaction": "view"/' interaction
expect 0 'not estimated' "${study[@]}" power interaction --studies 5
expect 0 'bumps: force off, on, interaction with view' "${study[@]}" power interaction --studies 5

# grim and power.
expect 1 '11.2: 10 answers from 0 to 10 in steps of 1 cannot have this mean' "${study[@]}" grim --mean 11.2 --n 10 --high 10
expect 2 '--high 1 is below --low 2' "${study[@]}" grim --mean 1.5 --n 10 --low 2 --high 1
expect 1 'cannot have this mean' "${study[@]}" grim --mean 6.684 --n 20
expect 0 'can have this mean' "${study[@]}" grim --mean 6.684 --n 19
expect 2 'expected the printed mean' "${study[@]}" grim --mean six --n 19
expect 0 '^ +(9[0-9]|100).[0-9] %  paper.guidance: force off, on' "${study[@]}" power guiding --effect force=2 --effect both=2 --studies 50
expect 2 '--effect: there is no condition "forse"; did you mean "force"' "${study[@]}" power guiding --effect forse=1
expect 2 'CONDITION=SHIFT, such as force=0.5' "${study[@]}" power guiding --effect force

# simulate: a small study, whose pages say that nobody took part.
change 's/"cover-m8"/"first-nut"/' small
expect 0 '2 simulated participants in small' "${study[@]}" simulate small --participants 2 --quiet
expect 1 'has 2 participants; expected a folder of the study without participants' "${study[@]}" simulate small --quiet
expect 0 '^P02 .* complete .*\(simulated\)' "${study[@]}" status small --html progress.html
check 'a blind study names no condition' bash -c '! "$@" | grep -qw force' - "${study[@]}" status small
check 'nor does its page' bash -c '! grep -qw force progress.html'
expect 0 '^small/results.html' "${study[@]}" results small
check 'the page says that they are simulated' grep -q 'Simulated participants' small/results.html
check 'the answers say that they are simulated' grep -q '^P01,1,' small/answers.csv
check 'the methods say that nobody was trained by playing' grep -q 'was counted without being played' small/results.html
check 'the table has the four conditions' test "$(cut -d, -f3 small/results.csv | sort -u | grep -c .)" -eq 5
check 'the numbers can be read' python3 -c 'import json; r = json.load(open("small/results.json")); assert r["simulated"] and len(r["comparisons"]) == 6'
expect 2 'everything that P01 answered and did is deleted; expected --yes' "${study[@]}" withdraw small P01
expect 0 'P01 withdrew' "${study[@]}" withdraw small P01 --yes
check 'and the pages with the values' test ! -e small/results.html
check 'only the mark of the withdrawal is left' test "$(ls small/participants/P01)" = withdrawn.txt
expect 0 '^P01 .*withdrew' "${study[@]}" status small
expect 1 'has withdrawn the consent' "${study[@]}" withdraw small P01 --yes
sed -i 's/"seed": 4/"seed": 5/' small/study.json
expect 1 'the plan or a form was changed after P02 began' "${study[@]}" results small

# run: in a window, which a second program cannot join, and which loses nothing when it is killed.
expect 2 'nobody takes part; expected --trainee NAME' "${study[@]}" run guiding
expect 4 'window' env -u DISPLAY "${study[@]}" run guiding --trainee Ada
check 'without a display nobody is enrolled' test ! -e guiding/participants/P01
expect 1 'people and simulated participants are never mixed' "${study[@]}" run uneven --trainee Ada
expect 1 'there is no such participant' "${study[@]}" run guiding --participant P07
"${study[@]}" run guiding --trainee Ada --silent 2> log &
player=$!
check 'a window leads the new participant' eventually test -f guiding/progress.html
expect 1 'P01 is led by another program; expected the end of that program' "${study[@]}" run guiding --participant P01
expect 0 '^P01 +0 of .* language' "${study[@]}" status guiding
kill -KILL $player
wait $player 2> /dev/null
player=
expect 0 '^P01 +0 of .* language' "${study[@]}" status guiding
check 'the code is in the journal' grep -q T- guiding/participants/P01/journal.db
check 'and not the name' bash -c '! grep -q Ada guiding/participants/P01/journal.db'
rm guiding/progress.html
# The clock is set back by 26 days: faketime is not needed, because the journal is moved forwards.
python3 - <<'PYTHON'
import sqlite3
journal = sqlite3.connect("guiding/participants/P01/journal.db")
journal.execute("UPDATE study_journal_1 SET time = strftime('%Y-%m-%dT%H:%M:%SZ', time, '+26 days')")
journal.commit()
PYTHON
expect 0 "^P01 .*last entry .*, 26.0 days ahead of this computer's clock; expected the right date and time" "${study[@]}" status guiding
expect 2 'P01: the last entry is of .*, but the clock of this computer says .*; expected the right date and time' "${study[@]}" run guiding --trainee Ada
"${study[@]}" run guiding --trainee Ada --silent --accept-clock 2> log &
player=$!
check 'the window opens again' eventually test -f guiding/progress.html
check 'the same person continues as P01' grep -q '^P01: language' log
kill -INT $player
wait $player
check 'an interruption ends it in order' test $? -eq 0
player=
expect 0 'answers .*guiding/participants/P01/journal.db' "$bin/boltwright" trainees show Ada guiding
expect 0 'answers .*guiding/participants/P01/journal.db' "$bin/boltwright" trainees show Ada
expect 0 . "$bin/boltwright" trainees export Ada --out mine
check 'a person can read what was stored' grep -q '"kind": "enrolled"' mine/index.json
check 'nobody else was enrolled' test "$(ls -d guiding/participants/P* | wc -l)" -eq 1
mv guiding moved
expect 1 'guiding: the folder of this study is not there, so it was not searched; expected .*studies.txt' "$bin/boltwright" trainees erase Ada --yes
expect 1 'the name is kept; expected' "$bin/boltwright" trainees erase Ada --yes
mv moved guiding
expect 0 'deleted .*guiding/participants/P01/journal.db' "$bin/boltwright" trainees erase Ada --yes
check 'the name is deleted with the rest' bash -c '! grep -q Ada "$XDG_DATA_HOME/boltwright/people/names.json"'
check 'an erased person leaves only the mark' test "$(ls guiding/participants/P01)" = withdrawn.txt
expect 0 '^P01 .*withdrew' "${study[@]}" status guiding
finish_checks
