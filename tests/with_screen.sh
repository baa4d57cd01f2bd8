#!/usr/bin/env bash
# Runs a command on its own virtual screen and returns the command's exit code. $BOLT_SCREEN is the file in which Xvfb stores the
# pixels (an XWD picture). Xvfb chooses a free display number.
set -uo pipefail
folder=$(mktemp -d)
mkfifo "$folder/number"
Xvfb -displayfd 3 -screen 0 1280x800x24 -fbdir "$folder" -nolisten tcp -noreset 3<>"$folder/number" \
    >"$folder/log" 2>&1 &
server=$!
trap 'kill $server 2>/dev/null; wait $server 2>/dev/null; rm -rf "$folder"' EXIT
exec 4<>"$folder/number"
number=
while [[ -z $number ]] && kill -0 $server 2>/dev/null; do read -r -t 1 number <&4; done
if [[ -z $number ]]; then
    echo "Xvfb does not start:" >&2
    cat "$folder/log" >&2
    exit 1
fi
DISPLAY=:$number WAYLAND_DISPLAY='' BOLT_SCREEN=$folder/Xvfb_screen0 "$@"
