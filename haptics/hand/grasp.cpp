#include "haptics/hand/grasp.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace bolt::hand {
namespace {

bool touches(const hand::FingertipContact& contact) { return contact.distance <= hand::touch_distance; }

// rad; larger than the friction angle of two fingertips (finger_closure.hpp), because the palm supports a
// closed hand.
constexpr double opposing = to_radians(60.0);

bool opposes(const hand::FingertipContact& one, const hand::FingertipContact& other) {
    const Vec3 between = other.point - one.point;
    return glm::dot(between, -one.normal) >= std::cos(opposing) * glm::length(between);
}

// Returns true if the thumb opposes the touching fingers combined into one virtual finger (M. A. Arbib, T.
// Iberall, D. Lyons, Coordinated control programs for movements of the hand, Exp. Brain Res. Suppl. 10,
// 1985).
bool opposed_by_virtual_finger(const FingerClosure& closure) {
    hand::FingertipContact all{0.0, Vec3(0.0), Vec3(0.0)};
    double count = 0.0;
    for (std::size_t i = 1; i < hand::digit_count; ++i) {
        const hand::FingertipContact& nearest = closure.digits[i].nearest;
        if (!touches(nearest)) continue;
        all.point += nearest.point;
        all.normal += nearest.normal;
        count += 1.0;
    }
    const double length = glm::length(all.normal);
    if (count == 0.0 || length < 0.5 * count) return false;  // the fingers push against each other
    all.point /= count;
    all.normal /= length;
    const hand::FingertipContact& thumb = closure.digits[0].nearest;
    return touches(thumb) && opposes(thumb, all) && opposes(all, thumb);
}

// The touching bones of thumb and fingers as fingertips for fingertip_grasp().
hand::Fingertips tips_of(const collision::ToolShape& tool, const FingerClosure& closure) {
    hand::Fingertips tips;
    for (std::size_t i = 0; i < hand::digit_count; ++i) {
        const hand::FingertipContact& nearest = closure.digits[i].nearest;
        tips.at[i] = touches(nearest)
                         ? nearest.point + (nearest.distance + tips.radius) * nearest.normal
                         : Vec3(2.0 * (tool.origin_radius() + hand::contact_query_range), 0.0, 0.0);
    }
    return tips;
}

// True if enough fingers touch and the thumb opposes one of them or the virtual finger.
bool grasps(const collision::ToolShape& tool, const FingerClosure& closure, std::size_t fingers) {
    const auto touching = std::count_if(closure.digits.begin() + 1, closure.digits.end(),
                                        [](const DigitStop& digit) { return touches(digit.nearest); });
    return touching >= static_cast<std::ptrdiff_t>(fingers) &&
           (opposed_by_virtual_finger(closure) || hand::fingertip_grasp(tool, tips_of(tool, closure)).held);
}

// True if the thumb or all fingers are beyond the release distance.
bool away(const FingerClosure& closure, double distance) {
    double nearest = collision::infinite_distance;
    for (std::size_t i = 1; i < hand::digit_count; ++i)
        nearest = std::min(nearest, closure.digits[i].nearest.distance);
    return nearest > distance || closure.digits[0].nearest.distance > distance;
}

GraspEvent update_glove_loss(GraspState& grasp, const GraspOptions& options, const GraspInput& input) {
    if (input.fresh) {
        if (!grasp.lost) return GraspEvent::none;
        grasp.lost = false;
        grasp.release_blocked_for = options.release_block_time;
        grasp.change_pending = false;
        return GraspEvent::glove_back;
    }
    if (grasp.lost || !grasp.has_frame || grasp.frame_age <= options.silence) return GraspEvent::none;
    grasp.lost = true;
    return GraspEvent::glove_lost;
}

// Updates by a frame that arrived `gap` seconds after the previous frame.
GraspEvent decide(GraspState& grasp, const GraspOptions& options, double gap) {
    grasp.release_blocked_for = std::max(0.0, grasp.release_blocked_for - gap);
    const bool contradicts =
        grasp.held ? grasp.release_blocked_for == 0.0 && away(grasp.closure, options.release_distance)
                   : grasp.grasping;
    grasp.change_pending_for = contradicts && grasp.change_pending ? grasp.change_pending_for + gap : 0.0;
    grasp.change_pending = contradicts;
    if (!contradicts || grasp.change_pending_for < (grasp.held ? options.release_delay : options.grasp_delay))
        return GraspEvent::none;
    grasp.held = !grasp.held;
    grasp.change_pending = false;
    return grasp.held ? GraspEvent::grasped : GraspEvent::released;
}

bool same(const Pose& a, const Pose& b) { return a.position == b.position && a.orientation == b.orientation; }

}  // namespace

const char* message_for(GraspEvent event, bool held) {
    switch (event) {
        case GraspEvent::none:
            return "";
        case GraspEvent::grasped:
            return "You hold the tool.";
        case GraspEvent::released:
            return "You have let go of the tool.";
        case GraspEvent::glove_lost:
            return held ? "The glove is lost: the tool stays in your hand. Is the glove plugged in and on?"
                        : "The glove is lost. Is it plugged in and switched on?";
        case GraspEvent::glove_back:
            return held ? "The glove is back: close your hand to keep the tool." : "The glove is back.";
    }
    return "";
}

GraspEvent update_grasp(GraspState& grasp, const GraspOptions& options, const collision::ToolShape& tool,
                        const hand::Hand& hand, const GraspInput& input, double dt) {
    grasp.frame_age += dt;
    const double gap = grasp.frame_age;
    const GraspEvent glove_event = update_glove_loss(grasp, options, input);
    const bool moved = !grasp.held && !same(grasp.wrist, input.wrist);
    if (!grasp.held) grasp.wrist = input.wrist;
    if (input.fresh) {
        grasp.measured = input.measured;
        grasp.has_frame = true;
        grasp.frame_age = 0.0;
    }
    if (input.fresh || moved) {
        grasp.closure = close_fingers(tool, hand, grasp.measured, grasp.wrist);
        grasp.grasping = grasps(tool, grasp.closure, options.fingers);
    }
    return input.fresh && glove_event == GraspEvent::none ? decide(grasp, options, gap) : glove_event;
}

}  // namespace bolt::hand
