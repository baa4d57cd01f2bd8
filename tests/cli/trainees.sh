#!/usr/bin/env bash
# `boltwright trainees`: the whole life of a person's data: trainees.sh BIN SOURCES. It needs a screen (with_screen.sh), because a
# person's session needs a window.
. "$(dirname "$0")/checks.sh"
export HOME=$work XDG_DATA_HOME=$work/data
people=$XDG_DATA_HOME/boltwright/people
trainees=("$bin/boltwright" trainees)

# Simulates a person who starts a lesson and ends it with Ctrl+C.
person() {  # person FOLDER train's options...
    local folder=$1
    shift
    "$bin/boltwright" train cover-m8 --start --silent --size 320x200 --out "$folder" "$@" 2>"$work/log" >/dev/null &
    player=$!
    begun() { grep -qs 'lesson begun' "$work/log"; }
    eventually begun && sleep 0.5
    kill -INT $player
    wait $player
    player=
    [[ -s $folder/session.boltwright ]]
}
code_of() { grep -A1 -B1 "\"name\": \"$1\"" "$people/names.json" | grep -oE 'T-[0-9A-Z]{6}'; }
holds() { grep -rqaF -- "$1" "$2"; }  # holds TEXT FOLDER

expect 0 'Nobody has trained here' "${trainees[@]}" list

# Two lessons of a person under the name and under the code, with settings and a calibration, and a lesson of another person.
check "a lesson of Adalbert" person out/one --trainee Adalbert
ada=$(code_of Adalbert)
check "the name got a code" test -n "$ada"
check "a second lesson, under the code in small letters" person out/two --trainee "${ada,,}"
check "a lesson of Bea" person out/bea --trainee ' Bea '
bea=$(code_of Bea)
check "Bea has another code" test -n "$bea" -a "$bea" != "$ada"
expect 0 "Saved to gloves/$ada.right.glove.json for Adalbert \($ada\)" "$bin/boltwright" glove import \
    "$sources/tests/fuzz/corpus/hand.cal" --trainee Adalbert --sensors 22 --folder gloves
