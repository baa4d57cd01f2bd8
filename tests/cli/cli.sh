#!/usr/bin/env bash
# The command lines of the programs: options, exit codes, messages, files. $1: folder of the programs, $2: sources.
. "$(dirname "$0")/checks.sh"

# bolt-author.
expect 0 '"preload_kN":80\.8' "$bin/bolt-author" torque --size M16 --class 8.8 --mu 0.12 --json
expect 0 '"preload_kN":87\.5' "$bin/bolt-author" torque --size M16 --pitch 1.5 --class 8.8 --mu 0.12 --json
expect 0 'torque_Nm 205\.8' "$bin/bolt-author" torque --size M16 --class 8.8 --mu 0.12
expect 0 '^torque_wrench_set_to_Nm 179\.0$' "$bin/bolt-author" torque --size M16 --class 8.8 --mu 0.12 --lever 400 --adaptor 60
expect 0 '^torque_wrench_set_to_Nm 205\.8$' "$bin/bolt-author" torque --size M16 --class 8.8 --mu 0.12 --lever 400 --adaptor 60 --adaptor-angle 90
expect 2 'lever' "$bin/bolt-author" torque --size M16 --class 8.8 --adaptor 60
expect 2 'did you mean "M16"' "$bin/bolt-author" torque --size N16 --class 8.8
expect 2 'did you mean "8.8"' "$bin/bolt-author" torque --size M16 --class 88
expect 2 '' "$bin/bolt-author" torque --size M16 --class 8.8 --mu -1
expect 0 '^engagement_needed_vdi_mm 14\.4$' "$bin/bolt-author" torque --size M12 --class 10.9 --head socket --tapped GJL-250
expect 0 '^strips_at_kN 159\.8$' "$bin/bolt-author" torque --size M12 --class 10.9 --tapped GJL-250 --engagement 20
expect 0 '^prevailing_fifth_off_least_Nm 3\.00$' "$bin/bolt-author" torque --size M16 --class 8.8 --locking
expect 2 'did you mean "GJL-250"' "$bin/bolt-author" torque --size M12 --class 8.8 --tapped GJL250
expect 2 'no socket head of M4' "$bin/bolt-author" torque --size M4 --class 8.8 --head socket
expect 2 '' "$bin/bolt-author"
expect 0 'boltwright|bolt-author' "$bin/bolt-author" --version

expect 0 '^$' "$bin/bolt-author" curve zq350 --joint B1 --law published --csv published.csv
check "the published curve begins with its header and -0.5761 N mm" \
    bash -c '[[ $(head -1 published.csv) == angle_deg,stage,torque_Nm,clamp_N && $(sed -n 2p published.csv) == 0.0000,navigation,-0.00057612* ]]'
check "... and ends at 72.126 N m" bash -c 'tail -1 published.csv | grep -q ",yield,72\.12"'
check "... with 14.354 N m per degree in the linear stage" awk -F, '
    $2 == "linearity" { if (n++) { s = ($3 - t) / ($1 - a); if (s < 14.352 || s > 14.356) bad = 1 } a = $1; t = $3 }
    END { exit !(n > 100 && !bad) }' published.csv
expect 0 'angle_deg,stage' "$bin/bolt-author" curve zq350 --joint F1 --direction loosen --csv -
expect 2 'did you mean B1' "$bin/bolt-author" curve zq350 --joint b1 --csv -
expect 2 'nothing to write' "$bin/bolt-author" curve zq350 --joint B1 --direction loosen
expect 1 'cannot be written' "$bin/bolt-author" curve zq350 --joint B1 --csv none/there.csv
expect 1 'cannot be written' bash -c "'$bin/bolt-author' curve zq350 --joint B1 --csv - > /dev/full"
expect 0 '^$' "$bin/bolt-author" curve zq350 --joint F1 --svg torque-angle.svg
check "the picture in README equals the program's output" cmp torque-angle.svg "$sources/docs/torque-angle.svg"

reducer=(zq350)
quick=()
if sanitized; then
    skip_part "the reducer, and contacts with the torque wrench: take minutes under a sanitizer"
    reducer=()
    quick=(--no-obstacles)
