#!/usr/bin/env bash
# Run by tests/monado.sh inside its Debian 13 root, on a screen: inside.sh BIN SOURCES OUT [PARTS...]. The parts: tracker (the head
# of a viewer of projection walls, tracked without pictures, lost and found again), program (the
# headset is lost and found again), first-nut and cover-m8 (a driven hand plays the lesson), window (Monado composes the pictures in
# a window, for a look at them), speed (prints how many frames a second are drawn).
. "$2/tests/cli/checks.sh"
out=$3
parts=("${@:4}")
[[ ${#parts[@]} -gt 0 ]] || parts=(tracker program first-nut cover-m8)
export XDG_RUNTIME_DIR=$work/run XRT_NO_STDIN=1 P_OVERRIDE_ACTIVE_CONFIG=remote XRT_COMPOSITOR_NULL=1
mkdir -m 700 "$XDG_RUNTIME_DIR"
service=
started() { grep -q 'service has started' "$out/service.log"; }
# Monado raises the priority of a thread above everything else if it may.
start_service() {
    rm -f "$XDG_RUNTIME_DIR/monado_comp_ipc"
    setpriv --bounding-set=-sys_nice --inh-caps=-sys_nice monado-service >"$out/service.log" 2>&1 &
    service=$!
    check 'Monado starts' eventually started
}
stop_service() {
    kill "$@" $service
    wait $service 2>/dev/null
}
told() { [[ $(grep -cE "$1" "$out/program.log") -ge $2 ]]; }
size_of() { stat -c %s lesson/session.boltwright-wal; }
grows() { [[ $(size_of) -gt $before ]]; }

# The real program in the headset; Monado ends in the middle of the lesson, and comes back.
play_program() {
    start_service
    "$bin/boltwright" train --start --silent --validate --full-resolution --size 320x240 --hmd first-nut --out lesson \
        >"$out/program.log" 2>&1 &
    player=$!
    check 'the lesson begins in the headset' eventually told '^lesson begun' 1
    # The lesson's time passes and is recorded only while the user sees the lesson.
    before=$(size_of)
    check 'the lesson passes in the headset' eventually grows
    import -window root "$out/in_headset.png"
    stop_service -9
    check 'the loss is told' eventually told '^the headset is lost: ' 1
    sleep 5
    check 'the program goes on in its window' kill -0 $player
    import -window root "$out/in_window.png"
    start_service
    check 'the headset is found again' eventually told '^headset: 2 eye' 2
    before=$(size_of)
    check 'the lesson passes in the headset again' eventually grows
    import -window root "$out/in_headset_again.png"
    kill -INT $player
    check 'the program ends in order, without a message of the validation layers' wait $player
    player=
    check 'its frames are counted' told '^headset: [1-9][0-9]* frames' 2
    check 'the session is complete' "$bin/boltwright" report lesson/session.boltwright --html lesson.html
    grep '^headset: [0-9]* frames' "$out/program.log"
    stop_service
}

track_head() {
    "$bin/boltwright" displays new cave.json >/dev/null
    sed -i 's/"tracker": "[a-z]*"/"tracker": "openxr", "pose": "headset"/' cave.json
    start_service
    "$bin/boltwright" displays track cave.json --seconds 60 >"$out/program.log" 2>&1 &
    player=$!
    check 'the head is tracked' eventually told '^tracked ' 2
    stop_service -9
    check 'its loss is told' eventually told '^(held|lost) ' 1
    before=$(grep -c '^tracked ' "$out/program.log")
    start_service
    check 'it is found again' eventually told '^tracked ' $((before + 2))
    kill -INT $player
    check 'the program ends in order' wait $player
    player=
    tail -2 "$out/program.log"
    stop_service
}

# Without validation layers, in the pictures' full size and in the size that the program chooses.
measure_speed() {
    start_service
    local size
    for size in --full-resolution ''; do
        # shellcheck disable=SC2086  # without the option there is no word
        "$bin/boltwright" train --start --silent $size --size 320x240 --hmd first-nut --out lesson >"$out/program.log" 2>&1 &
        player=$!
        sleep 30
        kill -INT $player
        check 'the program ends in order' wait $player
        player=
        echo "${size:-adapted resolution}: $(grep '^headset: [0-9]* frames' "$out/program.log")"
    done
    stop_service
}

show_window() {
    export XRT_COMPOSITOR_FORCE_XCB=1
    unset XRT_COMPOSITOR_NULL
    start_service
    "$bin/boltwright" train --start --silent --validate --full-resolution --size 320x240 --hmd first-nut --out lesson \
        >"$out/program.log" 2>&1 &
    player=$!
    check 'the lesson begins in the headset' eventually told '^lesson begun' 1
    sleep 40
    import -window root "$out/composed.png"
    kill -INT $player
    check 'the program ends in order, without a message of the validation layers' wait $player
    player=
    grep '^headset: ' "$out/program.log"
    stop_service
}

play_lesson() {
    start_service
    BOLT_MONADO_PICTURES=$out/pictures check "a driven hand plays $1" "$bin/test_monado" -tc="Monado: $1 *" -s
    rm -rf "${out:?}/$1"
    cp -r "monado/$1" "$out"
    stop_service
}

for part in "${parts[@]}"; do
    case $part in
        tracker) track_head ;;
        program) play_program ;;
        speed) measure_speed ;;
        window) show_window ;;
        *) play_lesson "$part" ;;
    esac
done
finish_checks
