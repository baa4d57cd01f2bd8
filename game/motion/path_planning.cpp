#include "game/motion/path_planning.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>

namespace bolt::motion {

Quat tool_orientation(const servo::NutGeometry& nut, double handle_angle, bool flipped) {
    const Vec3 x = servo::direction_at(nut, handle_angle);
    const Vec3 z = flipped ? -nut.axis : nut.axis;
    return glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z)));
}

namespace {

constexpr double swing_step = to_radians(5.0);
constexpr double swing_margin = to_radians(3.0);  // between handle and obstacles
constexpr double max_ahead = 4e-3;                // m by which the hand may be ahead of the wrench
constexpr double max_turn_lead = to_radians(4.0);
constexpr double clearance = 0.012;  // m between wrench and obstacles along a path
constexpr std::array arc_bulges{0.05, 0.1, 0.15, 0.2, 0.3, 0.4};  // m, of the middle of a curved path
constexpr std::array lifts{0.06, 0.12, 0.2, 0.35};                // m, straight up before moving across
constexpr std::array approach_heights{0.03, 0.08, 0.15};          // m above a nut, checked for the approach
constexpr double min_hover_height = 0.015, hover_height_step = 2e-3;  // m, of the hand that waits above a nut
constexpr double squeeze_cost = 2.0;  // rad, cost of an angle with an obstructed approach
constexpr double least_swing = to_radians(15.0);
constexpr double cramped_cost = 2.0 * pi;  // rad, cost of an angle with less than `least_swing`

// Collision queries for a wrench among the obstacles, by line-of-sight tests between points of its outline.
struct FreeSpace {
    const servo::Setup& setup;
    const servo::ToolContact& contact;
    double length = 0.0;      // m, from the middle of the head to the end of the handle
    double half_width = 0.0;  // m, of the handle
    // m along the tool's Z: the lower and the upper face of the head and of the handle. An open-end wrench,
    // which can be turned over, has the same faces either way up.
    std::array<double, 2> head{}, handle{};
    // Points of the head that reach furthest in each direction, at its lower and its upper face. A socket is
    // below its handle: the head has no points above it, and is narrower than the handle below.
    std::array<std::array<Vec3, 8>, 2> rims{};

    FreeSpace(const servo::Setup& s, const servo::ToolContact& t) : setup(s), contact(t) {
        double half_thickness = 0.0;
        handle = {1e9, -1e9};
        const auto each_point = [&](auto&& visit) {
            for (const auto& triangle : t.wrench.solid.corners)
                for (const Vec3 p : triangle) visit(p);
        };
        each_point([&](const Vec3& p) { length = std::max(length, p.x); });
        const auto of_handle = [&](const Vec3& p) { return p.x > 0.3 * length; };
        each_point([&](const Vec3& p) {
            if (of_handle(p)) {
                half_width = std::max(half_width, std::abs(p.y));
                handle = {std::min(handle[0], p.z), std::max(handle[1], p.z)};
            } else {
                half_thickness = std::max(half_thickness, std::abs(p.z));
                head = {std::min(head[0], p.z), std::max(head[1], p.z)};
            }
        });
        const bool either_way_up = reversible(s.wrench);
        each_point([&](const Vec3& p) {
            if (of_handle(p)) return;
            for (std::size_t face = 0; face < rims.size(); ++face)
                if (either_way_up || (face == 0) == (p.z < handle[0])) add_to_rim(p, rims[face]);
        });
        if (either_way_up) head = handle = {-half_thickness, half_thickness};
    }

    static void add_to_rim(const Vec3& p, std::array<Vec3, 8>& rim) {
        for (std::size_t k = 0; k < rim.size(); ++k) {
            const double angle = static_cast<double>(k) * pi / 4.0;
            const auto far = [angle](const Vec3& q) { return q.x * std::cos(angle) + q.y * std::sin(angle); };
            if (far(p) > far(rim[k])) rim[k] = {p.x, p.y, 0.0};
        }
    }

    // m, of the middle of the handle above the origin of the tool.
    [[nodiscard]] double handle_height() const { return 0.5 * (handle[0] + handle[1]); }

