#include "game/view/close_up_eye.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace bolt::view {

namespace {

// Degrees: from the handle's side, and above the plane of the jaw. In the order of preference.
constexpr std::array sides{0.0, 30.0, -30.0, 60.0, -60.0, 90.0, -90.0, 135.0, -135.0, 180.0};
constexpr std::array heights{50.0, 65.0, 35.0, 80.0};
constexpr std::array swung{0.0, 0.5, 1.0};  // of the swing

double seen_through_swing(const ViewOf& of, const Pose& tool, double swing, const Vec3& eye,
                          motion::Sight& sight) {
    const Vec3& axis = of.setup.nuts[of.joint].axis;
    double least = 1.0;
    for (const double share : swung) {
        const Quat turn = glm::angleAxis(share * swing, axis);
        const Pose there{tool.position, turn * tool.orientation};
        ViewOf then = of;
        if (of.wrench) then.wrench = there;
        least = std::min(least, seen_from(then, sight, there * eye));
        if (swing == 0.0) break;
    }
    return least;
}

}  // namespace

CloseUpEye close_up_eye(const ViewOf& of, const Pose& tool, double swing, motion::Sight& sight) {
    const servo::NutGeometry& nut = of.setup.nuts[of.joint];
    // The wrench may lie on either face.
    const double up = glm::dot(tool.orientation * Vec3(0, 0, 1), nut.axis) < 0.0 ? -1.0 : 1.0;
    const double behind = of.wrench ? 0.0 : 180.0;
    CloseUpEye best;
    for (const double side : sides)
        for (const double height : heights) {
            const double a = to_radians(side + behind), h = to_radians(height);
            const Vec3 eye = close_up_distance * nut.across_flats *
                             Vec3(std::cos(h) * std::cos(a), std::cos(h) * std::sin(a), up * std::sin(h));
            const double seen = seen_through_swing(of, tool, swing, eye, sight);
            if (seen <= best.seen) continue;
            best = {eye, seen};
            if (seen >= well_seen) return best;
        }
    return best;
}

}  // namespace bolt::view
