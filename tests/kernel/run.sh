#!/usr/bin/env bash
# Boots Debian's stock kernel in a virtual machine that contains only a test program. The program plugs emulated devices into
# that kernel and operates them. $1: the program, $2: the folder of tools/fetch-kernel.sh, $3: content, the rest: programs that
# the tests run.
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
# The shared libraries of the programs, at their paths.
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

# The guest's clock counts instructions and does not wait in idle times, so its measurements do not depend on the load of this
# machine. The limit only ends a guest that hangs: one that works takes about a minute of one processor.
status=0
timeout 600 qemu-system-x86_64 -M pc -m 768 -nographic -no-reboot -nic none -icount shift=1,sleep=off \
    -kernel "$kernel/vmlinuz" -initrd "$work/initrd.gz" -append "console=ttyS0 loglevel=1 panic=-1" \
    < /dev/null > "$work/log" 2>&1 || status=$?
tr -d '\r' < "$work/log" | sed 's/\x1b\[[0-9;?]*[a-zA-Z]//g'
[[ $status -ne 124 ]] || { echo "the guest did not end"; exit 1; }
tr -d '\r' < "$work/log" | grep -q '^guest: exit 0$'
