#include "game/scene/find_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace bolt::scene {

namespace {

constexpr int sides = 24;                                    // every 15° about the bolt
constexpr std::array pitches{35.0, 50.0, 22.0, 65.0, 80.0};  // degrees
constexpr double reach = 1.8;                                // of the handle's length: how far off
constexpr double dearer_pitch = 0.7;                         // a head is raised more easily than moved

Vec3 eye_of(const view::Orbit& orbit) { return Vec3(view::viewpoint_of(orbit).eye); }

}  // namespace

double seen_from(const ViewOf& of, operators::Sight& sight, const Vec3& eye) {
    if (of.touch == nullptr) return 1.0;
    return of.wrench ? operators::place_seen(sight, of.setup, *of.touch, of.joint, *of.wrench, eye)
                     : operators::nut_seen(sight, *of.touch, of.joint, eye);
}

view::Orbit find_view(const ViewOf& of, operators::Sight& sight, const view::Orbit& from) {
    view::Orbit near = from;
    near.target = of.nut;
    near.distance = std::min(from.distance, reach * of.setup.wrench.handle_length);
    near.pitch = std::clamp(from.pitch, to_radians(20.0), to_radians(80.0));
    view::Orbit best = near;
    double most = seen_from(of, sight, eye_of(near)), least_turn = 0.0;
    if (most >= well_seen) return near;
    for (int side = 0; side < sides; ++side)
        for (const double pitch : pitches) {
            view::Orbit orbit = near;
            orbit.yaw = from.yaw + wrap(2.0 * pi * side / sides, 2.0 * pi);
            orbit.pitch = to_radians(pitch);
            const double turn =
                std::abs(orbit.yaw - from.yaw) + dearer_pitch * std::abs(orbit.pitch - near.pitch);
            const bool enough = most >= well_seen;
            if (enough && turn >= least_turn) continue;
            const double seen = std::min(seen_from(of, sight, eye_of(orbit)), well_seen);
            if (seen < most || (seen == most && turn >= least_turn)) continue;
            most = seen;
            least_turn = turn;
            best = orbit;
        }
    return best;
}

}  // namespace bolt::scene
