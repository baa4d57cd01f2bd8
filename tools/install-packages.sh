#!/usr/bin/env bash
# Installs those packages of packages.txt for the given groups (build, test, bench) that are missing. Debian 12.
set -euo pipefail
list="$(dirname "$0")/../packages.txt"
missing=()
for group in "$@"; do
    while read -r package instead; do
        [[ -z $instead ]] || ! command -v "$instead" >/dev/null || continue
        status=$(dpkg-query -W -f='${Status}' "$package" 2>/dev/null || true)
        [[ $status == "install ok installed" ]] || missing+=("$package")
    done < <(awk -v group="$group" '!/^#/ && $2 == group { print $1, $3 }' "$list")
done
[[ ${#missing[@]} -gt 0 ]] || exit 0
echo "Installing: ${missing[*]}"
as_root=()
[[ $(id -u) -eq 0 ]] || as_root=(sudo)
if ! command -v apt-get >/dev/null; then
    echo "This system is not Debian: install the libraries of packages.txt with your own package manager." >&2
    exit 1
fi
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
