#!/usr/bin/env bash
# Builds Boltwright for release in a Debian 13 root and runs every test there: tests/debian13.sh [FOLDER]. FOLDER (default:
# build/debian13) keeps the root and the build, so that a second run is fast. Needs root, mmdebstrap and the package archive;
# exits with 77 and the reason where one of them is missing. Arguments after the folder go to ctest. With
# BOLT_GOLDEN_UPDATE set it redraws the golden pictures of Debian 13's driver instead.
set -euo pipefail
# In a mount namespace of its own, so that nothing stays mounted below the root whatever happens to this script.
if [[ -z ${BOLT_OWN_MOUNTS:-} ]]; then
    unshare --mount --propagation private true 2>/dev/null || { echo "skipped: a mount namespace is not allowed" >&2; exit 77; }
    BOLT_OWN_MOUNTS=1 exec unshare --mount --propagation private bash "$0" "$@"
fi
cd "$(dirname "$0")/.."
sources=$PWD
folder=$(realpath -m "${1:-build/debian13}")
shift || true
skip() { echo "skipped: $1" >&2; exit 77; }
[[ $(id -u) -eq 0 ]] || skip "only root can make a Debian 13 root"
command -v mmdebstrap >/dev/null || skip "mmdebstrap is not installed"
root=$folder/root
if [[ ! -e $root/made ]]; then
    rm -rf --one-file-system "$root"
    mkdir -p "$folder"
    mmdebstrap --variant=apt --aptopt='APT::Install-Recommends "false"' trixie "$root" >"$folder/log" 2>&1 ||
        skip "mmdebstrap failed: $(tail -1 "$folder/log")"
    touch "$root/made"
fi
mkdir -p "$root/src" "$root/build"
trap 'umount "$root/src" "$root/dev/pts" "$root/dev" "$root/proc" "$root/sys" 2>/dev/null || true' EXIT
{ mount --bind "$sources" "$root/src" && mount --bind /dev "$root/dev" && mount --bind /dev/pts "$root/dev/pts" && mount -t proc proc "$root/proc" && mount -t sysfs sys "$root/sys"; } ||
    skip "mounts are not allowed"
in_root() { chroot "$root" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin "$@"; }
in_root /src/tools/install-packages.sh build test bench
in_root cmake -S /src -B /build -G Ninja -DCMAKE_BUILD_TYPE=Release >"$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
if [[ -n ${BOLT_GOLDEN_UPDATE:-} ]]; then
    in_root /src/tests/golden/update.sh /build
    exit
fi
in_root ninja -C /build --quiet
in_root ctest --test-dir /build -j2 --no-tests=error --output-on-failure "$@"
