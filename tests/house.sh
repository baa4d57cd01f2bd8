#!/usr/bin/env bash
# Checks the rules of the sources: includes point to lower layers only, headers have #pragma once, no TODO remains, all texts are
# used, comments begin with their subject, documents name only what exists, skipped tests are reported, and clang-format changes no file.
set -euo pipefail
cd "$1"
. tests/support/skip.sh house
failed=0
bad() { echo "$1"; failed=1; }

# Negative control: a planted include of a higher layer is found.
planted=$(mktemp -d)
trap 'rm -rf "$planted"' EXIT
mkdir "$planted/engine"
echo '#include "haptics/joint/nut.hpp"' > "$planted/engine/upward.hpp"

includes() { grep -rnE "#include +\"($2)/" --include='*.hpp' --include='*.cpp' "$1" 2>/dev/null || true; }
[ -n "$(includes "$planted/engine" 'haptics|content|game|tools')" ] || bad "the check of the includes finds nothing"
[ -z "$(includes engine 'haptics|content|game|tools')" ] || bad "engine includes upward: $(includes engine 'haptics|content|game|tools')"
[ -z "$(includes haptics 'content|game|tools|engine/(ecs|gpu|assets|render|platform)')" ] || bad "haptics includes upward"
[ -z "$(includes content 'game|tools|engine/(ecs|gpu|assets|render|platform)')" ] || bad "content includes upward"
[ -z "$(includes game 'tools')" ] || bad "game includes tools"

# Prints the headers, of those named on the input, without #pragma once in their first 40 lines.
unguarded() {
    xargs awk 'FNR == 1 { if (file != "" && !found) print file; file = FILENAME; found = 0 }
               FNR <= 40 && /^#pragma once/ { found = 1 }
               END { if (file != "" && !found) print file }'
}
[ "$(echo "$planted/engine/upward.hpp" | unguarded)" = "$planted/engine/upward.hpp" ] || bad "the check of #pragma once finds nothing"
headers=$(find engine haptics content game tools tests -name '*.hpp' | unguarded)
[ -z "$headers" ] || bad "no #pragma once: $headers"

if grep -rnEi '\b(TODO|FIXME|XXX)\b' --include='*.hpp' --include='*.cpp' --include='*.glsl' engine haptics content game tools; then
    bad "unfinished: a TODO, FIXME or XXX remains"
fi
# Every text key is used in the code, so that translators translate no unused text.
unused_texts() {
    comm -23 <(grep -oE '\{"[a-z_.0-9]+"' "$1" | tr -d '{' | sort -u) \
        <(grep -rhoE '"[a-z_.0-9]+"' --include='*.hpp' --include='*.cpp' engine game tools | sort -u)
}
echo '    {"hint.of_nothing", ""},' > "$planted/key_rows.hpp"
[ -n "$(unused_texts "$planted/key_rows.hpp")" ] || bad "the check of the texts finds nothing"
unused_keys=$(unused_texts content/words/key_rows.hpp)
[ -z "$unused_keys" ] || bad "text keys that no code uses: $unused_keys"

# The first word of a comment is the subject of a sentence.
inverted() { grep -rnE '^\s*// (Of|What|Whether|Whoever|Nothing|How) ' --include='*.cpp' --include='*.hpp' "$@" || true; }
echo '// Of a nut that is turned.' > "$planted/inverted.cpp"
[ -n "$(inverted "$planted")" ] || bad "the check of the comments finds nothing"
found=$(inverted engine haptics content game tools tests)
[ -z "$found" ] || bad "comments that do not begin with their subject: $found"

# Documents name only files and functions that exist.
mkdir "$planted/docs"
for mistake in '`game/lost_folder`' '`lost_file.cpp`' '`lost_function`'; do
    echo "$mistake" > "$planted/docs/changes.md"
    ! python3 tests/documents.py "$planted" >/dev/null || bad "the check of the documents does not find: $mistake"
done
python3 tests/documents.py . || bad "a document names what does not exist"

# A test reports what it skips (tests/support/skip.hpp).
silent_skips() { grep -rnE 'sanitized\)? *\)? (return|continue);|sanitized && .*\) (return|continue);|doctest::skip\(' --include='*.cpp' --include='*.hpp' "$1" || true; }
for line in 'if (test::sanitized) return;' 'if (test::sanitized && x) continue;' 'TEST_CASE("a" * doctest::skip(true)) {'; do
    echo "$line" > "$planted/silent.cpp"
    [ -n "$(silent_skips "$planted")" ] || bad "the check of skipped tests does not find: $line"
done
silent=$(silent_skips tests)
[ -z "$silent" ] || bad "tests skipped without test::skip_rest: $silent"

if clang-format --version 2>/dev/null | grep -q 'version 14\.'; then
    find engine haptics content game tools tests \( -name '*.hpp' -o -name '*.cpp' \) -print0 |
        xargs -0 clang-format --dry-run -Werror || bad "not in the house style: clang-format -i"
else
    skip_part "formatting: clang-format 14, whose style is ours, is not installed"
fi
exit $failed
