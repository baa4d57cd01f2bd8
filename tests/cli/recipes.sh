#!/usr/bin/env bash
# Runs all sh blocks of CONTRIBUTING.md in order in an empty folder. $1: programs, $2: sources.
set -euo pipefail
export PATH="$1:$PATH" BUILD="${1%/bin}" SOURCES="$2" BOLTWRIGHT_CONTENT="$2/content"
export ASAN_OPTIONS=detect_leaks=0  # one recipe draws, and Vulkan drivers leak memory
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
awk '/^```sh$/ { on = 1; next } /^```$/ { on = 0 } on' "$2/CONTRIBUTING.md" > "$work/recipes.sh"
[[ $(grep -c . "$work/recipes.sh") -ge 10 ]] || { echo "no sh blocks found"; exit 1; }
cd "$work"
bash -euxo pipefail recipes.sh > log 2>&1 || { cat log; exit 1; }
for file in pump-cover/assembly.json after.svg loosened/report.html compare.html ticks.csv red.png; do
    [[ -s $file ]] || { echo "$file is missing"; exit 1; }
done
grep -q '"id": "B5"' five/summary.json
[[ -s mistakes.txt ]] || { echo "the mistake in a language file was not reported"; exit 1; }
cmp -s before.csv after.csv && { echo "the changed torque did not change the curve"; exit 1; }

# All commands and options in README.md and docs/training.md exist.
commands=$(cd "$2" && grep -hE '^(boltwright|bolt-author) [a-z]' README.md docs/training.md | sed 's/ #.*//' | sort -u)
[[ $(wc -l <<< "$commands") -ge 40 ]] || { echo "only these commands found:"; echo "$commands"; exit 1; }
while read -r program command rest; do
    help=$("$program" "$command" --help) || { echo "$program $command is unknown"; exit 1; }
    # The options of a command such as `study run` are in its own help.
    read -r second _ <<< "$rest"
    if [[ $second =~ ^[a-z]+$ ]] && grep -qE "^  $second " <<< "$help"; then help=$("$program" "$command" "$second" --help); fi
    for option in $(grep -oE -- '--[a-z][a-z-]*' <<< "$rest"); do
        grep -qE -- "$option([ ,]|$)" <<< "$help" || { echo "$program $command has no option $option"; exit 1; }
    done
done <<< "$commands"
echo "all blocks of CONTRIBUTING.md succeed"
