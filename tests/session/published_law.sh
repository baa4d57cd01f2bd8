#!/usr/bin/env bash
# Lessons under the published law: its targets are in all outputs of a lesson, and the session replays.
# $1: folder of the programs, $2: sources.
. "$(dirname "$0")/../cli/checks.sh"

if sanitized; then trainees=(expert); else trainees=(expert novice); fi
for trainee in "${trainees[@]}"; do
    expect 0 '^B1 +M16 .* 72\.1 .* OK' "$bin/boltwright" train zq350 --law published --headless --no-pictures --no-obstacles \
        --quiet --operator "$trainee" --out "$trainee"
    expect 1 '' grep -q 78.0 "$trainee/summary.json"
    check "$trainee: summary.json has the target" grep -q '"target_torque_Nm": 72.1' "$trainee/summary.json"
    expect 0 'all as they were recorded' "$bin/boltwright" replay "$trainee/session.boltwright"
done
check "the expert turns every nut into the last third of yield" bash -c '
    [[ $(grep -c "\"torque_Nm\": 7[12]\." expert/summary.json) -eq 12 ]]'
expect 0 'report.html' "$bin/boltwright" report expert/session.boltwright --html report.html
check "the report has the target" grep -q '72\.1' report.html
expect 0 ' 78\.0 ' "$bin/boltwright" train zq350 --headless --no-pictures --no-obstacles --quiet --out mechanistic

# A tool without a model: the message names the tool, its position in the file and the missing key.
mkdir bare && cp "$sources/content/assemblies/cover-m8/"* bare/
python3 - bare/assembly.json <<'END'
import json, sys
assembly = json.load(open(sys.argv[1]))
for tool in [assembly["tool"], *assembly.get("more_tools", {}).values()]:
    tool.pop("model", None)
json.dump(assembly, open(sys.argv[1], "w"))
END
expect 0 'no mistakes' "$bin/bolt-author" validate bare
expect 3 'bare/assembly.json: /tool: the tool "wrench" has no model; expected "model": the .glb of the wrench' \
    "$bin/boltwright" train bare --headless --no-pictures --obstacles --quiet --out never
expect 0 'The wrench passes through everything: .*/tool: the tool "wrench" has no model' \
    "$bin/boltwright" train bare --headless --no-pictures --out through

finish_checks
