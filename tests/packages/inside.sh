# Run by fresh_root.sh inside its root. Prints one line a check; exits with 1 if one fails.
failed=0
check() {
    local name=$1
    shift
    if "$@"; then echo "ok: $name"; else echo "FAILED: $name"; failed=1; fi
}
eventually() { for _ in $(seq 120); do "$@" && return; sleep 0.5; done; return 1; }
cd /packages
apt-get update -qq
find / -xdev -path /packages -prune -o -path /proc -prune -o -path /var/lib/dpkg -prune -o -iname '*boltwright*' -print >/tmp/before
check 'apt installs the packages' apt-get install -y -qq ./boltwright_*.deb ./boltwright-content_*.deb ./boltwright-author_*.deb ./boltwright-dev_*.deb
check 'lintian reports no error' lintian --fail-on error --tag-display-limit 0 ./boltwright_*.deb ./boltwright-content_*.deb ./boltwright-author_*.deb ./boltwright-dev_*.deb
check 'the desktop entry is valid' desktop-file-validate /usr/share/applications/boltwright.desktop
# There is no home page, which is a warning in some versions.
appstreamcli validate --no-net --no-color /usr/share/metainfo/io.github.boltwright.metainfo.xml >/tmp/appstream
cat /tmp/appstream
check 'the AppStream data has no error' bash -c '! grep -q "^E:" /tmp/appstream'
check 'the manual pages have no warnings' bash -c '
    for page in boltwright bolt-author; do man --warnings -E UTF-8 -l /usr/share/man/man1/$page.1.gz 2>&1 >/dev/null; done | { ! grep .; }'
useradd -m ada
as_ada() { su ada -s /bin/bash -c "cd; $1"; }
check 'bash completes a command and a value' as_ada '
    . /usr/share/bash-completion/completions/boltwright
    COMP_WORDS=(boltwright train --mode pr) COMP_CWORD=3; _boltwright; [[ ${COMPREPLY[*]} == practice ]] || exit
    COMP_WORDS=(boltwright rep) COMP_CWORD=1; _boltwright; [[ ${COMPREPLY[*]} == 'replay report' ]]'
find /usr -newer /tmp/before -type f >/tmp/installed
check 'a simulated trainee finishes a lesson' as_ada 'boltwright train cover-m8 --headless --quiet --no-pictures --out lesson'
check 'bolt-author finds the content' as_ada 'bolt-author validate zq350'
check 'the header of plug-ins and its example are installed' test -s /usr/include/boltwright_arm.h -a -s /usr/share/doc/boltwright-dev/examples/sample_arm.c
check 'the process of plug-ins is installed' test -x /usr/lib/boltwright/bolt-arm-host
cat >/tmp/play.sh <<'P'
cd
Xvfb -displayfd 3 -screen 0 1280x800x24 3>display >/dev/null 2>&1 &
screen=$!
trap 'kill $screen' EXIT
for _ in $(seq 40); do [[ -s display ]] && break; sleep 0.5; done
export DISPLAY=:$(cat display)
$(sed -n 's/^Exec=//p' /usr/share/applications/boltwright.desktop) 2>log >/dev/null &
player=$!
for _ in $(seq 120); do window=$(xdotool search --pid $player 2>/dev/null | tail -1) && [[ -n $window ]] && break; sleep 0.5; done
sleep 6
import -window root menu.png
for _ in $(seq 40); do
    grep -q 'lesson begun' log && break
    xdotool key --window $window Return
    sleep 2
done
sleep 8
import -window root lesson.png
kill -INT $player
wait $player
# The session opens in the viewer, by the entry for its file type.
exec=$(sed -n 's/^Exec=//p' /usr/share/applications/boltwright-session.desktop)
${exec/\%f/$(echo ~/.local/share/boltwright/sessions/*_first-nut/session.boltwright)} 2>viewer.log >/dev/null &
player=$!
for _ in $(seq 120); do window=$(xdotool search --pid $player 2>/dev/null | tail -1) && [[ -n $window ]] && break; sleep 0.5; done
sleep 6
import -window root viewer.png
xdotool key --window $window Escape
wait $player && touch viewed
P
check 'the menu entry opens the program, and Enter begins the tour' as_ada 'bash /tmp/play.sh && grep -q "lesson begun" log'
check 'the session opens in the viewer, and Escape closes it' as_ada 'test -e viewed'
check 'the file type of a session is known' as_ada 'gio info -a standard::content-type lesson/session.boltwright | grep -q application/vnd.boltwright.session'
check 'the lesson of the window is kept below the data folder' as_ada 'ls ~/.local/share/boltwright/sessions/*_first-nut/session.boltwright'
check 'the kept session replays' as_ada 'boltwright replay ~/.local/share/boltwright/sessions/*_first-nut/session.boltwright'
find /usr -newer /tmp/before -type f | sort >/tmp/used
sort /tmp/installed | comm -13 - /tmp/used | grep -i bolt >/tmp/written || true
check 'nothing is written to where it was installed' test ! -s /tmp/written
# A later version, made of the same files, replaces the packages; the user's files stay as they were.
as_ada 'mkdir -p ~/.local/share/boltwright/assemblies && cp -r /usr/share/boltwright/content/assemblies/cover-m8 ~/.local/share/boltwright/assemblies/mine'
users_files() { as_ada 'find ~/.local/share/boltwright lesson -type f -exec sha256sum {} + | sort'; }
users_files >/tmp/users_before
mkdir /tmp/later
for package in ./boltwright_*.deb ./boltwright-content_*.deb ./boltwright-author_*.deb ./boltwright-dev_*.deb; do
    rm -rf /tmp/unpacked
    dpkg-deb -R "$package" /tmp/unpacked
    sed -i -E 's/^Version: (.*)/Version: \1+later/; s/(boltwright[a-z-]* \(= [^)]*)\)/\1+later)/g' /tmp/unpacked/DEBIAN/control
    dpkg-deb -b --root-owner-group /tmp/unpacked /tmp/later >/dev/null
done
check 'apt upgrades the packages' apt-get install -y -qq /tmp/later/*.deb
check 'the later version is installed' bash -c "dpkg-query -W -f '\${Version}' boltwright | grep -q '+later\$'"
users_files >/tmp/users_after
rm -rf /tmp/later /tmp/unpacked
check 'an upgrade keeps the files of the user' cmp /tmp/users_before /tmp/users_after
check 'there are files of the user' test -s /tmp/users_before
check 'the later version replays the kept session' as_ada 'boltwright replay ~/.local/share/boltwright/sessions/*_first-nut/session.boltwright'
check 'an assembly of the user is found by its name' as_ada 'boltwright train mine --headless --quiet --no-pictures --out mine && grep -q "\"assembly\": \"mine\"" mine/summary.json'
check 'apt removes the packages' apt-get purge -y -qq boltwright boltwright-content boltwright-author boltwright-dev
find / -xdev -path /packages -prune -o -path /proc -prune -o -path /var/lib/dpkg -prune -o -path /home -prune -o -iname '*boltwright*' -print >/tmp/after
check 'nothing of them is left' cmp /tmp/before /tmp/after
check 'the sessions of the user are kept' as_ada 'ls ~/.local/share/boltwright/sessions/*_first-nut/session.boltwright lesson/session.boltwright'
exit $failed
