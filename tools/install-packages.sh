#!/usr/bin/env bash
# Installs those packages of packages.txt for the given groups (build, test, bench, package) that are missing. Debian 12 and 13.
set -euo pipefail
list="$(dirname "$0")/../packages.txt"
installed() { [[ $(dpkg-query -W -f='${Status}' "$1" 2>/dev/null || true) == "install ok installed" ]]; }
any_installed() {
    for one in "$@"; do ! installed "$one" || return 0; done
    return 1
}
missing=()
for group in "$@"; do
    while read -r package instead; do
        [[ -z $instead ]] || ! command -v "$instead" >/dev/null || continue
        # shellcheck disable=SC2086
        any_installed ${package//|/ } || missing+=("$package")
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
chosen=()
for package in "${missing[@]}"; do
    for one in ${package//|/ }; do
        name=$one
        ! apt-cache show "$one" >/dev/null 2>&1 || break
    done
    chosen+=("$name")
done
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${chosen[@]}" >/dev/null
