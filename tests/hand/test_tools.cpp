#include "tests/hand/test_tools.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

#include "haptics/hand/kinematics.hpp"

namespace grasp_test {

TestTool of(const std::vector<collision::ContactMesh>& parts) {
    return {collision::make_tool(parts).value(), contact_test::surface_of(parts)};
}

TestTool bar() {
    return of({contact_test::box(Vec3(-115.0, -3.5, -12.0) * mm, Vec3(115.0, 3.5, 12.0) * mm).mesh()});
}

Pose across_the_palm() {
    return inverse({Vec3(0.0, -28.0, -98.0) * mm, rotation({0.0, to_radians(-17.5), 0.0})});
}

hand::Angles opened(const hand::Angles& angles) {
    hand::Angles out = angles;
    for (hand::FingerAngles& f : out.fingers)
        f = {std::min(f.mcp, 0.0), std::min(f.pip, 0.0), std::min(f.dip, 0.0), f.abduction};
    out.thumb.abduction = std::max(out.thumb.abduction, hand::thumb_abduction_range.high);
    out.thumb.mcp = std::min(out.thumb.mcp, 0.0);
    out.thumb.ip = std::min(out.thumb.ip, 0.0);
    return out;
}

namespace {

double depth(const TestTool& held, const hand::Capsule& capsule, double t) {
    const double radius = capsule.radius_from + t * (capsule.radius_to - capsule.radius_from);
    return radius -
           contact_oracle::signed_distance(held.surface, capsule.from + t * (capsule.to - capsule.from));
}

}  // namespace

double deeper(const TestTool& held, const hand::Hand& hand, const Pose& wrist, std::size_t digit,
              const hand::Angles& angles, const hand::Angles& than) {
    const hand::Skeleton now = hand::joints(hand, angles, wrist), before = hand::joints(hand, than, wrist);
    double most = -1.0;
    for (std::size_t bone = 1; bone + 1 < hand::digits[digit].count; ++bone) {
        const hand::Capsule a = hand::bone_capsule(hand, now, digit, bone),
                            b = hand::bone_capsule(hand, before, digit, bone);
        const auto points = static_cast<int>(glm::length(a.to - a.from) / mm) + 1;
        for (int i = 0; i <= points; ++i) {
            const double t = static_cast<double>(i) / points;
            const double deep = depth(held, a, t);
            if (deep > most) most = std::max(most, deep - std::max(0.0, depth(held, b, t)));
        }
    }
    return most;
}

double deepest(const TestTool& held, const hand::Hand& hand, const Pose& wrist, std::size_t digit,
               const hand::Angles& angles) {
    const hand::Skeleton joints = hand::joints(hand, angles, wrist);
    double most = -1.0;
    for (std::size_t bone = 1; bone + 1 < hand::digits[digit].count; ++bone) {
        const hand::Capsule capsule = hand::bone_capsule(hand, joints, digit, bone);
        const auto points = static_cast<int>(glm::length(capsule.to - capsule.from) / mm) + 1;
        for (int i = 0; i <= points; ++i)
            most = std::max(most, depth(held, capsule, static_cast<double>(i) / points));
    }
    return most;
}

}  // namespace grasp_test
