#!/usr/bin/env bash
# Reports, exports and replays sessions of older formats with the present program. $1: folder of the programs, $2: sources.
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
# Their assemblies no longer exist; the text in the session suffices.
for name in format-4 format-4-published format-5-published; do
    expect 0 'all as they were recorded' "$bin/boltwright" replay "$data/$name.boltwright"
done
# Their targets under the published law are those of the programs that recorded them.
check "format 4: the target is 98 % of T_max, not the end of yield" grep -q '70\.7' format-4-published.html
check "format 5: no angle is judged" bash -c '! grep -q "torque and angle" format-5-published.html'
# The servo has changed since these were recorded. The number of different ticks is exact; another number means that the
# servo has changed again.
expect 1 ': 1262 of 12330 ticks differ from the recording' "$bin/boltwright" replay "$data/format-2.boltwright"
expect 1 ': 1263 of 20057 ticks differ from the recording' "$bin/boltwright" replay "$data/format-3.boltwright"
# Format 1 does not store the device, which a replay needs.
expect 3 'expected a session of format 2' "$bin/boltwright" replay "$data/format-1.boltwright"
check "a session of every format was tried" bash -c "ls '$data'/format-{1,2,3,4}.boltwright '$data'/format-{4,5}-published.boltwright"

finish_checks