fi
expect 0 'no mistakes' "$bin/bolt-author" validate "${reducer[@]}" cover-m8
expect 0 'variant stainless' "$bin/bolt-author" validate zq350 --variant stainless
expect 3 'did you mean|nearest' "$bin/bolt-author" validate zq35
expect 3 '' "$bin/bolt-author" validate /dev/null

# A new assembly, a mistake in it, and a lesson on it.
expect 0 'assembly.json' "$bin/bolt-author" new pump-cover
expect 0 'no mistakes' "$bin/bolt-author" validate pump-cover
expect 2 "not empty" "$bin/bolt-author" new pump-cover
cp -r pump-cover socket
sed -i 's/"size": "M8",/&\n      "head": "socket", "turned": "head",/' socket/assembly.json
expect 0 'angle_deg,stage' "$bin/bolt-author" curve socket --joint B1 --csv -
expect 3 'joint B1 has a socket head, which the tool "wrench" cannot turn; expected a hex_key of 6 mm, or a ratchet with a hex_bit' \
    "$bin/boltwright" train socket --headless --out socket-lesson
mkdir broken && sed 's/"friction_thread": *[0-9.]*/"frction_thread": 0.12/; s/"size": *"M8"/"size": "N8"/' \
    pump-cover/assembly.json > broken/assembly.json
expect 3 'broken/assembly.json:[0-9]+:[0-9]+: .*friction_thread' "$bin/bolt-author" validate broken
expect 3 'broken/assembly.json:[0-9]+:[0-9]+: .*M8' "$bin/bolt-author" validate broken
expect 3 'friction_thread' "$bin/boltwright" train --no-pictures broken --headless --out "$work/never"
check "bad content leaves no folder behind" test ! -e never
expect 0 'score' "$bin/boltwright" train --no-pictures pump-cover --no-obstacles --headless --quiet --out pump
# The lesson has one bolt, tightened once, because lessons with obstacles take long.
cp -r pump-cover one
sed -i '/"id": "B[234]"/d; s/\(.*"id": "B1".*\),$/\1/; s/"order": .*/"order": ["B1"],/; /"percent": 50/d; /recheck/d
    s/\("percent": 100 }\),/\1/' one/assembly.json
expect 0 '1 joints, 2 passes.*no mistakes' "$bin/bolt-author" validate one

# A lesson, its files, and the commands that read them.
expect 0 'score [0-9.]+ of 100' "$bin/boltwright" train --no-pictures --headless --no-obstacles --operator novice --seed 4 --out a
for file in session.boltwright summary.json report.html; do check "train leaves $file" test -s "a/$file"; done
expect 0 '"operator": "novice"' cat a/summary.json
expect 0 'simulated trainee plays' "$bin/boltwright" train --no-pictures cover-m8 --no-obstacles --out window
expect 0 'score' "$bin/boltwright" train --no-pictures --headless --no-obstacles --quiet --operator novice --seed 4 --out b
check "the same seed gives the same summary" cmp a/summary.json b/summary.json
check "the same seed gives the same session, byte by byte, as CSV" bash -c "
    '$bin/boltwright' export a/session.boltwright --csv - | sha256sum > a.sum &&
    '$bin/boltwright' export b/session.boltwright --csv - | sha256sum > b.sum && cmp a.sum b.sum"
expect 0 'report2.html' "$bin/boltwright" report a/session.boltwright b/session.boltwright --html report2.html
check "two sessions make one page" grep -q '<html' report2.html
expect 0 'study.html' env BIN="$bin" SEEDS=1 TRAINEES=clumsy JOBS=1 bash "$sources/tools/study.sh" study one
check "a study compares, and states that the trainees are simulated" bash -c "grep -q 'With and without guiding' study/study.html && grep -q 'are simulated' study/study.html"
expect 0 '' "$bin/boltwright" export a/session.boltwright --csv ticks.csv
check "the CSV has a header and a row per tick" bash -c '[[ $(wc -l < ticks.csv) -gt 300000 ]] && head -1 ticks.csv | grep -q wrench_torque_Nm'
expect 1 'full|written' bash -c "'$bin/boltwright' export a/session.boltwright --csv - > /dev/full"

