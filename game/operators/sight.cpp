#include "game/operators/sight.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::operators {

namespace {

constexpr std::size_t nut_spots = 120, wrench_spots = 600;  // of the latter a tenth is the head
constexpr double head_size = 0.9;                           // of the jaw's opening, from its middle

// Where heads go: about the place, in steps, as high and as far as somebody who stands there can be.
constexpr double step = to_radians(15.0);
constexpr double lowest = to_radians(15.0), highest = to_radians(80.0);
constexpr int most_round = 12;

// By touch and memory alone. Chosen: proprioception is good to about a centimetre.
constexpr double blind = 8e-3;  // m

const std::vector<contact::Spot>& spots_of(Sight& sight, const servo::Touch& touch, std::size_t joint) {
    if (sight.nuts.size() <= joint) sight.nuts.resize(touch.nuts.size());
    std::vector<contact::Spot>& spots = sight.nuts[joint];
    if (spots.empty())
        spots = contact::outer_spots(touch.world.shapes[touch.world.bodies[*touch.nuts[joint]].shape].solid,
                                     nut_spots);
    return spots;
}

}  // namespace

double nut_seen(Sight& sight, const servo::Touch& touch, std::size_t joint, const Vec3& eye) {
    if (joint >= touch.nuts.size() || !touch.nuts[joint]) return 1.0;
    return contact::look_at(touch.world, *touch.nuts[joint], spots_of(sight, touch, joint), eye).share;
}

double place_seen(Sight& sight, const servo::Setup& setup, const servo::Touch& touch, std::size_t joint,
                  const Pose& wrench, const Vec3& eye) {
    const double nut = nut_seen(sight, touch, joint, eye);
    if (nut <= 0.0) return 0.0;
    if (sight.head.empty()) {
        sight.head = contact::outer_spots(touch.wrench.solid, wrench_spots);
        std::erase_if(sight.head, [&](const contact::Spot& spot) {
            return glm::length(spot.at) > head_size * setup.wrench.jaw.opening;
        });
    }
    return std::min(nut, contact::look_at(touch.world, touch.wrench.solid, wrench, sight.head, eye).share);
}

std::optional<HeadMove> look_round(Sight& sight, const servo::Setup& setup, const servo::Touch& touch,
                                   std::size_t joint, const Pose& wrench, double content) {
    const auto share_at = [&](const Vec3& eye) {
        return place_seen(sight, setup, touch, joint, wrench, eye);
    };
    const double now = share_at(sight.eye);
    if (now >= content) return std::nullopt;
    const Vec3 place = setup.nuts[joint].seat, from = sight.eye - place;
    const double far = glm::length(from);
    const double round = std::atan2(from.x, from.z), high = std::asin(from.y / far);
    std::optional<HeadMove> best;
    double most = now;
    // The nearest first; one that is no better than a nearer one is not worth the way.
    for (int away = 1; away <= 2 * most_round; ++away)
        for (int aside = -std::min(away, most_round); aside <= std::min(away, most_round); ++aside)
            for (const int up : {away - std::abs(aside), std::abs(aside) - away}) {
                const double elevation = high + up * step;
                if (elevation < lowest || elevation > highest) continue;
                const double azimuth = round + aside * step;
                const Vec3 eye =
                    place + far * Vec3(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                                       std::cos(azimuth) * std::cos(elevation));
                const double share = share_at(eye);
                if (share <= most) continue;
                most = share;
                best = HeadMove{eye,
                                std::acos(std::clamp(glm::dot(from, eye - place) / (far * far), -1.0, 1.0))};
                if (share >= content) return best;
            }
    return best;
}

double placing_noise(double sharp, double share, int tries) {
    const double felt = blind / (1.0 + tries);
    return 1.0 / std::sqrt(share / square(sharp) + 1.0 / square(std::max(felt, sharp)));
}

}  // namespace bolt::operators
