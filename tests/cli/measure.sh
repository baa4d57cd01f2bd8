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
"$bin/boltwright" compare session/session.boltwright simulated/carbon_steel/record.csv --joint B1 --html compare.html \
    --fit fit.json > compare.txt
expect "slope" "slope in linearity: virtual" compare.txt
expect "limits of the fit" "what the data cannot tell" compare.txt
expect "joint type" '"M16x180-measured"' fit.json
sed '1i # thread: M8' simulated/carbon_steel/record.csv > m8.csv
refuse "$bin/boltwright" compare session/session.boltwright m8.csv --joint B1 --html other.html --fit other.json > other.txt
expect "another thread" "the measured thread is M8" other.txt
expect "no fit of another joint" "cannot be fitted" message.txt
test ! -e other.json

# The committed page is what the program makes now.
"$bin/boltwright" measure validate "$sources/docs/validation" --out validation > /dev/null
cmp validation/README.md "$sources/docs/validation/README.md" || failed=1
exit $failed
