#include "game/motion/path_planning.hpp"

#include <array>
#include <functional>
#include <optional>

namespace bolt::motion {

Quat orientation_of(const servo::NutGeometry& nut, double handle_angle, bool flipped) {
    const Vec3 x = std::cos(-handle_angle) * nut.e1 + std::sin(-handle_angle) * nut.e2;
    const Vec3 z = flipped ? -nut.axis : nut.axis;
    return glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z)));
}

namespace {

constexpr double beyond_grip = 1.12;  // the wrench's length over that from jaw to grip
constexpr double swing_step = to_radians(5.0);
constexpr double margin = to_radians(3.0);  // kept from where a handle would meet something
constexpr double yields = 4e-3;             // m that the hand lets the wrench stay behind
constexpr double yields_turn = to_radians(4.0);
constexpr double keeps_off = 0.012;                          // m, from what it goes by
constexpr std::array rises{0.05, 0.1, 0.15, 0.2, 0.3, 0.4};  // m
constexpr std::array lifts{0.06, 0.12, 0.2, 0.35};           // m, straight up before it goes across
constexpr std::array heights{0.03, 0.08, 0.15};              // m above a nut, where a wrench comes down to it
constexpr double least_above = 0.015, above_step = 2e-3;     // m
constexpr double cramped = 2.0;  // rad that it would rather turn away than squeeze by

struct Seen {
    const servo::Setup& setup;
    const servo::ToolContact& touch;
    double length;                    // m, of the wrench
    double broad = 0.0, thick = 0.0;  // m, half of its handle's width and of its head's thickness
    std::array<Vec3, 8> rim{};        // of its head, what reaches furthest to each side

    Seen(const servo::Setup& s, const servo::ToolContact& t)
        : setup(s), touch(t), length(beyond_grip * s.wrench.handle_length) {
        std::array<double, 8> furthest{};
        for (const auto& triangle : t.wrench.solid.corners)
            for (const Vec3 p : triangle) {
                if (p.x > 0.3 * length) {
                    broad = std::max(broad, std::abs(p.y));
                    continue;
                }
                thick = std::max(thick, std::abs(p.z));
                for (std::size_t k = 0; k < rim.size(); ++k) {
                    const double angle = static_cast<double>(k) * pi / 4.0;
                    const double far = p.x * std::cos(angle) + p.y * std::sin(angle);
                    if (far <= furthest[k]) continue;
                    furthest[k] = far;
                    rim[k] = {p.x, p.y, 0.0};
                }
            }
    }

    // Where the wrench is and where it has just been: both its faces, `clear` beyond all its sides.
    [[nodiscard]] bool step_is_free(const Pose& before, const Pose& pose, double clear) const {
        const auto blocked = [&](const Vec3& a, const Vec3& b) { return servo::occluded(touch, a, b, -1); };
        for (const double face : {-1.0, 1.0}) {
            const Vec3 off(0.0, 0.0, face * (thick + clear));
            const Vec3 middle = pose * (Vec3(0.5 * length, 0.0, 0.0) + off);
            for (const Vec3& side : rim) {
                const Vec3 point = side * (1.0 + clear / glm::length(side)) + off;
                if (blocked(before * point, pose * point) || blocked(middle, pose * point)) return false;
            }
            for (const double side : {-1.0, 1.0}) {
                const Vec3 end = Vec3(length, side * (broad + clear), 0.0) + off;
                if (blocked(before * end, pose * end) || blocked(middle, pose * end)) return false;
            }
        }
        return true;
    }

    [[nodiscard]] bool way_is_free(const Pose& from, const Pose& to, const Vec3& bulge) const {
        Pose before = from;
        for (int i = 1; i <= 24; ++i) {
            const double s = static_cast<double>(i) / 24.0;
            const Pose pose = along(from, to, s, bulge);
            // Where it begins and ends it is as near as it is; in between nobody goes by a hair's breadth.
            if (!step_is_free(before, pose, keeps_off * 4.0 * s * (1.0 - s))) return false;
            before = pose;
        }
        return true;
    }

    // Whether a handle at this angle, `above` the nut, has nothing in it; beside it and over it too.
    [[nodiscard]] bool handle_is_free(std::size_t joint, double nut_angle, double angle, double above) const {
        const servo::NutGeometry& nut = setup.nuts[joint];
        const Vec3 centre = servo::nut_centre(nut, nut_angle) + above * nut.axis;
        const Vec3 out = std::cos(-angle) * nut.e1 + std::sin(-angle) * nut.e2;
        const Vec3 across = glm::cross(nut.axis, out);
        for (const double side : {-broad, 0.0, broad})
            for (const double height : {-0.35, 0.0, 0.35}) {
                const Vec3 beside = side * across + height * nut.height * nut.axis;
                if (servo::occluded(touch, centre + nut.across_flats * out + beside,
                                    centre + length * out + beside, static_cast<int>(joint)))
                    return false;
            }
        return true;
    }

    // rad that a handle may swing before it meets something, at most `most`; below zero: not even there.
    [[nodiscard]] double swing_room(std::size_t joint, double nut_angle, double angle, double sign,
                                    double most) const {
        if (!handle_is_free(joint, nut_angle, angle, 0.0)) return -1.0;
        double room = 0.0;
        while (room < most && handle_is_free(joint, nut_angle, angle + sign * (room + margin), 0.0))
            room += swing_step;
        return std::min(room, most);
    }
};

// Into a gap that is not open above: straight in from the side, and to there over the top.
std::optional<Way> from_beside(const Seen& seen, const Pose& from, const Pose& to, const Vec3& up,
                               const std::function<Vec3(int)>& aside) {
    for (const double far : {0.25, 0.4, 0.6})
        for (int i = 0; i < 8; ++i) {
            const Pose beside{to.position + far * aside(i), to.orientation};
            if (!seen.way_is_free(beside, to, Vec3(0.0))) continue;
            for (const double high : lifts) {
                const Pose lifted{from.position + high * up, from.orientation};
                const Pose over{beside.position + glm::dot(lifted.position - beside.position, up) * up,
                                to.orientation};
                if (seen.way_is_free(from, lifted, Vec3(0.0)) && seen.way_is_free(lifted, over, Vec3(0.0)) &&
                    seen.way_is_free(over, beside, Vec3(0.0)))
                    return Way{Vec3(0.0), {lifted, over, beside}};
            }
        }
    return std::nullopt;
}

}  // namespace

