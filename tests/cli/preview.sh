#!/usr/bin/env bash
# bolt-author preview as an author uses it: a window, mouse and keyboard input, and changing files. Runs under
# tests/with_screen.sh. $1: folder of the programs, $2: sources. Each wait times out after two minutes.
. "$(dirname "$0")/checks.sh"
export ASAN_OPTIONS=detect_leaks=0

# Opens the only window. Without a window manager it has the requested position.
start() {  # start what option...
    : >log
    "$bin/bolt-author" preview "$@" --validate >log 2>&1 &
    player=$!
    eventually has_window || { echo "no window:"; cat log; exit 1; }
    # The swing of a selected joint is drawn after the check.
    eventually grep -q '^checked ' log || { echo "not checked:"; cat log; exit 1; }
}
has_window() { window=$(xdotool search --name 'preview|broken' 2>/dev/null | head -1) && [[ -n $window ]]; }
title() { xdotool getwindowname "$window"; }
shoot() {  # shoot FILE: a screenshot of the window
    local X Y WIDTH HEIGHT SCREEN WINDOW
    eval "$(xdotool getwindowgeometry --shell "$window")"
    "$bin/test_screenshot" "$1" "$X" "$Y" "$WIDTH" "$HEIGHT" 2>/dev/null
}
# Samples at edges may differ, because render computes its camera in different steps.
like() { "$bin/bolt-imagediff" "$1" "$2" --max-flip 0.004 >/dev/null 2>&1; }
shows() { shoot now.png && like "$1" now.png; }
shows_not() { shoot now.png && ! like "$1" now.png; }
# Waits until two successive screenshots are equal.
settle() {
    local i
    shoot before.png
    for ((i = 0; i < 300; i++)); do
        sleep 0.3
        shoot after.png && cmp -s before.png after.png && return
        cp after.png before.png
    done
    return 1
}
ends_well() {
    local i status
    xdotool key Escape
    for ((i = 0; i < 600; i++)); do kill -0 $player 2>/dev/null || break; sleep 0.2; done
    kill $player 2>/dev/null
    wait $player
    status=$?
    player=
    [[ $status -eq 0 ]] || { echo "exit $status"; cat log; return 1; }
}
# Draws with the level of detail of preview.
render() { "$bin/boltwright" render "$@" --level-error 0.5 >/dev/null; }

# Without a display: a picture, or an error.
expect 4 'DISPLAY.*--png FILE needs none' env -u DISPLAY -u WAYLAND_DISPLAY "$bin/bolt-author" preview cover-m8
expect 0 'pictures/cover.png' env -u DISPLAY "$bin/bolt-author" preview cover-m8 --view top --size 320x200 --validate \
    --png pictures/cover.png
render cover-m8 --view top --size 320x200 --png top.png
check "preview draws what render draws" like top.png pictures/cover.png
render cover-m8 --view front --size 320x200 --png front.png
check "... and the comparison can fail" bash -c '! "$1" front.png pictures/cover.png --max-flip 0.004 >/dev/null 2>&1' - \
    "$bin/bolt-imagediff"
expect 2 '"top"' "$bin/bolt-author" preview cover-m8 --view topp
expect 2 'not a size' "$bin/bolt-author" preview cover-m8 --size 320
expect 2 'not named "shaders"' "$bin/bolt-author" preview cover-m8 --shaders "$sources/engine" --png never.png
expect 3 'nowhere.glb' "$bin/bolt-author" preview nowhere.glb
expect 4 'does not match' "$bin/bolt-author" preview cover-m8 --gpu voodoo
check "no picture is written after an error" test ! -e never.png

expect 0 'sRGB' "$bin/boltwright" doctor --seconds 0
expect 0 'images, the minimum is' "$bin/boltwright" doctor --seconds 0

# Navigation.
start cover-m8 --size 320x200
check "the title names the model" [ "$(title)" = 'cover-m8 - bolt-author preview' ]
render cover-m8 --size 320x200 --png all.png
check "the whole model is shown first" eventually shows all.png
xdotool key 2
check "key 2 shows the second view" eventually shows top.png
xdotool key 1
check "key 1 shows the first view" eventually shows front.png
xdotool mousemove 160 100 mousedown 1 mousemove 220 110 mouseup 1
check "dragging turns the view" eventually shows_not front.png
check "... and comes to rest" settle
cp after.png turned.png
xdotool key 1
eventually shows front.png
xdotool mousemove 160 100 mousedown 3 mousemove 220 110 mouseup 3
check "dragging with the right button moves the view" eventually shows_not front.png
settle
check "... which gives another picture" bash -c '! cmp -s after.png turned.png'
cp after.png moved.png
xdotool key 1
eventually shows front.png
xdotool mousemove 160 100 mousedown 2 mousemove 220 110 mouseup 2
check "dragging with the middle button moves the view in the same way" eventually shows moved.png
xdotool mousemove 60 60 click 4 click 4 click 4
check "the wheel zooms in" eventually shows_not moved.png
settle
cp after.png near.png
xdotool click 5 click 5 click 5
check "... and back to the same place" eventually shows moved.png
xdotool key 1 key f
check "F shows the whole model" eventually shows_not front.png
xdotool key 2
eventually shows top.png
xdotool windowsize "$window" 500 260
render cover-m8 --view top --size 500x260 --png wide.png
check "a resized window shows the same view" eventually shows wide.png
xdotool key F11
render cover-m8 --view top --size 1280x800 --png whole.png
check "F11 switches to full screen" eventually shows whole.png
xdotool key F11
check "... and back" eventually shows wide.png
xdotool key l
check "key L loads the far level" eventually grep -q 'reloaded cover-m8' log
check "... which looks different" eventually shows_not wide.png
xdotool key l
check "... and back" eventually shows wide.png
check "Esc closes" ends_well

