// A lesson by mouse in which a second wrench must hold the head of the bolt.
#include <doctest/doctest.h>

#include <algorithm>

#include "tests/support/sanitized.hpp"
#include "tests/support/second_wrench.hpp"
#include "tests/support/skip.hpp"
#include "tests/trainer_app/headless_trainer.hpp"
#include "tests/trainer_app/simulated_user.hpp"

namespace second_wrench_test {

using namespace bolt;
using namespace bolt::trainer;

namespace {

bool is_drawn(const ActiveLesson& active) {
    const scene::SceneWorld& world = active.workplace.world;
    bool drawn = false;
    for (const ecs::Entity part : world.pool<scene::SecondWrenchPart>().entities())
        drawn = drawn || !world.find<scene::Appearance>(part)->hidden;
    return drawn;
}

}  // namespace

TEST_CASE("Trainer: a key puts the second wrench on the head of a bolt that turns with its nut") {
    if (test::sanitized) return test::skip_rest("a lesson takes minutes under a sanitizer");
    const test::Folder folder;
    AppOptions options = test::options("", false);
    options.choice.assembly = test::lesson_with_second_wrench(folder).parent_path().string();
    options.out = folder / "out";
    test::HeadlessTrainer driver(options);
    driver.frame();
    driver.key(platform::Key::i);  // hide the close-up: it doubles the rendering time
    const ActiveLesson& active = driver.lesson();
    test::SimulatedUser user(driver);
    user.play(200.0, 1);
    REQUIRE(active.session->lesson().current == 1);
    // The fingers of the other hand have held the head.
    CHECK(active.session->state().joints[0].common_turn == 0.0);
    CHECK_FALSE(is_drawn(active));

    for (int i = 0; i < 20 && !active.guidance.mistakes.shown; ++i)
        user.play(active.session->time() + 1.0, 2);
    REQUIRE(active.guidance.mistakes.shown);
    CHECK(active.guidance.mistakes.shown->kind == lesson::MistakeKind::turned_together);
    CHECK(active.session->state().joints[0].common_turn > 0.3);
    CHECK(active.session->lesson().current == 1);  // an undo would mend nothing

    driver.key(platform::Key::g);
    driver.frame();
    CHECK(active.second_wrench == 0);
    CHECK(is_drawn(active));
    const double turned = active.session->state().joints[0].common_turn;
    user.play(300.0, 2);
    CHECK(active.session->state().joints[0].common_turn == turned);
    driver.frame();
    REQUIRE(driver.outcome());
    CHECK(driver.outcome()->result.finished);
    CHECK(driver.outcome()->result.joints[0].overall == lesson::Verdict::ok);
    CHECK(driver.outcome()->result.score < 100.0);
}

TEST_CASE("Trainer: a joint with a fixed head needs no second wrench") {
    test::HeadlessTrainer driver(test::options("first-nut", false));
    driver.frame();
    driver.key(platform::Key::g);
    driver.frame();
    CHECK(driver.lesson().second_wrench == -1);
}

}  // namespace second_wrench_test
