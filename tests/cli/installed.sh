#!/usr/bin/env bash
# Tests a Boltwright that `cmake --install` has installed: it finds its content, keeps sessions below the user's data folder,
# changes nothing where it was installed, and shows errors in a window. installed.sh BIN SOURCES, on a screen (with_screen.sh).
. "$(dirname "$0")/checks.sh"
unset BOLTWRIGHT_CONTENT
prefix=$work/usr
check 'cmake --install succeeds' cmake --install "${bin%/bin}" --prefix "$prefix" >log
export HOME=$work/home
unset XDG_DATA_HOME
mkdir "$HOME"
# An assembly that exists only where it was installed.
cp -r "$prefix/share/boltwright/content/assemblies/cover-m8" "$prefix/share/boltwright/content/assemblies/installed-m8"
listing() { find "$prefix" -printf '%p %s %T@\n' | sort; }
listing >before

expect 0 'installed-m8' "$prefix/bin/bolt-author" validate installed-m8
expect 0 '' "$prefix/bin/boltwright" train installed-m8 --headless --quiet --no-pictures --out lesson
expect 3 'there is no such folder' "$bin/bolt-author" validate installed-m8
expect 0 'installed-m8' env XDG_DATA_DIRS="relative:$work/none:$prefix/share" bash -c '
    mkdir -p alone && cp "$0/bolt-author" alone && alone/bolt-author validate installed-m8' "$prefix/bin"

expect 0 'renders force' env BOLTWRIGHT_ARM_PLUGINS="${bin%/bin}/plugins" "$prefix/bin/boltwright" devices --device plugin:sample_arm:0 --seconds 0.1

# The menu entry runs the program without a command.
check 'the desktop entry starts an installed program' test -x "$prefix/bin/$(sed -n 's/^Exec=//p' "$prefix/share/applications/boltwright.desktop")"
"$prefix/bin/boltwright" 2>log >/dev/null &
player=$!
window() { xdotool search --pid $player 2>/dev/null | tail -1; }
shown() { [[ -n $(window) ]]; }
check 'a window opens' eventually shown
began() {
    grep -q 'lesson begun' log && return
    xdotool key --window "$(window)" Return 2>/dev/null
    sleep 2
    grep -q 'lesson begun' log
}
check 'Enter begins the tour at the first start' eventually began
sleep 1
kill -INT $player
check 'an interrupt ends the program with exit code 0' wait $player
player=
session=$(echo "$HOME"/.local/share/boltwright/sessions/20??-??-??_??-??-??_first-nut/session.boltwright)
check 'the session is kept in a folder of its own' test -s "$session"
check 'its report lies beside it' test -s "${session%/*}/report.html"
check 'its summary lies beside it' test -s "${session%/*}/summary.json"
expect 0 'all as they were recorded' "$prefix/bin/boltwright" replay "$session"
# The entry for the session's file type opens the viewer; Escape closes it.
check 'an entry opens sessions' grep -q '^MimeType=application/vnd.boltwright.session;$' "$prefix/share/applications/boltwright-session.desktop"
opener=$(sed -n 's/^Exec=//p' "$prefix/share/applications/boltwright-session.desktop")
# shellcheck disable=SC2086
"$prefix/bin/"${opener/\%f/$session} 2>log >/dev/null &
player=$!
check 'the viewer opens a window' eventually shown
gone() {
    xdotool key --window "$(window)" Escape 2>/dev/null
    ! shown
}
for ((i = 0; i < 60; i++)); do gone && break; sleep 1; done
check 'Escape closes the viewer with exit code 0' wait $player
player=
listing >after
check 'nothing was written to where it was installed' cmp before after

# Errors of a program that was started without a terminal.
mkdir tools
printf '#!/bin/sh\nprintf "%%s\\n" "$@" >"%s/shown"\n' "$work" >tools/zenity
chmod +x tools/zenity
expect 4 'display' env -u DISPLAY -u WAYLAND_DISPLAY PATH="$work/tools:$PATH" "$prefix/bin/boltwright"
check 'the error is shown in a window' grep -q 'display' shown
expect 1 'cannot be read as a session' env PATH="$work/tools:$PATH" "$prefix/bin/boltwright" open before
check 'the error of the viewer is shown in a window' grep -q 'cannot be read as a session' shown
expect 1 'cannot be opened' env PATH="$work/tools:$PATH" "$prefix/bin/boltwright" open nowhere.boltwright
rm -f shown
expect 2 '' env PATH="$work/tools:$PATH" "$prefix/bin/boltwright" nonsense
check 'no window opens for an error of the command line' test ! -e shown

# Manual pages and completions know every command.
for program in boltwright bolt-author; do
    page=$(gzip -dc "$prefix/share/man/man1/$program.1.gz")
    commands=$("$bin/$program" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z-]*\) .*/\1/p')
    check "$program has commands" test -n "$commands"
    for command in $commands; do
        check "the manual page describes $program $command" grep -qF ".SS $program ${command//-/\\-}" <<<"${page//bolt\\-author/bolt-author}"
    done
    if command -v man >/dev/null && command -v groff >/dev/null; then
        check "the manual page of $program has no warning" test -z "$(man --warnings -E UTF-8 -l "$prefix/share/man/man1/$program.1.gz" 2>&1 >/dev/null)"
    fi
done
complete_words() {  # complete_words WORD...: the completions of the last word
    COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMPREPLY=()
    "_$1"
    echo "${COMPREPLY[*]}"
}
. "$prefix/share/bash-completion/completions/boltwright"
check 'bash completes a command' [ "$(complete_words boltwright tr)" = 'train trainees' ]
check 'bash completes an option' [ "$(complete_words boltwright train zq350 --hea)" = --headless ]
check 'bash completes the value of an option' [ "$(complete_words boltwright train --mode pr)" = practice ]
check 'bash completes a command of a command' [ "$(complete_words boltwright glove cal)" = calibrate ]
check 'bash leaves files to its own completion' [ "$(complete_words boltwright replay se)" = '' ]
finish_checks
