#!/usr/bin/env bash
# An assembly with more than 1,000 fixed obstacles. many_obstacles.sh BIN SOURCES.
# 1,000 small tetrahedra are inserted before the parts of the cover's contact model. They are out of reach, so the lesson must
# be the same as without them.
. "$(dirname "$0")/checks.sh"

cp -r "$sources/content/assemblies/cover-m8" plain
cp -r plain crowded
python3 - crowded/cover-m8.contact.glb <<'PY'
import json, struct, sys
data = open(sys.argv[1], "rb").read()
length = struct.unpack_from("<I", data, 12)[0]
model = json.loads(data[20:20 + length])
binary = bytearray(data[28 + length:])
binary += b"\0" * (-len(binary) % 4)
points = [(0, 0, 0), (0.001, 0, 0), (0, 0.001, 0), (0, 0, 0.001)]
faces = [0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2]
def add(bytes_, component, count, type_, **more):
    model["bufferViews"].append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(bytes_)})
    model["accessors"].append({"bufferView": len(model["bufferViews"]) - 1, "componentType": component, "count": count,
                               "type": type_, **more})
    binary.extend(bytes_)
    return len(model["accessors"]) - 1
position = add(b"".join(struct.pack("<3f", *p) for p in points), 5126, 4, "VEC3", min=[0, 0, 0], max=[0.001] * 3)
indices = add(struct.pack("<12H", *faces), 5123, 12, "SCALAR")
model["meshes"].append({"name": "tetrahedron", "primitives": [{"attributes": {"POSITION": position}, "indices": indices}]})
mesh, root = len(model["meshes"]) - 1, model["scenes"][model.get("scene", 0)]["nodes"][0]
extra = []
for i in range(1000):
    extra.append(len(model["nodes"]))
    model["nodes"].append({"name": f"tetrahedron_{i}", "mesh": mesh,
                           "translation": [5 + 0.005 * (i % 10), 0.005 * (i // 10 % 10), 0.005 * (i // 100)]})
model["nodes"][root]["children"] = extra + model["nodes"][root]["children"]
model["buffers"][0]["byteLength"] = len(binary)
text = json.dumps(model).encode()
text += b" " * (-len(text) % 4)
with open(sys.argv[1], "wb") as out:
    out.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary)))
    out.write(struct.pack("<II", len(text), 0x4E4F534A) + text)
    out.write(struct.pack("<II", len(binary), 0x004E4942) + binary)
PY

touched() { "$bin/boltwright" export "$1/session.boltwright" --csv - | cut -d, -f24; }
for one in plain crowded; do
    sed -i '/"id": "B[234]"/d; s/\(.*"id": "B1".*\),$/\1/; s/"order": .*/"order": ["B1"],/; /"percent": 50/d; /recheck/d
        s/\("percent": 100 }\),/\1/' $one/assembly.json
    expect 0 'score' "$bin/boltwright" train --no-pictures "$one" --obstacles --headless --quiet --operator clumsy --seed 3 --out "$one-out"
    touched "$one-out" > "$one.touched"
done
check "the wrench touches a fixed obstacle" grep -qx B1_washer_nut plain.touched
check "the wrench touches the nut" grep -qx B1_nut plain.touched
check "with 1,000 more obstacles every tick names the same touched obstacle" cmp plain.touched crowded.touched
expect 0 'all as they were recorded' "$bin/boltwright" replay crowded-out/session.boltwright

expect 0 '' "$bin/boltwright" report crowded-out/session.boltwright --html crowded.html
finish_checks
