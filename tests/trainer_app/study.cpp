// A participant of a study in the trainer: pages, lessons, interruptions.
#include <cmath>

#include "game/session/replay.hpp"
#include "game/study_results/results.hpp"
#include "tests/study/support.hpp"
#include "tests/trainer_app/free_hand_user.hpp"
#include "tests/trainer_app/headless_trainer.hpp"
#include "tests/trainer_app/simulated_user.hpp"

namespace trainer_study_test {

using namespace bolt;
using namespace bolt::test;
using study_test::required;
using study_test::StudyFolder;

namespace {

trainer::AppOptions options_of(const StudyFolder& folder) {
    trainer::AppOptions o = options("first-nut", false);
    o.choice.language = "en";
    o.out = folder.path();
    return o;
}

// The trainer that leads a participant.
struct Led {
    Led(study::Participation participation, const StudyFolder& folder)
        : driver(options_of(folder), {{480, 270}, 0.45F, 0.1},
                 trainer::StudyRun{std::move(participation), folder.path(), [this] { ++steps; }}) {
        driver.frame();
        driver.frame();
    }
    [[nodiscard]] const study::Participation& participation() const {
        return driver.app().study()->participation();
    }
    [[nodiscard]] std::string due() const {
        const study::Step* step = participation().due();
        return step == nullptr ? std::string("none") : step->id;
    }
    void press(words::TextKey key) {
        driver.press_button(key);
        driver.frame();
    }
    // From the page of the language to that of the first lesson.
    void go_to_lesson() {
        press("study.language");  // the first one
        press("study.next");
        press("study.next");
        while (due() == "consent" && !participation().agreed(1)) agree();
        press("study.next");
        REQUIRE(due() == "part-1/lesson-1");
    }
    void begin_lesson() {
        go_to_lesson();
        press("study.start");
    }
    void answer_form(std::size_t items) {
        for (std::size_t i = 0; i < items; ++i) press("study.item");
        press("study.next");
    }

    // Continues the interrupted lesson, or begins it again.
    void start_again() {
        CHECK(driver.app().screen() == trainer::ShownScreen::study);
        CHECK(due() == "part-1/lesson-1");
        CHECK(driver.app().choice().language == "de");
        press("study.start");
        while (driver.app().screen() == trainer::ShownScreen::starting) driver.frame();
        REQUIRE(driver.app().screen() == trainer::ShownScreen::lesson);
    }

    void agree() {
        std::size_t statement = 0;
        for (const trainer::DrawnWidget& widget : driver.app().drawn_widgets())
            if (widget.label == words::TextKey("study.consent") && !participation().agreed(statement++)) {
                driver.press(glm::dvec2(widget.middle));
                driver.release(glm::dvec2(widget.middle));
            }
        driver.frame();
    }

