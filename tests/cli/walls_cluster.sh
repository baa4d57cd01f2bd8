#!/usr/bin/env bash
# A cave of five walls that five processes show, started by mpirun on this computer: the pictures are those of one process, the
# processes present together, keys work in every window, and a lost process ends the others. walls_cluster.sh BIN SOURCES PICTURES, on
# a screen of 1280x800 (with_screen.sh); writes screenshots to the folder PICTURES.
. "$(dirname "$0")/checks.sh"
pictures=$3
mkdir -p "$pictures"
rm -f "$pictures"/*
[[ -e $bin/boltwright_mpi.so ]] || skip_all "boltwright was built without MPI"
command -v mpirun >/dev/null || skip_all "mpirun is not installed"
# Processes on one computer: as root, more of them than processors, and without reading each other's memory, which containers forbid.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_btl_vader_single_copy_mechanism=none OMPI_MCA_mpi_show_help=0
launch=(mpirun --oversubscribe --bind-to none)
"${launch[@]}" -n 2 true >/dev/null 2>&1 || skip_all "mpirun cannot start processes on this computer"
process=0
wall() {  # wall NAME LOWER_LEFT LOWER_RIGHT UPPER_RIGHT X Y
    echo "    { \"name\": \"$1\", \"lower_left_m\": [$2], \"lower_right_m\": [$3], \"upper_right_m\": [$4],"
    echo "      \"output\": { \"position_px\": [$5, $6], \"resolution_px\": [240, 192], \"rank\": $process } }${7:-}"
    process=$((process + 1))
}
{
    echo '{ "format": "boltwright displays 1", "head": { "tracker": "fixed", "fixed": { "position_m": [0.2, 1.65, 0.3] } }, "walls": ['
    wall left '-1.5, 0, 1.5' '-1.5, 0, -1.5' '-1.5, 2.4, -1.5' 300 192 ,
    wall front '-1.5, 0, -1.5' '1.5, 0, -1.5' '1.5, 2.4, -1.5' 540 192 ,
    wall right '1.5, 0, -1.5' '1.5, 0, 1.5' '1.5, 2.4, 1.5' 780 192 ,
    wall floor '-1.5, 0, 1.5' '1.5, 0, 1.5' '1.5, 0, -1.5' 540 384 ,
    wall ceiling '-1.5, 2.4, -1.5' '1.5, 2.4, -1.5' '1.5, 2.4, 1.5' 540 0
    echo ']}'
} > cave.json
sed 's/"rank": [0-9]/"rank": 0/' cave.json > alone.json
take() { "$bin/test_screenshot" "$@"; }
# Two pictures of all five walls, 3 s apart, are equal: nothing moves any more. They show something.
rests() {  # rests PICTURE
    take "$1" 300 0 720 576 && [[ $(stat -c %s "$1") -gt $least ]] && sleep 3 && take again.png 300 0 720 576 && cmp -s "$1" again.png
}
equals() { take "$2" 300 0 720 576 && cmp -s "$1" "$2"; }  # equals PICTURE NEW_PICTURE
least=20000
logged() { grep -q -- "$1" log; }
window() { xdotool search --name "^$1\$" 2>/dev/null | tail -1; }
opened() { [[ -n $(window "$1") ]]; }
press() { xdotool windowfocus "$(window "$1")" key --window "$(window "$1")" "$2" 2>/dev/null; }
ended() { ! kill -0 "$player" 2>/dev/null; }
# The process with number 0. An interrupted mpirun 5 does not show what its processes print afterwards.
first_process() {
    for pid in $(pgrep -f -- '--displays cave.json'); do
        grep -qsz '^OMPI_COMM_WORLD_RANK=0$' "/proc/$pid/environ" && echo "$pid" && return
    done
}
# run_walls COMMAND...: in the background, with its output in `log`.
run_walls() {
    : >log
    "$@" >log 2>&1 &
    player=$!
}
# In an assessment no hint changes the picture.
train=(train first-nut --mode assessment --silent --validate --size 280x180 --displays)

# The lesson's first picture, by one process and by five.
run_walls "$bin/boltwright" "${train[@]}" alone.json --start --out alone
check 'one process: the lesson begins' eventually logged 'lesson begun'
check 'one process: the walls show it' eventually rests "$pictures/lesson-one.png"
kill -INT $player
check 'one process: it ends' wait $player
player=
run_walls "${launch[@]}" -n 5 "$bin/boltwright" "${train[@]}" cave.json --start --out five
check 'five processes: the lesson begins' eventually logged 'lesson begun'
check 'five processes show the same pixels as one' eventually equals "$pictures/lesson-one.png" "$pictures/lesson-five.png"
kill -INT "$(first_process)"
check 'five processes: an interrupt of the first one ends them' eventually ended
wait $player
player=
check 'the interrupted lesson has a report' test -s five/report.html
check 'the processes tell how they kept together' logged '^walls: [0-9]* frames in 5 processes'
grep "^walls:" log
small_frames() {
    bytes=$(sed -n 's/^walls: .*a frame has [0-9]* bytes (median; largest \([0-9]*\)).*/\1/p' log)
    [[ ${bytes:-9999} -lt 4096 ]]
}
check 'the state of each frame has less than 4 KiB' small_frames
check 'the time of a message is measured' logged 'a message of 4 KiB takes [0-9.]* ms (median; longest [0-9.]* ms)'

