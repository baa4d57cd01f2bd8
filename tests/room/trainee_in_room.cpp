#include "tests/room/trainee_in_room.hpp"

#include <algorithm>

#include "game/lesson/step_requirements.hpp"
#include "haptics/collision/jaw.hpp"
#include "haptics/servo/engagement.hpp"

namespace bolt::test {

namespace {

constexpr double ipd = 0.063;                  // m
constexpr double eye_height = 1.65;            // m
constexpr double fov = to_radians(45.0);       // to each side
constexpr double hand_speed = 0.35;            // m/s
constexpr double hand_turn = 3.0;              // rad/s
constexpr double correction = 6.0;             // 1/s, rate at which the visible error is corrected
constexpr double gaze_rate = 2.0;              // 1/s, at which the head turns to what it looks at
constexpr double forearm = to_radians(100.0);  // rad by which a nut is turned before the fingers regrasp
constexpr double stroke = to_radians(50.0);    // rad of a pull
constexpr double pull_speed = 0.6;             // rad/s
constexpr double aligned = to_radians(4.0);
constexpr double level_error = 0.004;           // m beside the bolt's axis at which the jaw may go down
constexpr double hover = 0.045;                 // m above the nut
constexpr double rises[] = {0.13, 0.25, 0.45};  // m

}  // namespace

view::EyeGroup two_eyes(const Pose& head, VkExtent2D size) {
    view::EyeGroup group{size, {}};
    for (const double side : {-0.5, 0.5})
        group.eyes.push_back(render::make_eye(head * Pose{{side * ipd, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}},
                                              {-fov, fov, fov, -fov}, view::immersive_range.near,
                                              view::immersive_range.far));
    return group;
}

Pose standing_head() {
    return {{0.0, eye_height, 0.0}, glm::angleAxis(to_radians(-20.0), Vec3(1.0, 0.0, 0.0))};
}

view::ImmersiveFrame standing_user(VkExtent2D size) {
    view::ImmersiveFrame immersive;
    immersive.head = standing_head();
    immersive.tracked = immersive.attentive = immersive.tracks_hands = true;
    immersive.groups = {two_eyes(immersive.head, size)};
    return immersive;
}

Vec3 TraineeInRoom::nut(std::size_t joint) const {
    return servo::nut_centre(setup().nuts[joint], state().joints[joint].nut.angle);
}

bool TraineeInRoom::going_on(std::size_t joint) const {
    return going() && due() != nullptr && due()->joint == joint;
}

Pose TraineeInRoom::tool() const {
    return wrench() ? trainer::tool_of(lesson()).pose : trainer::hand_of(lesson()).pose;
}

void TraineeInRoom::frame(const Pose& palm, double closed) {
    palm_ = palm;
    const trainer::RoomState& room = *driver_.app().room();
    xr::Hands hands;
    xr::HandInput& hand = hands[side_];
    hand.active = true;
    hand.grasp = static_cast<float>(closed);
    if (room.workpiece) {
        const Pose assembly =
            trainer::adjusted(*room.workpiece, lesson().workplace.workpiece, room.turns, room.height);
        hand.grip = xr::ReportedPose{assembly * palm_, true};
        look_at(assembly *
                (0.5 * (tool().position + (due() != nullptr ? nut(due()->joint) : tool().position))));
    }
    driver_.frame(head, hands);
    on_frame();
}

// Turns the head, without tilting it to a side.
void TraineeInRoom::look_at(const Vec3& target) {
    const Vec3 along = target - head.position;
    const double yaw = std::atan2(-along.x, -along.z),
                 pitch = std::atan2(along.y, std::hypot(along.x, along.z));
    const Quat seen = glm::angleAxis(yaw, Vec3(0.0, 1.0, 0.0)) * glm::angleAxis(pitch, Vec3(1.0, 0.0, 0.0));
    head.orientation = glm::slerp(head.orientation, seen, std::min(1.0, gaze_rate * driver_.step()));
}

void TraineeInRoom::hold_still(double seconds, double closed) {
    for (double t = 0.0; t < seconds && going(); t += driver_.step()) frame(palm_, closed);
}

Pose TraineeInRoom::moved_palm(const Vec3& along, const Vec3& about) const {
    const double step = driver_.step();
    const Vec3 way = force::clamp_length(std::min(1.0, correction * step) * along, hand_speed * step);
    const Quat turn =
        rotation(force::clamp_length(std::min(1.0, correction * step) * about, hand_turn * step));
    // The fingertips are beside the palm, the end of the handle is in it.
    const Vec3 reference = wrench() ? palm_.position : palm_ * trainer::fingertips_at_palm(side_).position;
    return {reference + way + turn * (palm_.position - reference), glm::normalize(turn * palm_.orientation)};
}

bool TraineeInRoom::lead_to(const Pose& target, double near, double longest, double closed) {
    const double length = wrench() ? setup().wrench.handle_length : 0.0;
    for (const double until = now() + longest; going() && now() < until;) {
        if (engaged() >= 0) return false;
        const Pose at = tool();
        const Vec3 error = target * Vec3(length, 0.0, 0.0) - at * Vec3(length, 0.0, 0.0);
        const Vec3 turn = turn_between(at.orientation, target.orientation);
        if (glm::length(error) < near && glm::length(turn) < to_radians(6.0)) return true;
        frame(moved_palm(error, turn), closed);
    }
    return false;
}

// Turns the hand about the fingertips.
void TraineeInRoom::twist(double angle, const Vec3& axis, double closed) {
    const double step = driver_.step(), rate = 4.0;
    for (double turned = 0.0; turned < std::abs(angle) && going(); turned += rate * step) {
        const Quat by = glm::angleAxis(std::copysign(rate * step, angle), axis);
        const Vec3 tips = palm_ * trainer::fingertips_at_palm(side_).position;
        frame({tips + by * (palm_.position - tips), glm::normalize(by * palm_.orientation)}, closed);
    }
}

void TraineeInRoom::run_down(std::size_t joint) {
    if (wrench()) return hold_still(0.2, 0.0);  // lays it down
    const std::size_t step = lesson().session->lesson().current;
    const Vec3 axis = setup().nuts[joint].axis;
    const auto at_nut = [&](double above) {
        // The fingers point against the axis.
        const Vec3 back = tool().orientation * Vec3(0.0, 0.0, 1.0);
        const Quat to_axis = glm::normalize(Quat(1.0 + glm::dot(back, axis), glm::cross(back, axis)));
        return Pose{nut(joint) + above * axis, glm::normalize(to_axis * tool().orientation)};
    };
    lead_to(at_nut(0.1), 0.02, 5.0, 0.0);
    lead_to(at_nut(0.0), 0.006, 4.0, 0.0);
    for (int i = 0; i < 60 && going_on(joint) && lesson().session->lesson().current == step &&
                    state().joints[joint].stage == joint::Stage::navigation;
         ++i) {
        hold_still(0.1, 1.0);
        twist(-forearm, axis, 1.0);
        hold_still(0.1, 0.0);
        twist(forearm, axis, 0.0);
        lead_to(at_nut(0.0), 0.006, 2.0, 0.0);
    }
    lead_to(at_nut(0.1), 0.02, 2.0, 0.0);
}

void TraineeInRoom::take_wrench() {
    const Pose rest = trainer::hand_of(lesson()).rest;
    const double length = setup().wrench.handle_length;
    const Vec3 end = rest * Vec3(length, 0.0, 0.0);
    lead_to({end + Vec3(0.0, 0.12, 0.0), tool().orientation}, 0.02, 5.0, 0.0);
    lead_to({end + Vec3(0.0, 0.02, 0.0), tool().orientation}, 0.01, 4.0, 0.0);
    hold_still(0.5, 1.0);
}

bool TraineeInRoom::lower(std::size_t joint, const Pose& seated) {
    const servo::NutGeometry& geometry = setup().nuts[joint];
    const Vec3 up = geometry.axis;
    for (const double until = now() + 6.0; going_on(joint) && now() < until;) {
        if (engaged() >= 0) return engaged() == static_cast<int>(joint);
        const Pose at = tool();
        const Vec3 error = seated.position - at.position;
        const Vec3 level = error - glm::dot(error, up) * up;
        const collision::HeadFit fit = collision::head_fit(
            setup().wrench.head, servo::shape_of(geometry),
            servo::pose_in_nut_frame(geometry, state().joints[joint], servo::tool_pose(at)));
        const Vec3 handle = at.orientation * Vec3(setup().wrench.handle_length, 0.0, 0.0);
        const Vec3 swing = fit.misalignment * glm::cross(up, handle);
        const bool fits = std::abs(fit.misalignment) < aligned && glm::length(level) < level_error;
        const double height =
            fits ? 0.0 : 0.8 * geometry.height + 0.5 * collision::thickness(setup().wrench.head);
        const Vec3 normal = at.orientation * Vec3(0.0, 0.0, 1.0);
        frame(moved_palm(level + swing + (glm::dot(error, up) + height) * up, glm::cross(normal, up)), 1.0);
    }
    return false;
}

void TraineeInRoom::tighten(std::size_t joint) {
    if (!wrench()) return take_wrench();
    ++approaches;
    const servo::NutGeometry& geometry = setup().nuts[joint];
    const Vec3 up = geometry.axis;
    const auto& contact = state().tool_contact;
    const double nut_angle = state().joints[joint].nut.angle;
    const motion::HandleAngle side = motion::choose_handle_angle(
        setup(), contact ? &*contact : nullptr, joint, state().joints[joint],
        nut_angle + setup().wrench.head_angle + approaches * pi / 3.0, 1.0, stroke);
    const double above =
        contact ? motion::hover_height(setup(), *contact, joint, nut_angle, side, hover) : hover;
    const Pose seated{nut(joint), motion::tool_orientation(geometry, side.angle, side.flipped)};
    const Pose over{nut(joint) + above * up, seated.orientation};
    const double rise = rises[0] + std::max(glm::dot(tool().position, up), glm::dot(over.position, up));
    const auto raised = [&](const Pose& pose) {
        return pose.position + (rise - glm::dot(pose.position, up)) * up;
    };
    const Pose from = tool();
    lead_to({raised(from), from.orientation}, 0.02, 4.0, 1.0);
    lead_to({raised(from), over.orientation}, 0.02, 4.0, 1.0);
    lead_to({raised(over), over.orientation}, 0.02, 4.0, 1.0);
    lead_to(over, 0.006, 4.0, 1.0);
    if (lower(joint, seated)) pull(joint, side.free_swing);
    lift(up);
}

void TraineeInRoom::pull(std::size_t joint, double room) {
    const Vec3 axis = setup().nuts[joint].axis;
    const double step = driver_.step();
    double pushed = 0.0;
    // Down until the jaw is on the nut, then round.
    for (const double until = now() + 0.4; going() && now() < until && pushed < 0.01; pushed += 0.03 * step)
        frame({palm_.position - 0.03 * step * axis, palm_.orientation}, 1.0);
    const double begin = state().engagement.hand_angle;
    double furthest = begin, moved = now();
    while (going_on(joint) && engaged() == static_cast<int>(joint)) {
        const double torque = state().joints[joint].torque, until = torque_share * due()->torque;
        const bool yields = state().joints[joint].stage == joint::Stage::yield;
        if (lesson::requires_yield(lesson().session->lesson(), *due()) ? yields : torque >= until) break;
        const double angle = state().engagement.hand_angle;
        if (angle > furthest + 0.01) furthest = angle, moved = now();
        if (angle - begin > std::min(room, stroke) || now() > moved + 2.0) break;
        const double rate = pull_speed * std::clamp(1.0 - torque / until, 0.08, 1.0);
        const Quat by = glm::angleAxis(-rate * step, axis);
        const Vec3 centre = nut(joint);
        frame({centre + by * (palm_.position - centre), glm::normalize(by * palm_.orientation)}, 1.0);
    }
    // The hand lets the wrench spring back before it lifts it.
    const Pose grip = tool();
    for (int i = 0; i < 10 && going(); ++i)
        frame(moved_palm(grip * Vec3(setup().wrench.handle_length, 0.0, 0.0) - palm_.position, Vec3(0.0)),
              1.0);
}

void TraineeInRoom::lift(const Vec3& up) {
    const double from = glm::dot(tool().position, up);
    for (const double until = now() + 1.5; going() && now() < until;) {
        if (engaged() < 0 && glm::dot(tool().position, up) > from + 0.9 * hover) return;
        frame({palm_.position + 0.15 * driver_.step() * up, palm_.orientation}, 1.0);
    }
}

void TraineeInRoom::play(double longest, std::size_t steps) {
    while (going() && now() < longest && lesson().session->lesson().current < steps) {
        if (due() == nullptr)
            hold_still(0.1, wrench() ? 1.0 : 0.0);
        else if (due()->kind == lesson::StepKind::run_down)
            run_down(due()->joint);
        else
            tighten(due()->joint);
    }
}

}  // namespace bolt::test
