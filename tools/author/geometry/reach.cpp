#include "tools/author/geometry/reach.hpp"

#include <algorithm>

namespace bolt::geometry {

namespace {

constexpr double step = 3e-3;                   // m; thinner than any wrench that is modelled
constexpr double turn_step = to_radians(10.0);  // between the angles that are tried
constexpr double most_lift = 2.0;               // m; what a wrench has passed by then is behind it
constexpr double jaw_to_tip = 1.7;              // head sizes to draw the jaw off a hexagon

struct Path {
    const Bvh& surroundings;
    const Bvh& wrench;
    double angle;
    std::uint32_t hit = no_part;  // what stopped it

    bool free(const Vec3& from, const Vec3& direction, double distance) {
        for (double gone = 0.0; gone < distance + step; gone += step) {
            const Vec3 shift = from + std::min(gone, distance) * direction;
            const auto found = first_crossing(surroundings, wrench, Pose::turned(angle, shift));
            if (!found) continue;
            hit = surroundings.triangles()[*found].part;
            return false;
        }
        return true;
    }
};

}  // namespace

std::uint32_t blocked_by(const Bvh& surroundings, const Bvh& wrench, const Swing& swing,
                         const Approach& approach) {
    if (surroundings.nodes().empty()) return no_part;
    const Vec3 start{0.0, approach.height, 0.0}, up{0.0, 1.0, 0.0};
    const double lift = std::clamp(surroundings.box().high.y - approach.height, 0.0, most_lift) + 2.0 * step;
    std::uint32_t hit = swing.blocking;
    for (const Arc& arc : swing.arcs) {
        const int tries = 1 + static_cast<int>(arc.width() / turn_step);
        for (int i = 0; i < tries; ++i) {
            const double angle = arc.from + (i + 0.5) / tries * arc.width();
            Path path{surroundings, wrench, angle};
            if (path.free(start, up, lift)) return no_part;
            // Off the nut, the jaw's bottom ahead: towards the handle.
            const double away = angle + approach.jaw_angle, off = jaw_to_tip * approach.head_size;
            const Vec3 direction{std::cos(away), 0.0, -std::sin(away)};
            Path sideways{surroundings, wrench, angle};
            if (sideways.free(start, direction, off) &&
                (sideways.free(start + off * direction, up, lift) ||
                 sideways.free(start + off * direction, direction, 2.0 * approach.reach)))
                return no_part;
            hit = sideways.hit;
        }
    }
    return hit;
}

}  // namespace bolt::geometry
