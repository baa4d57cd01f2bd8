#include "game/lesson/feedback.hpp"

#include <doctest/doctest.h>

#include "game/lesson/judge.hpp"
#include "tests/hints/bench.hpp"

using namespace bolt;
using namespace bolt::lesson;

namespace {

words::Words words_in(std::string_view language) {
    words::LoadedWords loaded = words::load_words(words::words_folder(), language);
    REQUIRE(loaded.ok());
    return std::move(loaded.words);
}

// Four joints with correct results.
struct Outcome {
    content::Assembly assembly;
    Lesson lesson;
    servo::State state;

    explicit Outcome(Task task = Task::tighten) {
        content::Pass pass{content::PassKind::tighten, 1.0, {}};
        for (std::size_t i = 0; i < 4; ++i) {
            content::AssemblyJoint joint;
            joint.design.id = "B" + std::to_string(i + 1);
            joint.spec.torque = {70.0, 60.0, 80.0};
            joint.spec.has_angle = true;
            joint.spec.angle = {to_radians(30.0), to_radians(20.0), to_radians(40.0)};
            assembly.joints.push_back(joint);
            pass.order.push_back(i);
        }
        assembly.passes = {pass};
        lesson = begin(assembly, Mode::guided, task);
        state.joints.resize(4);
        state.rounded.resize(4);
        for (std::size_t i = 0; i < 4; ++i) done(i, 70.0, 30.0);
        lesson.current = lesson.steps.size();
    }
    void done(std::size_t joint, double torque, double degrees) {
        lesson.joints[joint].result.torque = torque;
        lesson.joints[joint].result.angle = to_radians(degrees);
        state.joints[joint].stage = joint::Stage::linearity;
    }
    [[nodiscard]] Review review() const {
        return lesson::review(assembly, judge(lesson, test::make_world(state), 1e-3));
    }
    [[nodiscard]] std::vector<std::string> reasons() const {
        const words::Words en = words_in("en");
        std::vector<std::string> texts;
        for (const DeductionText& deduction : review().reasons)
            texts.push_back(deduction_text(en, deduction));
        return texts;
    }
    [[nodiscard]] std::vector<std::string_view> advice() const {
        std::vector<std::string_view> keys;
        for (const words::TextKey key : review().advice) keys.push_back(key.row().name);
        return keys;
    }
};

using Keys = std::vector<std::string_view>;
using ReasonTexts = std::vector<std::string>;

}  // namespace

TEST_CASE("Feedback: a perfect result has no reasons and one piece of advice") {
    CHECK(Outcome().reasons().empty());
    CHECK(Outcome().advice() == Keys{"advice.nothing"});
}

TEST_CASE("Feedback: each deduction has a reason with numbers and a piece of advice") {
    struct Case {
        const char* reason;
        const char* advice;
        void (*spoil)(Outcome&);
    };
    const Case cases[] = {
        {"B1 has 59.9 N·m; at least 60 N·m are needed.", "advice.torque_low",
         [](Outcome& r) { r.done(0, 59.9, 30.0); }},
        {"B1 reached 81.2 N·m; at most 80 N·m are allowed.", "advice.torque_high",
         [](Outcome& r) { r.done(0, 81.2, 30.0); }},
        {"B1 was turned by 12° from the snug torque; at least 20° are needed.", "advice.angle_low",
         [](Outcome& r) { r.done(0, 70.0, 12.0); }},
        {"B1 was turned by 55° from the snug torque; at most 40° are allowed.", "advice.angle_high",
         [](Outcome& r) { r.done(0, 70.0, 55.0); }},
        {"The bolt of B1 broke.", "advice.broken",
         [](Outcome& r) { r.state.joints[0].condition = joint::JointCondition::broken; }},
        {"The thread of B1 was stripped.", "advice.stripped",
         [](Outcome& r) { r.state.joints[0].condition = joint::JointCondition::stripped; }},
        {"B1 is off its seat again and holds nothing.", "advice.off_seat",
         [](Outcome& r) { r.state.joints[0].stage = joint::Stage::navigation; }},
        {"A joint was worked on out of turn once.", "advice.out_of_turn",
         [](Outcome& r) { r.lesson.joints[2].result.out_of_turn = 1; }},
        {"Finished joints were worked on again 3 times.", "advice.done_already",
         [](Outcome& r) {
             r.lesson.joints[2].result.done_already = 2;
             r.lesson.joints[1].result.done_already = 1;
         }},
        {"2 times a nut was turned the wrong way.", "advice.wrong_way",
         [](Outcome& r) { r.lesson.joints[1].wrong_way_count = 2; }},
        {"A nut got too much torque once; this was corrected.", "advice.torque_high",
         [](Outcome& r) { r.lesson.joints[1].over_torque_count = 1; }},
        {"B1 reached 81.2 N·m; at most 80 N·m are allowed.", "advice.torque_high",
         [](Outcome& r) {
             r.done(0, 81.2, 30.0);
             r.lesson.joints[0].over_torque_count = 1;
         }},
        {"2 times the wrench slipped off a nut.", "mistake.slipped.do",
         [](Outcome& r) { r.lesson.joints[1].slip_count = 2; }},
        {"The lesson was left at step 4 of 4.", "advice.unfinished",
         [](Outcome& r) { r.lesson.current = 3; }},
    };
    for (const Case& c : cases) {
        CAPTURE(c.reason);
        Outcome r;
        c.spoil(r);
        CHECK(r.reasons() == ReasonTexts{c.reason});
        CHECK(r.advice() == Keys{c.advice});
        for (const char* language : {"de", "zh"})
            for (const DeductionText& deduction : r.review().reasons)
                CHECK(deduction_text(words_in(language), deduction).find('{') == std::string::npos);
    }
    Outcome screws;
    for (content::AssemblyJoint& joint : screws.assembly.joints)
        joint.design.turned = joint::TurnedPart::head;
    screws.lesson.joints[1].wrong_way_count = 2;
    CHECK(screws.reasons() == ReasonTexts{"2 times a screw was turned the wrong way."});
    screws.assembly.joints[0].design.turned = joint::TurnedPart::nut;
    CHECK(screws.reasons() == ReasonTexts{"2 times a joint was turned the wrong way."});
    Outcome loose(Task::loosen);
    loose.lesson.joints[1].result.torque = 0.0;
    CHECK(loose.reasons() == ReasonTexts{"B2 was not loosened."});
}