# Loosening, compared with measured data.
expect 0 'score' "$bin/boltwright" train --no-pictures cover-m8 --no-obstacles --headless --quiet --task loosen --out loose

# A bolt whose head only a second wrench holds.
cp -r "$sources/content/assemblies/cover-m8" held
sed -i '0,/"class": "8.8",/s//& "counter_hold": "second_wrench",/' held/assembly.json
expect 0 'score 100' "$bin/boltwright" train --no-pictures held --no-obstacles --headless --quiet --out holds
expect 0 'times nut and bolt turned together' "$bin/boltwright" train --no-pictures held --no-obstacles --headless --operator clumsy --out forgets
expect 0 'all as they were recorded' "$bin/boltwright" replay forgets/session.boltwright

# The choice of the tool is judged.
expect 0 'torque wrench was used for loosening' "$bin/boltwright" train --no-pictures cover-m8 --no-obstacles --headless --task loosen --tool torque_wrench --out clicks
cp -r "$sources/content/assemblies/cover-m8" weak
sed -i 's/"more_tools": {/& "ring": { "kind": "ring_wrench", "size_mm": 13, "handle_length_mm": 170 },/; s/"class": "8.8"/"class": "12.9"/; s/"friction_\(thread\|bearing\)": 0.12/"friction_\1": 0.3/; s/"target_torque_Nm": 20/"target_torque_Nm": 62/' weak/assembly.json
expect 0 'the chosen tool is too weak' "$bin/boltwright" train --no-pictures weak --no-obstacles --headless --out is_weak
expect 0 'score 100' "$bin/boltwright" train --no-pictures weak --no-obstacles --headless --tool ring --out is_strong

# A torque wrench with an adaptor: the scale is set lower, so the joints get their torque.
cp -r "$sources/content/assemblies/cover-m8" longer
sed -i '/"kind": "click_torque_wrench"/,/"model"/{s/"handle_length_mm": 140,/"handle_length_mm": 240, "adaptor_mm": 60/;/"model"/d}' longer/assembly.json
expect 0 'adaptor in line 60 mm' "$bin/bolt-author" validate longer
expect 0 'score 100' "$bin/boltwright" train --no-pictures longer --headless --quiet --tool torque_wrench --out lengthened

# Contacts are simulated if the assembly has contact models, and the files record this. Two runs are equal byte for byte.
expect 0 'score 100' "$bin/boltwright" train --no-pictures one --headless --quiet --out solid
expect 0 '"obstacles": true' cat solid/summary.json
expect 0 'score 100' "$bin/boltwright" train --no-pictures one --headless --quiet --out solid2
check "the same seed gives the same session among obstacles" bash -c "
    '$bin/boltwright' export solid/session.boltwright --csv - | sha256sum > s.sum &&
    '$bin/boltwright' export solid2/session.boltwright --csv - | sha256sum > s2.sum && cmp s.sum s2.sum"
check "the touched obstacle is named" bash -c "'$bin/boltwright' export solid/session.boltwright --csv - | grep -c ',B1_washer_nut,none' >/dev/null"
expect 0 '"obstacles": false' cat a/summary.json
expect 0 '"guide": true' cat a/summary.json

# Replays: verified bit for bit, as a picture, as a film; changes since the recording are detected.
expect 0 'all as they were recorded' "$bin/boltwright" replay solid/session.boltwright
film=(env ASAN_OPTIONS=detect_leaks=0 "$bin/boltwright" replay)  # Vulkan drivers leak memory
expect 0 'now.png' "${film[@]}" solid/session.boltwright --at 8 --png now.png --size 160x90 --validate
expect 0 'both.png' "${film[@]}" solid/session.boltwright --at 8 --png both.png --size 160x90 --stereo --validate
check "both eyes are side by side: 320 wide" bash -c '[[ $(od -An -tu1 -j16 -N4 both.png) =~ ^\ +0\ +0\ +1\ +64$ ]]'
check "the picture exists" test -s now.png
expect 0 'film.mp4: 3 pictures, with sound' "${film[@]}" solid/session.boltwright --from 2 --until 2.25 --rate 10 --video film.mp4 --size 64x36
check "the film exists" test -s film.mp4
check "the temporary files of the film are removed" bash -c '! ls film.*.mp4 film.*.wav'
expect 0 'film.wav' "${film[@]}" solid/session.boltwright --from 4 --until 6 --rate 30 --video film.mp4 --wav film.wav --size 64x36
lasts() { ffprobe -v error -select_streams "$1" -show_entries stream=duration -of csv=p=0 "$2"; }
check "pictures and sound last as long as the lesson did" awk -v v="$(lasts v film.mp4)" -v a="$(lasts a film.mp4)" \
    'BEGIN { exit !(v > 1.99 && v < 2.05 && a > 1.99 && a < 2.05) }'
