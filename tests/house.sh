#!/usr/bin/env bash
# The arrows of the house point down, every header is complete in itself by name, and nothing is left half done.
set -euo pipefail
cd "$1"
failed=0
bad() { echo "$1"; failed=1; }

includes() { grep -rnE "#include +\"($2)/" --include='*.hpp' --include='*.cpp' "$1" 2>/dev/null || true; }
[ -z "$(includes engine 'haptics|content|game|tools')" ] || bad "engine includes upward: $(includes engine 'haptics|content|game|tools')"
[ -z "$(includes haptics 'content|game|tools|engine/(ecs|gpu|assets|render|platform)')" ] || bad "haptics includes upward"
[ -z "$(includes content 'game|tools|engine/(ecs|gpu|assets|render|platform)')" ] || bad "content includes upward"
[ -z "$(includes game 'tools')" ] || bad "game includes tools"

while read -r header; do
    head -40 "$header" | grep -q '^#pragma once' || bad "$header: no #pragma once"
done < <(find engine haptics content game tools tests -name '*.hpp')

if grep -rnEi '\b(TODO|FIXME|XXX)\b' --include='*.hpp' --include='*.cpp' --include='*.glsl' engine haptics content game tools; then
    bad "left half done"
fi
exit $failed