    // True if no obstacle is between the poses: tests both faces of the wrench, enlarged by `distance` m.
    [[nodiscard]] bool step_is_free(const Pose& before, const Pose& pose, double distance) const {
        const auto blocked = [&](const Vec3& a, const Vec3& b) { return servo::occluded(contact, a, b, -1); };
        for (const std::size_t face : {0U, 1U}) {
            const double margin = face == 0 ? -distance : distance;
            const Vec3 off(0.0, 0.0, handle[face] + margin);
            const Vec3 middle = pose * (Vec3(0.5 * length, 0.0, 0.0) + off);
            for (const Vec3& side : rims[face]) {
                if (side == Vec3(0.0)) continue;  // the head has no points on this side of the handle
                const Vec3 point =
                    side * (1.0 + distance / glm::length(side)) + Vec3(0.0, 0.0, head[face] + margin);
                if (blocked(before * point, pose * point) || blocked(middle, pose * point)) return false;
            }
            for (const double side : {-1.0, 1.0}) {
                const Vec3 end = Vec3(length, side * (half_width + distance), 0.0) + off;
                if (blocked(before * end, pose * end) || blocked(middle, pose * end)) return false;
            }
        }
        return true;
    }

    [[nodiscard]] bool path_is_free(const Pose& from, const Pose& to, const Vec3& bulge) const {
        Pose before = from;
        for (int i = 1; i <= 24; ++i) {
            const double s = static_cast<double>(i) / 24.0;
            const Pose pose = arc_pose(from, to, s, bulge);
            // No clearance at both ends, where the wrench may be close to obstacles; full clearance between.
            if (!step_is_free(before, pose, clearance * 4.0 * s * (1.0 - s))) return false;
            before = pose;
        }
        return true;
    }

    // True if a handle at this angle, `above` m over the nut, meets no obstacle. Tests lines along its middle
    // and its edges, at three heights.
    [[nodiscard]] bool handle_is_free(std::size_t joint, double nut_angle, double angle, double above) const {
        const servo::NutGeometry& nut = setup.nuts[joint];
        const Vec3 centre = servo::nut_centre(nut, nut_angle) + (above + handle_height()) * nut.axis;
        const Vec3 out = servo::direction_at(nut, angle);
        const Vec3 across = glm::cross(nut.axis, out);
        for (const double side : {-half_width, 0.0, half_width})
            for (const double height : {-0.35, 0.0, 0.35}) {
                const Vec3 beside = side * across + height * nut.height * nut.axis;
                if (servo::occluded(contact, centre + nut.across_flats * out + beside,
                                    centre + length * out + beside, static_cast<int>(joint)))
                    return false;
            }
        return true;
    }

    // The angle in rad by which a handle can swing before it meets an obstacle, at most `most`; negative if
    // it meets one at the start.
    [[nodiscard]] double free_swing(std::size_t joint, double nut_angle, double angle, double sign,
                                    double most) const {
        if (!handle_is_free(joint, nut_angle, angle, 0.0)) return -1.0;
        double room = 0.0;
        while (room < most && handle_is_free(joint, nut_angle, angle + sign * (room + swing_margin), 0.0))
            room += swing_step;
        return std::min(room, most);
    }
};

// Plans a path into a gap that is closed above: over the top to a pose beside the gap, then straight in.
std::optional<ReachPath> side_approach(const FreeSpace& space, const Pose& from, const Pose& to,
                                       const Vec3& up, const std::function<Vec3(int)>& aside) {
    for (const double far : {0.25, 0.4, 0.6})
        for (int i = 0; i < 8; ++i) {
            const Pose beside{to.position + far * aside(i), to.orientation};
            if (!space.path_is_free(beside, to, Vec3(0.0))) continue;
            for (const double high : lifts) {
                const Pose lifted{from.position + high * up, from.orientation};
                const Pose over{beside.position + glm::dot(lifted.position - beside.position, up) * up,
                                to.orientation};
                if (space.path_is_free(from, lifted, Vec3(0.0)) &&
                    space.path_is_free(lifted, over, Vec3(0.0)) &&
                    space.path_is_free(over, beside, Vec3(0.0)))
                    return ReachPath{Vec3(0.0), {lifted, over, beside}};
            }
        }
    return std::nullopt;
}

// A straight way out of the assembly's box: first `lifted` off the nut, then to a point on a face of the box.
struct WayOut {
    Pose lifted, outside;
    Vec3 face{0.0};  // unit, outward
    double length = 0.0;
};

// The box around all obstacles, enlarged by the room that a wrench needs to turn at its faces, m.
collision::BoundingBox box_to_go_around(const FreeSpace& space) {
    collision::BoundingBox box{Vec3(1e9), Vec3(-1e9)};
    for (const collision::Body& body : space.contact.world.bodies) {
        const collision::BoundingBox& own = space.contact.world.shapes[body.shape].solid.box;
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3 point = body.pose * Vec3((corner & 1) != 0 ? own.high.x : own.low.x,
                                                (corner & 2) != 0 ? own.high.y : own.low.y,
                                                (corner & 4) != 0 ? own.high.z : own.low.z);
            box = {glm::min(box.low, point), glm::max(box.high, point)};
        }
    }
    return {box.low - Vec3(space.length + clearance), box.high + Vec3(space.length + clearance)};
}