expect 0 'part.wav' "$bin/boltwright" replay solid/session.boltwright --from 4 --until 6 --wav part.wav
check "--wav writes the same sound with and without a film" cmp film.wav part.wav
check "... and it is not silent" bash -c "ffmpeg -nostdin -i part.wav -af volumedetect -f null - 2>&1 | grep -E 'max_volume: -[0-4]?[0-9]\.'"
expect 0 'silent.mp4: 3 pictures$' "${film[@]}" solid/session.boltwright --silent --from 2 --until 2.25 --rate 10 --video silent.mp4 --size 64x36
check "a silent film has no sound" test -z "$(lasts a silent.mp4)"
expect 2 'wav' "$bin/boltwright" replay solid/session.boltwright --from 4
expect 2 'no view' "$bin/boltwright" replay solid/session.boltwright --at 8 --png now.png --view nowhere
expect 1 'FFmpeg' env PATH=/nonexistent "$bin/boltwright" replay solid/session.boltwright --video no.mp4 --size 64x36
expect 3 'format 2' "$bin/boltwright" replay "$sources/tests/data/format-1.boltwright"
expect 2 '' "$bin/boltwright" replay solid/session.boltwright --at 8

# A torque wrench instead of the default tool: it is recorded in the session and in the files made from it.
expect 0 'score' "$bin/boltwright" train --no-pictures cover-m8 --tool torque_wrench "${quick[@]}" --headless --quiet --out click
expect 0 '"tool": "torque_wrench"' cat click/summary.json
check "the report names the tool" grep -q 'torque_wrench' click/report.html
expect 0 'all as they were recorded' "$bin/boltwright" replay click/session.boltwright
expect 3 'did you mean "torque_wrench"' "$bin/boltwright" train cover-m8 --tool torque_wrnch --headless --out never
expect 0 'score' "$bin/boltwright" train --no-pictures cover-m8 --headless --quiet --no-obstacles --no-guide --out alone
expect 0 '"guide": false' cat alone/summary.json
bare="$sources/tests/data/cover.json"
expect 0 'has no contact model' "$bin/boltwright" train --no-pictures "$bare" --headless --out bare
expect 3 'contact model' "$bin/boltwright" train --no-pictures "$bare" --headless --quiet --obstacles --out bare
expect 2 'obstacles' "$bin/boltwright" train cover-m8 --headless --obstacles --no-obstacles --out never
expect 0 '' "$bin/boltwright" export "$sources/tests/data/format-1.boltwright" --csv old.csv
expect 0 'old.html' "$bin/boltwright" report "$sources/tests/data/format-1.boltwright" --html old.html
expect 0 'Al Assadi' "$bin/boltwright" compare loose/session.boltwright "$sources/tests/data/m8_releasable.csv" --html m8.html
expect 0 'MAPE' "$bin/boltwright" compare loose/session.boltwright "$sources/tests/data/m8_releasable.csv" --html m8.html
check "compare names the source on the page" grep -q 'Al Assadi' m8.html
expect 0 'MAPE' bash -c "'$bin/bolt-author' curve zq350 --joint F1 --csv m.csv && '$bin/boltwright' compare a/session.boltwright m.csv --joint F1 --html m.html"
expect 1 'm8_releasable|loosen' "$bin/boltwright" compare a/session.boltwright "$sources/tests/data/m8_releasable.csv"
printf 'angle,torque\n1,2\n' > wrong.csv
expect 3 'wrong.csv:1' "$bin/boltwright" compare a/session.boltwright wrong.csv

