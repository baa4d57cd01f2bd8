#!/usr/bin/env bash
# Boots Debian's stock kernel in a software machine with nothing in it but a program of tests, which plugs emulated devices
# into that kernel and drives them. $1: the program, $2: what tools/fetch-kernel.sh fetched, $3: content, the rest: programs
# that it runs.
set -euo pipefail
program=$1 kernel=$2 content=$3
shift 3
. "$(dirname "$0")/../support/skip.sh" kernel
for needed in qemu-system-x86_64 busybox cpio; do
    command -v $needed >/dev/null || skip_all "$needed is not installed"
done
[[ -e $kernel/vmlinuz ]] || skip_all "$kernel has no kernel; expected what tools/fetch-kernel.sh fetches"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
root=$work/root
mkdir -p "$root"/{bin,proc,sys,dev,tmp,modules}
cp "$(command -v busybox)" "$root/bin/busybox"
cp "$kernel"/*.ko "$root/modules"
cp "$program" "$root/bin/guest"
[[ $# -eq 0 ]] || cp "$@" "$root/bin"
mkdir -p "$root"/content/{assemblies,tools}
cp -r "$content/assemblies/cover-m8" "$root/content/assemblies"
cp "$content"/tools/wrench-13* "$root/content/tools"
cp -r "$content/schema" "$root/content"
find "$root/content" -name '*.step' -delete
# Their libraries, each where it is looked for.
while read -r library; do
    mkdir -p "$root$(dirname "$library")"
    cp -L "$library" "$root$library"
done < <(for one in "$program" "$@"; do ldd "$one"; done | grep -o '/[^ :]*\.so[^ :]*' | sort -u)
cat > "$root/init" <<END
#!/bin/busybox sh
/bin/busybox mount -t proc none /proc
/bin/busybox mount -t sysfs none /sys
/bin/busybox mount -t devtmpfs none /dev
for module in hid hid-generic uhid; do /bin/busybox insmod /modules/\$module.ko; done
export PATH=/bin
/bin/guest
echo "guest: exit \$?"
/bin/busybox poweroff -f
END
chmod +x "$root/init"
(cd "$root" && find . | cpio -o -H newc --quiet | gzip -1) > "$work/initrd.gz"

# Its clock counts instructions and does not wait while nothing is done: what the guest measures is its own doing, however
# busy this machine is. A guest that hangs is ended, and has failed.
status=0
timeout 110 qemu-system-x86_64 -M pc -m 768 -nographic -no-reboot -nic none -icount shift=1,sleep=off \
    -kernel "$kernel/vmlinuz" -initrd "$work/initrd.gz" -append "console=ttyS0 loglevel=1 panic=-1" \
    < /dev/null > "$work/log" 2>&1 || status=$?
tr -d '\r' < "$work/log" | sed 's/\x1b\[[0-9;?]*[a-zA-Z]//g'
[[ $status -ne 124 ]] || { echo "the guest did not end"; exit 1; }
tr -d '\r' < "$work/log" | grep -q '^guest: exit 0$'
