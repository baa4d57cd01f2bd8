#include "tools/assets/sculpt/glove.hpp"

#include <algorithm>

#include "tools/assets/sculpt/noise.hpp"

namespace bolt::sculpt {
namespace {

constexpr int no_digit = 5;
constexpr int around = 6;

// The digit whose own flesh a point past the web belongs to; no_digit: the palm.
int digit_at(const HandShape& shape, const Vec3& p) {
    int best = no_digit;
    double depth = 1.0;
    for (std::size_t d = 0; d < 5; ++d) {
        const Along at = shape.along(d, p);
        if (at.depth >= depth) continue;
        depth = at.depth;
        const double root = shape.travel(d, 1) + (d == 0 ? 2 * mm : 14 * mm);
        best = at.travel > root ? static_cast<int>(d) : no_digit;
    }
    return best;
}

glm::dmat3 axes_of(const HandShape& shape, int digit) {
    if (digit == no_digit) return glm::dmat3(1.0);
    const Digit& d = digits[static_cast<std::size_t>(digit)];
    return glm::mat3_cast(shape.skeleton().rotation[d.first + d.count - 3]);
}

}  // namespace

double dipped(const HandShape& shape, const Vec3& p) {
    std::array<Along, 5> at{};
    double nearest = 1.0;
    for (std::size_t d = 0; d < 5; ++d) {
        at[d] = shape.along(d, p);
        nearest = std::min(nearest, at[d].depth);
    }
    // Weighted, so that the line does not jump from one digit to the next.
    double sum = 0.0;
    double height = 0.0;
    double tip = 0.0;
    for (std::size_t d = 0; d < 5; ++d) {
        const double weight = std::exp(-(at[d].depth - nearest) / (2.5 * mm));
        const double nail = shape.travel(d, digits[d].count - 2) + (d == 0 ? 9 * mm : 5.5 * mm);
        height += weight * at[d].height;
        tip += weight * std::clamp((at[d].travel - nail) / (7 * mm), -3.0, 3.0);
        sum += weight;
    }
    const double ragged = 0.34 * (noise3(p / (9 * mm), 11) - 0.5) + 0.14 * (noise3(p / (3.5 * mm), 12) - 0.5);
    const double side = -0.02 - height / sum + ragged;
    const double dip = -smooth_union(-side, -(tip / sum + 2.0 * ragged), 0.5);
    const double heel = (-14 * mm - p.z) / (9 * mm) + 2.0 * ragged;
    return std::min(dip, heel);
}

GlovePart glove_part(const HandShape& shape, const Vec3& p) {
    if (p.z > HandShape::cuff_end - HandShape::hem) return hem;
    if (p.z > cuff_begin) return cuff;
    return dipped(shape, p) > 0.0 ? coat : knit;
}

Patch patch_of(const HandShape& shape, const Vec3& p, const Vec3& normal, GlovePart part) {
    if (part == cuff || part == hem) return {around, 0};
    const int digit = digit_at(shape, p);
    const Vec3 local = glm::transpose(axes_of(shape, digit)) * normal;
    int axis = 0;
    if (std::abs(local.y) * 1.15 > std::abs(local[axis])) axis = 1;
    if (std::abs(local.z) * 0.8 > std::abs(local[axis])) axis = 2;
    return {digit, 2 * axis + (local[axis] < 0.0 ? 1 : 0)};
}

Laid lay(const HandShape& shape, const Patch& patch, const Vec3& p) {
    if (patch.digit == around) {
        const double angle = std::atan2(p.y, p.x);
        return {{angle / (2 * pi) * cuff_round, p.z},
                Vec3(-std::sin(angle), std::cos(angle), 0.0),
                Vec3(0, 0, -1)};
    }
    const glm::dmat3 axes = axes_of(shape, patch.digit);
    const Vec3 local = glm::transpose(axes) * p;
    // Wales of the knit run along the finger: v along −Z wherever that is possible.
    switch (patch.face / 2) {
        case 0:
            return {{local.y, local.z}, axes[1], -axes[2]};
        case 1:
            return {{local.x, local.z}, axes[0], -axes[2]};
        default:
            return {{local.x, -local.y}, axes[0], axes[1]};
    }
}

double shading(const HandShape& shape, const Vec3& p, const Vec3& normal) {
    double hidden = 0.0;
    double weight = 1.0;
    for (const double reach : {2.0, 4.0, 8.0, 14.0, 22.0}) {
        const double open = shape(p + normal * (reach * mm)) / (reach * mm);
        hidden += weight * std::clamp(1.0 - open, 0.0, 1.0);
        weight *= 0.75;
    }
    const double wear = 0.9 + 0.2 * noise3(p / (14 * mm), 21);
    return std::clamp((1.0 - 0.22 * hidden) * wear, 0.3, 1.0);
}

}  // namespace bolt::sculpt