expect 2 'is also the input' "$bin/boltwright" report a/session.boltwright --html a/session.boltwright
expect 2 'is also the input' "$bin/boltwright" export a/session.boltwright --csv ./a/session.boltwright
expect 0 'b/session' "$bin/boltwright" report a/session.boltwright --html b/session.html
expect 2 'whole number' "$bin/boltwright" train --no-pictures --seed -1
expect 2 'whole number' "$bin/boltwright" train --no-pictures --seed 18446744073709551616
expect 1 'standard output' bash -c "'$bin/bolt-author' torque --size M16 --class 8.8 > /dev/full"
expect 1 'standard output' bash -c "'$bin/bolt-author' validate pump-cover > /dev/full"
expect 1 'standard output' bash -c "'$bin/boltwright' train --no-pictures cover-m8 --no-obstacles --headless --quiet --out full > /dev/full"
mkfifo pipe && (cat pipe > piped.html &) && expect 0 '' "$bin/boltwright" report a/session.boltwright --html pipe
check "a pipe stays a pipe" test -p pipe

# `locking` has locking nuts, which are run down with the wrench; `plain` has no model.
cp -r pump-cover plain
sed -i '/^  "\(model\|model_far\|contact_model\)": /d; s/"node": "[^"]*", //' plain/assembly.json
cp -r pump-cover locking
sed -i 's/"lubrication": "oiled"/"lubrication": "oiled", "prevailing_torque_Nm": 4/' locking/assembly.json
expect 0 'score' "$bin/boltwright" train --no-pictures locking --no-obstacles --headless --quiet --out locked

# Pictures without a display, under validation: any message of the layers is an error. Leaks of drivers are ignored.
draw=(env ASAN_OPTIONS=detect_leaks=0 "$bin/boltwright")
expect 0 ': used' "${draw[@]}" doctor --seconds 0
# The timing of this machine is not tested. The test requires that too few ticks are reported as such.
expect 0 'at 4000 ticks a second this machine is NOT good enough' bash -c "$(printf '%q ' "${draw[@]}") doctor --seconds 0.05 | tee host.txt"
check "too few ticks are reported" grep -qE 'only [0-9]+ ticks were timed' host.txt
expect 2 '' "${draw[@]}" doctor --seconds -1
expect 0 '^Devices: [0-9]+, [0-9]+ serial port' "${draw[@]}" doctor --seconds 0
expect 0 'its button is held' "$bin/boltwright" doctor --help

# The trial of a station: errors before it begins.
expect 4 'no device 256f:0000; expected one that .boltwright devices. lists' "$bin/boltwright" doctor --device 256f:0000
expect 4 'not a serial port' "$bin/boltwright" doctor cover-m8 --glove /dev/null
expect 4 'is the device.s adapter plugged in' "$bin/boltwright" doctor cover-m8 --glove /dev/ttyNONE
echo '{"format": "boltwright rig 1", "most_torque_Nm": 400}' > rig.json
expect 3 '^rig.json:1:[0-9]+: ' "$bin/boltwright" doctor --device 256f:0000 --rig rig.json
expect 3 'there is no such folder, file or assembly' "$bin/boltwright" doctor nowhere --device 256f:0000
expect 2 'requires --device' "$bin/boltwright" doctor --rig rig.json
expect 2 'requires --glove' "$bin/boltwright" doctor --trainee Ada