# Changing files.
cp -r "$sources/content/assemblies/cover-m8" mine
start mine --view top --size 320x200
check "the folder of an assembly is shown" eventually shows top.png
sed -i 's/"name": "top", "eye_mm": \[0, 500, 1\]/"name": "top", "eye_mm": [200, 300, 1]/' mine/assembly.json
check "a changed assembly.json is reloaded" eventually grep -q 'reloaded mine' log
xdotool key 2
render mine --view top --size 320x200 --png moved_view.png
check "... with the changed view" eventually shows moved_view.png
cp mine/cover-m8.glb good.glb
cp "$sources/content/tools/wrench-13.glb" new.glb && mv new.glb mine/cover-m8.glb
render mine --view top --size 320x200 --png wrench.png
check "a model that replaces the old file is shown" eventually shows wrench.png
head -c 1000 good.glb > mine/cover-m8.glb
says_broken() { [[ $(title) == *"error: "*cover-m8.glb* ]]; }
check "a truncated model is reported in the title" eventually says_broken
check "... and on the terminal" grep -q 'mine/cover-m8.glb: ' log
check "... and the last valid picture remains" shows wrench.png
cp good.glb mine/cover-m8.glb
check "the repaired model is shown" eventually shows moved_view.png
says_well() { [[ $(title) == 'mine - bolt-author preview' ]]; }
check "... with the previous title" eventually says_well
sed -i 's/"model": /"modle": /' mine/assembly.json
says_where() { [[ $(title) == *"error: mine/assembly.json:"*:*modle* ]]; }
check "a mistake in assembly.json is reported with its position" eventually says_where
check "... and the last valid picture remains" shows moved_view.png
sed -i 's/"modle": /"model": /' mine/assembly.json
check "the repaired file is shown" eventually says_well
check "Esc closes" ends_well

# Selecting a joint. In the top view of 320 × 200 pixels B3 is at 189, 121 and B1 at 131, 77.
cp "$sources/content/assemblies/cover-m8/assembly.json" mine/assembly.json
entry() { grep -n "\"id\": \"$1\"" mine/assembly.json | cut -d: -f1; }
count() { [[ $(grep -cE "$1" log) -eq $2 ]]; }
has_title() { [[ $(title) == $1 ]]; }
start mine --view top --size 320x200
eventually shows top.png
xdotool mousemove 189 121 mousedown 1 mousemove 230 130 mouseup 1
eventually shows_not top.png
settle
check "a drag that begins on a joint selects nothing" count ': joint ' 0
xdotool key 2
eventually shows top.png
xdotool mousemove 189 121 click 3
xdotool mousemove 189 121 click 1
line=$(entry B3)
check "a click on a joint prints its place, type and tool" eventually grep -qxF \
    "mine/assembly.json:$line:5: joint B3: type M8x30, tool wrench" log
check "... the right button selects nothing" count ': joint ' 1
check "... the title shows the same" eventually has_title \
    "mine - joint B3: type M8x30, tool wrench - mine/assembly.json:$line:5 - bolt-author preview"
check "... and the joint is highlighted" eventually shows_not top.png
settle
cp after.png selected.png
xdotool mousemove 131 77 click 1
check "a click on another joint selects that one" eventually grep -qxF \
    "mine/assembly.json:$(entry B1):5: joint B1: type M8x30, tool wrench" log
check "... and highlights only it" eventually shows_not selected.png
xdotool mousemove 160 12 click 1
check "a click beside all joints clears the title" eventually has_title 'mine - bolt-author preview'
check "... and the highlight" eventually shows top.png
xdotool mousemove 189 121 click 1
check "the joint is selected again" eventually shows selected.png
sed -i '1a\\n' mine/assembly.json
check "the selection follows the joint's line when the file changes" eventually grep -qxF \
    "mine/assembly.json:$((line + 2)):5: joint B3: type M8x30, tool wrench" log
