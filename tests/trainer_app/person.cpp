#include "tests/trainer_app/person.hpp"

#include <doctest/doctest.h>

#include <algorithm>

namespace bolt::test {

using namespace trainer;  // what it is all about

namespace {

constexpr double fastest_drag = 0.9;     // rad/s of the handle
constexpr double slowest_share = 0.08;   // of that, before the torque that is sought
constexpr double longest_hold = 12.0;    // s
constexpr double spent = 0.03;           // of the room to swing: then the handle is set back
constexpr double twist_of_width = 0.34;  // of the picture, to the right of the nut: spins it by hand
constexpr double edge = 4.0;             // px

}  // namespace

void Person::play(double longest, std::size_t steps) {
    while (going() && now() < longest && p().course->lesson().current < steps) {
        if (due() == nullptr)
            seat_.frame();
        else
            do_step();
    }
}

void Person::wait(double seconds) {
    for (const double until = now() + seconds - 1e-6; going() && now() < until;) seat_.frame();
}

void Person::do_step() {
    const bool fingers = due()->kind == lesson::StepKind::run_down;
    if (hand_of(p()).wrench == fingers) {
        seat_.key(platform::Key::t);
        for (int i = 0; i < 200 && hand_of(p()).wrench == fingers; ++i) seat_.frame();
        return;
    }
    const auto at = nut_on_screen();
    if (!at) {
        ++looks;
        REQUIRE(looks < 100);
        seat_.key(platform::Key::v);
        wait(0.8);
        return;
    }
    ++presses;
    const double pressed = now();
    seat_.press(*at);
    const std::size_t joint = due()->joint;
    glm::dvec2 pointer = *at;
    dragged_ = now();
    while (going() && due() != nullptr && p().mouse.held && now() - pressed < longest_hold)
        if (fingers ? spin(*at, pointer) : pull(joint, pointer)) break;
    seat_.release(pointer);
    wait(0.5);
}

std::optional<glm::dvec2> Person::nut_on_screen() {
    const servo::Setup& setup = p().course->setup();
    const std::size_t joint = due()->joint;
    const auto at = project(
        seat_.screen(), servo::nut_centre(setup.nuts[joint], p().course->state().joints[joint].nut.angle));
    if (!at || at->x < edge || at->y < edge || at->x > seat_.size().x - edge || at->y > seat_.size().y - edge)
        return {};
    seat_.move(*at);
    if (p().pointing.nut != joint) return {};
    return at;
}

bool Person::spin(const glm::dvec2& from, glm::dvec2& pointer) {
    pointer = from + glm::dvec2(twist_of_width * seat_.size().x, 0.0);
    seat_.move(pointer);
    return !hand_of(p()).nut ||
           p().course->state().joints[*hand_of(p()).nut].stage != joint::Stage::navigation;
}

bool Person::pull(std::size_t joint, glm::dvec2& pointer) {
    const session::Course& course = *p().course;
    const servo::Setup& setup = course.setup();
    const double since = std::exchange(dragged_, now());
    if (hand_of(p()).doing != Doing::holding || course.state().engagement.joint != static_cast<int>(joint)) {
        seat_.frame();
        return false;
    }
    const lesson::Step& step_due = *due();
    const double torque = course.state().joints[joint].torque;
    const bool yields = course.state().joints[joint].stage == joint::Stage::yield;
    const double until = sought * step_due.torque;
    if (lesson::into_yield(course.lesson(), step_due) ? yields : torque >= until) return true;
    if (hand_of(p()).room < spent * p().mouse.room) return true;
    const glm::dvec2 lever = lever_on_screen(seat_.screen(), tool_of(p()).pose, setup.nuts[joint].axis,
                                             setup.wrench.handle_length);
    const double share = std::max(slowest_share, 1.0 - torque / until);
    pointer += lever * (fastest_drag * share * (now() - since));
    seat_.move(pointer);
    return false;
}

}  // namespace bolt::test