# Devices: none connected, an emulated glove, missing permission, a port without a glove.
expect 0 'Serial ports for a CyberGlove' "$bin/boltwright" devices
expect 4 'there is no device 256f:0000; expected one that' "$bin/boltwright" devices --device 256f:0000
expect 4 'is the device.s adapter plugged in' "$bin/boltwright" devices --glove /dev/ttyNONE
expect 4 'not a serial port' "$bin/boltwright" devices --glove /dev/null
expect 2 '' "$bin/boltwright" devices --seconds -1
glove() {  # starts an emulated glove with these options on ./port
    "$bin/bolt-emulate" glove "$@" --link "$work/port" > /dev/null &
    emulated=$!
    for _ in $(seq 600); do [[ -L port ]] && return; sleep 0.1; done
}
glove --sensors 22 --left
expect 0 'left hand, 22 sensors' "$bin/boltwright" devices --glove port --seconds 0.2
nobody=(setpriv --reuid=65534 --regid=65534 --clear-groups)
if [[ $(id -u) -eq 0 ]] && "${nobody[@]}" "$bin/boltwright" --version > /dev/null 2>&1; then
    tty=$(readlink port)
    chgrp dialout "$tty" && chmod 660 "$tty"
    expect 4 'Permission denied; expected a user in the group dialout: sudo usermod' "${nobody[@]}" "$bin/boltwright" devices --glove "$tty"
    expect 4 'Permission denied; expected a user in the group dialout' "${nobody[@]}" "$bin/boltwright" doctor cover-m8 --glove "$tty"
else
    skip_part "a port without permission: expected to run as root, with setpriv"
fi
kill $emulated && wait $emulated
expect 4 'plugged in' "$bin/boltwright" devices --glove port
expect 2 '18' "$bin/bolt-emulate" glove --sensors 20
expect 0 'seen/view-top.png' "${draw[@]}" train cover-m8 --no-obstacles --headless --quiet --out seen
check "train draws every view" test -s seen/view-front.png
expect 0 'score' env VK_ICD_FILENAMES=/nonexistent.json VK_DRIVER_FILES=/nonexistent.json \
    "${draw[@]}" train cover-m8 --no-obstacles --headless --quiet --out unseen
check "without a GPU all other files are written" test -s unseen/report.html
expect 0 'none: .*there is no display.*DISPLAY' env -u DISPLAY -u WAYLAND_DISPLAY "${draw[@]}" doctor --seconds 0
expect 0 'pictures/cover-front.png' "${draw[@]}" render cover-m8 --view top --view front --size 96x64 --validate \
    --png pictures/cover.png
check "there is a picture for each view" test -s pictures/cover-top.png -a -s pictures/cover-front.png
expect 0 'both.png' "${draw[@]}" render "$sources/content/tools/wrench-13.glb" --stereo --size 48x48 --frames 2 \
    --timings times.json --validate --png both.png
check "--timings has an entry for each of the two frames" test "$(grep -c '"ms"' times.json)" -eq 2
expect 0 'same.png' "${draw[@]}" render cover-m8 --view top --size 96x64 --png same.png
check "a picture drawn again is the same" cmp same.png pictures/cover-top.png
expect 0 'marked.png' "${draw[@]}" render cover-m8 --view top --inset front --labels --size 96x64 --validate \
    --timings marked.json --png marked.png
