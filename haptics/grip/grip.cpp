#include "haptics/grip/grip.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace bolt::grip {
namespace {

bool touches(const contact::FingertipContact& contact) { return contact.distance <= contact::touching; }

// More than the friction of two fingertips (contact/grasp.hpp): a hand that is closed has the palm behind it.
constexpr double opposing = to_radians(60.0);

bool pushes_at(const contact::FingertipContact& one, const contact::FingertipContact& other) {
    const Vec3 between = other.point - one.point;
    return glm::dot(between, -one.normal) >= std::cos(opposing) * glm::length(between);
}

// The fingers that touch, taken as one that does what they do together (the virtual finger of M. A. Arbib, T.
// Iberall, D. Lyons, Coordinated control programs for movements of the hand, Exp. Brain Res. Suppl. 10,
// 1985).
bool together(const Closing& closing) {
    contact::FingertipContact all{0.0, Vec3(0.0), Vec3(0.0)};
    double count = 0.0;
    for (std::size_t i = 1; i < hand::digit_count; ++i) {
        const contact::FingertipContact& nearest = closing.digits[i].nearest;
        if (!touches(nearest)) continue;
        all.point += nearest.point;
        all.normal += nearest.normal;
        count += 1.0;
    }
    const double length = glm::length(all.normal);
    if (count == 0.0 || length < 0.5 * count) return false;  // they push at each other
    all.point /= count;
    all.normal /= length;
    const contact::FingertipContact& thumb = closing.digits[0].nearest;
    return touches(thumb) && pushes_at(thumb, all) && pushes_at(all, thumb);
}

// The touching parts of thumb and fingers as fingertips of the size that `contact::grasp` knows.
contact::Fingertips tips_of(const contact::ToolShape& tool, const Closing& closing) {
    contact::Fingertips tips;
    for (std::size_t i = 0; i < hand::digit_count; ++i) {
        const contact::FingertipContact& nearest = closing.digits[i].nearest;
        tips.at[i] = touches(nearest) ? nearest.point + (nearest.distance + tips.radius) * nearest.normal
                                      : Vec3(2.0 * (tool.reach() + contact::sight), 0.0, 0.0);
    }
    return tips;
}

// Enough fingers touch, and the thumb opposes one of them or all together.
bool grasps(const contact::ToolShape& tool, const Closing& closing, std::size_t fingers) {
    const auto touching = std::count_if(closing.digits.begin() + 1, closing.digits.end(),
                                        [](const DigitStop& digit) { return touches(digit.nearest); });
    return touching >= static_cast<std::ptrdiff_t>(fingers) &&
           (together(closing) || contact::grasp(tool, tips_of(tool, closing)).held);
}

// Far enough for what was held to fall.
bool away(const Closing& closing, double distance) {
    double nearest = contact::nothing_near;
    for (std::size_t i = 1; i < hand::digit_count; ++i)
        nearest = std::min(nearest, closing.digits[i].nearest.distance);
    return nearest > distance || closing.digits[0].nearest.distance > distance;
}

Told tell_of_glove(Grip& grip, const GripOptions& options, const GripInput& input) {
    if (input.fresh) {
        if (!grip.lost) return Told::nothing;
        grip.lost = false;
        grip.undecided = options.think;
        grip.contrary = false;
        return Told::glove_back;
    }
    if (grip.lost || !grip.any || grip.quiet <= options.silence) return Told::nothing;
    grip.lost = true;
    return Told::glove_lost;
}

// By a frame that came `gap` seconds after the one before it.
Told decide(Grip& grip, const GripOptions& options, double gap) {
    grip.undecided = std::max(0.0, grip.undecided - gap);
    const bool contrary =
        grip.held ? grip.undecided == 0.0 && away(grip.closing, options.away) : grip.grasping;
    grip.contrary_for = contrary && grip.contrary ? grip.contrary_for + gap : 0.0;
    grip.contrary = contrary;
    if (!contrary || grip.contrary_for < (grip.held ? options.let_go_after : options.take_after))
        return Told::nothing;
    grip.held = !grip.held;
    grip.contrary = false;
    return grip.held ? Told::taken : Told::let_go;
}

bool same(const Pose& a, const Pose& b) { return a.position == b.position && a.orientation == b.orientation; }

}  // namespace

const char* words(Told told, bool held) {
    switch (told) {
        case Told::nothing:
            return "";
        case Told::taken:
            return "You hold the tool.";
        case Told::let_go:
            return "You have let go of the tool.";
        case Told::glove_lost:
            return held ? "The glove is lost: the tool stays in your hand. Is the glove plugged in and on?"
                        : "The glove is lost. Is it plugged in and switched on?";
        case Told::glove_back:
            return held ? "The glove is back: close your hand to keep the tool." : "The glove is back.";
    }
    return "";
}

Told step(Grip& grip, const GripOptions& options, const contact::ToolShape& tool, const hand::Hand& hand,
          const GripInput& input, double dt) {
    grip.quiet += dt;
    const double gap = grip.quiet;
    const Told of_glove = tell_of_glove(grip, options, input);
    const bool moved = !grip.held && !same(grip.wrist, input.wrist);
    if (!grip.held) grip.wrist = input.wrist;
    if (input.fresh) {
        grip.measured = input.measured;
        grip.any = true;
        grip.quiet = 0.0;
    }
    if (input.fresh || moved) {
        grip.closing = close_on(tool, hand, grip.measured, grip.wrist);
        grip.grasping = grasps(tool, grip.closing, options.fingers);
    }
    return input.fresh && of_glove == Told::nothing ? decide(grip, options, gap) : of_glove;
}

}  // namespace bolt::grip
