// A participant of a study in the trainer: pages, lessons, interruptions.
#include "game/study_results/results.hpp"
#include "tests/study/support.hpp"
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
    void answer_form(std::size_t items) {
        for (std::size_t i = 0; i < items; ++i) press("study.item");
        press("study.next");
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

study::Participation enrolled(const content::Study& study, const StudyFolder& folder) {
    return required(study::Participation::enrol(study, folder.path(), "T-1", false));
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

TEST_CASE("Trainer: a lesson of a study that the program's end interrupts begins again") {
    StudyFolder folder;
    folder.make_short();
    const content::Study study = folder.load();
    {
        Led led(enrolled(study, folder), folder);
        led.go_to_lesson();
        led.press("study.start");
        led.driver.wait(2.0);
        REQUIRE(led.driver.app().end());
    }
    Led led(required(study::Participation::resume(study, folder.path(), "P01", false)), folder);
    CHECK(led.driver.app().screen() == trainer::ShownScreen::study);
    CHECK(led.due() == "part-1/lesson-1");
    CHECK(led.driver.app().choice().language == "de");
    led.press("study.start");
    REQUIRE(led.driver.app().screen() == trainer::ShownScreen::lesson);
    CHECK(led.participation().progress().interrupted.size() == 1);
    // The participant ends the lesson early: that counts, and joints_ok tells it.
    led.driver.key(platform::Key::escape);
    led.press("menu.end");
    CHECK(led.due() == "part-1/paper");
    CHECK(led.participation().progress().measures.at("part-1/lesson-1").at("joints_ok") == 0.0);
    for (const char* session : {"part-1-lesson-1", "part-1-lesson-1-2"})
        CHECK(std::filesystem::exists(folder.path() / "participants/P01" / session / "session.boltwright"));
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
    led.go_to_lesson();
    led.press("study.start");
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
