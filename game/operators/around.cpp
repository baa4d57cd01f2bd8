#include "game/operators/around.hpp"

#include <array>
#include <optional>

namespace bolt::operators {

namespace {

constexpr double beyond_grip = 1.12;  // the wrench's length over that from jaw to grip
constexpr double swing_step = to_radians(5.0);
constexpr double margin = to_radians(3.0);  // kept from where a handle would meet something
constexpr double yields = 4e-3;             // m that the hand lets the wrench stay behind
constexpr double yields_turn = to_radians(4.0);
constexpr std::array rises{0.05, 0.1, 0.15, 0.2, 0.3, 0.4};  // m
constexpr std::array heights{0.03, 0.08, 0.15};              // m above a nut, where a wrench comes down to it
constexpr double cramped = 2.0;  // rad that it would rather turn away than squeeze by

struct Seen {
    const servo::Setup& setup;
    const servo::Touch& touch;
    double length;                   // m, of the wrench
    double head = 0.0, broad = 0.0;  // m, half widths of its head and its handle

    Seen(const servo::Setup& s, const servo::Touch& t)
        : setup(s), touch(t), length(beyond_grip * s.wrench.handle_length) {
        for (const auto& triangle : t.wrench.solid.corners)
            for (const Vec3 p : triangle) {
                double& width = p.x > 0.3 * length ? broad : head;
                width = std::max(width, std::abs(p.y));
            }
    }

    [[nodiscard]] bool way_is_free(const Pose& from, const Pose& to, const Vec3& bulge) const {
        Pose before = from;
        for (int i = 1; i <= 24; ++i) {
            const Pose pose = along(from, to, static_cast<double>(i) / 24.0, bulge);
            for (const double side : {0.0, -1.0, 1.0}) {
                const Vec3 jaw(0.0, side * head, 0.0), middle(0.5 * length, side * broad, 0.0),
                    end(length, side * broad, 0.0);
                for (const Vec3& point : {jaw, middle, end})
                    if (servo::hidden(touch, before * point, pose * point, -1)) return false;
                if (servo::hidden(touch, pose * jaw, pose * middle, -1) ||
                    servo::hidden(touch, pose * middle, pose * end, -1))
                    return false;
            }
            before = pose;
        }
        return true;
    }

    // Whether a handle at this angle, `above` the nut, has nothing in it; beside it and over it too.
    [[nodiscard]] bool handle_is_free(std::size_t joint, double nut_angle, double angle, double above) const {
        const servo::NutPlace& nut = setup.nuts[joint];
        const Vec3 centre = servo::nut_centre(nut, nut_angle) + above * nut.axis;
        const Vec3 out = std::cos(-angle) * nut.e1 + std::sin(-angle) * nut.e2;
        const Vec3 across = glm::cross(nut.axis, out);
        for (const double side : {-broad, 0.0, broad})
            for (const double height : {-0.35, 0.0, 0.35}) {
                const Vec3 beside = side * across + height * nut.height * nut.axis;
                if (servo::hidden(touch, centre + nut.across_flats * out + beside,
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

}  // namespace

Way way_round(const servo::Setup& setup, const servo::Touch& touch, const Pose& from, const Pose& to,
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
    return {rises.back() * up, {}};
}

GripAngle choose_grip(const servo::Setup& setup, const servo::Touch* touch, std::size_t joint,
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

}  // namespace bolt::operators
