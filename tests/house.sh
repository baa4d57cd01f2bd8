#!/usr/bin/env bash
# The arrows of the house point down, every header is complete in itself by name, and nothing is left half done.
set -euo pipefail
cd "$1"
failed=0
bad() { echo "$1"; failed=1; }

# The check itself can fail: a planted include that points upward is found.
planted=$(mktemp -d)
trap 'rm -rf "$planted"' EXIT
mkdir "$planted/engine"
echo '#include "haptics/joint/nut.hpp"' > "$planted/engine/upward.hpp"

includes() { grep -rnE "#include +\"($2)/" --include='*.hpp' --include='*.cpp' "$1" 2>/dev/null || true; }
[ -n "$(includes "$planted/engine" 'haptics|content|game|tools')" ] || bad "the check of the arrows finds nothing"
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
if command -v clang-format >/dev/null; then
    find engine haptics content game tools tests \( -name '*.hpp' -o -name '*.cpp' \) -print0 |
        xargs -0 clang-format --dry-run -Werror || bad "not in the house style: clang-format -i"
fi
exit $failed
