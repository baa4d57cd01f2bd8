#!/usr/bin/env bash
# The file of projection walls, from the example to the tracker. displays.sh BIN SOURCES, on a screen of 1280x800 (with_screen.sh).
. "$(dirname "$0")/checks.sh"
run=("$bin/boltwright" displays)

# new: examples that check accepts, and no file is overwritten.
expect 2 'subcommand is required' "${run[@]}"
expect 2 'FILE is required' "${run[@]}" new
expect 0 'front +3.000x2.400 +0.0 +0.0 +1.50 +88x75 mono +1500x1200 +2.00x2.00 +1500x1200\+1500\+0' "${run[@]}" new cave.json --name 'Lab 2'
expect 2 'cave.json exists already; expected a new file, or --force' "${run[@]}" new cave.json
check 'it has the name' grep -q '"name": "Lab 2"' cave.json
check 'its schema exists' test -f "$(sed -n 's/.*"$schema": "\(.*\)",/\1/p' cave.json)"
expect 0 'left and front meet at 90.0 degrees, gap 0.0 mm' "${run[@]}" check cave.json --without-monitors
expect 0 'Lab 2' "${run[@]}" check cave.json --without-monitors
for kind in wall cave desk; do
    for stereo in mono side_by_side top_bottom two_outputs; do
        expect 0 "$stereo" "${run[@]}" new cave.json --force --kind $kind --stereo $stereo
        expect 0 '^The file has no mistakes' "${run[@]}" check cave.json --without-monitors
    done
done
expect 2 'hall not in' "${run[@]}" new hall.json --kind hall
expect 1 'nowhere/cave.json' "${run[@]}" new nowhere/cave.json

# check: mistakes in the file are reported with its lines; walls that do not fit the monitors have another exit code.
"${run[@]}" new cave.json --force > /dev/null
expect 1 '^cave.json:[0-9]+:[0-9]+: wall "front": the window 1500x1200\+1500\+0 is not on the monitors; expected it within .* 1280x800\+0\+0' "${run[@]}" check cave.json
expect 1 'compared with the monitor of this computer' "${run[@]}" check cave.json
expect 0 'compared' "${run[@]}" check cave.json --rank 1
expect 0 'not compared with monitors: a window cannot be opened: there is no display' env -u DISPLAY "${run[@]}" check cave.json
change() { sed "$1" cave.json > "$2"; }
change 's/"eye_separation_m": 0.065/"eye_separation_m": 65/' eyes.json
expect 3 '^eyes.json:5:[0-9]+: /eye_separation_m: 65 is too large; expected a number >= 0 and <= 0.1' "${run[@]}" check eyes.json
change 's/"front"/"left"/' twice.json
expect 3 'twice.json:[0-9]+:[0-9]+: .*there is another wall "left"; expected a name of its own; the first is in line' "${run[@]}" check twice.json
change 's/"lower_left_m": \[-1.5, 0.0, -1.5\]/"lower_left_m": [-1.5, 0.3, -1.5]/' shape.json
expect 3 '^shape.json:[0-9]+:5: wall "front": its angle at the lower right corner is 84.29 degrees; expected 90' "${run[@]}" check shape.json --without-monitors
change '/"name": "left"/,/stereo/{s/\[-1.5,/[-1.3,/; s/-1.5\]/-1.7]/}' crossed.json
expect 3 '^crossed.json:[0-9]+:5: walls "left" and "front" cross; expected walls that meet at their edges' "${run[@]}" check crossed.json --without-monitors
expect 3 'The file has mistakes that prevent its use' "${run[@]}" check crossed.json --without-monitors
expect 3 'nowhere.json: ' "${run[@]}" check nowhere.json
change 's/"tracker": "dtrack"/"tracker": "file", "recording": "walk.csv"/' recorded.json
expect 3 'walk.csv' "${run[@]}" check recorded.json --without-monitors
"${run[@]}" check shape.json --without-monitors > out 2> err
check 'mistakes are on the standard error output' grep -q 'its angle' err
check 'and only there' bash -c '! grep -q "its angle" out'

# import: a cave of ParaView.
cat > cave.pvx <<'END'
<?xml version="1.0" ?>
<pvx>
  <Process Type="server">
    <EyeSeparation Value="6.5"/>
    <Machine Name="left" Environment="DISPLAY=:0" Geometry="640x480+0+0"
             LowerLeft="-100 0 100" LowerRight="-100 0 -100" UpperRight="-100 150 -100"/>
    <Machine Name="front" Environment="DISPLAY=:0" Geometry="640x480+640+0"
             LowerLeft="-100 0 -100" LowerRight="100 0 -100" UpperRight="100 150 -100" StereoType="Anaglyph"/>
  </Process>
