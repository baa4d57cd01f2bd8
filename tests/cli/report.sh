#!/usr/bin/env bash
# `boltwright report` for several trainees: report.sh BIN SOURCES [PAGE]. It needs a screen (with_screen.sh), because a person's
# session needs a window. PAGE: a copy of the page, for inspection.
. "$(dirname "$0")/checks.sh"
page=${3:-}

simulated() {  # simulated FOLDER SEED train's options...
    local folder=$1 seed=$2
    shift 2
    "$bin/boltwright" train cover-m8 --headless --quiet --no-pictures --no-obstacles --seed "$seed" --out "$folder" "$@" \
        >/dev/null || [[ $? -eq 1 ]]  # 1: the lesson was not finished
}
# Simulates a person who starts a lesson and ends it with Ctrl+C.
person() {  # person FOLDER train's options...
    local folder=$1
    shift
    HOME=$work XDG_DATA_HOME=$work "$bin/boltwright" train cover-m8 --start --silent --size 320x200 --out "$folder" "$@" \
        2>"$folder.log" >/dev/null &
    player=$!
    begun() { grep -qs 'lesson begun' "$folder.log"; }
    eventually begun && sleep 0.5
    kill -INT $player
    wait $player
    player=
    [[ -s $folder/session.boltwright ]]
}
count() { grep -oE "$1" "$2" | wc -l; }

for seed in 1 2 3; do
    check "Anna's lesson $seed" simulated "anna$seed" "$seed" --trainee Anna --operator novice
    check "Ben's lesson $seed" simulated "ben$seed" $((seed + 10)) --trainee Ben --operator expert
done
for seed in 1 2; do check "an expert's lesson $seed" simulated "expert$seed" $((seed + 20)) --operator expert; done
check "a lesson of a person called expert" person person1 --trainee expert
check "... a second one, without the guiding force" person person2 --trainee expert --no-guide
check "the summary names the trainee and who held the tool" \
    bash -c "grep -q '\"operator\": \"novice\"' anna1/summary.json && grep -q '\"trainee\": \"Anna\"' anna1/summary.json"

code=$(grep -oE 'T-[0-9A-Z]{6}' boltwright/people/names.json)
check "a person's session has the code, not the name" bash -c "grep -qa '$code' person2/session.boltwright && grep -q '\"trainee\": \"$code\"' person2/summary.json"
sessions=()
for seed in 1 2 3; do sessions+=("anna$seed/session.boltwright" "ben$seed/session.boltwright"); done
sessions+=(expert{1,2}/session.boltwright)
expect 0 'page.html' "$bin/boltwright" report "${sessions[@]}" person{1,2}/session.boltwright --html page.html
check "a learning curve for each trainee: Anna, Ben, the simulated expert, the person called expert (by code)" \
    test "$(count '<div class="trainee">' page.html)" -eq 4
check "each learning curve has four plots" test "$(count '<h4>' page.html)" -eq 16
for name in 'Anna (simulated novice)' 'Ben (simulated expert)' 'expert (simulated)' "$code"; do
    check "the curves of $name are labelled" grep -qF "<h3>$name <span" page.html
    check "$name has a row among the trainees" grep -qF "<td class=\"w\">$name</td>" page.html
done
expect 0 'named.html' env XDG_DATA_HOME="$work" "$bin/boltwright" report person{1,2}/session.boltwright --names --html named.html
check "with --names the person's name is beside the code" grep -qF "<h3>expert ($code) <span" named.html
check "Anna's curve has her attempts alone" \
    grep -qF '<h3>Anna (simulated novice) <span class="of">attempts <a href="#session-1">1</a>, <a href="#session-3">3</a>' page.html

# Lessons of the same person with and without guiding. The trainee's name does not make the person a simulated trainee.
expect 0 'study.html' "$bin/boltwright" report person{1,2}/session.boltwright --html study.html
check "the person's lessons are compared" grep -q 'With and without guiding' study.html
check "a person called expert is not simulated" bash -c "! grep -qi simulated study.html"
simulated plain 31 --operator expert && simulated unled 31 --operator expert --no-guide
expect 0 'study2.html' "$bin/boltwright" report plain/session.boltwright unled/session.boltwright --html study2.html
check "a simulated expert is reported as simulated" grep -q 'trainees are simulated' study2.html

# Sessions of older programs do not record whether the trainee was simulated.
expect 0 'old.html' "$bin/boltwright" report "$sources"/tests/data/format-[23].boltwright --html old.html
check "an old session is reported as person or simulated: not recorded" grep -q 'person or simulated: not recorded' old.html
check "... and not as simulated" bash -c "! grep -q '(simulated' old.html"

[[ -z $page ]] || cp page.html "$page"
finish_checks
