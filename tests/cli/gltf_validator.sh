#!/usr/bin/env bash
# All shipped .glb files pass the Khronos glTF validator without errors and warnings, and bolt-author validate reports the
# validator's findings. $1: programs, $2: sources.
set -uo pipefail
bin=$1
sources=$2
. "$sources/tests/support/skip.sh" gltf_validator
runner=$sources/tools/gltf-validator
if [[ ! -d $runner/node_modules/gltf-validator ]] || ! command -v node >/dev/null; then
    skip_all "the glTF validator is not installed; expected tools/install-node-tools.sh to have installed it"
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0
bad() { echo "FAILED: $1"; failed=1; }

# Invalid files: a reference to a missing scene, a misspelt name (a warning), and a file that is not glTF.
glb() {
    python3 - "$1" "$2" <<'PY'
import struct, sys
text = sys.argv[2].encode()
text += b' ' * (-len(text) % 4)
chunk = struct.pack('<I4s', len(text), b'JSON') + text
open(sys.argv[1], 'wb').write(struct.pack('<4sII', b'glTF', 2, 12 + len(chunk)) + chunk)
PY
}
glb "$work/good.glb" '{"asset":{"version":"2.0"}}'
glb "$work/error.glb" '{"asset":{"version":"2.0"},"scene":5}'
glb "$work/warning.glb" '{"asset":{"version":"2.0"},"scens":[]}'
echo "no glTF" > "$work/none.glb"
node "$runner/validate.mjs" "$work"/{good,error,warning,none}.glb > "$work/messages.json" || bad "the runner failed"
python3 - "$work/messages.json" <<'PY' || bad "the runner does not report the errors"
import json, sys
good, error, warning, none = json.load(open(sys.argv[1]))
assert good['messages'] == [], good
assert [(m['severity'], m['code'], m['pointer']) for m in error['messages']] == [(0, 'UNRESOLVED_REFERENCE', '/scene')], error
assert [(m['severity'], m['code'], m['pointer']) for m in warning['messages']] == [(1, 'UNEXPECTED_PROPERTY', '/scens')], warning
assert len(none['messages']) == 1 and none['messages'][0]['severity'] == 0, none
PY

# The shipped files.
mapfile -d '' shipped < <(find "$sources/content" -name '*.glb' -print0 | sort -z)
if [[ ${#shipped[@]} -eq 0 ]]; then
    bad "there are no shipped files"
else
    node "$runner/validate.mjs" "${shipped[@]}" > "$work/shipped.json" || bad "the runner failed on the shipped files"
    python3 - "$work/shipped.json" "${#shipped[@]}" <<'PY' || bad "a shipped file has an error or a warning"
import json, sys
reports = json.load(open(sys.argv[1]))
assert len(reports) == int(sys.argv[2])
lines = [f"{r['file']}: {m['pointer']}: {m['message']} ({m['code']})" for r in reports for m in r['messages']]
print('\n'.join(lines))
sys.exit(1 if lines else 0)
PY
fi

# bolt-author validate runs the validator, and reports if it is not installed.
mkdir -p "$work/content/assemblies/cover" "$work/content/schema" "$work/content/tools"
cp "$sources/content/schema/assembly.schema.json" "$work/content/schema"
cp "$work/error.glb" "$work/content/tools/wrench.glb"
export BOLTWRIGHT_CONTENT=$work/content BOLTWRIGHT_GLTF_VALIDATOR=$runner
cat > "$work/content/assemblies/cover/assembly.json" <<'JSON'
{
  "title": { "en": "Cover" }, "lesson": { "en": "Tighten." },
  "tool": { "kind": "open_end_wrench", "jaw_mm": 13.2, "handle_length_mm": 140, "model": "wrench.glb" },
  "joint_types": { "M8": { "size": "M8", "class": "8.8", "bolt_length_mm": 30, "members": [{ "thickness_mm": 19, "material": "steel" }],
    "friction_thread": 0.12, "friction_bearing": 0.12, "spec": { "strategy": "torque", "target_torque_Nm": 20 } } },
  "joints": [{ "id": "B1", "type": "M8", "position_mm": [0, 0, 0] }],
  "passes": [{ "kind": "run_down" }, { "kind": "tighten", "percent": 100 }, { "kind": "recheck" }]
}
JSON
"$bin/bolt-author" validate cover > "$work/out" 2> "$work/err"
[[ $? -eq 3 ]] || bad "an error of the validator does not give exit code 3"
grep -q 'tools/wrench.glb: /scene: .*UNRESOLVED_REFERENCE, an error of the Khronos glTF validator' "$work/err" ||
    { bad "the validator's error is not reported"; cat "$work/err"; }
BOLTWRIGHT_GLTF_VALIDATOR=$work "$bin/bolt-author" validate cover > "$work/out" 2> "$work/err"
[[ $? -eq 0 ]] || { bad "without the validator, validate fails"; cat "$work/err"; }
grep -q 'the Khronos glTF validator is not installed, so its checks are left out' "$work/out" || bad "the missing validator is not reported"
mkdir -p "$work/broken/node_modules/gltf-validator"
echo 'process.exit(3)' > "$work/broken/validate.mjs"
BOLTWRIGHT_GLTF_VALIDATOR=$work/broken "$bin/bolt-author" validate cover > "$work/out" 2> "$work/err"
[[ $? -eq 1 ]] && grep -q 'the Khronos glTF validator: it failed' "$work/err" || bad "a failure of the validator is not reported"
cp "$work/good.glb" "$work/content/tools/wrench.glb"
"$bin/bolt-author" validate cover > "$work/out" 2> "$work/err" || { bad "a valid file is rejected"; cat "$work/err"; }
cp "$work/error.glb" "$work/content/tools/spare.glb"
sed -i 's|"joint_types":|"more_tools": { "spare": { "kind": "open_end_wrench", "jaw_mm": 13.2, "handle_length_mm": 140, "model": "spare.glb" } },\n  &|' \
    "$work/content/assemblies/cover/assembly.json"
"$bin/bolt-author" validate cover > "$work/out" 2> "$work/err"
[[ $? -eq 3 ]] && grep -q 'tools/spare.glb: /scene: .*UNRESOLVED_REFERENCE, an error of the Khronos glTF validator' "$work/err" ||
    { bad "the model of a further tool is not validated"; cat "$work/err"; }

[[ $failed -eq 0 ]] && echo "${#shipped[@]} shipped files, no errors, no warnings"
exit $failed