</pvx>
END
expect 3 'cave.pvx:4:20: the eye separation cannot be "6.5"' "${run[@]}" import cave.pvx lab.json
check 'no file is written' test ! -e lab.json
expect 0 'cave.pvx:7:6: warning: the file does not have the viewer|cave.pvx:8:.*warning: the StereoType "Anaglyph" has no counterpart: the wall is mono' "${run[@]}" import cave.pvx lab.json --scale 0.01 --name Lab
expect 2 'lab.json exists already' "${run[@]}" import cave.pvx lab.json --scale 0.01
expect 0 'front +2.000x1.500' "${run[@]}" check lab.json
sed 's/-100 0 /-100 -100 /g; s/100 0 /100 -100 /g; s/150/100/g' cave.pvx > eyes.pvx
expect 0 'eyes.json:[0-9]+:5: warning: wall "front": its lowest corner is 1.00 m below the floor' "${run[@]}" import eyes.pvx eyes.json --scale 0.01 --force
expect 0 'warning: the fixed head, 1.60 m high, is above all walls, which end at 1.00 m; .* --eye-height' "${run[@]}" check eyes.json --without-monitors
expect 0 'fixed head at 0.00, 1.25, 0.00 m' "${run[@]}" import eyes.pvx eyes.json --scale 0.01 --force --eye-height 1.25
check 'walls at the height of the eyes are neither too low nor too high' bash -c "! $bin/boltwright displays check eyes.json --without-monitors 2>&1 | grep -qE 'below the floor|above all walls|dmm'"
sed 's/-100 150 -100/-100 150 -90/' cave.pvx > bent.pvx
expect 3 'bent.json:[0-9]+:5: wall "left": its angle' "${run[@]}" import bent.pvx bent.json --scale 0.01
check 'it can be corrected' test -s bent.json
expect 3 'not XML' "${run[@]}" import cave.json lab.json --force
expect 2 'PVX is required|FILE is required' "${run[@]}" import cave.pvx
expect 3 'none.pvx' "${run[@]}" import none.pvx lab.json --force

# track: a recorded walk, packets of DTrack, and no packets.
printf 't_s,x_m,y_m,z_m,qw,qx,qy,qz\n' > walk.csv
for i in $(seq 0 99); do echo "$i,0.25,1.5,0.5,1,0,0,0"; done | sed -E 's/^([0-9]+)/\1e-2/' >> walk.csv
expect 0 'tracked +x +0.250  y +1.500  z +0.500 m' "${run[@]}" track recorded.json --seconds 0.7
n=0
port=$((20000 + $$ % 20000))
change "s/\"port\": 5000/\"port\": $port/; s/\"body\": 0/\"body\": 3/" dtrack.json
expect 1 "No packet has arrived at UDP port $port" "${run[@]}" track dtrack.json --seconds 0.3
flystick=  # the line of a flystick in each packet
send() {  # send BODY: a packet every 50 ms, each in one write
    while sleep 0.05; do
        printf "fr $((++n))\r\n6d 1 [$1 1.0][100 1700 200 0 0 0][1 0 0 0 1 0 0 0 1]\r\n$flystick\r\n" > packet
        cat packet > "/dev/udp/127.0.0.1/$port"
    done 2> /dev/null
}
send 3 & player=$!
expect 0 'tracked +x +0.100  y +1.700  z +0.200 m +looks +0 degrees to the right, +0 up$' "${run[@]}" track dtrack.json --seconds 4
kill $player; wait $player 2> /dev/null
change "s/\"port\": 5000/\"port\": $port/; s/\"body\": 0/\"body\": 3, \"flystick\": {\"id\": 0, \"select\": 2, \"menu\": 1}/" wand.json
expect 1 'flystick sends nothing' "${run[@]}" track wand.json --seconds 0.2
flystick='6df2 1 1 [0 1.0 4 2][300 1100 -200 ][0 0 -1 0 1 0 1 0 0][6 0.0 0.0]'
send 3 & player=$!
expect 0 'flystick x +0.300  y +1.100  z -0.200 m +points +-90 degrees to the right, +0 up +pressed: select, tool' "${run[@]}" track wand.json --seconds 4
kill $player; wait $player 2> /dev/null
flystick=
change 's/"tracker": "dtrack"/"tracker": "openxr", "flystick": {"id": 0}/' nowand.json
expect 3 'nowand.json:[0-9]+:[0-9]+: /head/flystick: the tracker "openxr" has no flystick; expected the tracker "dtrack"' "${run[@]}" track nowand.json
change 's/"body": 0/"body": 0, "flystick": {"select": 2, "menu": 2}/' twice.json
expect 3 'twice.json:[0-9]+:[0-9]+: /head/flystick: a button has two functions; expected' "${run[@]}" track twice.json
change "s/\"port\": 5000/\"port\": $port/; s/\"axes\": .*/\"axes\": [\"+x\", \"+z\", \"-y\"],/" turned.json
send 0 & player=$!
expect 0 'tracked +x +0.100  y +0.200  z -1.700 m .* behind front' "${run[@]}" track turned.json --seconds 4
kill $player; wait $player 2> /dev/null
send 4 & player=$!
expect 1 'Body 3 is not seen; DTrack sees 4' "${run[@]}" track dtrack.json --seconds 2
kill $player; wait $player 2> /dev/null
player=
expect 2 'the tracker of lab.json is "fixed"; expected "dtrack", "openxr" or "file"' "${run[@]}" track lab.json
# The mock runtime has a headset at rest, and a controller in no hand.
change 's/"tracker": "dtrack"/"tracker": "openxr", "pose": "headset"/' headset.json
export XR_RUNTIME_JSON=${bin%/bin}/mock_openxr/mock_openxr.json
expect 0 'tracked +x +0.000  y +1.600  z +0.000 m +looks +0 degrees' "${run[@]}" track headset.json --seconds 1
change 's/"tracker": "dtrack"/"tracker": "openxr", "pose": "left_foot"/' foot.json
expect 3 'foot.json:[0-9]+:[0-9]+: /head/pose: .*left_foot.*; expected' "${run[@]}" track foot.json
XR_RUNTIME_JSON=/nowhere.json expect 4 'no OpenXR runtime' "${run[@]}" track headset.json
unset XR_RUNTIME_JSON

# The manual page has the commands and their options.
"$bin/boltwright" --man-page > page
check 'the manual page has the command' grep -q 'boltwright displays import' page
check 'and its options' grep -q 'without.*monitors' page
finish_checks
