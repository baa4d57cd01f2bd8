#include "game/motion/visibility_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace bolt::motion {

namespace {

constexpr std::size_t nut_samples = 120, wrench_samples = 600;  // a tenth of these are on the wrench's head
constexpr double head_size = 0.9;                               // radius of the head / jaw opening

// Head positions: steps about the target, and the range of elevations of a standing person.
constexpr double step = to_radians(15.0);
constexpr double lowest = to_radians(15.0), highest = to_radians(80.0);
constexpr int max_vain_steps = 2;  // steps without an increase of the visibility
constexpr int max_tries = 12;      // directions tried in all

// Standard deviation by touch and memory alone. Our choice: proprioception is accurate to about 1 cm.
constexpr double touch_noise = 8e-3;  // m

double angle_between(const Vec3& a, const Vec3& b) {
    return std::acos(std::clamp(glm::dot(a, b) / (glm::length(a) * glm::length(b)), -1.0, 1.0));
}

const std::vector<collision::SurfacePoint>& nut_samples_of(VisibilityModel& model,
                                                           const servo::ToolContact& contact,
                                                           std::size_t joint) {
    if (model.nuts.size() <= joint) model.nuts.resize(contact.nut_bodies.size());
    std::vector<collision::SurfacePoint>& samples = model.nuts[joint];
    if (samples.empty()) samples = servo::turned_part_samples(contact, joint, nut_samples);
    return samples;
}

struct HeadDirection {
    int aside, up;
};

// The position of an eye relative to the target: m, rad, rad.
struct Bearing {
    double distance, azimuth, elevation;
};

struct EyeCandidate {
    Bearing bearing;
    double share;
};

Bearing bearing_of(const Vec3& target, const Vec3& eye) {
    const Vec3 from = eye - target;
    const double distance = glm::length(from);
    return {distance, std::atan2(from.x, from.z), std::asin(from.y / distance)};
}

Vec3 eye_at(const Vec3& target, const Bearing& b) {
    return target + b.distance * Vec3(std::sin(b.azimuth) * std::cos(b.elevation), std::sin(b.elevation),
                                      std::cos(b.azimuth) * std::cos(b.elevation));
}

// Moves in one direction while the visibility increases, then returns to the best position. Adds the movement
// to `move`.
EyeCandidate search_direction(const EyeCandidate& from, const HeadDirection& direction, const Vec3& target,
                              double sufficient, const std::function<double(const Vec3&)>& visibility_from,
                              HeadMovement& move) {
    EyeCandidate best = from;
    Bearing bearing = from.bearing;
    ++move.glances;
    for (int vain_steps = 0; vain_steps < max_vain_steps && best.share < sufficient;) {
        const Bearing next{bearing.distance, bearing.azimuth + direction.aside * step,
                           bearing.elevation + direction.up * step};
        if (next.elevation < lowest || next.elevation > highest) break;
        const Vec3 eye = eye_at(target, next);
        move.turn += angle_between(eye_at(target, bearing) - target, eye - target);
        bearing = next;
        const double share = visibility_from(eye);
        ++vain_steps;
        if (share <= best.share) continue;
        best = {bearing, share};
        vain_steps = 0;
    }

    move.turn += angle_between(eye_at(target, bearing) - target, eye_at(target, best.bearing) - target);
    return best;
}

}  // namespace

double nut_visibility(VisibilityModel& model, const servo::ToolContact& contact, std::size_t joint,
                      const Vec3& eye) {
    if (joint >= contact.nut_bodies.size() || !contact.nut_bodies[joint]) return 1.0;
    return collision::visibility_of(contact.world, *contact.nut_bodies[joint],
                                    nut_samples_of(model, contact, joint), eye)
        .share;
}

double target_visibility(VisibilityModel& model, const servo::Setup& setup, const servo::ToolContact& contact,
                         std::size_t joint, const Pose& wrench, const Vec3& eye) {
    const double nut = nut_visibility(model, contact, joint, eye);
    if (nut <= 0.0) return 0.0;
    if (model.wrench_head.empty()) {
        model.wrench_head = collision::sample_outer_surface(contact.wrench.solid, wrench_samples);
        std::erase_if(model.wrench_head, [&](const collision::SurfacePoint& sample) {
            return glm::length(sample.at) > head_size * collision::width_across_flats(setup.wrench.head);
        });
    }
    return std::min(
        nut,
        collision::visibility_of(contact.world, contact.wrench.solid, wrench, model.wrench_head, eye).share);
}

std::optional<HeadMovement> improve_view(VisibilityModel& model, const servo::Setup& setup,
                                         const servo::ToolContact& contact, std::size_t joint,
                                         const Pose& wrench, double sufficient, Random& random) {
    const auto visibility_from = [&](const Vec3& eye) {
        return target_visibility(model, setup, contact, joint, wrench, eye);
    };
    const double now = visibility_from(model.eye);
    if (now >= sufficient) return std::nullopt;
    const Vec3 target = setup.nuts[joint].seat;
    EyeCandidate best{bearing_of(target, model.eye), now};
    HeadMovement move;
    std::array<HeadDirection, 4> ways{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
    for (int tries = 0; tries < max_tries && best.share < sufficient;) {
        for (std::size_t i = ways.size() - 1; i > 0; --i) std::swap(ways[i], ways[random.bits() % (i + 1)]);
        const double before = best.share;
        for (const HeadDirection& way : ways) {
            if (++tries > max_tries) break;
            const EyeCandidate found = search_direction(best, way, target, sufficient, visibility_from, move);
            if (found.share > best.share) {
                best = found;
                break;
            }
        }
        if (!(best.share > before)) break;  // no direction is better
    }
    move.eye = best.share > now ? eye_at(target, best.bearing) : model.eye;
    return move;
}

double placement_noise(double full_view_noise, double share, int tries) {
    const double felt = touch_noise / (1.0 + tries);
    return 1.0 / std::sqrt(share / square(full_view_noise) + 1.0 / square(std::max(felt, full_view_noise)));
}

}  // namespace bolt::motion
