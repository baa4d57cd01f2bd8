// The label at the wrench in every language.
#include "game/scene/annotations.hpp"

#include <doctest/doctest.h>

#include "haptics/servo/tick.hpp"
#include "tests/lesson/script.hpp"
#include "tests/support/haptic_world.hpp"

using namespace bolt;
using test::Script;

namespace {

std::string shown(const char* language, const Script& s, bool wrench) {
    const words::LoadedWords loaded = words::load_words(words::words_folder(), language);
    REQUIRE(loaded.ok());
    servo::Setup setup;
    setup.nuts.resize(2);
    test::HapticWorld world(2);
    const auto label =
        scene::work_label(loaded.words, s.lesson, setup, world.write(s.state, s.output, wrench));
    return label ? label->text : "";
}

}  // namespace

TEST_CASE("Work label: its values and words are in the trainee's language") {
    Script s;
    s.seat_both();
    s.state.joints[0].nut.angle = 4.0 * pi;
    s.tick(0, servo::Grip::wrench, 5.0);
    s.lesson.joints[0].begin_angle = 4.0 * pi - to_radians(30.0);
    CHECK(shown("en", s, true) == "5 N·m   +30°   Seating");
    CHECK(shown("de", s, true) == "5 N·m   +30°   Anlegen");
    s.tick(0, servo::Grip::fingers, 0.1);
    CHECK(shown("en", s, false) == "2.0 turns");
    CHECK(shown("de", s, false) == "2,0 Umdrehungen");
    CHECK(shown("zh", s, false) == "2.0 圈");
}

TEST_CASE(
    "Work label: its sign rates the torque against the due pass, and breakaway never counts as too high") {
    Script s;
    s.seat_both();  // then to half of 70 N·m, 31.5 to 38.5
    const auto sign = [&](double torque, double speed) {
        s.tick(0, servo::Grip::wrench, torque, speed);
        const std::string text = shown("en", s, true);
        return text.substr(0, text.find_first_of("0123456789"));
    };
    CHECK(sign(20.0, 1.0).empty());
    CHECK(sign(35.0, 1.0) == std::string(view::symbol_of(lesson::Verdict::ok)) + " ");
    CHECK(sign(45.0, 0.0) == std::string(view::symbol_of(lesson::Verdict::ok)) + " ");
    CHECK(sign(45.0, 1.0) == std::string(view::symbol_of(lesson::Verdict::high)) + " ");
}

TEST_CASE("Work label: a nut out of turn shows no angle, which would include the turns on the thread") {
    Script s;
    s.seat_both();
    s.state.joints[1].nut.angle = 40.0;
    s.tick(1, servo::Grip::wrench, 2.0);
    CHECK(shown("en", s, true) == "2 N·m   Seating");
}

TEST_CASE("Work label: a hand in the air has none") {
    Script s;
    s.idle();
    CHECK(shown("en", s, true).empty());
}