# The menu: its panel is drawn by the first process.
least=20000
run_walls "$bin/boltwright" "${train[@]}" alone.json --out alone
check 'one process: the walls show the menu' eventually rests "$pictures/menu-one.png"
kill -INT $player
wait $player
player=
run_walls "${launch[@]}" -n 5 "$bin/boltwright" "${train[@]}" cave.json --out five
check 'five processes show the same menu as one' eventually equals "$pictures/menu-one.png" "$pictures/menu-five.png"
kill -INT "$(first_process)"
check 'five processes: an interrupt of the first one ends the menu' eventually ended
wait $player
player=
grep "^walls:" log
check 'the state of each frame of the menu has less than 4 KiB' small_frames
run_walls "${launch[@]}" -n 5 "$bin/boltwright" "${train[@]}" cave.json --out five
check 'the menu begins again' eventually opened 'Boltwright: ceiling'
sleep 2
kill -INT $player
check 'five processes: an interrupt of mpirun ends the menu' eventually ended
wait $player
player=

# The test pattern ends by a key in the window of another process.
run_walls "${launch[@]}" -n 5 "$bin/boltwright" displays test cave.json --validate
check 'the window of another process opens' eventually opened 'Boltwright: ceiling'
pattern_ends() { press 'Boltwright: ceiling' Escape; sleep 0.5; ended; }
check 'Escape in it ends all processes' bash -c "$(declare -f pattern_ends press window ended); player=$player; for i in \$(seq 60); do pattern_ends && exit 0; done; exit 1"
check 'without an error' wait $player
player=

# A process that dies: the others end, and nothing recorded is lost.
run_walls "${launch[@]}" -n 5 "$bin/boltwright" "${train[@]}" cave.json --start --out lost
check 'the lesson begins again' eventually logged 'lesson begun'
sleep 3
kill -KILL "$(pgrep -f -- "--displays cave.json --start --out lost" | tail -1)"
check 'the others end' eventually ended
wait $player
check 'mpirun tells the loss with its exit code' test $? -ne 0
player=
check 'the session can be read' eval "$bin/boltwright report lost/session.boltwright --html lost.html >/dev/null"

# Mistakes.
expect 2 'wall "front": its output has rank 1, and the program was started alone; expected mpirun -n 2 or more' "$bin/boltwright" "${train[@]}" cave.json --out none
expect 2 'wall "right": its output has rank 2, and there are 2 processes' "${launch[@]}" -n 2 "$bin/boltwright" "${train[@]}" cave.json --out none
expect 2 'process 5 shows no wall' "${launch[@]}" -n 6 "$bin/boltwright" "${train[@]}" cave.json --out none
sed 's/0.2, 1.65/0.1, 1.65/' cave.json > other.json
expect 3 'process 4 on .* has another display file or another version' \
    "${launch[@]}" -n 5 sh -c "[ \$OMPI_COMM_WORLD_RANK = 4 ] && file=other.json; exec '$bin/boltwright' ${train[*]} \${file:-cave.json} --out none"
finish_checks