    int steps = 0;
    HeadlessTrainer driver;
};

std::filesystem::path session_of(const StudyFolder& folder, const char* lesson) {
    return folder.path() / "participants/P01" / lesson / "session.boltwright";
}

std::uint64_t ticks_of(double time) { return static_cast<std::uint64_t>(std::llround(time * 1e3)); }

// The ticks of a session that replay differently.
std::uint64_t mismatches(const std::filesystem::path& file) {
    const auto reader = required(session::SessionReader::open(file));
    const auto replayed = required(session::replay(reader, required(session::restore_setup(reader)),
                                                   [](const session::ReplayTick&) { return true; }));
    CHECK(replayed.ticks > 0);
    return replayed.mismatches;
}

study::Participation enrolled(const content::Study& study, const StudyFolder& folder) {
    return required(study::Participation::enrol(study, folder.path(), "T-1", false));
}

study::Participation resumed(const content::Study& study, const StudyFolder& folder) {
    return required(study::Participation::resume(study, folder.path(), "P01", false));
}

}  // namespace

TEST_CASE("Trainer: a participant clicks through a whole study, with its lesson") {
    StudyFolder folder;
    folder.make_short();
    const content::Study study = folder.load();
    Led led(enrolled(study, folder), folder);
    CHECK(led.driver.app().screen() == trainer::ShownScreen::study);
    CHECK(led.due() == "language");
    led.go_to_lesson();
    CHECK(led.participation().progress().language == "de");
    CHECK(led.driver.app().choice().language == "de");

    led.press("study.start");
    REQUIRE(led.driver.app().screen() == trainer::ShownScreen::lesson);
    const trainer::ActiveLesson& lesson = led.driver.lesson();
    CHECK_FALSE(lesson.view.help);
    CHECK(lesson.session->lesson().mode == lesson::Mode::practice);
    SimulatedUser(led.driver).play(300.0);
    led.driver.frame();
    CHECK(led.driver.app().screen() == trainer::ShownScreen::study);
    CHECK(led.due() == "part-1/paper");
    const auto& measures = led.participation().progress().measures.at("part-1/lesson-1");
    CHECK(measures.at("joints_ok") == 1.0);
    CHECK(measures.at("duration_s") > 5.0);

    led.answer_form(4);
    CHECK(led.due() == "after/tlx");
    CHECK(led.participation().progress().answers.at("part-1/paper").size() == 4);
    led.press("study.no_answer");
    led.answer_form(5);
    CHECK(led.due() == "comment");
    led.press("study.next");
    CHECK(led.due() == "farewell");
    led.press("study.finish");
    CHECK(led.due() == "none");
    CHECK(led.driver.app().closed());
    CHECK(led.steps >= 7);

    const study::StudyData data = required(study::collect(study, folder.path()));
    CHECK(data.completed() == 1);
    CHECK(
        std::isnan(study::participant_means(data, {"tlx.workload", study::ObservationTime::after}).front()));
    // The lowest answer to every item.
    CHECK(study::participant_means(data, {"paper.stability"}).front() == 0.0);
    CHECK(led.driver.app().study()->texts().find("Secret") == std::string::npos);
}

TEST_CASE(
    "Trainer: an interrupted lesson of a study continues at the point reached, and its measures count all "
    "parts") {
    StudyFolder folder;
    folder.make_short();
    const content::Study study = folder.load();
    double killed = 0.0, closed = 0.0;
    {
        Led led(enrolled(study, folder), folder);
        led.begin_lesson();
        SimulatedUser(led.driver).play(6.0);
        killed = led.driver.lesson().session->time();
        // The application is not told that it ends, as if the program was killed.
    }
    {
        Led led(resumed(study, folder), folder);
        led.start_again();
        const session::LessonSession& session = *led.driver.lesson().session;
        CHECK(session.time() >= killed);  // and the ticks of a frame
        CHECK(session.time() < killed + 0.2);
        CHECK(led.participation().progress().continued.size() == 1);
        const double angle = session.state().joints.front().nut.angle;
        CHECK(angle > 0.0);
        led.driver.wait(1.0);
        CHECK(session.state().joints.front().nut.angle == doctest::Approx(angle).epsilon(1e-3));
        CHECK(session.state().engagement.joint < 0);
        closed = session.time();
        REQUIRE(led.driver.app().end());
    }
    Led led(resumed(study, folder), folder);
    led.start_again();
    CHECK(led.driver.lesson().session->time() >= closed);
    SimulatedUser(led.driver).play(300.0);
    led.driver.frame();
    CHECK(led.due() == "part-1/paper");
    const study::Progress& progress = led.participation().progress();
    CHECK(progress.interrupted_lessons == 1);
    CHECK(progress.continued.size() == 2);
    CHECK(progress.begun_again.empty());
    const auto& measures = progress.measures.at("part-1/lesson-1");
    CHECK(measures.at("joints_ok") == 1.0);
    CHECK(measures.at("duration_s") > closed + 1.0);
    CHECK(measures.at("duration_s") < closed + 300.0);

    // All three recordings replay, and the last one names the interruptions.
    for (const char* lesson : {"part-1-lesson-1", "part-1-lesson-1-2", "part-1-lesson-1-3"})
        CHECK(mismatches(session_of(folder, lesson)) == 0);
    const auto header = required(session::read_header(session_of(folder, "part-1-lesson-1-3")));
    CHECK(header.continued_after == std::vector<std::uint64_t>{ticks_of(killed), ticks_of(closed)});
    const study::StudyData data = required(study::collect(study, folder.path()));
    const study::Results results = study::analyse(study, data, {.resamples = 100, .seed = 1});
    CHECK(study::results_page(study, data, results)
              .find("1 lesson was interrupted. 2 times, a lesson was continued") != std::string::npos);
    CHECK(study::results_json(study, data, results).find("\"times_continued\": 2") != std::string::npos);
}

TEST_CASE(
    "Trainer: an interrupted assessment continues before the hold of the nut, so the interruption judges "
    "nothing") {
    StudyFolder folder;
    folder.make_short();
    folder.edit(R"("view_help": false)", R"("view_help": false, "mode": "assessment")");
    const content::Study study = folder.load();
    double free = 0.0;
    {
        Led led(enrolled(study, folder), folder);
        led.begin_lesson();
        SimulatedUser(led.driver).play(300.0, 1);  // until the nut is run down
        led.driver.key(platform::Key::t);
        led.driver.wait(4.0);
        const session::LessonSession& session = *led.driver.lesson().session;
        REQUIRE(session.state().engagement.joint < 0);
        free = session.time();
        led.driver.hold(0);
        REQUIRE(session.state().engagement.joint == 0);
        led.driver.wait(0.5);
    }
    Led led(resumed(study, folder), folder);
    led.start_again();
    const session::LessonSession& session = *led.driver.lesson().session;
    CHECK(session.time() > free);
    CHECK(session.time() < free + 4.0);
    CHECK(session.lesson().current == 1);
    led.driver.wait(1.0);
    CHECK(session.lesson().current == 1);
    SimulatedUser(led.driver).play(300.0);
    led.driver.frame();
    CHECK(led.participation().progress().measures.at("part-1/lesson-1").at("joints_ok") == 1.0);
}

TEST_CASE("Trainer: an interrupted lesson with a station continues, and the station with it") {
    StudyFolder folder;
    folder.make_short();
    folder.edit(R"("view_help": false)", R"("view_help": false, "hand": "free")");
    const content::Study study = folder.load();
    double killed = 0.0;
    {
        Led led(enrolled(study, folder), folder);
        led.begin_lesson();
        FreeHandUser(led.driver).play(10.0);
        killed = led.driver.lesson().session->time();
        REQUIRE(killed > 9.0);
    }
    Led led(resumed(study, folder), folder);
    led.start_again();
    CHECK(led.driver.lesson().session->time() == killed);
    CHECK(led.driver.lesson().session->state().joints.front().nut.angle > 0.0);
    FreeHandUser(led.driver).play(400.0);
    led.driver.frame();
    CHECK(led.due() == "part-1/paper");
    CHECK(led.participation().progress().measures.at("part-1/lesson-1").at("joints_ok") == 1.0);
    CHECK(mismatches(session_of(folder, "part-1-lesson-1-2")) == 0);
}

TEST_CASE(
    "Trainer: an interrupted lesson begins again if its recording is damaged, and the reason is recorded") {
    StudyFolder folder;
    folder.make_short();
    const content::Study study = folder.load();
    {
        Led led(enrolled(study, folder), folder);
        led.begin_lesson();
        led.driver.wait(2.0);
        REQUIRE(led.driver.app().end());
    }
    const std::filesystem::path torn = session_of(folder, "part-1-lesson-1");
    std::filesystem::resize_file(torn, std::filesystem::file_size(torn) / 2);
    Led led(resumed(study, folder), folder);
    led.start_again();
    CHECK(led.driver.lesson().session->time() < 1.0);
    CHECK(led.participation().progress().begun_again.size() == 1);
    const auto& log = led.driver.log();
    CHECK(std::any_of(log.begin(), log.end(), [](const std::string& line) {
        return line.find("the interrupted lesson cannot be continued and begins again: ") !=
               std::string::npos;
    }));
    // The participant ends the lesson early: that counts, and joints_ok tells it.
    led.driver.key(platform::Key::escape);
    led.press("menu.end");
    CHECK(led.due() == "part-1/paper");
    CHECK(led.participation().progress().measures.at("part-1/lesson-1").at("joints_ok") == 0.0);
    for (const char* session : {"part-1-lesson-1", "part-1-lesson-1-2"})
        CHECK(std::filesystem::exists(session_of(folder, session)));
}

TEST_CASE("Trainer: a participant can leave, and can withdraw on any page") {
    StudyFolder folder;
    folder.make_short();
    const content::Study study = folder.load();
    {
        Led led(enrolled(study, folder), folder);
        led.press("study.stop");
        led.press("study.continue");
        led.press("study.stop");
        led.press("study.leave");
        CHECK(led.driver.app().closed());
    }
    Led led(required(study::Participation::resume(study, folder.path(), "P01", false)), folder);
    led.go_to_lesson();
    led.press("study.stop");
    led.press("study.withdraw");
    CHECK(std::filesystem::exists(folder.path() / "participants/P01" / study::journal_file_name));
    led.press("study.delete");
    CHECK_FALSE(std::filesystem::exists(folder.path() / "participants/P01" / study::journal_file_name));
    led.press("study.finish");
    CHECK(led.driver.app().closed());
}

TEST_CASE("Trainer: a double click answers one item, and a consent can be taken back") {
    StudyFolder folder;
    folder.make_short();
    const content::Study study = folder.load();
    Led led(enrolled(study, folder), folder);
    led.press("study.language");
    led.press("study.next");
    led.press("study.next");
    REQUIRE(led.due() == "consent");
    led.press("study.consent");
    CHECK(led.participation().agreed(0));
    led.press("study.consent");
    CHECK_FALSE(led.participation().agreed(0));
    while (!led.participation().agreed(1)) led.agree();
    led.press("study.next");
    led.press("study.start");
    led.driver.key(platform::Key::escape);
    led.press("menu.settings");
    for (const trainer::DrawnWidget& widget : led.driver.app().drawn_widgets())
        CHECK(widget.label != words::TextKey("menu.force_scale"));
    led.driver.key(platform::Key::escape);  // back to the pause
    led.driver.frame();
    led.press("menu.end");
    REQUIRE(led.due() == "part-1/paper");
    glm::dvec2 at{0.0};
    for (const trainer::DrawnWidget& widget : led.driver.app().drawn_widgets())
        if (widget.label == words::TextKey("study.item") && at == glm::dvec2{0.0})
            at = glm::dvec2(widget.middle);
    led.driver.wait(1.0);
    const auto click = [&] {
        for (const bool down : {true, false})
            led.driver.frame(
                {platform::CursorEvent{at}, platform::ButtonEvent{platform::Button::left, down, at}}, 0.03);
    };
    click();
    click();
    led.driver.wait(1.0);
    CHECK(led.participation().progress().answers.at("part-1/paper").size() == 1);
    click();
    led.driver.wait(0.2);
    CHECK(led.participation().progress().answers.at("part-1/paper").size() == 2);
}

TEST_CASE("Trainer: an answer that cannot be stored is shown and asked again") {
    StudyFolder folder;
    folder.make_short();
    const content::Study study = folder.load();
    Led led(enrolled(study, folder), folder);
    led.begin_lesson();
    led.driver.key(platform::Key::escape);
    led.press("menu.end");
    REQUIRE(led.due() == "part-1/paper");
    const auto own = folder.path() / "participants/P01";
    // SQLite cannot make its journal of the transaction in place of a folder.
    std::filesystem::create_directory(own / (std::string(study::journal_file_name) + "-journal"));
    led.press("study.item");
    CHECK_FALSE(led.participation().progress().answers.contains("part-1/paper"));
    std::filesystem::remove(own / (std::string(study::journal_file_name) + "-journal"));
    led.press("study.item");
    CHECK(led.participation().progress().answers.at("part-1/paper").size() == 1);
}

}  // namespace trainer_study_test
