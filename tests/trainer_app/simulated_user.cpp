#include "tests/trainer_app/simulated_user.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "game/lesson/step_requirements.hpp"

namespace bolt::test {

using namespace trainer;

namespace {

constexpr double fastest_drag = 0.9;    // rad/s of the handle
constexpr double slowest_share = 0.08;  // of fastest_drag, just below the target torque
constexpr double longest_hold = 12.0;   // s
constexpr double spent = 0.03;          // fraction of the room left at which the handle is set back
// Drag that spins a nut, relative to the picture's width: to the right, at a left-hand thread to the left.
constexpr double twist_of_width = 0.34;
constexpr double edge = 4.0;  // px

}  // namespace

void SimulatedUser::play(double longest, std::size_t steps) {
    while (going() && now() < longest && lesson().session->lesson().current < steps) {
        if (due() == nullptr)
            driver_.frame();
        else
            do_step();
    }
}

void SimulatedUser::wait(double seconds) {
    for (const double until = now() + seconds - 1e-6; going() && now() < until;) driver_.frame();
}

void SimulatedUser::do_step() {
    const bool fingers = due()->kind == lesson::StepKind::run_down;
    if (hand_of(lesson()).wrench == fingers) {
        driver_.key(platform::Key::t);
        for (int i = 0; i < 200 && hand_of(lesson()).wrench == fingers; ++i) driver_.frame();
        return;
    }
    const auto at = nut_on_screen();
    if (!at) {
        ++view_searches;
        REQUIRE(view_searches < 100);
        driver_.key(platform::Key::v);
        wait(0.8);
        return;
    }
    ++presses;
    const double pressed = now();
    driver_.press(*at);
    const std::size_t joint = due()->joint;
    glm::dvec2 pointer = *at;
    dragged_ = now();
    while (going() && due() != nullptr && lesson().helped_hand.button_down && now() - pressed < longest_hold)
        if (fingers ? spin(*at, pointer) : pull(joint, pointer)) break;
    driver_.release(pointer);
    wait(0.5);
}

std::optional<glm::dvec2> SimulatedUser::nut_on_screen() {
    const servo::Setup& setup = lesson().session->setup();
    const std::size_t joint = due()->joint;
    const auto at =
        project(driver_.projection(),
                servo::nut_centre(setup.nuts[joint], lesson().session->state().joints[joint].nut.angle));
    if (!at || at->x < edge || at->y < edge || at->x > driver_.size().x - edge ||
        at->y > driver_.size().y - edge)
        return {};
    driver_.move(*at);
    if (lesson().pointer.nut != joint) return {};
    return at;
}

bool SimulatedUser::spin(const glm::dvec2& from, glm::dvec2& pointer) {
    const double sense = lesson().session->setup().nuts[due()->joint].sense;
    pointer = from + glm::dvec2(sense * twist_of_width * driver_.size().x, 0.0);
    driver_.move(pointer);
    return !hand_of(lesson()).nut ||
           lesson().session->state().joints[*hand_of(lesson()).nut].stage != joint::Stage::navigation;
}

bool SimulatedUser::pull(std::size_t joint, glm::dvec2& pointer) {
    const session::LessonSession& session = *lesson().session;
    const servo::Setup& setup = session.setup();
    const double since = std::exchange(dragged_, now());
    if (hand_of(lesson()).action != HandAction::holding ||
        session.state().engagement.joint != static_cast<int>(joint)) {
        driver_.frame();
        return false;
    }
    const lesson::LessonStep& step_due = *due();
    const double torque = session.state().joints[joint].torque;
    const bool yields = session.state().joints[joint].stage == joint::Stage::yield;
    const double until = torque_share * step_due.torque;
    if (lesson::requires_yield(session.lesson(), step_due) ? yields : torque >= until) return true;
    if (hand_of(lesson()).free_swing < spent * lesson().helped_hand.free_swing) return true;
    // A drag along the lever turns the handle clockwise.
    const servo::NutGeometry& nut = setup.nuts[joint];
    const glm::dvec2 lever = nut.sense * lever_on_screen(driver_.projection(), tool_of(lesson()).pose,
                                                         nut.axis, setup.wrench.handle_length);
    const double share = std::max(slowest_share, 1.0 - torque / until);
    pointer += lever * (fastest_drag * share * (now() - since));
    driver_.move(pointer);
    return false;
}

}  // namespace bolt::test
