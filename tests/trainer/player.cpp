#include "tests/trainer/player.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "content/format/assembly.hpp"
#include "game/lesson/step_requirements.hpp"

namespace trainer_test {

using trainer::HandAction;

content::Assembly assembly(const char* name) {
    content::LoadedAssembly loaded = content::load_assembly(name);
    REQUIRE(loaded.ok());
    return std::move(loaded.assembly);
}

trainer::MouseCommand next_command(Player& p, const session::LessonSession& session, double seconds) {
    trainer::MouseCommand command;
    const lesson::LessonStep* due = session.lesson().due();
    if (due == nullptr) return command;
    if (p.step != session.lesson().current) p.peak = 0.0;
    p.step = session.lesson().current;
    const bool fingers = due->kind == lesson::StepKind::run_down;
    const bool loosens = due->kind == lesson::StepKind::loosen;
    const joint::JointState& joint = session.state().joints[due->joint];
    const bool on = session.state().engagement.joint == static_cast<int>(due->joint);
    if (on) p.peak = std::max(p.peak, loosens ? -joint.torque : joint.torque);
    p.wait_left = std::max(0.0, p.wait_left - seconds);
    if (!p.button_down) {
        if (p.hand.action != HandAction::resting || p.wait_left > 0.0) return command;
        if (p.hand.wrench == fingers) {
            (fingers ? command.lay_down : command.take_wrench) = true;
            return command;
        }
        p.button_down = true;
        ++p.presses;
        command.nut = due->joint;
        command.loosens = loosens;
        command.button_down = true;
        return command;
    }
    // The joint in the hand may be done already.
    bool enough = p.hand.nut && *p.hand.nut != due->joint;
    if (on && fingers) {
        command.spin = loosens ? -1.0 : 1.0;
        enough = joint.stage != joint::Stage::navigation;
    } else if (on) {
        const bool yields = session.state().joints[due->joint].stage == joint::Stage::yield;
        const bool until_yield = lesson::requires_yield(session.lesson(), *due);
        enough = loosens       ? joint.stage == joint::Stage::navigation
                 : until_yield ? yields && p.peak >= lesson::torque_window(session.lesson(), *due).low
                               : p.peak >= due->torque;
        const double missing = loosens ? 1.0 : std::max(0.15, 1.0 - p.peak / due->torque);
        command.turn = (loosens ? -1.0 : 1.0) * 1.2 * missing * seconds;
        const double swung = std::abs(p.hand.handle_angle - p.hand.stroke_begin);
        enough = enough || swung > 0.97 * p.hand.free_swing;
    }
    command.button_down = p.button_down =
        p.hand.button_down || p.hand.action == HandAction::reaching || p.hand.action == HandAction::lowering;
    if (enough || (p.hand.missed && p.hand.action == HandAction::resting)) {
        command.button_down = p.button_down = false;
        p.wait_left = 0.1;
    }
    return command;
}

}  // namespace trainer_test
