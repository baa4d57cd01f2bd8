#include "tests/dead_ends/lesson_run.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "game/lesson/step_requirements.hpp"

namespace dead_ends {

namespace {

constexpr double fastest_hand = 0.03;  // m per tick; the servo rejects faster motion

}  // namespace

LessonRun::LessonRun(session::LessonSession& lesson_session, InvariantChecker& invariant_checker)
    : session(lesson_session), checker(invariant_checker) {
    world::add_haptics(world, session.state());
    player.hand = trainer::make_hand({Vec3(0.0, 0.05, 0.35), Quat(1, 0, 0, 0)});
    last.commanded_tool = servo::to_commanded_tool(player.hand.pose);
}

bool LessonRun::tick(servo::TickInput input, bool wrench_in_hand, double free_swing, bool hint_key) {
    input.set_torque = static_cast<float>(set_torque_scale * lesson::wrench_set_torque(session.lesson()));
    const auto stepped = session.tick(world, input);
    if (!stepped) {
        checker.report(stepped.error().message());
        return false;
    }
    output = *stepped;
    last = input;
    checker.tick(output);
    if (session.state().tick % frame_ticks == 0) checker.frame(output, wrench_in_hand, free_swing, hint_key);
    return true;
}

void LessonRun::frame(trainer::MouseCommand command, std::optional<std::size_t> undo_steps, bool hint_key) {
    trainer::HelpedHand& hand = player.hand;
    if (undo_steps) trainer::request_undo(undo, session.lesson(), *undo_steps);
    if (undo.target && hand.nut) command.retreat = true;
    trainer::apply_command(hand, command, session.setup(), session.state());
    for (int i = 0; i < frame_ticks && !over(); ++i) {
        const Vec3 before = hand.pose.position;
        servo::TickInput input = trainer::step_hand(hand, session.setup(), session.state());
        if (const lesson::LessonStep* due = session.lesson().due(); due != nullptr && session.lesson().guides)
            input.guided_joint = static_cast<std::int16_t>(due->joint);
        const auto steps = trainer::steps_to_undo(undo, session.lesson());
        if (steps && hand.action == trainer::HandAction::resting && !hand.nut) session.request_undo(*steps);
        double room = std::numeric_limits<double>::infinity();
        if (hand.wrench && hand.action == trainer::HandAction::holding)
            room = hand.free_swing - std::abs(hand.handle_angle - hand.stroke_begin);
        double leap = glm::distance(before, hand.pose.position);
        // After a miss the hand continues from the pose at which an obstacle stopped the wrench.
        if (session.state().tool_contact && hand.wrench)
            leap = std::min(leap,
                            glm::distance(session.state().tool_contact->god_object.constrained_tool.position,
                                          hand.pose.position));
        if (!(leap < fastest_hand))
            checker.report(fmt::format("the helped hand jumps by {:.1f} mm during action {}", 1e3 * leap,
                                       static_cast<int>(hand.action)));
        if (!tick(input, hand.wrench, room, hint_key)) return;
        for (const lesson::LessonEvent& event : session.events())
            trainer::observe(undo, session.lesson(), event);
    }
    trainer::update(undo, frame_seconds);
}

}  // namespace dead_ends
