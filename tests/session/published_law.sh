#!/usr/bin/env bash
# Lessons under the published law: its targets are in all outputs of a lesson, and the session replays.
# $1: folder of the programs, $2: sources.
. "$(dirname "$0")/../cli/checks.sh"

play=("$bin/boltwright" train --law published --headless --no-pictures --no-obstacles --quiet)
yields() {  # the joints that reached the yield stage in this session
    python3 - "$1/session.boltwright" <<'END'
import sqlite3, sys
print(sqlite3.connect(sys.argv[1]).execute(
    "SELECT COUNT(DISTINCT joint) FROM event WHERE kind = 'stage' AND text = 'yield'").fetchone()[0])
END
}

if sanitized; then trainees=(expert); else trainees=(expert novice clumsy); fi
for trainee in "${trainees[@]}"; do
    expect 0 '^B1 +M16 .* 72\.1 .* OK' "${play[@]}" zq350 --operator "$trainee" --out "$trainee"
    expect 1 '' grep -q 78.0 "$trainee/summary.json"
    check "$trainee: summary.json has the target" grep -q '"target_torque_Nm": 72.1' "$trainee/summary.json"
    check "$trainee: the lesson is finished" grep -q '"finished": true' "$trainee/summary.json"
    check "$trainee: every joint reached the yield stage" test "$(yields "$trainee")" = 12
    expect 0 'all as they were recorded' "$bin/boltwright" replay "$trainee/session.boltwright"
done
# Sizes for which Table 1 is too much have values of their own, which their tools bear.
expect 0 'score 100' "${play[@]}" pump-32-160 --out pump
check "the expert turns every nut into the last third of yield" bash -c '
    [[ $(grep -c "\"torque_Nm\": 7[12]\." expert/summary.json) -eq 12 ]]'
expect 0 'report.html' "$bin/boltwright" report expert/session.boltwright --html report.html
check "the report has the target, and no other" bash -c "grep -q '>/ 72\.1<' report.html && ! grep -q '>/ 78\.0<' report.html"
check "the report judges the angle" grep -q 'torque and angle' report.html
expect 0 ' 78\.0 ' "$bin/boltwright" train zq350 --headless --no-pictures --no-obstacles --quiet --out mechanistic

# Loosening, the other material, and the torque wrench, which clicks below T_max.
expect 0 'score 100' "${play[@]}" zq350 --variant stainless --task loosen --out loosened
expect 0 'all as they were recorded' "$bin/boltwright" replay loosened/session.boltwright
expect 0 '^F4 +M16 .* 69\.2 .* OK' "${play[@]}" zq350 --variant stainless --tool torque_wrench --out clicked
check "the torque wrench clicks in the yield stage" test "$(yields clicked)" = 12
expect 0 'clicked.html' "$bin/boltwright" report clicked/session.boltwright --html clicked.html
check "the report has the target of the torque wrench" bash -c "grep -q '>/ 69\.2<' clicked.html && ! grep -q '>/ 72\.1<' clicked.html"
expect 0 'all as they were recorded' "$bin/boltwright" replay clicked/session.boltwright

# Without targets in the file those of the law hold, whatever the joint types specify.
expect 0 '^B1 +M8 .* 72\.0 .* OK' "${play[@]}" cover-m8 --out cover
check "M8: every joint reached the yield stage" test "$(yields cover)" = 4

# Each joint type and material has its curve; the drawing shows the targets of this law.
slope() {
    awk -F, '$2 == "linearity" { if (n++ == 50) { t = $3; a = $1 } if (n == 100) printf "%.1f", ($3 - t) / ($1 - a) }' "$1"
}
for row in "B1 carbon_steel 14.4" "F1 carbon_steel 18.0" "B1 stainless 14.0" "F1 stainless 17.6"; do
    read -r joint variant expected <<< "$row"
    expect 0 '^$' "$bin/bolt-author" curve zq350 --joint "$joint" --variant "$variant" --law published --csv curve.csv --svg curve.svg
    check "$joint, $variant: $expected N m per degree" test "$(slope curve.csv)" = "$expected"
    check "$joint, $variant: ends at 72.126 N m" bash -c 'tail -1 curve.csv | grep -q ",yield,72\.126"'
done

finish_checks
