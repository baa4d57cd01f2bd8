#!/usr/bin/env bash
# A study that compares displays and hands: the window, a headset of the mock runtime in tests/mock_openxr, and walls.
# study_displays.sh BIN SOURCES, on a screen (with_screen.sh).
. "$(dirname "$0")/checks.sh"
. "$sources/tests/cli/study_window.sh"
cat > template.json <<'END'
{
  "format": "boltwright displays 1",
  "head": { "tracker": "fixed", "fixed": { "position_m": [0, 1.65, 0.3] } },
  "walls": [{ "name": "front", "lower_left_m": [-1.5, 0, -1.5], "lower_right_m": [1.5, 0, -1.5], "upper_right_m": [1.5, 2.4, -1.5],
              "output": { "position_px": [800, 300], "resolution_px": [300, 240] } }]
}
END
condition() { printf '{ "id": "%s", "title": { "en": "%s" }, "lesson": { %s } }' "$1" "$1" "$2"; }
plan() { make_study "$1" "$(condition screen '"display": "window"'), $(condition other "$2")"; }

# Contradictory plans are mistakes with line and column.
mistake() { plan "$1" "$2"; expect 3 "^$1/study.json:6:[0-9]+: /conditions/1/lesson/$3" "${study[@]}" check "$1"; }
mistake unknown '"display": "monitor"' 'display: .*expected one of "window", "headset", "walls"|display: .*"monitor"'
mistake nowalls '"display": "walls"' 'display: the walls are not described; expected "displays", their display file, with it'
mistake nofile '"display": "headset", "displays": "w.json"' 'displays: only a lesson on walls has a display file; expected "display": "walls" with it'
mistake tracked '"hand": "tracked"' 'hand: only a headset tracks the hand; expected "display": "headset" with it'
mistake mouse '"display": "headset", "hand": "free"' 'hand: the mouse that moves this hand cannot be used in a headset; expected an arm'
mistake desk '"display": "headset", "devices": ["mouse"]' 'devices: the mouse cannot be used in a headset'

# `check` states what this computer lacks, before anybody takes part.
plan headless '"display": "headset"'
lacks() {  # lacks CODE FOLDER PATTERN
    expect "$1" "^$2/study.json:6:[0-9]+: /conditions/1/lesson/$3" env XR_RUNTIME_JSON=/nonexistent.json "${study[@]}" check "$2"
    expect "$1" "^$2/study.json:6:[0-9]+: /conditions/1/lesson/$3" env XR_RUNTIME_JSON=/nonexistent.json "${study[@]}" run "$2" --trainee Ada
    check "$2: nobody is enrolled" test ! -e "$2/participants/P01"
}
lacks 4 headless 'display: no OpenXR runtime: .*expected an active runtime'
plan wallless '"display": "walls", "displays": "walls.json"'
lacks 3 wallless 'displays: walls.json: '
sed 's/800, 300/99999, 300/' template.json > wallless/walls.json
lacks 3 wallless 'displays: wallless/walls.json: the walls cannot be shown: '
plan gloveless '"glove": "/dev/no-glove"'
lacks 4 gloveless 'glove: /dev/no-glove'
plan both '"display": "headset"'
expect 2 'the plan names the displays of its lessons; expected no --hmd and no --displays' "${study[@]}" run both --trainee Ada --displays walls.json

