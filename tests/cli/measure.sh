#!/usr/bin/env bash
# boltwright measure and compare as a laboratory uses them. $1: folder of the programs, $2: the sources.
set -euo pipefail
bin=$1 sources=$2
export BOLTWRIGHT_CONTENT="$sources/content"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
failed=0
refuse() { ! "$@" 2> message.txt || { echo "FAILED: not refused: $*"; failed=1; }; }
expect() {  # expect NAME PATTERN FILE
    grep -q -- "$2" "$3" || { echo "FAILED: $1: no '$2' in:"; cat "$3"; failed=1; }
}

# 24 simulated runs become raw data, records and the page; the page says that nothing was measured.
"$bin/boltwright" measure simulate --out simulated > simulated.txt
test "$(ls simulated/*/*.csv | grep -vc record)" = 24
expect "simulated runs" "SIMULATED: no joint was measured" simulated.txt
expect "the paper's figures" "0.13432" simulated.txt
expect "page" "SIMULATED" simulated/table2.html
"$bin/boltwright" measure simulate --out again > /dev/null
cmp simulated/stainless/record.csv again/stainless/record.csv

# The raw data can be imported again; mistakes have a place.
cd simulated/stainless
"$bin/boltwright" measure import rig.json B1.csv B2.csv --out ../two.csv > ../two.txt
expect "landmarks" "linear part" ../two.txt
expect "source" "# source: SIMULATED" ../two.csv
cd ../..
sed '100s/,[^,]*,/,NaN,/' simulated/stainless/B1.csv > nan.csv
refuse "$bin/boltwright" measure import simulated/stainless/rig.json nan.csv --out x.csv
expect "not a number" "^nan.csv:100:[0-9]*: 'Fx' is NaN; expected" message.txt
sed 's/"direction": "tighten"/"direction": "loosen"/' simulated/stainless/rig.json > wrong.json
refuse "$bin/boltwright" measure import wrong.json simulated/stainless/B1.csv --out x.csv
expect "wrong sign" "^wrong.json:[0-9]*:[0-9]*: the largest torque" message.txt
test ! -e x.csv

# A session against the record of the same joint, and a fit that an author can paste; another thread is refused.
"$bin/boltwright" train zq350 --headless --out session > /dev/null 2>&1
runs_of_B=$(printf -- '--run B%s ' 1 2 3 4 5 6 7 8)
"$bin/boltwright" compare session/session.boltwright simulated/carbon_steel/record.csv --joint B1 $runs_of_B --html compare.html \
    --fit fit.json > compare.txt
expect "slope" "slope in linearity: virtual" compare.txt
refuse "$bin/boltwright" compare session/session.boltwright simulated/carbon_steel/record.csv --joint B1 --html mixed.html \
    --fit mixed.json > mixed.txt
expect "several joints" "record.csv: the slopes of its runs differ by a factor of .*; expected the runs of one joint, with --run" message.txt
refuse "$bin/boltwright" compare session/session.boltwright simulated/carbon_steel/record.csv --run B9 --html mixed.html > mixed.txt
expect "unknown run" 'there is no run "B9"; expected one of B1, B2' message.txt
"$bin/boltwright" compare session/session.boltwright simulated/carbon_steel/record.csv --run B1 --html b1.html > b1.txt
expect "joints of another length" "^F1: another joint, .* the torque rises in linearity by a factor of" b1.txt
expect "the other eight" "^B8 .*all" b1.txt
expect "limits of the fit" "what the data cannot tell" compare.txt
expect "joint type" '"M16x180-measured"' fit.json
sed '1i # thread: M8' simulated/carbon_steel/record.csv > m8.csv
refuse "$bin/boltwright" compare session/session.boltwright m8.csv --joint B1 --html other.html --fit other.json > other.txt
expect "another thread" "the measured thread is M8" other.txt
expect "no fit of another joint" "cannot be fitted" message.txt
test ! -e other.json

# Loosening, too: the published runs of M8 are of another joint than the cover's.
"$bin/boltwright" train cover-m8 --headless --task loosen --out loosened > /dev/null 2>&1
"$bin/boltwright" compare loosened/session.boltwright "$sources/docs/validation/unfastening_m8.csv" --html loose.html > loose.txt
test "$(grep -c '^B[1-4]: another joint' loose.txt)" = 4 || { echo "FAILED: another joint:"; cat loose.txt; failed=1; }
refuse grep -E '[0-9]{2}\.[0-9]{5}' loose.txt
"$bin/boltwright" compare loosened/session.boltwright "$sources/docs/validation/unfastening_m8.csv" --same-joint --html loose.html > loose.txt
refuse grep -E '[0-9]{3}\.[0-9]{5}' loose.txt

# Wrong units, an encoder that starts again after a turn, and missing samples.
rig=simulated/stainless/rig.json run=simulated/stainless/B1.csv
sed 's/"unit": "N"/"unit": "kN"/' $rig > units.json
refuse "$bin/boltwright" measure import units.json $run --out x.csv
expect "kN for N" "^units.json:[0-9]*:[0-9]*: the largest torque of B1 is .* for a bolt M16; check unit" message.txt
sed 's/"unit": "deg"/"unit": "turn"/' $rig > units.json
refuse "$bin/boltwright" measure import units.json $run --out x.csv
expect "turns for degrees" "^units.json:[0-9]*:[0-9]*: .*; check unit" message.txt
awk -F, -v OFS=, 'NR > 1 { a = $3 + 300; $3 = a >= 360 ? a - 360 : a } 1' $run > wrapped.csv
"$bin/boltwright" measure import $rig wrapped.csv --out x.csv > wrapped.txt
expect "encoder" "check .*starts again at 0 does; the turns were added" wrapped.txt
test "$(grep '  peak' wrapped.txt)" = "$("$bin/boltwright" measure import $rig $run --out x.csv | grep '  peak')" || failed=1
rm x.csv
sed 's/"column": "t",/"rate_Hz": 1000/; /"unit": "s"/d' $rig > rate.json
awk -F, 'NR == 1 || $3 < 60 || $3 > 80' $run > gap.csv
refuse "$bin/boltwright" measure import rate.json gap.csv --out x.csv
expect "gap" "^gap.csv:[0-9]*:[0-9]*: the angle jumps by" message.txt
test ! -e x.csv

# The committed page is what the program makes now.
"$bin/boltwright" measure validate "$sources/docs/validation" --out validation > /dev/null
cmp validation/README.md "$sources/docs/validation/README.md" || failed=1
for page in unfastening_m6 unfastening_m8 retightening_m8 vdi2230_a1; do
    expect "page of $page" "<svg" validation/$page.html
done
expect "verdict on the page" "Verdict: the law's wear" <(sed "s/&#39;/'/g" validation/retightening_m8.html)
exit $failed
