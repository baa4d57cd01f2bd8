#!/usr/bin/env bash
# Fetches Debian's stock kernel for tests/kernel into the folder $1, without installing it: the image and the modules for HID
# devices. Needs the package archive on the first run only.
set -euo pipefail
to=$1
[[ ! -e $to/vmlinuz ]] || exit 0
if [[ $(dpkg --print-architecture 2>/dev/null) != amd64 ]]; then
    echo "This system is not Debian on amd64: the test against a real kernel is skipped" >&2
    exit 0
fi
as_root=()
[[ $(id -u) -eq 0 ]] || as_root=(sudo)
newest() { apt-cache depends linux-image-amd64 2>/dev/null | awk '$1 == "Depends:" && $2 ~ /^linux-image-[0-9]/ { print $2; exit }'; }
rm -rf "$to"
mkdir -p "$to/unpacked"
download() { (cd "$to/unpacked" && apt-get download -qq -o APT::Sandbox::User=root "$(newest)"); }
echo "Fetching: a Linux kernel for tests"
if [[ -z $(newest) ]] || ! download 2>/dev/null; then
    "${as_root[@]}" apt-get update -qq
    download
fi
dpkg-deb --fsys-tarfile "$to"/unpacked/*.deb | tar -x -C "$to/unpacked" --wildcards './boot/vmlinuz-*' \
    './lib/modules/*/kernel/drivers/hid/hid.ko' './lib/modules/*/kernel/drivers/hid/hid-generic.ko' \
    './lib/modules/*/kernel/drivers/hid/uhid.ko'
mv "$to"/unpacked/lib/modules/*/kernel/drivers/hid/*.ko "$to"
mv "$to"/unpacked/boot/vmlinuz-* "$to/vmlinuz.new"
rm -r "$to/unpacked"
mv "$to/vmlinuz.new" "$to/vmlinuz"
