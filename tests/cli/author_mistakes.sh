#!/usr/bin/env bash
# The messages to an author about mistakes that a file's syntax does not show. author_mistakes.sh BIN SOURCES
. "$(dirname "$0")/checks.sh"

author=$bin/bolt-author

# Replaces a text in a file; fails if it is not there.
edit() {  # edit FILE FROM TO
    python3 - "$@" <<'PY'
import sys
path, old, new = sys.argv[1:]
text = open(path, encoding="utf-8").read()
assert old in text, old
open(path, "w", encoding="utf-8").write(text.replace(old, new, 1))
PY
}
# A copy of the small assembly.
copy() { rm -rf "$1" && cp -r "$sources/content/assemblies/cover-m8" "$1"; }
# Validates and keeps the output.
said() { "$author" validate "$@" >said.txt 2>&1; }

# A variant that changes nothing but torques can need a stronger tool; validate finds it without --variant.
copy torques
edit torques/assembly.json '"joint_types": {' '"variants": {
    "light": { "title": { "en": "Light" }, "every_joint_type": { "spec": { "target_torque_Nm": 10, "snug_torque_Nm": 2 } } },
    "heavy": { "title": { "en": "Heavy" }, "every_joint_type": { "class": "12.9", "friction_thread": 0.3, "friction_bearing": 0.3, "spec": { "target_torque_Nm": 62, "snug_torque_Nm": 5 } } }
  },
  "joint_types": {'
expect 3 'assembly.json:[0-9]+:[0-9]+: /joints/0: in the variant "heavy": the wrench is an open end of 13 mm, which is tested with 6. N.m .*; expected a ring of 13 mm' \
    "$author" validate torques
said torques
check "the light variant has no message" bash -c '! grep "light" said.txt'
edit torques/assembly.json '"target_torque_Nm": 62' '"target_torque_Nm": 40'
expect 0 'variant heavy: no mistakes' "$author" validate torques
expect 0 'variant light: no mistakes' "$author" validate torques

# A handle of 30 mm instead of 300: 20 N m take 667 N at the grip, and 40 N m take 1333 N.
copy short
edit short/assembly.json '"handle_length_mm": 140' '"handle_length_mm": 30'
said short
check "20 N m on 30 mm have no note" bash -c '! grep "at the grip" said.txt'
edit short/assembly.json '"class": "8.8"' '"class": "12.9"'
edit short/assembly.json '"target_torque_Nm": 20' '"target_torque_Nm": 40'
expect 0 '^note: .*: the wrench with its handle of 30 mm takes 1333 N at the grip for the target torque of "M8x30", 40 N.m; a handle of 50 mm takes at most 800 N' \
    "$author" validate short

# A variant of the same joints with another tool has another room, so its pictures do not replace the first ones.
copy other_tool
edit other_tool/assembly.json '"more_tools": {' '"variants": { "ringed": { "title": { "en": "Ring" }, "tool": "ring" } },
  "more_tools": { "ring": { "kind": "ring_wrench", "size_mm": 13, "handle_length_mm": 170 },'
expect 0 '^pictures/ringed/B1.png: [0-9.]+ degrees of free swing' "$author" validate other_tool --pictures pictures
check "both variants have a picture" test -s pictures/B1.png -a -s pictures/ringed/B1.png
check "... of different tools" bash -c '! cmp -s pictures/B1.png pictures/ringed/B1.png'

# Tightening to yield with a window that ends below yield: every trainee would be judged HIGH.
copy early
edit early/assembly.json '"strategy": "torque"' '"strategy": "yield"'
expect 3 '/spec/strategy: the highest torque that is judged OK, 22 N.m, is below yield: .* yields near 27.. N.m; expected the strategy "torque"' \
    "$author" validate early
said early
check "validate states that it has not checked the models yet" \
    grep -q '^note: early/assembly.json: models, pictures, and strength and room of the tools are checked once' said.txt

# A picture that cannot be shown, in the file and in a variant; one that can.
copy picture
edit picture/assembly.json '"kind": "recheck"' '"kind": "recheck", "instruction": { "text": { "en": "Look." }, "picture": "mark.png" }'
edit picture/assembly.json '"joint_types": {' '"variants": { "v": { "title": { "en": "V" }, "passes": [ { "kind": "run_down" },
    { "kind": "tighten", "percent": 100, "instruction": { "text": { "en": "Look." }, "picture": "other.jpg" } } ] } },
  "joint_types": {'
echo hello >picture/mark.png
cp pictures/B1.png picture/other.jpg
expect 3 'assembly.json:[0-9]+:[0-9]+: /passes/[0-9]/instruction/picture: the picture "mark.png" cannot be shown: .*; expected a PNG or JPEG file' \
    "$author" validate picture
cp pictures/B1.png picture/mark.png
echo hello >picture/other.jpg
expect 3 '/variants/v/passes/1/instruction/picture: the picture "other.jpg" cannot be shown' "$author" validate picture
cp pictures/B1.png picture/other.jpg
expect 0 'no mistakes' "$author" validate picture

# All positions in metres: one message.
copy metres
python3 - <<'PY'
import json
with open("metres/assembly.json", encoding="utf-8") as file:
    assembly = json.load(file)
for joint in assembly["joints"]:
    joint["position_mm"] = [value / 1000 for value in joint["position_mm"]]
with open("metres/assembly.json", "w", encoding="utf-8") as file:
    json.dump(assembly, file)
PY
expect 3 '/joints/0/position_mm: with such positions [0-9]+ of [0-9]+ joints overlap; it looks as if position_mm is in metres; expected millimetres' \
    "$author" validate metres
said metres
check "... once" [ "$(grep -c position_mm: said.txt)" = 1 ]

# The head is to be turned, but the joint is where the nut is: one message a joint.
copy other_end
edit other_end/assembly.json '"size": "M8",' '"size": "M8", "turned": "head",'
expect 3 '/joints/0: the axis points from the members to the nut, but the head is turned; expected position_mm and axis at the head' \
    "$author" validate other_end
said other_end
check "... and nothing that follows from it" [ "$(grep -c ': /joints/' said.txt)" = 4 ]

# A misspelled tool or joint type does not accuse the tools that lose their joints by it.
copy lost
edit lost/assembly.json '"more_tools": {' '"more_tools": { "ring16": { "kind": "ring_wrench", "size_mm": 16, "handle_length_mm": 170 },'
expect 3 'a ring of 16 mm does not fit M8, 13 mm across flats; expected 13 mm' "$author" validate lost
python3 - <<'PY'
import copy, json
with open("lost/assembly.json", encoding="utf-8") as file:
    assembly = json.load(file)
name, design = next(iter(assembly["joint_types"].items()))
other = copy.deepcopy(design)
other.update(size="M10", tool="ring_16", bolt_length_mm=40)
other["spec"]["target_torque_Nm"] = 30
assembly["joint_types"]["M10x40"] = other
assembly["joints"][0]["type"] = "M10x40"
assembly.pop("model"), assembly.pop("model_far"), assembly.pop("contact_model")
with open("lost/assembly.json", "w", encoding="utf-8") as file:
    json.dump(assembly, file)
PY
expect 3 '/joint_types/M10x40/tool: there is no tool "ring_16"; did you mean "ring16"\?' "$author" validate lost
said lost
check "... and no tool is accused" bash -c '! grep "does not fit" said.txt'
sed -i 's/"tool": "ring_16"/"tool": "ring16"/; s/"type": "M10x40"/"type": "M10x400"/' lost/assembly.json
expect 3 '/joints/0/type: "M10x400" is not a joint type of this file; did you mean "M10x40"\?' "$author" validate lost
said lost
check "... nor by a misspelled type" bash -c '! grep "does not fit" said.txt'

# A tool of the wrong kind is reported beside the other mistakes of the file.
copy kind
edit kind/assembly.json '"more_tools": {' '"more_tools": { "bit": { "kind": "ratchet", "head": "hex_bit", "size_mm": 8, "handle_length_mm": 170 },'
edit kind/assembly.json '"size": "M8",' '"size": "M8", "tool": "bit",'
edit kind/assembly.json '"risk_class": "C"' '"risk_class": "D"'
expect 3 '/joint_types/M8x30/tool: "bit" is a hexagon bit and cannot turn the hexagon of 13 mm; expected "wrench" or "torque_wrench"' "$author" validate kind
expect 3 'risk_class: "D" is not known' "$author" validate kind

edit kind/assembly.json '"kind": "ratchet"' '"kind": "ratchett"'
said kind
check "... but not a tool whose kind is misspelled" bash -c 'grep -q ratchett said.txt && ! grep "cannot turn" said.txt'

# A joint type that no joint has.
sed -i 's/"type": "M10x400"/"type": "M8x30"/; s/"ring16": {[^}]*}, //; s/, "tool": "ring16"//' lost/assembly.json
expect 0 '^note: .*/joint_types/M10x40: no joint has the type "M10x40"' "$author" validate lost

# Sizes that the tables lack.
expect 2 '"M7" is not a known thread size; expected one of M4, M5, M6, M8, M10,' "$author" torque --size M7 --class 8.8
expect 2 'expected "size": "M8" and "thread_direction": "left"' "$author" torque --size M8-LH --class 8.8

# The figures of a curve, without a file to write: the angle from the snug torque to the target, and where the bolt yields.
"$author" curve cover-m8 --joint B1 >figures.txt
"$author" curve cover-m8 --joint B1 --csv figures.csv
check "the angle between snug torque and target is that of the curve" awk -F '[ ,]' '
    FNR == NR { if (/^angles_count_from_Nm/) from = $2; if (/^target_torque_Nm/) to = $2; if (/^target_torque_deg/) angle = $2; next }
    FNR == 1 { next } $3 >= from && !a { a = $1 } $3 >= to && !b { b = $1 }
    END { exit !(from == 5 && to == 20 && a && angle > 15 && (b - a - angle) ^ 2 < 0.01) }' figures.txt figures.csv
expect 0 '^yield_stage_Nm 2[4-7]\.[0-9]$' "$author" curve cover-m8 --joint B1
# With passes of kind turn angles count from the last torque before them: 40 % of 230 N m.
expect 0 '^angles_count_from_Nm 92\.0$' "$author" curve dn200-pn16 --variant by_angle --joint B1
expect 0 '^smallest_angle_Nm [0-9.]+$' "$author" curve dn200-pn16 --variant by_angle --joint B1

# Nuts with inserts on 60 mm of free thread take more than 900 s, but the trainee makes progress.
copy long
sed -i 's/"bolt_length_mm": 30/"bolt_length_mm": 80, "bolt_thread_length_mm": 70, "locking_insert": true/; s/"percent": 50/"percent": 80/' long/assembly.json
expect 0 'score [0-9.]* of 100' "$bin/boltwright" train long --no-obstacles --headless --no-pictures --quiet --out long_out
# A lesson that the simulated trainee does not finish: the error names the step. The nut of B1 is inside the plate.
copy blocked
sed -i 's/\("id": "B1".*"position_mm": \[[^,]*, \)[^,]*,/\1-30,/' blocked/assembly.json
expect 1 'gave up after 900 s of virtual time without progress at step 5 of 16 \(tighten to 50 %: B1\); expected a step that this tool can finish' \
    "$bin/boltwright" train blocked --headless --no-pictures --quiet --out blocked_out
finish_checks