expect 0 'alone.png' "${draw[@]}" render cover-m8 --view top --size 96x64 --timings alone.json --png alone.png
draws_of() { sed -n 's/^ "draws": \([0-9]*\),$/\1/p' "$1"; }
check "--timings counts the view and its inset" test "$(draws_of marked.json)" -gt "$(draws_of alone.json)"
check "an inset and labels change the picture" bash -c '! cmp -s marked.png same.png'
expect 2 '"front"' "${draw[@]}" render cover-m8 --view top --inset frontt --png never.png
expect 2 'no joints' "${draw[@]}" render "$sources/content/tools/wrench-13.glb" --labels --png never.png
expect 0 'best.png' "${draw[@]}" render cover-m8 --joint B3 --size 96x64 --png best.png
check "--joint selects the view that shows its nut best" cmp best.png pictures/cover-front.png
expect 2 'no joint "B9"' "${draw[@]}" render cover-m8 --joint B9 --png never.png
expect 0 '^B3 .* front$' "$bin/bolt-author" views cover-m8
sanitized || expect 0 '^B3 +0 % .* back$' "$bin/bolt-author" views zq350
expect 0 '"best": "front"' "$bin/bolt-author" views cover-m8 --json
expect 3 '' "$bin/bolt-author" views /dev/null
expect 1 'fonts-dejavu-core' env BOLTWRIGHT_FONTS=/nowhere "${draw[@]}" render cover-m8 --view top --labels --size 8x8 --png never.png
posed="$sources/tests/fuzz/gltf/everything.gltf"
expect 0 'posed.png' "${draw[@]}" render "$posed" --animation wave --at 0.4 --size 64x48 --validate --png posed.png
expect 0 'first.png' "${draw[@]}" render "$posed" --animation 0 --size 64x48 --png first.png
check "another time of the animation gives another picture" test -n "$(cmp posed.png first.png)"
expect 0 'again.png' "${draw[@]}" render "$posed" --animation 0 --at 0.4 --size 64x48 --png again.png
check "an animation is the same by name and by index" cmp posed.png again.png
expect 2 '"wave"' "${draw[@]}" render "$posed" --animation wav --png never.png
expect 2 'index from 0 to 0' "${draw[@]}" render "$posed" --animation 1 --png never.png
expect 2 'has animations' "${draw[@]}" render cover-m8 --view top --animation wave --png never.png
expect 2 'animation' "${draw[@]}" render "$posed" --at 1 --png never.png
expect 2 '"top"' "${draw[@]}" render cover-m8 --view topp --png never.png
expect 2 'not a size' "${draw[@]}" render cover-m8 --size 0x10 --png never.png
expect 2 'not a point' "${draw[@]}" render cover-m8 --eye 1,2 --png never.png
expect 2 'same point' "${draw[@]}" render cover-m8 --eye 1,2,3 --target 1,2,3 --png never.png
expect 2 'no named views' "${draw[@]}" render "$sources/content/tools/wrench-13.glb" --view top --png never.png
expect 3 'nowhere.glb' "${draw[@]}" render nowhere.glb --png never.png
expect 3 'names no model' "${draw[@]}" render plain --png never.png
expect 4 'does not match' "${draw[@]}" render cover-m8 --gpu voodoo --png never.png
expect 1 'null' "${draw[@]}" render cover-m8 --size 8x8 --png /dev/null/picture.png
check "no picture is written after an error" test ! -e never.png

# Errors and their exit codes.
expect 4 'there is no display' env -u DISPLAY -u WAYLAND_DISPLAY "$bin/boltwright"
expect 2 '' "$bin/boltwright" train --no-pictures --mode hard
expect 2 'did you mean expert' "$bin/boltwright" train --no-pictures --headless --operator exprt --out never
expect 2 'wears no headset' "$bin/boltwright" train --no-pictures --headless --hmd --out never
expect 4 'omega7' "$bin/boltwright" train --no-pictures --headless --device omega7 --out never
expect 4 'ttyS99' "$bin/boltwright" train --no-pictures --headless --glove /dev/ttyS99 --out never
expect 2 'cannot be combined' "$bin/boltwright" train --headless --device mouse --device 256f:c62e --out never
expect 1 'cannot be created|Not a directory' "$bin/boltwright" train --no-pictures --headless --quiet --out /dev/null/out
expect 1 'session' "$bin/boltwright" report ticks.csv --html never.html
expect 1 'nowhere' "$bin/boltwright" report nowhere --html never.html

# The calibration of a glove: the vendor's file is imported and stored under the trainee's code; errors have a position.
export XDG_DATA_HOME=$work/data
code_of() { grep -B1 "\"name\": \"$1\"" "$XDG_DATA_HOME/boltwright/people/names.json" | grep -oE 'T-[0-9A-Z]{6}'; }
expect 0 'Saved to gloves/T-[0-9A-Z]{6}.right.glove.json for Ada L. ' "$bin/boltwright" glove import "$sources/tests/fuzz/corpus/hand.cal" --trainee 'Ada L.' --sensors 22 --folder gloves
ada_l=$(code_of 'Ada L.')
check "the calibration is stored" test -s "gloves/$ada_l.right.glove.json"
check "... without the name" bash -c "! grep -rq Ada gloves"
head -8 "$sources/tests/fuzz/corpus/hand.cal" > short.cal
expect 3 '^(boltwright: |error: )?short.cal:[0-9]+' "$bin/boltwright" glove import short.cal --trainee Ada --folder gloves
sed 's/"gain": /"gian": /' "gloves/$ada_l.right.glove.json" > misspelt.json
expect 3 'misspelt.json:13:7: .*did you mean "gain"' "$bin/boltwright" glove show misspelt.json --port /dev/null
expect 4 'not a serial port' "$bin/boltwright" glove calibrate --trainee Ada --port /dev/null --folder gloves
expect 2 'trainee is required' "$bin/boltwright" glove calibrate --port /dev/null
# A simulated wearer of an emulated glove follows the prompts and is then measured.
mkfifo asked
"$bin/bolt-emulate" glove --postures --link "$work/worn" < asked > /dev/null &
emulated=$!
exec 4> asked
for _ in $(seq 600); do [[ -L worn ]] && break; sleep 0.1; done
"$bin/boltwright" glove calibrate --trainee Ada --port worn --folder gloves 2>&1 | tee calibrated | while read -r line; do
    case $line in 1/4*) echo flat ;; 2/4*) echo fist ;; 3/4*) echo spread ;; 4/4*) echo across ;; esac >&4