TEST_CASE("Feedback: advice begins with the costliest mistake and has at most three entries") {
    Outcome r;
    r.lesson.joints[0].result.out_of_turn = 1;
    r.lesson.joints[0].result.done_already = 5;
    r.done(1, 50.0, 30.0);
    r.done(2, 90.0, 30.0);
    r.done(3, 90.0, 30.0);
    CHECK(r.advice() == Keys{"advice.torque_high", "advice.torque_low", "advice.done_already"});
    const Review review = r.review();
    double points = 0.0;
    for (const DeductionText& deduction : review.reasons) points += deduction.points;
    CHECK(points == doctest::Approx(judge(r.lesson, test::make_world(r.state), 1e-3).score - 100.0));
}

TEST_CASE("Feedback: reasons from a session file keep their stored text") {
    Outcome r;
    r.done(0, 50.0, 30.0);
    LessonResult result = judge(r.lesson, test::make_world(r.state), 1e-3);
    for (Deduction& reason : result.reasons) reason = {reason.points, reason.text};
    const Review review = lesson::review(r.assembly, result);
    REQUIRE(review.reasons.size() == 1);
    CHECK(deduction_text(words_in("zh"), review.reasons[0]) == result.reasons[0].text);
    CHECK(review.reasons[0].points == -25.0);
    CHECK(review.advice.empty());
}

TEST_CASE("Feedback: enumeration values have distinct names in every language") {
    for (const char* language : {"en", "de", "zh"}) {
        const words::Words words = words_in(language);
        const auto differ = [&](std::initializer_list<words::TextKey> keys) {
            for (const words::TextKey& a : keys)
                for (const words::TextKey& b : keys)
                    if (&a != &b) CHECK(words[a] != words[b]);
        };
        differ({text_key(Mode::guided), text_key(Mode::practice), text_key(Mode::assessment)});
        differ({text_key(Task::tighten), text_key(Task::loosen)});
        differ({text_key(StepKind::run_down), text_key(StepKind::tighten), text_key(StepKind::recheck),
                text_key(StepKind::loosen)});
        differ({text_key(Verdict::none), text_key(Verdict::low), text_key(Verdict::ok),
                text_key(Verdict::high)});
        differ({text_key(joint::Stage::navigation), text_key(joint::Stage::transition),
                text_key(joint::Stage::linearity), text_key(joint::Stage::yield)});
        differ({text_key(joint::JointCondition::intact), text_key(joint::JointCondition::stripped),
                text_key(joint::JointCondition::broken)});
        for (std::size_t a = 0; a < force::fault_kinds; ++a)
            for (std::size_t b = 0; b < a; ++b)
                CHECK(words[text_key(static_cast<force::Fault>(a))] !=
                      words[text_key(static_cast<force::Fault>(b))]);
    }
}
