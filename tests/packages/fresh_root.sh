#!/usr/bin/env bash
# Installs the packages in a fresh Debian root, uses them as a user who is not root, and removes them:
# fresh_root.sh SUITE PACKAGES FOLDER, for example fresh_root.sh bookworm build/package/packages /tmp/root. Writes a screenshot of the
# menu and of the lesson to FOLDER. Needs root, mmdebstrap and the package archive; exits with 77 and the reason without them.
set -euo pipefail
# In a mount namespace of its own, so that nothing stays mounted below the root whatever happens to this script.
if [[ -z ${BOLT_OWN_MOUNTS:-} ]]; then
    unshare --mount --propagation private true 2>/dev/null || { echo "skipped: a mount namespace is not allowed" >&2; exit 77; }
    BOLT_OWN_MOUNTS=1 exec unshare --mount --propagation private bash "$0" "$@"
fi
suite=$1 packages=$(realpath "$2") folder=$(realpath -m "$3")
skip() { echo "skipped: $1" >&2; exit 77; }
[[ $(id -u) -eq 0 ]] || skip "only root can make a Debian root"
command -v mmdebstrap >/dev/null || skip "mmdebstrap is not installed"
mkdir -p "$folder"
root=$folder/root
rm -rf --one-file-system "$root"
# The first packages are only for this test: a screen, keys, a screenshot, and what a desktop has anyway.
mmdebstrap --variant=apt --aptopt='APT::Install-Recommends "false"' \
    --include=passwd,xvfb,xdotool,imagemagick,procps,desktop-file-utils,shared-mime-info,libglib2.0-bin,appstream,man-db,bash-completion,lintian \
    "$suite" "$root" >"$folder/log" 2>&1 || skip "mmdebstrap failed: $(tail -1 "$folder/log")"
trap 'umount -l "$root/dev" "$root/proc" 2>/dev/null || true' EXIT
{ mount --bind /dev "$root/dev" && mount -t proc proc "$root/proc"; } || skip "mounts are not allowed"
mkdir -p "$root/packages"
cp "$packages"/*.deb "$root/packages"
cp "$(dirname "$0")/inside.sh" "$root/inside.sh"
status=0
chroot "$root" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 bash /inside.sh || status=$?
cp "$root"/home/ada/*.png "$folder" 2>/dev/null || true
exit $status
