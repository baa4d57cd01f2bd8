#include "tests/trainer/player.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "content/format/assembly.hpp"

namespace trainer_test {

using trainer::Doing;

content::Assembly assembly(const char* name) {
    content::Loaded loaded = content::load_assembly(name);
    REQUIRE(loaded.ok());
    return std::move(loaded.assembly);
}

trainer::Wish wish_of(Player& p, const session::Course& course, double seconds) {
    trainer::Wish wish;
    const lesson::Step* due = course.lesson().due();
    if (due == nullptr) return wish;
    if (p.step != course.lesson().current) p.peak = 0.0;
    p.step = course.lesson().current;
    const bool fingers = due->kind == lesson::StepKind::run_down;
    const bool loosens = due->kind == lesson::StepKind::loosen;
    const joint::JointState& joint = course.state().joints[due->joint];
    const bool on = course.state().engagement.joint == static_cast<int>(due->joint);
    if (on) p.peak = std::max(p.peak, loosens ? -joint.torque : joint.torque);
    p.waited = std::max(0.0, p.waited - seconds);
    if (!p.held) {
        if (p.hand.doing != Doing::resting || p.waited > 0.0) return wish;
        if (p.hand.wrench == fingers) {
            (fingers ? wish.lay_down : wish.wrench) = true;
            return wish;
        }
        p.held = true;
        ++p.presses;
        wish.nut = due->joint;
        wish.loosens = loosens;
        wish.held = true;
        return wish;
    }
    // What it still has is done already.
    bool enough = p.hand.nut && *p.hand.nut != due->joint;
    if (on && fingers) {
        wish.spin = loosens ? -1.0 : 1.0;
        enough = joint.stage != joint::Stage::navigation;
    } else if (on) {
        const bool yields = course.state().joints[due->joint].stage == joint::Stage::yield;
        const bool until_yield = lesson::into_yield(course.lesson(), *due);
        enough = loosens       ? joint.stage == joint::Stage::navigation
                 : until_yield ? yields && p.peak >= lesson::window(course.lesson(), *due).low
                               : p.peak >= due->torque;
        const double missing = loosens ? 1.0 : std::max(0.15, 1.0 - p.peak / due->torque);
        wish.turn = (loosens ? -1.0 : 1.0) * 1.2 * missing * seconds;
        const double swung = std::abs(p.hand.handle - p.hand.begun_at);
        enough = enough || swung > 0.97 * p.hand.room;
    }
    wish.held = p.held = p.hand.held || p.hand.doing == Doing::reaching || p.hand.doing == Doing::lowering;
    if (enough || (p.hand.missed && p.hand.doing == Doing::resting)) {
        wish.held = p.held = false;
        p.waited = 0.1;
    }
    return wish;
}

}  // namespace trainer_test