check "... also in the title" eventually has_title "mine - joint B3: *:$((line + 2)):5 - bolt-author preview"
check "... and stays highlighted" eventually shows selected.png
xdotool key l
check "... also in the far level" eventually count 'reloaded mine' 2
xdotool key l
check "... and back" eventually shows selected.png
check "an unchanged place is not printed again" count ': joint B3' 3
sed -i 's/"B3"/"B9"/' mine/assembly.json
check "a joint that has gone is no longer selected" eventually grep -qxF 'joint B3 has gone and is no longer selected' log
check "... as the title shows" eventually has_title 'mine - bolt-author preview'
check "... and the highlight is gone" eventually shows top.png
check "Esc closes" ends_well

# Problems of the tools' room: the ratchet of two joints no longer has a ring instead, and there is no way for it.
cp -r "$sources/content/assemblies/dn200-pn16" room
sed -i 's/"handle_length_mm": 450,/"handle_length_mm": 450/; /"instead": { "B6": "ring"/d' room/assembly.json
place() { echo "room/assembly.json:$(grep -n "\"id\": \"$1\"" room/assembly.json | cut -d: -f1):5"; }
start room --size 800x600
check "a check reports problems when the window is open" grep -qxF 'checked room (by_torque): 12 joints, 2 problems' log
check "... with their places, as validate does" grep -qE "^$(place B6): .*\"ratchet\" cannot be brought onto \"B6\"" log
check "... and their number in the title" eventually has_title 'room - 2 problems - bolt-author preview'
settle
cp after.png problems.png
xdotool key p
check "key P hides the panel" eventually shows_not problems.png
xdotool key p
check "... and shows it again" eventually shows problems.png
xdotool key n
check "key N selects the joint of the first problem" eventually grep -q "^$(place B6): joint B6: " log
xdotool key n
check "... and then that of the next one" eventually grep -q "^$(place B7): joint B7: " log
settle
cp after.png next.png
xdotool mousemove 150 180 click 1
check "a click on a problem in the panel selects its joint" eventually count ': joint B6: ' 2
check "... and shows it" eventually shows_not next.png
settle
cp after.png chosen.png
xdotool mousemove 700 550 click 1
check "a click beside all joints removes the swing" eventually has_title 'room - 2 problems - bolt-author preview'
xdotool key f
check "... from the picture" eventually shows_not chosen.png
settle
cp after.png before_all.png
xdotool key s
check "key S draws the swing of all joints" eventually shows_not before_all.png
xdotool key s
check "... and removes it" eventually shows before_all.png
xdotool mousemove 60 63 click 1
check "a click on a variant in the panel shows and checks it" eventually grep -qF 'checked room (by_angle): ' log
xdotool key v
check "key V shows the next variant" eventually grep -qF 'checked room (held_heads): ' log
xdotool key v
check "... and after the last one the first" eventually count 'checked room .by_torque.' 2
cp "$sources/content/assemblies/dn200-pn16/assembly.json" room/assembly.json
check "the check is repeated after a change" eventually grep -qxF 'checked room (by_torque): 12 joints, no problems' log
check "... and the title follows" eventually has_title 'room - bolt-author preview'
check "Esc closes" ends_well
start room --variant by_angle --size 320x200
check "--variant begins with another one" grep -qF 'checked room (by_angle): ' log
check "Esc closes" ends_well
expect 3 'did you mean "by_angle"' "$bin/bolt-author" preview room --variant by_angel

# A changing light, and shaders.
cp "$sources/content/environments/workshop.hdr" light.hdr
cp -r "$sources/shaders" shaders
start cover-m8 --view top --size 320x200 --light light.hdr --shaders shaders
render cover-m8 --view top --size 320x200 --light "$sources/content/environments/workshop.hdr" --png lit.png
check "light and shaders from files are used" eventually shows lit.png
echo rubbish > light.hdr
says_light() { [[ $(title) == *"error: light.hdr"* ]]; }
check "a broken light is reported" eventually says_light
check "... and the old one remains" shows lit.png
cp "$sources/content/environments/workshop.hdr" light.hdr
says_well() { [[ $(title) == 'cover-m8 - bolt-author preview' ]]; }
check "the repaired file is shown" eventually says_well
sed -i 's/^void main() {/void main() { nonsense;/' shaders/light.frag
says_shader() { [[ $(title) == *"error: "*light.frag* ]]; }
check "a shader that does not compile is reported" eventually says_shader
check "... with the compiler's message" grep -q "'nonsense' : undeclared identifier" log
check "... and the old one remains" shows lit.png
sed -i 's/^void main() { nonsense;/void main() { color_out = vec4(1, 0, 0, 1); return;/' shaders/light.frag
is_red() {
    shoot now.png && "$bin/bolt-imagediff" red.png now.png --max-flip 0.004 >/dev/null 2>&1
}
"$bin/bolt-author" preview cover-m8 --view top --size 320x200 --shaders shaders --png red.png >/dev/null
check "a changed shader is used at once" eventually is_red
check "... and gives another picture" bash -c '! cmp -s red.png lit.png'
check "Esc closes" ends_well

finish_checks
