#include "tools/assets/sculpt/hand_shape.hpp"

#include <algorithm>
#include <glm/vec2.hpp>

namespace bolt::sculpt {
namespace {

constexpr double flatness = 0.92;  // depth of a finger divided by its breadth

// The arm is an elliptic tube along z, given by its half axes at stations from the cuff's end to inside the
// palm.
struct ArmStation {
    double z_mm, x_mm, y_mm, centre_x_mm, centre_y_mm;
};
constexpr std::array<ArmStation, 6> arm_stations{
    ArmStation{70, 38.5, 30.5, 0.0, 0.0},    ArmStation{30, 35.5, 26.8, 0.0, 0.0},
    ArmStation{6, 31.6, 22.0, 0.0, -0.5},    ArmStation{-8, 31.8, 19.8, -0.5, -2.0},
    ArmStation{-24, 34.0, 17.8, -1.0, -4.0}, ArmStation{-46, 31.0, 12.0, 1.0, -3.0}};

ArmStation arm_station(double z) {
    const double z_mm = std::clamp(z / mm, arm_stations.back().z_mm, arm_stations.front().z_mm);
    std::size_t i = 0;
    while (i + 2 < arm_stations.size() && z_mm < arm_stations[i + 1].z_mm) ++i;
    const ArmStation& a = arm_stations[i];
    const ArmStation& b = arm_stations[i + 1];
    const double t = smooth_step(0.0, 1.0, (z_mm - a.z_mm) / (b.z_mm - a.z_mm));
    const auto mix = [t](double from, double to) { return from + t * (to - from); };
    return {z_mm, mix(a.x_mm, b.x_mm), mix(a.y_mm, b.y_mm), mix(a.centre_x_mm, b.centre_x_mm),
            mix(a.centre_y_mm, b.centre_y_mm)};
}

double elliptic(const Vec3& p, double inset) {
    const ArmStation s = arm_station(p.z);
    const double x = p.x - s.centre_x_mm * mm;
    const double y = p.y - s.centre_y_mm * mm;
    const double a = s.x_mm * mm - inset;
    const double b = s.y_mm * mm - inset;
    const double k0 = std::hypot(x / a, y / b);
    const double k1 = std::hypot(x / (a * a), y / (b * b));
    return k1 < 1e-9 ? -b : k0 * (k0 - 1.0) / k1;
}

// A sleeve with a rolled hem, open at z = cuff_end and closed inside near the wrist.
double cuff_distance(const Vec3& p) {
    const double end = HandShape::cuff_end;
    const double bead =
        std::max(0.0, 1.0 - square((p.z - (end - 0.5 * HandShape::hem)) / (0.5 * HandShape::hem)));
    const double outside = elliptic(p, 0.0) - 0.9 * mm * bead;
    double d = smooth_intersection(outside, p.z - end, 1.5 * mm);
    d = smooth_intersection(d, -46 * mm - p.z, 6 * mm);
    const double inside = smooth_intersection(elliptic(p, 2.6 * mm), 14 * mm - p.z, 8 * mm);
    return smooth_difference(d, inside, 1.2 * mm);
}

// Returns the depth, 0 to 1, of a groove in the palm along a polyline of points (x, z in mm).
template <std::size_t n>
double groove(const Vec3& p, const std::array<glm::dvec2, n>& line_mm, double width_mm) {
    const glm::dvec2 at(p.x / mm, p.z / mm);
    double nearest2 = 1e9;
    for (std::size_t i = 0; i + 1 < n; ++i) {
        const glm::dvec2 axis = line_mm[i + 1] - line_mm[i];
        const double t = std::clamp(glm::dot(at - line_mm[i], axis) / glm::dot(axis, axis), 0.0, 1.0);
        const glm::dvec2 off = at - line_mm[i] - axis * t;
        nearest2 = std::min(nearest2, glm::dot(off, off));
    }
    return std::exp(-nearest2 / (width_mm * width_mm));
}

// The grooves of a coated glove: one where it folds when the fingers bend, one around the thumb.
constexpr std::array<glm::dvec2, 6> finger_fold{
    {{40, -66}, {30, -71}, {18, -78}, {4, -85}, {-8, -90}, {-15, -97}}};
constexpr std::array<glm::dvec2, 6> thumb_fold{
    {{-30, -84}, {-20, -74}, {-12, -62}, {-8, -50}, {-7, -38}, {-9, -28}}};

}  // namespace

HandShape::HandShape() : skeleton_(right_skeleton()) {
    for (std::size_t d = 0; d < digits.size(); ++d) {
        const std::size_t first = digits[d].first;
        bone_count_[d] = digits[d].count - 1;
        for (std::size_t i = 0; i < bone_count_[d]; ++i) {
            Bone& bone = bones_[d][i];
            bone.a = skeleton_.position[first + i];
            bone.b = skeleton_.position[first + i + 1];
            const glm::dmat3 axes = glm::mat3_cast(skeleton_.rotation[first + i]);
            bone.side = axes[0];
            bone.up = axes[1];
            bone.forward = -axes[2];
            bone.radius_a = half_breadths_mm[d][i] * mm;
            bone.radius_b = half_breadths_mm[d][i + 1] * mm;
            bone.length = glm::length(bone.b - bone.a);
            travel_[d][i + 1] = travel_[d][i] + bone.length;
            if (i + 1 == bone_count_[d]) {  // the last sphere ends at the tip of the glove
                bone.b += bone.forward * (glove_mm * mm - bone.radius_b);
                bone.length = glm::length(bone.b - bone.a);
            }
        }
    }
}

FieldBounds HandShape::bounds() const { return {Vec3(-96, -62, -200) * mm, Vec3(58, 40, 72) * mm}; }

DigitPosition HandShape::locate(std::size_t digit, const Vec3& p) const {
    DigitPosition best;
    best.depth = 1.0;
    for (std::size_t i = 0; i < bone_count_[digit]; ++i) {
        const Bone& bone = bones_[digit][i];
        const Vec3 from = p - bone.a;
        const double raw = glm::dot(from, bone.forward);
        const bool last = i + 1 == bone_count_[digit];
        const double part = std::clamp(raw, i == 0 ? -20 * mm : 0.0, last ? raw + 1.0 : bone.length);
        const double t = std::clamp(part / bone.length, 0.0, 1.0);
        const double radius = bone.radius_a + t * (bone.radius_b - bone.radius_a);
        const double depth = glm::length(from - bone.forward * std::clamp(raw, 0.0, bone.length)) - radius;
        if (depth >= best.depth) continue;
        best = {depth, travel_[digit][i] + part, glm::dot(from, bone.up) / radius,
                bone.a + bone.forward * (t * bone.length), i};
    }
    return best;
}

double HandShape::digit_distance(std::size_t digit, const Vec3& p) const {
    const std::size_t count = bone_count_[digit];
    const double far = round_cone(p, bones_[digit][1].a, bones_[digit][count - 1].b, 16 * mm, 16 * mm);
    if (far > 14 * mm) return far;
    double d = 1.0;
    for (std::size_t i = 1; i < count; ++i) {
        const Bone& bone = bones_[digit][i];
        const Vec3 from = p - bone.a;
        const bool last = i + 1 == count;
        const double flat = last ? flatness - 0.05 : flatness;
        const Vec3 local(glm::dot(from, bone.side), glm::dot(from, bone.up) / flat,
                         glm::dot(from, bone.forward));
        const Vec3 end(0.0, 0.0, bone.length);
        const double mid = (bone.radius_a + bone.radius_b) * (last ? 0.51 : 0.485);
        const Vec3 half(0.0, 0.0, bone.length * (last ? 0.55 : 0.5));
        double cone = smooth_union(round_cone(local, Vec3(0.0), half, bone.radius_a, mid),
                                   round_cone(local, half, end, mid, bone.radius_b), 2 * mm);
        // The finger pad on the palm side.
        const Vec3 pad = Vec3(local.x, local.y * flat, local.z) - Vec3(0.0, -0.42 * mid, bone.length * 0.52);
        const double soft = ellipsoid(pad, Vec3(0.86 * mid, 0.66 * mid, bone.length * (last ? 0.62 : 0.44)));
        cone = smooth_union(cone, soft, 3 * mm);
        d = i == 1 ? cone : smooth_union(d, cone, 4 * mm);
    }
    return d;
}

double HandShape::palm_body(const Vec3& p) const {
    double d = 1.0;
    for (std::size_t digit = 1; digit < 5; ++digit) {
        const Bone& bone = bones_[digit][0];
        const double cone = round_cone(p, bone.a, bone.b, bone.radius_a, bone.radius_b);
        d = digit == 1 ? cone : smooth_union(d, cone, 9 * mm);
        const double knuckle =
            glm::length(p - bone.b - bone.up * (3.4 * mm)) - (bones_[digit][1].radius_a - 2.3 * mm);
        d = smooth_union(d, knuckle, 5 * mm);
    }
    // The pad at the roots of the fingers, from one metacarpal head to the next on the palm side, up to the
    // webs.
    for (std::size_t digit = 1; digit < 4; ++digit) {
        const Bone& one = bones_[digit][1];
        const Bone& two = bones_[digit + 1][1];
        const double reach = 11 * mm;
        const Vec3 a = one.a + one.forward * reach - one.up * (5.0 * mm);
        const Vec3 b = two.a + two.forward * reach - two.up * (5.0 * mm);
        d = smooth_union(d, round_cone(p, a, b, 8.2 * mm, 8.2 * mm), 6 * mm);
    }
    // Thenar: the muscle around the thumb's metacarpal, the mound in the palm, and the skin to the index
    // finger.
    const Bone& thumb = bones_[0][0];
    double thenar = round_cone(p, thumb.a, thumb.b, thumb.radius_a, thumb.radius_b);
    const Vec3 mound = 0.45 * thumb.a + 0.55 * thumb.b + Vec3(7.0, -1.0, 1.0) * mm;
    const glm::dmat3 axes(thumb.side, thumb.up, thumb.forward);
    thenar =
        smooth_union(thenar, ellipsoid(glm::transpose(axes) * (p - mound), Vec3(14, 13.5, 27) * mm), 8 * mm);
    d = smooth_union(d, thenar, 13 * mm);
    const Vec3 fold_a = 0.30 * thumb.a + 0.70 * thumb.b + Vec3(6, 3, 0) * mm;
    const Vec3 fold_b = 0.35 * bones_[1][0].a + 0.65 * bones_[1][0].b + Vec3(-4, -3, 0) * mm;
    d = smooth_union(d, round_cone(p, fold_a, fold_b, 5.5 * mm, 7 * mm), 11 * mm);
    const Vec3 little_mound = p - Vec3(24.5, -7.5, -42.0) * mm;
    const double turn = to_radians(-13.0);
    const Vec3 turned(std::cos(turn) * little_mound.x - std::sin(turn) * little_mound.z, little_mound.y,
                      std::sin(turn) * little_mound.x + std::cos(turn) * little_mound.z);
    d = smooth_union(d, ellipsoid(turned, Vec3(13.5, 13.0, 31.0) * mm), 9 * mm);
    return d;
}

// Returns the displacement of the surface by folds and grooves of the glove (m); positive is outward.
double HandShape::folds(const Vec3& p) const {
    double out = 0.0;
    std::size_t nearest = 1;
    DigitPosition at = locate(1, p);
    double second = 1.0;
    for (const std::size_t digit : {0U, 2U, 3U, 4U}) {
        const DigitPosition other = locate(digit, p);
        second = std::min(second, std::max(other.depth, at.depth));
        if (other.depth < at.depth) {
            at = other;
            nearest = digit;
        }
    }
    // Fade folds towards the next digit to avoid a step between digits.
    const double own = smooth_step(0.0, 3 * mm, second - at.depth);
    const double scale = own * (nearest == 4 ? 0.85 : 1.0);
    for (std::size_t k = nearest == 0 ? 1 : 2; k < bone_count_[nearest]; ++k) {
        // Signed distance across the plane that bisects the angle between the bones.
        const Bone& after = bones_[nearest][k];
        const Vec3 axis = glm::normalize(bones_[nearest][k - 1].forward + after.forward);
        const double s = glm::dot(p - after.a, axis) / mm;
        const double height = glm::dot(p - after.a, after.up) / after.radius_a;
        const double back = smooth_step(-0.1, 0.6, height);
        const double front = smooth_step(0.1, -0.5, height);
        // On the back, folds of the knit over the joint; on the palm side, one deep crease with raised edges.
        const double slant = glm::dot(p - after.a, after.side) / mm;
        const double wave =
            s + 0.09 * slant + 0.8 * std::sin(0.35 * slant + static_cast<double>(nearest + 2 * k));
        out += scale * mm * back * 0.26 * std::cos(wave * (2 * pi / 5.4)) * std::exp(-square(s / 7.0));
        out += scale * mm * front * (0.45 * std::exp(-square(s / 5.5)) - 0.95 * std::exp(-square(s / 2.3)));
    }
    if (p.y < 2 * mm && p.z < -20 * mm && p.z > -112 * mm) {
        const double face = smooth_step(2 * mm, -8 * mm, p.y) * mm;
        out -= face * (0.6 * groove(p, finger_fold, 2.6) + 0.8 * groove(p, thumb_fold, 3.0));
    }
    // The knit gathers at the narrow start of the cuff.
    const double gather = std::exp(-square((p.z - 2 * mm) / (13 * mm)));
    out +=
        0.42 * mm * gather * std::cos(p.z / mm * (2 * pi / 6.2) + 1.2 * std::sin(std::atan2(p.y, p.x) * 3.0));
    return out;
}

double HandShape::operator()(const Vec3& p) const {
    double fingers = 1.0;
    for (std::size_t digit = 1; digit < 5; ++digit)
        fingers = smooth_union(fingers, digit_distance(digit, p), 1.5 * mm);
    double d = palm_body(p);
    d = smooth_union(d, cuff_distance(p), 12 * mm);
    if (p.z > 12 * mm) d = std::max(d, cuff_distance(p));  // the blend must not fill the sleeve
    d = smooth_union(d, fingers, 6 * mm);
    d = smooth_union(d, digit_distance(0, p), 6 * mm);
    return std::abs(d) < 4 * mm ? d - folds(p) : d;
}

}  // namespace bolt::sculpt
