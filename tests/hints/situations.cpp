// Every situation of a lesson and its hint, in every mode.

#include <doctest/doctest.h>

#include <set>

#include "game/lesson/hints.hpp"
#include "tests/hints/cases.hpp"

namespace hints_situations_test {

using namespace bolt;
using namespace bolt::lesson;
using servo::Grip;
using test::Bench;
using test::Case;
using test::cases;

namespace {

// Announcements of a step, which depend on time.
constexpr Situation announced[] = {Situation::next,       Situation::pass_run_down,  Situation::pass_tighten,
                                   Situation::pass_turn,  Situation::pass_turn_back, Situation::pass_recheck,
                                   Situation::pass_loosen};

words::Words words_in(std::string_view language) {
    words::LoadedWords loaded = words::load_words(words::words_folder(), language);
    REQUIRE(loaded.ok());
    return std::move(loaded.words);
}

}  // namespace

TEST_CASE("Hints: every situation is recognised") {
    std::set<Situation> seen(std::begin(announced), std::end(announced));
    for (const Case& c : cases) {
        CAPTURE(c.text);
        for (const Mode mode : {Mode::guided, Mode::practice, Mode::assessment}) {
            Bench b(mode, c.strategy, c.task);
            c.arrange(b);
            CHECK(static_cast<int>(b.now()) == static_cast<int>(c.situation));
        }
        seen.insert(c.situation);
    }
    CHECK(seen.size() == situation_count);
}

TEST_CASE("Hints: guided: every situation has a complete hint for the due joint in every language") {
    std::vector<words::Words> languages;
    for (const char* language : {"en", "de", "zh"}) languages.push_back(words_in(language));
    for (const Case& c : cases) {
        CAPTURE(c.text);
        Bench b(Mode::guided, c.strategy, c.task);
        c.arrange(b);
        b.wait(3.5);  // until the announcement has ended
        REQUIRE(b.hints.shown);
        const Hint hint = *b.hints.shown;
        CHECK(static_cast<int>(hint.situation) == static_cast<int>(c.situation));
        CHECK(hint.text.row().name == c.text);
        CHECK(static_cast<int>(hint.motion) == static_cast<int>(c.motion));
        const LessonStep* due = b.lesson.due();
        CHECK(hint.joint == (due == nullptr ? -1 : static_cast<int>(due->joint)));
        for (int level = 0; level <= 3; ++level) {
            Hint at = hint;
            at.level = level;
            for (const words::Words& language : languages) {
                const std::string text = hint_text(language, at);
                CHECK_FALSE(text.empty());
                CHECK(text.find('{') == std::string::npos);
                for (const ControlNames& controls :
                     {mouse_controls(language, "T"), device_controls(language, "A", "T"),
                      puck_controls(language, "A", "T"), keyboard_controls(language, "Space", "T"),
                      glove_controls(language, puck_controls(language, "A", "T"))}) {
                    const std::string motion = motion_text(language, at, controls);
                    CHECK(motion.empty() == (level < 3 || c.motion == HintMotion::none));
                    CHECK(motion.find('{') == std::string::npos);
                    const std::string pressed = words::replace_placeholders(
                        language, controls[static_cast<std::size_t>(c.motion)], hint.arguments);
                    CHECK(pressed.empty() == (c.motion == HintMotion::none));
                    CHECK((motion.empty() || motion.find(pressed) != std::string::npos));
                }
            }
        }
    }
}

TEST_CASE("Hints: assessment: no hint in any situation, requested or not") {
    for (const Case& c : cases) {
        Bench b(Mode::assessment, c.strategy, c.task);
        c.arrange(b);
        for (int i = 0; i < 1000; ++i) CHECK_FALSE(b.frame(0.1, i % 7 == 0).has_value());
    }
}

TEST_CASE("Hints: practice: no hint until a long time has passed or the trainee requests one") {
    for (const Case& c : cases) {
        CAPTURE(c.text);
        Bench b(Mode::practice, c.strategy, c.task);
        c.arrange(b);
        CHECK_FALSE(b.wait(19.0).has_value());
        CHECK(b.wait(2.0).has_value());
        Bench requested(Mode::practice, c.strategy, c.task);
        c.arrange(requested);
        requested.wait(3.5);
        CHECK_FALSE(requested.frame().has_value());
        REQUIRE(requested.frame(0.05, true).has_value());
        CHECK(static_cast<int>(requested.hints.shown->situation) == static_cast<int>(c.situation));
    }
}

TEST_CASE("Hints: texts have the numbers of the step") {
    const words::Words en = words_in("en");
    Bench b;
    b.seat_both();
    b.turn(0, 10.0);
    b.wait(2.0);
    CHECK(hint_text(en, *b.hints.shown) == "Pull clockwise, smoothly, until A has 35 N·m.");
    b.turn(0, 45.0);
    b.frame();
    CHECK(hint_text(en, *b.hints.shown) == "Stop. A should get 38.5 N·m at most.");
    Bench wrong;
    wrong.seat_both();
    wrong.tick(1, Grip::wrench, 0.2);
    wrong.wait(2.0);
    CHECK(hint_text(en, *wrong.hints.shown) == "This is B. A is due: let go and go there.");
    Bench start;
    start.seat_both();
    start.frame();
    CHECK(hint_text(en, *start.hints.shown) ==
          "This round: tighten all nuts to 50 % of their torque. Begin with A.");
    start.wait(4.0);
    CHECK(hint_text(en, *start.hints.shown) == "Take the 24 mm wrench.");
    start.wait(12.0);
    CHECK(motion_text(en, *start.hints.shown, mouse_controls(en, "T")) ==
          "Move the hand to the wrench and close it on the handle: press T or click on the wrench.");
}

TEST_CASE("Hints: name the nut, or the screw that is turned at its head, of the due joint") {
    const words::Words en = words_in("en"), de = words_in("de"), zh = words_in("zh");
    const auto start = [](std::initializer_list<std::size_t> screws) {
        Bench b;
        for (const std::size_t joint : screws)
            b.assembly.joints[joint].design.turned = joint::TurnedPart::head;
        b.frame();
        return *b.hints.shown;
    };
    CHECK(hint_text(en, start({})) ==
          "This round: run all nuts down by hand until they are seated. Begin with A.");
    CHECK(hint_text(en, start({0, 1})) ==
          "This round: run all screws down by hand until they are seated. Begin with A.");
    CHECK(hint_text(en, start({1})) ==
          "This round: run all nuts and screws down by hand until they are seated. Begin with A.");
    CHECK(hint_text(de, start({0, 1})) ==
          "Dieser Umlauf: alle Schrauben von Hand bis zur Anlage drehen. Beginnen Sie mit A.");
    CHECK(hint_text(zh, start({0, 1})) == "本轮：用手把所有螺钉拧到贴合。从 A 开始。");
    // Each joint by itself, in the motion too, and no screw's hint names a nut in any situation and language.
    Bench b;
    b.assembly.joints[1].design.turned = joint::TurnedPart::head;
    Hint nut = make_hint(Situation::grip_nut, Situation::grip_nut, 3, b.work_state());
    CHECK(hint_text(en, nut) == "Take the nut of A between your fingers.");
    CHECK(motion_text(en, nut, mouse_controls(en, "T")).find("two faces of the nut") != std::string::npos);
    for (content::AssemblyJoint& joint : b.assembly.joints) joint.design.turned = joint::TurnedPart::head;
    for (std::size_t i = 0; i < situation_count; ++i) {
        const auto situation = static_cast<Situation>(i);
        const Hint hint = make_hint(situation, situation, 3, b.work_state());
        for (const words::Words* words : {&en, &de, &zh}) {
            const std::string text = hint_text(*words, hint) +
                                     motion_text(*words, hint, mouse_controls(*words, "T")) +
                                     motion_text(*words, hint, tracked_controls(*words));
            CAPTURE(text);
            for (const char* word : {" nut", "Nut", "Mutter", "螺母", "螺栓", "bolt"})
                CHECK(text.find(word) == std::string::npos);
        }
    }
}

TEST_CASE("Hints: with a glove, controls name the device that moves the hand and the fingers that grip") {
    const auto loaded = words::load_words(words::words_folder(), "en");
    REQUIRE(loaded.ok());
    const ControlNames keys = keyboard_controls(loaded.words, "Space", "T"),
                       gloved = glove_controls(loaded.words, keys);
    const auto of = [](const ControlNames& controls, HintMotion motion) {
        return controls[static_cast<std::size_t>(motion)];
    };
    CHECK(of(gloved, HintMotion::set_on) == of(keys, HintMotion::set_on));
    CHECK(of(gloved, HintMotion::pull_on) == of(keys, HintMotion::pull_on));
    CHECK(of(gloved, HintMotion::take).find("close your hand") != std::string::npos);
    CHECK(of(gloved, HintMotion::grip_nut).find("pinch") != std::string::npos);
}

}  // namespace hints_situations_test