// The ways out of the box to its four sides and its top, the shortest first.
std::vector<WayOut> ways_out(const FreeSpace& space, const collision::BoundingBox& box, const Pose& pose) {
    std::vector<WayOut> ways;
    const Vec3 along = pose.orientation * Vec3(0, 0, 1);
    for (const double lift : {0.0, 0.03, 0.08, 0.15})
        for (const Vec3& face :
             {Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)}) {
            const Pose lifted{pose.position + lift * along, pose.orientation};
            // The point of the box that is furthest out in this direction.
            const Vec3 border(face.x > 0.0 ? box.high.x : box.low.x, face.y > 0.0 ? box.high.y : box.low.y,
                              face.z > 0.0 ? box.high.z : box.low.z);
            const double far = std::max(0.0, glm::dot(border - lifted.position, face));
            ways.push_back({lifted, {lifted.position + far * face, pose.orientation}, face, lift + far});
        }
    std::stable_sort(ways.begin(), ways.end(),
                     [](const WayOut& a, const WayOut& b) { return a.length < b.length; });
    std::erase_if(ways, [&](const WayOut& way) {
        return !space.path_is_free(pose, way.lifted, Vec3(0.0)) ||
               !space.path_is_free(way.lifted, way.outside, Vec3(0.0));
    });
    return ways;
}

// Plans a path out of the assembly's box, along its faces and in again.
std::optional<ReachPath> path_around(const FreeSpace& space, const Pose& from, const Pose& to) {
    const collision::BoundingBox box = box_to_go_around(space);
    const std::vector<WayOut> out = ways_out(space, box, from), in = ways_out(space, box, to);
    if (out.empty() || in.empty()) return std::nullopt;
    const WayOut &first = out.front(), &last = in.front();
    const Quat turned = to.orientation;
    ReachPath path{Vec3(0.0), {first.lifted, first.outside}};
    const auto go_to = [&](const Vec3& position) { path.waypoints.push_back({position, turned}); };
    // Moves the point p onto the plane of a face, in which it then moves without meeting anything.
    const auto onto = [](const Vec3& p, const Vec3& face, const Vec3& on_face) {
        return p + glm::dot(on_face - p, face) * face;
    };
    Vec3 at = first.outside.position;
    if (glm::dot(first.face, last.face) < -0.5) {  // opposite sides: over the top
        const Vec3 top(0.0, std::max(box.high.y, last.outside.position.y), 0.0);
        at = onto(at, Vec3(0, 1, 0), top);
        go_to(at);
        at = onto(last.outside.position, Vec3(0, 1, 0), top);
        go_to(at);
    } else if (first.face != last.face) {
        go_to(onto(at, last.face, last.outside.position));
    }
    go_to(last.outside.position);
    path.waypoints.push_back(last.lifted);
    return path;
}

}  // namespace

