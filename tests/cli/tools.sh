#!/usr/bin/env bash
# Tools that are generated from parameters: the commands of bolt-author, and lessons whose tools have no model. tools.sh BIN SOURCES
. "$(dirname "$0")/checks.sh"

author=$bin/bolt-author
mkdir first second
sizes=(
    "open_end 24" "ring 24" "combination 24" "hex_key 8" "socket 24" "extension_bar 12.5" "adaptor 10" "hex_bit 8"
    "torque_wrench 24" "electronic_torque_wrench 24")
for row in "${sizes[@]}"; do
    read -r kind size <<<"$row"
    expect 0 "^$kind: size $size mm" "$author" tool "$kind" --size "$size" -o "first/$kind"
    expect 0 "$kind.contact.glb: [0-9]+ bytes" "$author" tool "$kind" --size "$size" -o "second/$kind.glb" --no-picture
    for ending in glb contact.glb; do
        check "$kind: the same $ending every time" cmp "first/$kind.$ending" "second/$kind.$ending"
    done
    check "$kind: a picture is drawn" test -s "first/$kind.png"
    check "$kind: no picture on request" test ! -e "second/$kind.png"
    expect 0 "first/$kind-drawn.png" "$bin/boltwright" render "first/$kind.glb" --size 160x120 --png "first/$kind-drawn.png"
