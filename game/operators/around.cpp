#include "game/operators/around.hpp"

#include <array>

namespace bolt::operators {

namespace {

constexpr double beyond_grip = 1.12;  // the wrench's length over that from jaw to grip
constexpr double broad = 0.012;       // m to either side of the handle's middle
constexpr double swing_step = to_radians(5.0);
constexpr double margin = to_radians(3.0);  // kept from where a handle would meet something
constexpr double yields = 4e-3;             // m that the hand lets the wrench stay behind
constexpr double yields_turn = to_radians(4.0);
constexpr std::array rises{0.05, 0.1, 0.15, 0.2, 0.3, 0.4};  // m

}  // namespace

double rise_over(const servo::Setup& setup, const servo::Touch& touch, const Pose& from, const Pose& to,
                 const Vec3& up, double least) {
    const double length = beyond_grip * setup.wrench.handle_length;
    const auto free = [&](double rise) {
        Pose before = from;
        for (int i = 1; i <= 24; ++i) {
            const Pose pose = along(from, to, static_cast<double>(i) / 24.0, up, rise);
            for (const double part : {0.0, 0.5, 1.0}) {
                const Vec3 reach(part * length, 0.0, 0.0);
                if (servo::hidden(touch, before.position + before.orientation * reach,
                                  pose.position + pose.orientation * reach, -1))
                    return false;
            }
            if (servo::hidden(touch, pose.position, pose.position + pose.orientation * Vec3(length, 0, 0),
                              -1))
                return false;
            before = pose;
        }
        return true;
    };
    if (free(least)) return least;
    for (const double rise : rises)
        if (rise > least && free(rise)) return rise;
    return rises.back();
}

double swing_room(const servo::Setup& setup, const servo::Touch& touch, std::size_t joint, double nut_angle,
                  double angle, double sign, double most) {
    const servo::NutPlace& nut = setup.nuts[joint];
    const Vec3 centre = servo::nut_centre(nut, nut_angle);
    const double length = beyond_grip * setup.wrench.handle_length;
    const auto free = [&](double at) {
        const Vec3 out = std::cos(-at) * nut.e1 + std::sin(-at) * nut.e2, across = glm::cross(nut.axis, out);
        for (const double side : {-broad, 0.0, broad})
            for (const double height : {-0.35, 0.0, 0.35}) {
                const Vec3 beside = side * across + height * nut.height * nut.axis;
                if (servo::hidden(touch, centre + nut.across_flats * out + beside,
                                  centre + length * out + beside, static_cast<int>(joint)))
                    return false;
            }
        return true;
    };
    if (!free(angle)) return -1.0;
    double room = 0.0;
    while (room < most && free(angle + sign * (room + margin))) room += swing_step;
    return std::min(room, most);
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
