#!/usr/bin/env bash
# Plays lessons on a real OpenXR runtime: monado.sh BUILD SOURCE [OUT [ROOT [PARTS...]]]. It is Monado of Debian 13, with simulated
# devices, in a Debian 13 root. ROOT (default: /tmp/monado_root) keeps the root, so that a second run is fast; OUT (default:
# BUILD/monado) gets sessions, logs, pictures and a film of both eyes. PARTS (default: program first-nut cover-m8): see
# tests/monado/inside.sh. Needs root, mmdebstrap and the package archive; exits with 77 and the reason where one of them is missing.
set -euo pipefail
if [[ $# -lt 2 ]]; then
    sed -n '2,5s/^# //p' "$0" >&2
    exit 2
fi
build=$(realpath "$1") source=$(realpath "$2")
out=$(realpath -m "${3:-$build/monado}") folder=$(realpath -m "${4:-/tmp/monado_root}")
shift $(($# < 4 ? $# : 4))
skip() { echo "skipped: $1" >&2; exit 77; }
[[ $(id -u) -eq 0 ]] || skip "only root can make a Debian 13 root"
command -v mmdebstrap >/dev/null || skip "mmdebstrap is not installed"
root=$folder/root
if [[ ! -e $root/made ]]; then
    rm -rf --one-file-system "$root"
    mkdir -p "$folder"
    # Monado, then what a desktop has: a driver, a screen, pictures of it, and the libraries of our programs.
    mmdebstrap --variant=apt --aptopt='APT::Install-Recommends "false"' \
        --include=monado-service,libopenxr1-monado,libopenxr-loader1,mesa-vulkan-drivers,vulkan-validationlayers \
        --include=xvfb,imagemagick,iproute2,procps,fontconfig,fonts-dejavu-core,fonts-wqy-microhei \
        --include=libglfw3,libopenal1,libsqlite3-0 \
        trixie "$root" >"$folder/log" 2>&1 || skip "mmdebstrap failed: $(tail -1 "$folder/log")"
    touch "$root/made"
fi
# From here on in namespaces of its own: nothing stays mounted or running whatever happens to this script, and only this
# computer can reach Monado, which listens on every network interface. The root was made before, because that needs the network.
if [[ -z ${BOLT_OWN_MOUNTS:-} ]]; then
    own=(unshare --mount --propagation private --net --pid --fork --kill-child)
    "${own[@]}" true 2>/dev/null || skip "namespaces are not allowed"
    BOLT_OWN_MOUNTS=1 exec "${own[@]}" bash "$0" "$build" "$source" "$out" "$folder" "$@"
fi
mkdir -p "$root/src" "$root/build" "$root/out" "$root/host" "$out"
{ mount --bind "$source" "$root/src" && mount --bind "$build" "$root/build" && mount --bind "$out" "$root/out" &&
    mount --bind /dev "$root/dev" && mount -t proc proc "$root/proc"; } || skip "mounts are not allowed"
in_root() { chroot "$root" env -i HOME=/root LANG=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin LD_LIBRARY_PATH=/host "$@"; }
# The libraries that Debian 13 has with another version number come from this system, with what they need in turn.
programs=(boltwright test_monado)
missing() {
    { in_root bash -c "cd /build/bin && ldd ${programs[*]} \$(find /host -type f)" || true; } | awk '/=> not found/ { print $1 }' | sort -u
}
while libraries=$(missing) && [[ -n $libraries ]]; do
    for library in $libraries; do
        file=$(cd "$build/bin" && ldd "${programs[@]}" | awk -v name="$library" '$1 == name && $3 ~ "^/" { print $3; exit }')
        [[ -n $file ]] || { echo "monado.sh: this system has no $library" >&2; exit 1; }
        cp "$file" "$root/host/$library"
    done
done
in_root ip link set lo up
status=0
in_root /src/tests/with_screen.sh bash /src/tests/monado/inside.sh /build/bin /src /out "$@" || status=$?
# A film of both eyes, and sixteen of its pictures, from those that the lessons left.
for pictures in "$out"/pictures/*/; do
    [[ -e ${pictures}00000.png ]] || continue
    name=$(basename "$pictures")
    ffmpeg -nostdin -y -loglevel error -framerate 20 -i "${pictures}%05d.png" -c:v libx264 -pix_fmt yuv420p "$out/$name.mp4"
    every=$((($(find "$pictures" -name '*.png' | wc -l) + 15) / 16))
    ffmpeg -nostdin -y -loglevel error -i "${pictures}%05d.png" -vf "select=not(mod(n\,$every)),tile=2x8" -frames:v 1 "$out/$name.png"
done
exit $status