done
expect 0 'ring.png' "$author" tool ring --size 24 -o second/ring
expect 0 'adaptor in line 60 mm' "$author" tool torque_wrench --size 24 --adaptor 60 -o first/with-adaptor
check "an adaptor is drawn" grep -aq '"adaptor"' first/with-adaptor.glb
expect 2 'a torque wrench with an open end' "$author" tool ring --size 24 --adaptor 60 -o second/ring
check "the same picture every time" cmp first/ring.png second/ring.png
check "all kinds are tried" [ "${#sizes[@]}" = "$("$author" tools | sed '/^$/q' | grep -c .)" ]
validator=$sources/tools/gltf-validator
if [[ -d $validator/node_modules/gltf-validator ]] && command -v node >/dev/null; then
    node "$validator/validate.mjs" first/*.glb >messages.json
    check "the Khronos validator finds no mistake" python3 -c '
import json
reports = json.load(open("messages.json"))
assert len(reports) == 22
assert not any(report["messages"] for report in reports), reports'
else
    skip_part "the glTF validator is not installed; expected tools/install-node-tools.sh to have installed it"
fi

# Sizes and options.
expect 0 'note: 20 mm is not a standard size of ring' "$author" tool ring --size 20 -o odd --no-picture
for size in 5.5 7 50 55 60; do
    "$author" tool combination --size $size -o standard --no-picture >standard.log 2>&1
    check "$size mm is a standard size" bash -c 'grep -q "^combination: size $1 mm" standard.log && ! grep -q note: standard.log' - $size
done
expect 0 'length 300 mm' "$author" tool ring --size 24 --length 300 -o long --no-picture
check "another length gives other bytes" bash -c '! cmp -s long.glb first/ring.glb'
expect 0 '24 teeth' "$author" tool socket --size 19 --teeth 24 --drive 12.5 -o ratchet --no-picture
expect 0 'ISO 1711-1 as read' "$author" tools
expect 0 '^  24 mm +359 +451$' "$author" tools
expect 0 '^  17 mm +~1' "$author" tools
expect 0 '^   8 mm +44 \+ 108$' "$author" tools

# The kinds and heads of assembly.json. The weaker of head and square drive states what the tool bears.
expect 0 '^test torque 175 N.m$' "$author" tool click_torque_wrench --head socket --size 16 -o by_file --no-picture
expect 0 '^test torque 115 N.m$' "$author" tool click_torque_wrench --size 16 -o by_file --no-picture
expect 0 '^test torque \?340 N.m, of its square drive of 12.5 mm$' "$author" tool ratchet --size 24 -o by_file --no-picture
expect 0 '^ring: size 24 mm' "$author" tool ring_wrench --size 24 -o by_file --no-picture
expect 0 'hexagon bit, extension bar 75 mm' "$author" tool ratchet --head hex_bit --size 8 --extension 75 -o by_file --no-picture
expect 0 '^begins to bend at 129 N.m' "$author" tool ratchet --head hex_bit --size 8 -o by_file --no-picture
expect 0 '^begins to bend at 129 N.m' "$author" tool hex_key --size 8 -o by_file --no-picture
expect 0 '^click_torque_wrench +torque_wrench here$' "$author" tools

# Mistakes.
expect 2 'no tool of the kind "rign"; did you mean "ring"\?' "$author" tool rign --size 24 -o never
expect 2 'ring of 65 mm: the size is out of range; expected 5.5 to 60 mm; the nearest is 60' "$author" tool ring --size 65 -o never
expect 2 'a ratchet of 73 teeth is unknown; expected 24, 72, 90' "$author" tool socket --size 24 --teeth 73 -o never
expect 2 'a length of 20 mm is impossible' "$author" tool ring --size 24 --length 20 -o never
expect 2 'is not a size' "$author" tool ring --size 24 --picture-size huge -o never
expect 2 '' "$author" tool ring -o never
check "a mistake leaves no files" bash -c '! ls never* 2>/dev/null'
touch file
expect 1 'cannot be written' "$author" tool ring --size 24 --no-picture -o file/ring
(ulimit -f 40 && trap '' XFSZ && "$author" tool ring --size 24 --no-picture -o disk) >full.log 2>&1
check "a full disk gives exit code 1" [ $? = 1 ]
check "a full disk is reported" grep -q 'disk.*cannot be written' full.log
check "a full disk leaves no files" bash -c '! ls disk* 2>/dev/null'
expect 1 'standard output' bash -c "'$author' tools > /dev/full"

# A lesson whose tools have no model: they are generated, drawn and touch the parts, and the session replays.
mkdir bare && cp "$sources/content/assemblies/cover-m8/"* bare/
python3 - bare/assembly.json <<'END'
import json, sys
assembly = json.load(open(sys.argv[1]))
for tool in [assembly["tool"], *assembly.get("more_tools", {}).values()]:
    tool.pop("model", None)
assembly["joints"] = [joint for joint in assembly["joints"] if joint["id"] == "B1"]
assembly["order"] = ["B1"]
assembly["passes"] = [{"kind": "run_down"}, {"kind": "tighten", "percent": 100}]
json.dump(assembly, open(sys.argv[1], "w"))
END
expect 0 'no mistakes' "$author" validate bare
expect 0 'bare/assembly.json:[0-9]+:[0-9]+: /tool: no model is named, so the tool is generated: open_end: size 13 mm' "$author" validate bare
expect 0 '/more_tools/torque_wrench: no model is named, so the tool is generated: torque_wrench: size 13 mm' "$author" validate bare
expect 0 'B1' "$author" views bare
# A picture of each joint with the room for its wrench.
expect 0 'joints/B1.png: [0-9.]+ degrees of free swing.*; blocked by "cover" \([0-9]+ degrees\)' \
    "$author" validate bare --pictures joints
check "one picture for each joint" [ "$(ls joints)" = B1.png ]
expect 0 'again/B1.png' "$author" validate bare --pictures again
check "the same picture of a joint every time" cmp joints/B1.png again/B1.png
expect 1 'file/joints cannot be created' "$author" validate bare --pictures file/joints
expect 2 '--pictures draws the joints of one assembly' "$author" validate bare cover-m8 --pictures never
# The picture of a joint shows its own tool.
sed 's/"type": *"M8x30"/&, "override": { "tool": "ring" }/; s/"more_tools": *{/&"ring": { "kind": "ring_wrench", "size_mm": 13, "handle_length_mm": 140 }, /' \
    bare/assembly.json >bare/ring.json
expect 0 'ring/B1.png: [0-9.]+ degrees of free swing with the tool "ring"; blocked by "filler_plug"' "$author" validate bare/ring.json --pictures ring
check "another tool gives another picture" bash -c '! cmp -s joints/B1.png ring/B1.png'
sed 's/"model": *"[^"]*",//; s/"model_far": *"[^"]*",//; s/"contact_model": *"[^"]*",//' bare/assembly.json >bare/flat.json
expect 0 'no model is named' "$author" validate bare/flat.json --pictures never
check "nothing is drawn without a model" test ! -e never
for tool in wrench torque_wrench; do
    expect 0 'score' "$bin/boltwright" train bare --tool $tool --headless --no-pictures --obstacles --out "with-$tool"
    expect 0 'all as they were recorded' "$bin/boltwright" replay "with-$tool/session.boltwright"
    expect 0 '' "$bin/boltwright" export "with-$tool/session.boltwright" --csv "$tool.csv"
    check "$tool: the tool touches parts" awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "touched") c = i }
        NR > 1 && $c != "" { n++ } END { exit n < 200 }' "$tool.csv"
done
check "the session names the generated tool" grep -aq 'generated open_end: size 13 mm, opening 13.2 mm' with-wrench/session.boltwright
check "... and the torque wrench" grep -aq 'generated torque_wrench: size 13 mm' with-torque_wrench/session.boltwright
expect 0 'film.png' "$bin/boltwright" replay with-wrench/session.boltwright --at 3 --png film.png --size 160x90
mkdir open && sed 's/"contact_model": *"[^"]*",//' bare/assembly.json >open/assembly.json && cp bare/*.glb open/
expect 3 'open/assembly.json: the assembly has no contact model; expected "contact_model"' \
    "$bin/boltwright" train open --headless --no-pictures --obstacles --quiet --out never
expect 0 'The wrench passes through everything: .*the assembly has no contact model' \
    "$bin/boltwright" train open --headless --no-pictures --out through
# The tool of a session is that of its recorded text: the file may change, and name a model.
cp bare/assembly.json before.json
sed -i 's/"handle_length_mm": 140/"handle_length_mm": 150/' bare/assembly.json
check "the wrench is another one now" bash -c '! cmp -s before.json bare/assembly.json'
expect 0 'all as they were recorded' "$bin/boltwright" replay with-wrench/session.boltwright
cp "$sources/content/assemblies/cover-m8/assembly.json" bare/
expect 0 'all as they were recorded' "$bin/boltwright" replay with-wrench/session.boltwright

# A lesson whose joints need different tools: a ring, a ratchet and a torque wrench with a socket, and the tool of the file.
mkdir several && cp "$sources/content/assemblies/cover-m8/"* several/
python3 - several/assembly.json <<'END'
import json, sys
assembly = json.load(open(sys.argv[1]))
assembly["more_tools"] = {
    "key": {"kind": "hex_key", "size_mm": 6, "handle_length_mm": 90},
    "ring": {"kind": "ring_wrench", "size_mm": 13, "handle_length_mm": 140},
    "ratchet": {"kind": "ratchet", "size_mm": 13, "handle_length_mm": 150},
    "socket_torque_wrench": {"kind": "click_torque_wrench", "head": "socket", "size_mm": 13, "handle_length_mm": 250},
}
assembly["passes"] = [{"kind": "run_down"}, {"kind": "tighten", "percent": 100}]
for joint, tool in zip(assembly["joints"], ["ring", "ratchet", "socket_torque_wrench", "wrench"]):
    joint.setdefault("override", {})["tool"] = tool
json.dump(assembly, open(sys.argv[1], "w"))
END
expect 0 'no mistakes' "$author" validate several
expect 0 'score 100' "$bin/boltwright" train several --headless --no-pictures --operator expert --seed 2 --obstacles --out with-several
expect 0 'all as they were recorded' "$bin/boltwright" replay with-several/session.boltwright
for tool in 'ring: size 13' 'socket: size 13' 'torque_wrench: size 13 mm, .* socket'; do
    check "the session names the generated $tool" grep -aq "generated $tool" with-several/session.boltwright
done
sed -i 's/"tool": "ratchet"/"tool": "key"/' several/assembly.json
expect 3 '/joints/1/override/tool: "key" is a hexagon key and cannot turn the hexagon of 13 mm; expected "wrench" or ' \
    "$bin/boltwright" train several --headless --no-pictures --operator expert --out never

# validate names the joints that a tool does not reach: a stand is below two nuts of the flange.
mkdir flange && cp "$sources/content/assemblies/dn200-pn16/"* flange/
python3 - flange/assembly.json <<'END'
import json, sys
assembly = json.load(open(sys.argv[1]))
for tool in [assembly["tool"], *assembly["more_tools"].values()]:
    tool.pop("model", None)
json.dump(assembly, open(sys.argv[1], "w"))
for tool in assembly["more_tools"].values():
    tool.pop("instead", None)
json.dump(assembly, open(sys.argv[1].replace("assembly", "everywhere"), "w"))
END
expect 0 'no mistakes' "$author" validate flange
"$author" validate flange/everywhere.json >/dev/null 2>unreached
check "four mistakes without \"instead\"" [ "$(grep -c . unreached)" = 4 ]
for joint in 6 7; do
    check "the ratchet does not reach B$joint" grep -qF "the tool \"ratchet\" cannot be brought onto \"B$joint\" along the bolt: \"stand_downstream\" is in its way; expected \"instead\": { \"B$joint\": \"wrench\" or \"ring\" }, which fits" unreached
    check "the torque wrench with a socket does not reach B$joint" grep -qF "the tool \"socket_torque_wrench\" cannot be brought onto \"B$joint\" along the bolt: \"stand_downstream\" is in its way; expected \"instead\": { \"B$joint\": \"electronic_torque_wrench\" or \"torque_wrench\" }, which fits" unreached
done

# An open end is too weak for a strong bolt, and a ring is not.
sed 's/"class": *"8.8"/"class": "12.9"/; s/"friction_\(thread\|bearing\)": *0.12/"friction_\1": 0.3/g; s/"target_torque_Nm": *20/"target_torque_Nm": 66/; s/"torque_tolerance_percent": *10/"torque_tolerance_percent": 5/' \
    before.json >bare/strong.json
expect 3 'the wrench is an open end of 13 mm, which is tested with 64 N·m \(ISO 1711-1, from a catalogue\), and the target torque of "M8x30" reaches 69 N·m; expected a ring of 13 mm \(107 N·m\) or a socket' \
    "$author" validate bare/strong.json

# A key bends, so its screw cannot have a higher torque.
cp -r "$sources/content/assemblies/pump-32-160" strong_screws
python3 - strong_screws/assembly.json <<'END'
import json, sys
assembly = json.load(open(sys.argv[1]))
screw = assembly["joint_types"]["M8 cap screw"]
screw.update({"class": "12.9", "friction_thread": 0.3, "friction_bearing": 0.3})
screw["spec"]["target_torque_Nm"] = 60
json.dump(assembly, open(sys.argv[1], "w"))
END
expect 3 'the tool "hex_key_6" is a hexagon key of 6 mm, which begins to bend at 54 N·m \(torsion of its hexagon\), and the target torque of "M8 cap screw" reaches 66 N·m; expected a lower target torque: no tool of this size bears it' \
    "$author" validate strong_screws

finish_checks