done
check "the quality of the calibration is printed" grep -qE '^Quality 0\.[5-9]' calibrated
echo fist >&4
expect 0 'middle  90 100  67' "$bin/boltwright" glove show "gloves/$(code_of Ada).right.glove.json" --port worn --seconds 3
expect 2 'for another glove' "$bin/boltwright" glove show "gloves/$ada_l.right.glove.json" --port worn
# The same gloved hand at a station, without a display and a GPU: it grasps the wrench; the glove is unplugged and plugged in again.
tried=(env -u DISPLAY VK_ICD_FILENAMES=/nonexistent.json VK_DRIVER_FILES=/nonexistent.json
    "$bin/boltwright" doctor cover-m8 --glove worn)
expect 3 'no calibration of Bob.s right hand.*boltwright glove calibrate --trainee "Bob"' "${tried[@]}" --trainee Bob --folder gloves
echo grip >&4
"${tried[@]}" --trainee Ada --folder gloves --seconds 3600 > tried 2>&1 &
doctor=$!
reports() { for _ in $(seq 1200); do grep -q "$1" tried && return; sleep 0.1; done; return 1; }
check "a station begins with a glove alone" reports 'For 3600 s'
check "... whose closed hand takes the wrench" reports 'the hand takes the wrench'
kill $emulated && wait $emulated
exec 4>&-
check "... an unplugged glove is reported with a remedy" reports 'worn.*is the device.s adapter plugged in'
sleep 0.5  # a problem that another message replaces within 0.3 s is dropped
"$bin/bolt-emulate" glove --postures --link "$work/worn" < asked > /dev/null &
emulated=$!
exec 4> asked
echo grip >&4
check "... its return is reported" reports 'resolved: .*adapter plugged in'
check "... the hand is reported to work again" reports 'resolved: The glove is lost'
kill -INT $doctor && wait $doctor
check "... and the trial fails" test $? -eq 1
check "the report describes the glove" grep -qE 'Glove on worn: CyberGlove, right hand, 18 sensors' tried
check "... its calibration" grep -qE "calibrated for Ada \\($(code_of Ada)\\) on 20[0-9-]+, quality 0\." tried
check "... the verdict" grep -qE 'not good enough, because' tried
check "... and the time of the disconnection" grep -qE 'adapter plugged in\? \(from [0-9.]+ to [0-9.]+ s\)' tried
kill $emulated && wait $emulated
exec 4>&-
expect 1 'cannot be' "$bin/boltwright" glove import "$sources/tests/fuzz/corpus/hand.cal" --trainee Ada --folder /dev/null/gloves

# A killed lesson: the recorded part can be reported, with a note that it was cut short.
for delay in 0.05 0.15 0.3; do
    rm -rf killed
    "$bin/boltwright" train --no-pictures --no-obstacles --headless --quiet --operator novice --out killed >/dev/null 2>&1 &
    victim=$!
    sleep "$delay"
    kill -9 $victim 2>/dev/null
    wait $victim 2>/dev/null
    if [[ -s killed/session.boltwright && ! -e killed/summary.json ]]; then
        expect 0 'cut short' "$bin/boltwright" report killed/session.boltwright --html killed.html
        check "the page of a killed lesson states that it was cut short" grep -qi 'cut short' killed.html
    fi
done

finish_checks
