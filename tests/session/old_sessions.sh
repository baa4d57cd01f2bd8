#!/usr/bin/env bash
# Sessions that older programs recorded, through the program of today: they open, are reported, exported and replayed. $1: folder of the programs, $2: sources.
. "$(dirname "$0")/../cli/checks.sh"

data=$sources/tests/data
for session in "$data"/format-*.boltwright; do
    name=$(basename "$session" .boltwright)
    expect 0 "$name.html" "$bin/boltwright" report "$session" --html "$name.html"
    check "$name: the report is a page" grep -q '</html>' "$name.html"
    expect 0 '^$' "$bin/boltwright" export "$session" --csv "$name.csv"
    check "$name: the export has a header and a row for each tick" bash -c "
        head -1 $name.csv | grep -q wrench_torque_Nm && [[ \$(wc -l < $name.csv) -gt 5000 ]]"
done
# Their assemblies are no longer there: the text in the session is enough.
for name in format-4 format-4-published; do
    expect 0 'all as they were recorded' "$bin/boltwright" replay "$data/$name.boltwright"
done
# The servo has changed since these were recorded. The number of ticks that differ is exact: another number means that the
# servo has changed again.
expect 1 ': 1262 of 12330 ticks did not come out' "$bin/boltwright" replay "$data/format-2.boltwright"
expect 1 ': 1263 of 20057 ticks did not come out' "$bin/boltwright" replay "$data/format-3.boltwright"
# Format 1 does not hold the device that a replay needs.
expect 3 'expected a session of format 2' "$bin/boltwright" replay "$data/format-1.boltwright"
check "a session of every format was tried" bash -c "ls '$data'/format-{1,2,3,4}.boltwright '$data'/format-4-published.boltwright"

tell_and_leave
