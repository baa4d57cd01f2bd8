// The texts of joints with a left-hand thread name the opposite direction, in every language.
#include <doctest/doctest.h>

#include "game/lesson/feedback.hpp"
#include "tests/hints/bench.hpp"

namespace hints_left_thread_test {

using namespace bolt;
using namespace bolt::lesson;
using joint::ThreadDirection;
using test::Bench;

namespace {

words::Words words_in(std::string_view language) {
    words::LoadedWords loaded = words::load_words(words::words_folder(), language);
    REQUIRE(loaded.ok());
    return std::move(loaded.words);
}

std::size_t count_of(std::string_view text, std::string_view word) {
    std::size_t count = 0;
    for (std::size_t at = 0; (at = text.find(word, at)) != std::string_view::npos; at += word.size()) ++count;
    return count;
}

// The number of times that a text names each direction.
struct Directions {
    std::size_t clockwise = 0, anticlockwise = 0, left = 0, right = 0;

    explicit Directions(std::string text) {
        for (char& c : text) c = c == 'C' ? 'c' : c == 'A' ? 'a' : c;
        anticlockwise = count_of(text, "anticlockwise") + count_of(text, "gegen den Uhrzeigersinn") +
                        count_of(text, "逆时针");
        clockwise = count_of(text, "clockwise") - count_of(text, "anticlockwise") +
                    count_of(text, "im Uhrzeigersinn") + count_of(text, "顺时针");
        left = count_of(text, "to the left") + count_of(text, "nach links") + count_of(text, "向左");
        right = count_of(text, "to the right") + count_of(text, "nach rechts") + count_of(text, "向右");
    }
    [[nodiscard]] Directions mirrored() const {
        Directions other = *this;
        std::swap(other.clockwise, other.anticlockwise);
        std::swap(other.left, other.right);
        return other;
    }
    bool operator==(const Directions&) const = default;
};

void make_left(Bench& bench) { bench.assembly.joints[0].design.thread_direction = ThreadDirection::left; }

}  // namespace

TEST_CASE("Hints: those of a left-hand thread name the opposite direction, in every language") {
    Bench right, left;
    make_left(left);
    for (const char* language : {"en", "de", "zh"}) {
        const words::Words words = words_in(language);
        std::size_t directions = 0, drags = 0;
        for (std::size_t i = 0; i < situation_count; ++i) {
            const auto situation = static_cast<Situation>(i);
            const auto text = [&](Bench& bench) {
                const Hint hint = make_hint(situation, situation, 3, bench.work_state());
                std::string all = hint_text(words, hint);
                for (const ControlNames& controls : {mouse_controls(words, "T"), drag_controls(words, "T"),
                                                     device_controls(words, "A", "T")})
                    all += " " + motion_text(words, hint, controls);
                return all;
            };
            const std::string of_right = text(right), of_left = text(left);
            CAPTURE(of_right);
            CAPTURE(of_left);
            CHECK(of_left.find("{thread") == std::string::npos);
            CHECK(Directions(of_left) == Directions(of_right).mirrored());
            directions += Directions(of_right).clockwise + Directions(of_right).anticlockwise;
            drags += Directions(of_right).right;
        }
        CHECK(directions >= 9);
        CHECK(drags >= 2);
    }
    const words::Words en = words_in("en");
    const auto english = [&](Situation situation) {
        return hint_text(en, make_hint(situation, situation, 3, left.work_state()));
    };
    CHECK(english(Situation::run_down) ==
          "Turn the nut of A anticlockwise (left-hand thread) until it is seated.");
    CHECK(english(Situation::pull).starts_with("Pull anticlockwise, smoothly, until A has"));
    CHECK(english(Situation::break_loose) ==
          "Pull clockwise (left-hand thread), with growing force, until A comes loose.");
    CHECK(english(Situation::other_way_on) ==
          "The other way: this loosens the nut. Pull anticlockwise: its thread is left-handed.");
    const Hint spin = make_hint(Situation::run_down, Situation::run_down, 3, left.work_state());
    CHECK(
        motion_text(en, spin, mouse_controls(en, "T")) ==
        "Turn the hand anticlockwise, seen from the nut's side: keep the button down and drag to the left.");
}

TEST_CASE("Mistakes: the remedy at a left-hand thread names the opposite direction, in every language") {
    for (const bool loosens : {false, true}) {
        const auto remedy = [&](bool is_left, const char* language) {
            Bench b;
            if (is_left) make_left(b);
            b.seat_both();
            if (loosens) {
                b.lesson = begin(b.assembly, b.lesson.mode, Task::loosen);
                b.turn(0, 20.0, 2.0);
            } else {
                b.turn(0, -20.0, -2.0);
            }
            for (const LessonEvent& event : b.lesson.events)
                if (const auto mistake = mistake_of(b.lesson, event))
                    return remedy_text(words_in(language), *mistake);
            return std::string();
        };
        for (const char* language : {"en", "de", "zh"}) {
            const Directions right(remedy(false, language));
            CHECK(right.clockwise + right.anticlockwise == 1);
            CHECK(Directions(remedy(true, language)) == right.mirrored());
        }
    }
}

TEST_CASE("Feedback: advice names the directions of all threads of the lesson") {
    content::Assembly assembly;
    assembly.joints.resize(2);
    LessonResult result;
    result.reasons = {{.kind = DeductionKind::wrong_way, .count = 1}};
    const auto advice = [&](const char* language) {
        const Review given = review(assembly, result);
        REQUIRE(given.advice.size() == 1);
        const std::string text =
            words::format_text(words_in(language), given.advice.front(), given.arguments);
        CHECK(text.find('{') == std::string::npos);
        return text;
    };
    const std::string right = advice("en");
    CHECK(
        right ==
        "Clockwise tightens, anticlockwise loosens, seen from the wrench's side: begin each pull gently and "
        "feel which way it goes.");
    assembly.joints[0].design.thread_direction = ThreadDirection::left;
    CHECK(
        advice("en").starts_with("Clockwise tightens a right-hand thread, anticlockwise a left-hand "
                                 "thread, seen from"));
    for (const char* language : {"de", "zh"}) {
        CHECK(Directions(advice(language)).clockwise == 1);
        CHECK(Directions(advice(language)).anticlockwise == 1);
    }
    assembly.joints[1].design.thread_direction = ThreadDirection::left;
    CHECK(
        advice("en").starts_with("These threads are left-handed: anticlockwise tightens, clockwise "
                                 "loosens, seen from"));
}

}  // namespace hints_left_thread_test
