// A study in a room: its pages are a panel, on which the hands press the buttons.
#include <doctest/doctest.h>

#include "tests/room/immersive_driver.hpp"
#include "tests/study/support.hpp"

namespace room_study_test {

using namespace bolt;
using namespace bolt::trainer;

TEST_CASE("Room: a participant reads a study on the panel and presses its buttons by the trigger") {
    const study_test::StudyFolder folder;
    folder.make_short();
    const content::Study study = folder.load();
    AppOptions options = test::options("first-nut", false);
    options.choice.equipment.hand = HandMode::tracked;
    options.out = folder.path();
    test::HeadlessTrainer driver(
        options, {test::eye_size(), 0.3F, 0.02},
        StudyRun{study_test::required(study::Participation::enrol(study, folder.path(), "T-1", false)),
                 folder.path()});
    driver.immersive = test::standing_user(test::eye_size());
    for (int i = 0; i < 40; ++i) driver.frame();
    test::save_eyes(driver, "study");
    const auto due = [&] { return driver.app().study()->participation().due()->id; };
    const auto press = [&](words::TextKey label) {
        test::press_on_panel(driver, label);
        driver.frame();
    };
    press("study.language");
    press("study.next");
    CHECK(due() == "information");
    press("study.next");
    CHECK(due() == "consent");
    const auto& participation = driver.app().study()->participation();
    press("study.consent");
    CHECK(participation.agreed(0));
    CHECK_FALSE(participation.agreed(1));
    press("study.next");
    CHECK(due() == "consent");  // one statement is left
    test::save_eyes(driver, "consent");
    // The second box: the widgets are listed in their order.
    std::vector<DrawnWidget> boxes;
    for (const DrawnWidget& widget : driver.app().drawn_widgets())
        if (widget.label == words::TextKey("study.consent")) boxes.push_back(widget);
    REQUIRE(boxes.size() == 2);
    for (const float select : {0.0F, 0.0F, 1.0F, 1.0F, 0.0F, 0.0F}) test::point_at(driver, boxes[1], select);
    driver.frame();
    CHECK(participation.agreed(1));
    press("study.next");
    REQUIRE(due() == "part-1/lesson-1");
    press("study.start");
    CHECK(driver.app().screen() == ShownScreen::lesson);
    CHECK(driver.app().lesson()->station->tracked.has_value());
}

}  // namespace room_study_test