export XR_RUNTIME_JSON=${bin%/bin}/mock_openxr/mock_openxr.json MOCK_OPENXR_SCRIPT=$work/script
cat > script <<END
0 config width 96
0 config height 90
0 config realtime 1
0 config with XR_EXT_user_presence
0 report $work/report
1 head 0 1.65 0 -0.1 0 0 0.995
1 hand right active 1
1 hand right grip 0.05 1.15 -0.35 0 0 0 1
2 follow $work/commands
END
make_study three "$(condition screen '"display": "window"'), $(condition headset '"display": "headset"'), $(condition walls '"display": "walls", "displays": "walls.json"')"
cp template.json three/walls.json
expect 0 'place 1: screen, headset, walls' "${study[@]}" check three
forget() { cp log earlier; : > log; }
due() { "$bin/boltwright" study status three | grep -qE "^P01 .* $1 "; }
shown() { logged "^the study is shown $1"; }
own=three/participants/P01
end_in_window() {
    logged '^lesson ended' && return
    click "${end_button[@]}"
    logged '^lesson ended'
}
next_page() { click "${start_button[@]}"; }
# Points the controller at a place on the panel, in m from its middle, which is 0.75 m in front of the head and 2 cm below it.
point() { echo "hand right aim $1 $(awk -v y="$2" 'BEGIN { print 1.63 + y }') 0 0 0 0 1" > commands; sleep 0.5; }
trigger() { echo "hand right trigger $1" > commands; sleep 0.5; }
touch_panel() { point "$1" "$2"; trigger 1; trigger 0; rm commands; }
# The button of a page in the headset. Presses until the log has the pattern.
presses_start() {
    logged "$1" && return
    touch_panel 0.263 -0.144
    local i
    for ((i = 0; i < 20; i++)); do logged "$1" && return; sleep 0.25; done
    return 1
}
# The same in the window, which shows the panel of the walls.
clicks_start() {
    logged "$1" && return
    click 546 331
    sleep 1
    logged "$1"
}
leads_to() {  # leads_to CONDITION...: presses "next" until the condition holds
    "$@" && return
    next_page
    sleep 1
    "$@"
}

# The first lesson is in the window, where the headset shows nothing.
begin three
check 'the lesson in the window begins' eventually started
press Escape
check 'and is ended' eventually end_in_window
check 'the headset was not used' test "$(grep -c 'headset:' log)" = 0
check 'a break follows' eventually due break-1
check 'the participant puts the headset on' eventually leads_to shown 'in the headset'
check 'the headset is found' logged 'headset: Mock headset with Mock runtime'
forget
check 'the lesson in the headset begins' eventually presses_start '^lesson begun'

# Killed in the headset; the lesson is continued there, after the participant has put it on again.
sleep 2
stop KILL
lead three --participant P01
check 'again the headset is put on' eventually leads_to shown 'in the headset'
check 'the lesson continues in the headset' eventually presses_start '^lesson continued'
sleep 1
press Escape
sleep 1
end_in_headset() {
    logged '^lesson ended' && return
    touch_panel 0 -0.147
    logged '^lesson ended'
}
check 'the participant ends it' eventually end_in_headset
check 'the next break is due' eventually due break-2
# The page asks to take the headset off. The runtime senses it, and the window shows the next page.
sleep 2
echo 'event not_worn' > commands
check 'without the headset the study goes on in the window' eventually shown 'in the window'
rm commands
forget
check 'the participant goes to the walls' eventually leads_to shown 'on the walls'
wall() { xdotool search --name '^Boltwright: front$' > /dev/null 2>&1; }
check 'whose window opens' eventually wall
check 'the lesson on the walls begins' eventually clicks_start '^lesson begun'
sleep 1
press Escape
end_button=(379 387)  # below the buttons that place the workpiece in the room
check 'and is ended' eventually end_in_window
forget
check 'the comment is at the desk' eventually clicks_start "^the study is shown in the window"
check 'where the walls are closed' bash -c '! xdotool search --name "^Boltwright: front$" > /dev/null 2>&1'
stop INT
check 'the runtime was used correctly' test "$(grep -c '^violation' report)" = 0
check 'the headset showed frames' grep -qE '^drawn [1-9]' report
expect 0 . "${study[@]}" results three
check 'the methods name the displays' grep -q 'The scene was shown in the window (screen), in a headset (headset) and on projection walls (walls)' three/results.html
for session in part-1-lesson-1 part-2-lesson-1-2 part-3-lesson-1; do
    expect 0 'all as they were recorded' "$bin/boltwright" replay $own/$session/session.boltwright
done
finish_checks