Way way_round(const servo::Setup& setup, const servo::ToolContact& touch, const Pose& from, const Pose& to,
              const Vec3& up, double least) {
    const Seen seen(setup, touch);
    if (seen.way_is_free(from, to, least * up)) return {least * up, {}};
    for (const double rise : rises)
        if (rise > least && seen.way_is_free(from, to, rise * up)) return {rise * up, {}};
    const Vec3 helper = std::abs(up.x) < 0.9 ? Vec3(1, 0, 0) : Vec3(0, 0, 1);
    const Vec3 e1 = glm::normalize(helper - up * glm::dot(helper, up)), e2 = glm::cross(up, e1);
    const auto aside = [&](int eighth) {
        return std::cos(eighth * pi / 4.0) * e1 + std::sin(eighth * pi / 4.0) * e2;
    };
    for (const double rise : {0.1, 0.2, 0.4})
        for (int i = 0; i < 8; ++i)
            if (const Vec3 bulge = rise * (up + aside(i)); seen.way_is_free(from, to, bulge))
                return {bulge, {}};
    const auto over_it = [&](double high) -> Way {
        return {Vec3(0.0),
                {{from.position + high * up, from.orientation}, {to.position + high * up, to.orientation}}};
    };
    for (const double high : lifts) {
        const Way way = over_it(high);
        const Pose &lifted = way.stations[0], &above = way.stations[1];
        if (seen.way_is_free(from, lifted, Vec3(0.0)) && seen.way_is_free(lifted, above, Vec3(0.0)) &&
            seen.way_is_free(above, to, Vec3(0.0)))
            return way;
    }
    const Vec3 middle = 0.5 * (from.position + to.position);
    for (const double high : {0.2, 0.5})
        for (const double far : {0.0, 0.3, 0.6})
            for (int i = 0; i < (far > 0.0 ? 8 : 1); ++i) {
                const Vec3 open = middle + high * up + far * aside(i);
                const Pose as_it_is{open, from.orientation}, turned{open, to.orientation};
                if (seen.way_is_free(from, as_it_is, Vec3(0.0)) &&
                    seen.way_is_free(as_it_is, turned, Vec3(0.0)) && seen.way_is_free(turned, to, Vec3(0.0)))
                    return {Vec3(0.0), {as_it_is, turned}};
            }
    if (std::optional<Way> way = from_beside(seen, from, to, up, aside)) return *std::move(way);
    return over_it(lifts.back());
}

GripAngle choose_grip(const servo::Setup& setup, const servo::ToolContact* touch, std::size_t joint,
                      double nut_angle, double wanted, double sign, double stroke) {
    std::optional<Seen> seen;
    if (touch != nullptr) seen.emplace(setup, *touch);
    GripAngle best;
    double least = 1e9;
    for (const bool flip : {false, true}) {
        const double head = flip ? setup.wrench.head_angle : -setup.wrench.head_angle;
        const double nearest = wanted + wrap(nut_angle - head - wanted, pi / 3.0);
        for (int sixth = -3; sixth < 3; ++sixth) {
            const double candidate = nearest + (touch != nullptr ? sixth * pi / 3.0 : 0.0);
            double swing = stroke, squeeze = 0.0;
            if (seen) {
                swing = seen->swing_room(joint, nut_angle, candidate, sign, stroke);
                for (const double above : heights)
                    if (!seen->handle_is_free(joint, nut_angle, candidate, above)) squeeze = cramped;
            }
            // Room for the pull counts more than where the arm would like to be.
            const double cost = std::abs(candidate - wanted) + 4.0 * (stroke - swing) + squeeze;
            if (cost >= least) continue;
            least = cost;
            best = {candidate, flip, std::max(swing, to_radians(15.0))};
        }
    }
    return best;
}

double room_above(const servo::Setup& setup, const servo::ToolContact& touch, std::size_t joint,
                  double nut_angle, const GripAngle& grip, double most) {
    const Seen seen(setup, touch);
    const servo::NutGeometry& nut = setup.nuts[joint];
    const Quat held = orientation_of(nut, grip.handle, grip.flipped);
    for (double above = most; above > least_above; above -= above_step) {
        const Pose pose{servo::nut_centre(nut, nut_angle) + above * nut.axis, held};
        if (seen.step_is_free(pose, pose, 0.5 * above_step)) return above;
    }
    return most;
}

Pose give_way(const Pose& wanted, const Pose& wrench) {
    const Vec3 ahead = wanted.position - wrench.position;
    const Vec3 turn =
        rotation_vector(glm::normalize(wanted.orientation * glm::conjugate(wrench.orientation)));
    const double far = glm::length(ahead), round = glm::length(turn);
    Pose pose = wanted;
    if (far > yields) pose.position = wrench.position + ahead * (yields / far);
    if (round > yields_turn)
        pose.orientation = glm::normalize(rotation(turn * (yields_turn / round)) * wrench.orientation);
    return pose;
}

}  // namespace bolt::motion
