#include "game/motion/visibility_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace bolt::motion {

namespace {

constexpr std::size_t nut_spots = 120, wrench_spots = 600;  // of the latter a tenth is the head
constexpr double head_size = 0.9;                           // of the jaw's opening, from its middle

// Where heads go: about the place, and as high as somebody who stands there can be.
constexpr double step = to_radians(15.0);
constexpr double lowest = to_radians(15.0), highest = to_radians(80.0);
constexpr int in_vain = 2;      // steps that are gone on without seeing more
constexpr int most_tries = 12;  // ways that are begun, before it is left at that

// By touch and memory alone. Chosen: proprioception is good to about a centimetre.
constexpr double blind = 8e-3;  // m

double angle_between(const Vec3& a, const Vec3& b) {
    return std::acos(std::clamp(glm::dot(a, b) / (glm::length(a) * glm::length(b)), -1.0, 1.0));
}

const std::vector<collision::SurfacePoint>& spots_of(Sight& sight, const servo::ToolContact& touch,
                                                     std::size_t joint) {
    if (sight.nuts.size() <= joint) sight.nuts.resize(touch.nut_bodies.size());
    std::vector<collision::SurfacePoint>& spots = sight.nuts[joint];
    if (spots.empty())
        spots = collision::sample_outer_surface(
            touch.world.shapes[touch.world.bodies[*touch.nut_bodies[joint]].shape].solid, nut_spots);
    return spots;
}

struct Direction {
    int aside, up;
};

struct Bearing {  // of an eye about a place
    double far, azimuth, elevation;
};

struct Round {
    Bearing at;
    double share;
};

Bearing about(const Vec3& place, const Vec3& eye) {
    const Vec3 from = eye - place;
    const double far = glm::length(from);
    return {far, std::atan2(from.x, from.z), std::asin(from.y / far)};
}

Vec3 eye_at(const Vec3& place, const Bearing& b) {
    return place + b.far * Vec3(std::sin(b.azimuth) * std::cos(b.elevation), std::sin(b.elevation),
                                std::cos(b.azimuth) * std::cos(b.elevation));
}

// One way on from there, for as long as more is seen, and back to where most was. Added to `move`: what that
// takes.
Round go_on(const Round& from, const Direction& way, const Vec3& place, double content,
            const std::function<double(const Vec3&)>& share_from, HeadMove& move) {
    Round best = from;
    Bearing at = from.at;
    ++move.glances;
    for (int vain = 0; vain < in_vain && best.share < content;) {
        const Bearing next{at.far, at.azimuth + way.aside * step, at.elevation + way.up * step};
        if (next.elevation < lowest || next.elevation > highest) break;
        const Vec3 eye = eye_at(place, next);
        move.turn += angle_between(eye_at(place, at) - place, eye - place);
        at = next;
        const double share = share_from(eye);
        ++vain;
        if (share <= best.share) continue;
        best = {at, share};
        vain = 0;
    }

    move.turn += angle_between(eye_at(place, at) - place, eye_at(place, best.at) - place);
    return best;
}

}  // namespace

double nut_seen(Sight& sight, const servo::ToolContact& touch, std::size_t joint, const Vec3& eye) {
    if (joint >= touch.nut_bodies.size() || !touch.nut_bodies[joint]) return 1.0;
    return collision::visibility_of(touch.world, *touch.nut_bodies[joint], spots_of(sight, touch, joint), eye)
        .share;
}

double place_seen(Sight& sight, const servo::Setup& setup, const servo::ToolContact& touch, std::size_t joint,
                  const Pose& wrench, const Vec3& eye) {
    const double nut = nut_seen(sight, touch, joint, eye);
    if (nut <= 0.0) return 0.0;
    if (sight.head.empty()) {
        sight.head = collision::sample_outer_surface(touch.wrench.solid, wrench_spots);
        std::erase_if(sight.head, [&](const collision::SurfacePoint& spot) {
            return glm::length(spot.at) > head_size * setup.wrench.jaw.opening;
        });
    }
    return std::min(nut,
                    collision::visibility_of(touch.world, touch.wrench.solid, wrench, sight.head, eye).share);
}

std::optional<HeadMove> look_round(Sight& sight, const servo::Setup& setup, const servo::ToolContact& touch,
                                   std::size_t joint, const Pose& wrench, double content, Random& random) {
    const auto share_from = [&](const Vec3& eye) {
        return place_seen(sight, setup, touch, joint, wrench, eye);
    };
    const double now = share_from(sight.eye);
    if (now >= content) return std::nullopt;
    const Vec3 place = setup.nuts[joint].seat;
    Round best{about(place, sight.eye), now};
    HeadMove move;
    std::array<Direction, 4> ways{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
    for (int tries = 0; tries < most_tries && best.share < content;) {
        for (std::size_t i = ways.size() - 1; i > 0; --i) std::swap(ways[i], ways[random.bits() % (i + 1)]);
        const double before = best.share;
        for (const Direction& way : ways) {
            if (++tries > most_tries) break;
            const Round seen = go_on(best, way, place, content, share_from, move);
            if (seen.share > best.share) {
                best = seen;
                break;
            }
        }
        if (!(best.share > before)) break;  // worse wherever it went
    }
    move.eye = best.share > now ? eye_at(place, best.at) : sight.eye;
    return move;
}

double placing_noise(double sharp, double share, int tries) {
    const double felt = blind / (1.0 + tries);
    return 1.0 / std::sqrt(share / square(sharp) + 1.0 / square(std::max(felt, sharp)));
}

}  // namespace bolt::motion