ReachPath plan_reach(const servo::Setup& setup, const servo::ToolContact& contact, const Pose& from,
                     const Pose& to, const Vec3& up, double min_bulge) {
    const FreeSpace space(setup, contact);
    if (space.path_is_free(from, to, min_bulge * up)) return {min_bulge * up, {}};
    for (const double rise : arc_bulges)
        if (rise > min_bulge && space.path_is_free(from, to, rise * up)) return {rise * up, {}};
    const Vec3 helper = std::abs(up.x) < 0.9 ? Vec3(1, 0, 0) : Vec3(0, 0, 1);
    const Vec3 e1 = glm::normalize(helper - up * glm::dot(helper, up)), e2 = glm::cross(up, e1);
    const auto aside = [&](int eighth) {
        return std::cos(eighth * pi / 4.0) * e1 + std::sin(eighth * pi / 4.0) * e2;
    };
    for (const double rise : {0.1, 0.2, 0.4})
        for (int i = 0; i < 8; ++i)
            if (const Vec3 bulge = rise * (up + aside(i)); space.path_is_free(from, to, bulge))
                return {bulge, {}};
    const auto path_over = [&](double high) -> ReachPath {
        return {Vec3(0.0),
                {{from.position + high * up, from.orientation}, {to.position + high * up, to.orientation}}};
    };
    for (const double high : lifts) {
        const ReachPath path = path_over(high);
        const Pose &lifted = path.waypoints[0], &above = path.waypoints[1];
        if (space.path_is_free(from, lifted, Vec3(0.0)) && space.path_is_free(lifted, above, Vec3(0.0)) &&
            space.path_is_free(above, to, Vec3(0.0)))
            return path;
    }
    const Vec3 middle = 0.5 * (from.position + to.position);
    for (const double high : {0.2, 0.5})
        for (const double far : {0.0, 0.3, 0.6})
            for (int i = 0; i < (far > 0.0 ? 8 : 1); ++i) {
                const Vec3 centre = middle + high * up + far * aside(i);
                const Pose unturned{centre, from.orientation}, turned{centre, to.orientation};
                if (space.path_is_free(from, unturned, Vec3(0.0)) &&
                    space.path_is_free(unturned, turned, Vec3(0.0)) &&
                    space.path_is_free(turned, to, Vec3(0.0)))
                    return {Vec3(0.0), {unturned, turned}};
            }
    if (std::optional<ReachPath> path = side_approach(space, from, to, up, aside)) return *std::move(path);
    if (std::optional<ReachPath> path = path_around(space, from, to)) return *std::move(path);
    return path_over(lifts.back());
}

HandleAngle choose_handle_angle(const servo::Setup& setup, const servo::ToolContact* contact,
                                std::size_t joint, const joint::JointState& state, double preferred,
                                double sign, double stroke) {
    std::optional<FreeSpace> space;
    if (contact != nullptr) space.emplace(setup, *contact);
    HandleAngle best;
    double lowest_cost = 1e9;
    const double period = collision::fitting_angle(setup.wrench.head);
    const double step = std::max(period, pi / 6.0);
    const int half = static_cast<int>(std::lround(pi / step));
    for (const bool flip : {false, true}) {
        if (flip && !reversible(setup.wrench)) break;
        const double head =
            setup.nuts[joint].sense * (flip ? setup.wrench.head_angle : -setup.wrench.head_angle);
        const double nearest = preferred + wrap(state.rotation() - head - preferred, period);
        for (int k = -half; k < half; ++k) {
            const double candidate = nearest + (contact != nullptr ? k * step : 0.0);
            double swing = stroke, penalty = 0.0;
            if (space) {
                swing = space->free_swing(joint, state.nut.angle, candidate, sign, stroke);
                for (const double above : approach_heights)
                    if (!space->handle_is_free(joint, state.nut.angle, candidate, above))
                        penalty = squeeze_cost;
            }
            // Room for the pull has more weight than the preferred angle.
            if (swing < std::min(stroke, least_swing)) penalty += cramped_cost;
            const double cost = std::abs(candidate - preferred) + 4.0 * (stroke - swing) + penalty;
            if (cost >= lowest_cost) continue;
            lowest_cost = cost;
            best = {candidate, flip, std::max(swing, least_swing)};
        }
    }
    return best;
}

double hover_height(const servo::Setup& setup, const servo::ToolContact& contact, std::size_t joint,
                    double nut_angle, const HandleAngle& handle, double max_height) {
    const FreeSpace space(setup, contact);
    const servo::NutGeometry& nut = setup.nuts[joint];
    const Quat held = tool_orientation(nut, handle.angle, handle.flipped);
    for (double above = max_height; above > min_hover_height; above -= hover_height_step) {
        const Pose pose{servo::nut_centre(nut, nut_angle) + above * nut.axis, held};
        if (space.step_is_free(pose, pose, 0.5 * hover_height_step)) return above;
    }
    return max_height;
}

Pose give_way_to_wrench(const Pose& commanded, const Pose& wrench) {
    const Vec3 ahead = commanded.position - wrench.position;
    const Vec3 turn = turn_between(wrench.orientation, commanded.orientation);
    const double far = glm::length(ahead), round = glm::length(turn);
    Pose pose = commanded;
    if (far > max_ahead) pose.position = wrench.position + ahead * (max_ahead / far);
    if (round > max_turn_lead)
        pose.orientation = glm::normalize(rotation(turn * (max_turn_lead / round)) * wrench.orientation);
    return pose;
}

}  // namespace bolt::motion
