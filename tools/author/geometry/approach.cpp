#include "tools/author/geometry/approach.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace bolt::geometry {

namespace {

constexpr double step = 3e-3;                   // m, smaller than the thickness of any modelled tool
constexpr double turn_step = to_radians(10.0);  // between the handle angles that are tried
constexpr double max_lift = 2.0;                // m, beyond which obstacles are ignored
constexpr int sides = 8;                        // directions across the bolt that are tried
constexpr double jaw_to_tip = 1.7;              // travel that frees the jaw from a hexagon, in head sizes

// Moves the tool along a straight line at a fixed handle angle and tests it for collisions.
struct PathProbe {
    const Obstacles& surroundings;
    const Bvh& tool;
    double angle;
    std::uint32_t hit = no_part;  // the part that blocks the path

    bool free(const Vec3& from, const Vec3& direction, double distance) {
        const int last = static_cast<int>(std::ceil(distance / step));
        return free_between({from, direction, distance}, 0, last);
    }

  private:
    struct Line {
        Vec3 from, direction;
        double length;

        [[nodiscard]] Vec3 at(int sample) const { return from + std::min(sample * step, length) * direction; }
    };
    // Tests the samples from `first` to `last`, in this order, except where all are surely free.
    bool free_between(const Line& line, int first, int last) {
        const Vec3 low = line.at(first), high = line.at(last);
        const auto turned = [&](const Vec3& at) { return RigidMotion::about_y(angle, at); };
        if (first == last) {
            const std::uint32_t found = surroundings.first_hit_by(tool, turned(low));
            if (found != no_part) hit = found;
            return found == no_part;
        }
        if (!surroundings.may_be_hit(tool, turned(0.5 * (low + high)), {0.0, 0.5 * (high - low)}))
            return true;
        const int middle = first + (last - first) / 2;
        return free_between(line, first, middle) && free_between(line, middle + 1, last);
    }
};

// The handle angles that are tried in a free arc.
std::vector<double> tried_angles(const Arc& arc) {
    const int tries = 1 + static_cast<int>(arc.width() / turn_step);
    std::vector<double> angles;
    for (int i = 0; i < tries; ++i) angles.push_back(arc.from + (i + 0.5) / tries * arc.width());
    return angles;
}

// Returns the lift, m, from `height` to above all obstacles.
double lift_beyond(const Obstacles& surroundings, double height) {
    return std::clamp(surroundings.top() - height, 0.0, max_lift) + 2.0 * step;
}

}  // namespace

std::uint32_t find_obstruction(const Obstacles& surroundings, const Bvh& tool, const FreeSwing& swing,
                               const ExitPaths& paths) {
    if (surroundings.empty()) return no_part;
    const Vec3 start{0.0, paths.height, 0.0}, up{0.0, 1.0, 0.0};
    const double lift = lift_beyond(surroundings, paths.height);
    std::uint32_t hit = swing.blocking;
    for (const Arc& arc : swing.arcs) {
        for (const double angle : tried_angles(arc)) {
            PathProbe path{surroundings, tool, angle};
            if (path.free(start, up, lift)) return no_part;
            // Sideways off the nut: the wrench moves in the direction from its mouth to its throat.
            const double away = angle + paths.jaw_angle, off = jaw_to_tip * paths.head_size;
            const Vec3 direction{std::cos(away), 0.0, -std::sin(away)};
            PathProbe sideways{surroundings, tool, angle};
            if (sideways.free(start, direction, off) &&
                (sideways.free(start + off * direction, up, lift) ||
                 sideways.free(start + off * direction, direction, 2.0 * paths.reach)))
                return no_part;
            hit = sideways.hit;
        }
    }
    return hit;
}

std::uint32_t find_obstruction(const Obstacles& surroundings, const Bvh& tool, const FreeSwing& swing,
                               const AxialExit& exit) {
    if (surroundings.empty()) return no_part;
    const Vec3 start{0.0, exit.height, 0.0}, up{0.0, 1.0, 0.0}, lifted = start + exit.lift * up;
    const double lift = lift_beyond(surroundings, lifted.y);
    std::uint32_t hit = swing.blocking;
    for (const Arc& arc : swing.arcs)
        for (const double angle : tried_angles(arc)) {
            PathProbe path{surroundings, tool, angle};
            if (!path.free(start, up, exit.lift)) {
                hit = path.hit;
                continue;
            }
            if (path.free(lifted, up, lift)) return no_part;
            hit = path.hit;
            for (int i = 0; i < sides; ++i) {
                const double away = angle + i * 2.0 * pi / sides;
                if (path.free(lifted, {std::cos(away), 0.0, -std::sin(away)}, 2.0 * exit.reach))
                    return no_part;
            }
        }
    return hit;
}

}  // namespace bolt::geometry
