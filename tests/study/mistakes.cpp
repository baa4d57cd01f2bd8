// The messages of a study about wrong clocks, second programs, and lessons that cannot be played.
#include "game/study/study_lesson.hpp"
#include "game/study_results/results.hpp"
#include "tests/study/participants.hpp"

namespace study_mistakes_test {

using namespace bolt;
using namespace bolt::study;
using namespace study_test;

TEST_CASE("Study: a clock that was set back is reported, and the retention test does not move by it") {
    StudyFolder folder;
    const content::Study study = folder.load();
    const std::int64_t right = folder.now;
    folder.now += 26 * 86400;  // wrong
    {
        Participation participation = enrolled(folder, study);
        do_all(participation);
        folder.now += 120;  // the break
        do_all(participation);
        REQUIRE(participation.due()->kind == StudyStepKind::retention);
    }
    folder.now = right;
    const auto states = required(list_participants(study, folder.path()));
    CHECK(progress_text(study, states, right)
              .find("days ahead of this computer's clock; expected the right date") != std::string::npos);
    Participation participation = required(resumed(folder, study, "P01"));
    CHECK(participation.clock_behind() > 26 * 86400.0);
    CHECK(participation.remaining_wait() > 30 * 86400.0);
    REQUIRE(participation.accept_clock());
    CHECK(participation.clock_behind() == 0.0);
    CHECK(participation.remaining_wait() <= 7 * 86400.0);
    CHECK(participation.remaining_wait() > 5 * 86400.0);
    CHECK(participation.progress().clock_set_back > 26 * 86400.0);
    REQUIRE(participation.accept_clock());  // once is enough
    CHECK(participation.progress().clock_set_back < 27 * 86400.0);
}

TEST_CASE("Study: a second program for one participant is told who has the participant") {
    StudyFolder folder;
    const content::Study study = folder.load();
    const Participation first = enrolled(folder, study);
    const auto second = resumed(folder, study, "P01");
    REQUIRE_FALSE(second);
    CHECK(second.error().message().ends_with(
        "P01 is led by another program; expected the end of that program, or another participant"));
}

TEST_CASE("Study: an agreement can be taken back before the next page, also in the journal") {
    StudyFolder folder;
    const content::Study study = folder.load();
    {
        Participation participation = enrolled(folder, study);
        do_until(participation, "consent");
        REQUIRE(participation.agree(0));
        REQUIRE(participation.agree(1));
        REQUIRE(participation.take_back(1));
        CHECK_FALSE(participation.agreed(1));
        CHECK_FALSE(participation.complete());
    }
    Participation participation = required(resumed(folder, study, "P01"));
    CHECK(participation.agreed(0));
    CHECK_FALSE(participation.agreed(1));
    REQUIRE(participation.agree(1));
    CHECK(participation.complete());
}

TEST_CASE("Study: every lesson of the training keeps its measures") {
    StudyFolder folder;
    const content::Study study = folder.load();
    Participation participation = enrolled(folder, study);
    do_until(participation, "training");
    REQUIRE(participation.begin_lesson());
    REQUIRE(participation.end_lesson({{"duration_s", 200.0}, {"score", 60.0}, {"bumps", bolt::nan}}));
    REQUIRE(participation.begin_lesson());
    REQUIRE(participation.begin_lesson());  // interrupted, begun again
    REQUIRE(participation.end_lesson({{"bumps", 1.0}, {"duration_s", 300.0}, {"score", 80.0}}));
    const auto& lessons = participation.progress().training_lessons;
    REQUIRE(lessons.size() == 2);
    CHECK(lessons[0].at("score") == 60.0);
    CHECK_FALSE(lessons[0].contains("bumps"));
    CHECK(lessons[1].at("score") == 80.0);
}

TEST_CASE("Study: a lesson that cannot be played is a mistake with its place in the plan") {
    StudyFolder folder;
    const auto first_error = [&](const std::string& settings,
                                 const std::function<Status(const std::vector<std::string>&)>& devices = {}) {
        const StudyFolder changed;
        changed.edit(R"("lesson": { "mode": "guided" })",
                     R"("lesson": { "mode": "guided", )" + settings + " }");
        const StudyCheck check = check_study(changed.load(), changed.path(), {devices, {}, {}, {}});
        REQUIRE_MESSAGE(check.errors.size() == 1, settings);
        std::string message = check.errors.front().message();
        REQUIRE_MESSAGE(message.starts_with((changed.path() / "study.json").string() + ":12:"), message);
        return message.substr(message.find(": ") + 2);
    };
    const auto has = [](const std::string& text, const char* part) {
        return text.find(part) != std::string::npos;
    };
    CHECK(has(first_error(R"("assembly": "cover-m9")"), "cover-m9"));
    CHECK(has(first_error(R"("assembly": "zq350", "variant": "brass")"), "zq350 has no variant \"brass\""));
    CHECK(has(first_error(R"("assembly": "zq350", "tool": "hammer")"), "zq350 has no tool \"hammer\""));
    CHECK(has(first_error(R"("devices": ["novint-falcon"])",
                          [](const std::vector<std::string>& ids) -> Status {
                              return fail(ErrorCode::no_device, "there is no device " + ids.at(0),
                                          "another one");
                          }),
              "there is no device novint-falcon; expected another one"));
    const content::Study study = folder.load();
    CHECK(check_study(study, folder.path(), {[](const auto&) -> Status { return {}; }, {}, {}, {}})
              .errors.empty());
}

}  // namespace study_mistakes_test