mkdir -p data/boltwright/gloves data/boltwright/settings
mv gloves/* data/boltwright/gloves/
# Settings of an older program, under the typed name.
sed "s/\"trainee\": \"[^\"]*\"/\"trainee\": \"Adalbert\"/" "$sources/tests/fuzz/corpus/ada.settings.json" \
    > data/boltwright/settings/_41dalbert.settings.json
check "a third lesson adopts settings of an older program" person out/three --trainee Adalbert
check "... and renames them" test -s "data/boltwright/settings/$ada.settings.json" -a ! -e data/boltwright/settings/_41dalbert.settings.json
check "... and rewrites them" grep -q "\"trainee\": \"$ada\"" "data/boltwright/settings/$ada.settings.json"
check "the summary has the code" grep -q "\"trainee\": \"$ada\"" out/one/summary.json
check "the report has the code" grep -q "<dd>$ada</dd>" out/one/report.html
for place in out data/boltwright/settings data/boltwright/gloves; do
    check "no file in $place has a name" bash -c "! grep -rqaE 'Adalbert|Bea' $place"
done
check "no file name has a name" test -z "$(find out data -iname '*dalbert*')"
check "only the user can read the names" test "$(stat -c %a "$people/names.json")" = 600

# Reports show codes unless names are requested.
expect 0 page.html "$bin/boltwright" report out/{one,two,three,bea}/session.boltwright --html page.html
check "a report has codes alone" bash -c "grep -q '<h3>$ada <span' page.html && ! grep -qE 'Adalbert|Bea' page.html"
expect 0 named.html "$bin/boltwright" report out/{one,two,three,bea}/session.boltwright --names --html named.html
check "... and names beside codes with --names" grep -q "<h3>Adalbert ($ada) <span" named.html

# list, show, and mistyped names.
expect 0 "$ada  Adalbert +11  20[0-9-]+ [0-9:]+" "${trainees[@]}" list
expect 0 "$bea  Bea +3 " "${trainees[@]}" list
expect 0 "^Adalbert \($ada\)" "${trainees[@]}" show Adalbert
expect 0 "session +20.* out/two/session.boltwright" "${trainees[@]}" show "$ada"
expect 0 "Small flanged cover|cover-m8, guided, tighten" "${trainees[@]}" show "$ada"
expect 0 "calibration.*$ada.right.glove.json" "${trainees[@]}" show "${ada,,}"
expect 2 'nothing about a trainee "Adalbrt"; did you mean "Adalbert"\?' "${trainees[@]}" show Adalbrt
expect 2 'nothing about a trainee "Zoe".*trainees list' "${trainees[@]}" erase Zoe --yes
expect 2 'nowhere: there is no such folder' "${trainees[@]}" list nowhere
expect 2 'WHO is required' "${trainees[@]}" show
expect 2 'did you mean|not expected|A subcommand is required' "${trainees[@]}" lits

# export
expect 2 'out is required' "${trainees[@]}" export Adalbert
expect 2 'is not empty; expected a new or empty folder' "${trainees[@]}" export Adalbert --out data
expect 2 'is inside out' "${trainees[@]}" export Adalbert --out out/copy
expect 0 'copy/index.json' "${trainees[@]}" export Adalbert --out copy
check "everything is exported" test "$(find copy -type f | wc -l)" -eq 12
check "the index names the person and the files" bash -c \
    "python3 -c \"import json; i = json.load(open('copy/index.json')); assert i['name'] == 'Adalbert' and i['code'] == '$ada' and len(i['files']) == 11\""
check "the export has no other person" bash -c "! grep -rqaE 'Bea|$bea' copy"
expect 0 copied.html "$bin/boltwright" report copy/sessions/001/session.boltwright --html copied.html

# The name alone, and the damaged file of names.
cp "$people/names.json" names.saved
echo '{"format": "boltwright names 1", "people": 3}' > "$people/names.json"
expect 0 "names.json:1:44: .*is not a list" "${trainees[@]}" list
expect 0 "$ada +- |$ada  +11" "${trainees[@]}" list
check "a lesson is possible with a damaged file of names" person out/four --trainee Adalbert
check "... the reason is on stderr" grep -qE 'names.json:1:44: .*is not a list' log
four=$(grep -oaE '"trainee": "T-[0-9A-Z]{6}"' out/four/summary.json)
check "... under a new code" test -n "$four" -a "$four" != "\"trainee\": \"$ada\""
check "... and the file is unchanged" grep -q '"people": 3' "$people/names.json"
expect 3 'names.json:1:44' "$bin/boltwright" glove import "$sources/tests/fuzz/corpus/hand.cal" --trainee Cy --folder gloves
cp names.saved "$people/names.json"
rm -r out/four
expect 2 'no terminal to ask: Delete the name of Bea .*; expected --yes' "${trainees[@]}" erase Bea --name-only
expect 0 "deleted the name of $bea" "${trainees[@]}" erase Bea --name-only --yes
expect 0 "$bea +3 " "${trainees[@]}" list
check "the name is forgotten" bash -c "! grep -q Bea '$people/names.json'"
expect 2 'no entry in the file of names' "${trainees[@]}" erase "$bea" --name-only --yes

# erase
cp page.html out/class.html
expect 2 'no terminal to ask: Delete 11 files of Adalbert' "${trainees[@]}" erase Adalbert
check "... and nothing is deleted" test -s out/one/session.boltwright
expect 1 'out/class.html: shows other people too' "${trainees[@]}" erase Adalbert --yes
check "all files of the person are deleted" bash -c "! find out data | grep -E '$ada|one|two|three'"
check "... and the name" bash -c "! grep -q Adalbert '$people/names.json'"
check "the other person's lesson is untouched" test -s out/bea/session.boltwright -a -s out/bea/report.html
check "the page with both is kept" test -s out/class.html
rm out/class.html
expect 0 "deleted out/bea/session.boltwright" "${trainees[@]}" erase "$bea" --yes
expect 0 'Nobody has trained here' "${trainees[@]}" list
check "only the folder of names and its lock are left" \
    test "$(find data -type f | sort | xargs -n1 basename | tr '\n' ' ')" = 'names.json names.lock '
finish_checks
