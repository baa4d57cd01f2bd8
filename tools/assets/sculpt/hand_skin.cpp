#include "tools/assets/sculpt/hand_skin.hpp"

#include <algorithm>
#include <numeric>

namespace bolt::sculpt {
namespace {

using Weights = std::array<double, joint_count>;

Vec3 forward(const Skeleton& hand, std::size_t joint) { return hand.rotation[joint] * Vec3(0.0, 0.0, -1.0); }

// How far a point is past joint k of a digit, 0 to 1, across the plane that halves the angle between the
// bones.
double past(const HandShape& shape, std::size_t digit, std::size_t k, const Vec3& p) {
    const Skeleton& hand = shape.skeleton();
    const std::size_t joint = digits[digit].first + k;
    const Vec3 axis = glm::normalize(forward(hand, joint - 1) + forward(hand, joint));
    double way = glm::dot(p - hand.position[joint], axis);
    const double height = glm::dot(p - hand.position[joint], hand.rotation[joint] * Vec3(0.0, 1.0, 0.0));
    double reach = k == 1 ? 13.5 * mm : (k == 2 ? 11.5 * mm : 8.5 * mm);
    if (digit == 0) reach = k == 1 ? 10 * mm : 8 * mm;
    // In the palm the finger begins later than on the back: the skin of the web belongs to the palm.
    if (digit != 0 && k == 1) way -= 6 * mm * smooth_step(2 * mm, -10 * mm, height);
    return smooth_step(-reach, reach, way);
}

void add_digit(const HandShape& shape, std::size_t digit, const Vec3& p, double share, Weights& out) {
    if (share <= 0.0) return;
    double taken = 0.0;  // by the joints further out
    for (std::size_t k = digits[digit].count - 2; k > 0; --k) {
        const double own = std::max(0.0, share * past(shape, digit, k, p) - taken);
        out[digits[digit].first + k] += own;
        taken += own;
    }
    out[digits[digit].first] += share - taken;
}

Influences strongest(const Weights& weights) {
    std::array<std::size_t, joint_count> order{};
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return weights[a] > weights[b]; });
    double sum = 0.0;
    for (std::size_t i = 0; i < 4; ++i) sum += weights[order[i]];
    Influences out;
    int left = 256;
    for (std::size_t i = 3; i > 0; --i) {
        const int part = static_cast<int>(std::lround(256.0 * weights[order[i]] / sum));
        if (part == 0) continue;
        out.joints[i] = static_cast<std::uint16_t>(order[i]);
        out.weights[i] = static_cast<float>(part) / 256.0F;
        left -= part;
    }
    out.joints[0] = static_cast<std::uint16_t>(order[0]);
    out.weights[0] = static_cast<float>(left) / 256.0F;
    return out;
}

}  // namespace

Influences influences(const HandShape& shape, const Vec3& p) {
    const Skeleton& hand = shape.skeleton();
    Weights weights{};

    std::array<double, 5> depth{};
    std::size_t nearest = 1;
    for (std::size_t d = 0; d < 5; ++d) {
        depth[d] = shape.along(d, p).depth;
        if (d > 1 && depth[d] < depth[nearest]) nearest = d;
    }
    // The thumb takes over where its flesh does.
    const double thumb_way = glm::dot(p - hand.position[thumb_metacarpal], forward(hand, thumb_metacarpal));
    const double thumb =
        smooth_step(-10 * mm, 13 * mm, depth[nearest] - depth[0]) * smooth_step(-12 * mm, 18 * mm, thumb_way);
    add_digit(shape, 0, p, thumb, weights);

    const double arm = smooth_step(-46 * mm, -12 * mm, p.z) * (1.0 - thumb);
    weights[wrist] += arm;

    // Fingers share the palm and part at the web.
    const std::size_t knuckle = digits[nearest].first + 1;
    const double way = glm::dot(p - hand.position[knuckle], forward(hand, knuckle));
    const double parted = smooth_step(2 * mm, 19 * mm, way);
    const double width = 14 * mm + parted * (0.3 * mm - 14 * mm);
    std::array<double, 5> key = depth;
    if (parted > 0.0) {
        for (std::size_t d = 1; d < 5; ++d) key[d] += parted * (shape.finger(d, p) - key[d]);
    }
    const double first = *std::min_element(key.begin() + 1, key.end());
    std::array<double, 5> member{};
    double total = 0.0;
    for (std::size_t d = 1; d < 5; ++d) {
        member[d] = square(std::max(0.0, 1.0 - (key[d] - first) / width));
        total += member[d];
    }
    for (std::size_t d = 1; d < 5; ++d) {
        add_digit(shape, d, p, (1.0 - thumb - arm) * member[d] / total, weights);
    }
    return strongest(weights);
}

}  // namespace bolt::sculpt
