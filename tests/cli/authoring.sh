#!/usr/bin/env bash
# Runs all sh blocks of content/AUTHORING.md in order in an empty folder. $1: programs, $2: sources.
set -euo pipefail
. "$2/tests/support/skip.sh" authoring
export PATH="$1:$PATH" SOURCES="$2" BOLTWRIGHT_CONTENT="$2/content"
if bolt-author import-step --help | grep -q 'without OpenCASCADE'; then
    skip_all "this build has no import-step, which needs OpenCASCADE"
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
awk '/^```sh$/ { on = 1; next } /^```$/ { on = 0 } on' "$2/content/AUTHORING.md" > "$work/walk.sh"
[[ $(grep -c . "$work/walk.sh") -ge 12 ]] || { echo "no sh blocks found"; exit 1; }
mkdir "$work/empty" "$work/home"
unset XDG_DATA_HOME
export HOME="$work/home"
cd "$work/empty"
bash -euxo pipefail ../walk.sh > ../log 2>&1 || { cat ../log; exit 1; }
failed=0
expect() { grep -qE -- "$1" "$2" || { echo "FAILED: no /$1/ in $2"; cat "$2"; failed=1; }; }
for file in bracket/bracket.glb bracket/bracket.far.glb bracket/bracket.contact.glb bracket.png curve.csv report.html ring-18.glb ring-18.png; do
    [[ -s $file ]] || { echo "FAILED: $file is missing"; failed=1; }
done
expect '^bracket/assembly.json: 2 joints, 5 passes, variant -: no mistakes' ../log
expect 'contact model: watertight' ../log
expect 'tool: an open-end wrench of 18 mm, 180 mm from the jaw to the grip, generated from these numbers' ../log
expect '^room/J2.png: [0-9.]+ degrees of free swing' ../log
expect '^socket-18.contact.glb: [0-9]+ bytes' ../log
expect '"id": "J2"' lesson/summary.json
expect '"obstacles": true' lesson/summary.json
expect '"assembly": "bracket"' lesson/summary.json
expect '"model_far": "bracket.far.glb"' bracket/assembly.json
# Both mistakes of the wrong copy are reported, each with its position.
expect 'assembly.json:[0-9]+:[0-9]+: /joints/1/node: there is no node "joint_J22" in the model; did you mean "joint_J2"\?' mistakes.txt
expect '/joints/0/position_mm: the joint is \[-50, 27, 9\] mm here, but its node "joint_J1" stands at \[-50, 27, 8\] mm, 1 mm away' mistakes.txt
[[ $(wc -l < mistakes.txt) -eq 2 ]] || { echo "FAILED: not two mistakes"; cat mistakes.txt; failed=1; }

# The copy in the assemblies of the user is found by its name from any folder.
(cd / && boltwright train bracket --headless --operator expert --out "$work/by_name") > ../by_name_log 2>&1 \
    || { echo "FAILED: train bracket"; cat ../by_name_log; failed=1; }
expect '"assembly": "bracket"' "$work/by_name/summary.json"

# The same STEP file gives the same bytes.
bolt-author import-step bracket.step -o again --name bracket --lod >/dev/null 2>&1
for file in bracket.glb bracket.far.glb bracket.contact.glb; do
    cmp "bracket/$file" "again/$file" || failed=1
done

# The shipped assemblies must be valid too.
for folder in "$SOURCES"/content/assemblies/*/; do
    bolt-author validate "$folder" > ../shipped 2>&1 || { echo "FAILED: $folder"; cat ../shipped; failed=1; }
done
echo "all blocks of AUTHORING.md succeed"
exit $failed
