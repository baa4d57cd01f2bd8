#include "game/view/view_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/render/camera.hpp"

namespace bolt::view {

namespace {

constexpr int sides = 24;                                    // every 15° about the bolt
constexpr std::array pitches{35.0, 50.0, 22.0, 65.0, 80.0};  // degrees
constexpr double reach = 1.8;                                // of the handle's length: how far off
constexpr double dearer_pitch = 0.7;                         // a head is raised more easily than moved

// From the same side, no further off and no more aside of the nut than it takes to have the wrist in the
// picture too; as far as that goes.
view::Orbit with_wrist(const view::Orbit& of_nut, const ViewOf& of) {
    view::Orbit orbit = of_nut;
    if (!of.wrist) return orbit;
    for (const glm::dvec2& middle : {open_middle, whole_picture})
        for (const double further : {1.0, 1.15, 1.3, 1.5, 1.75})
            for (const double aside : {0.0, 0.2, 0.35, 0.5}) {
                orbit.target = glm::mix(of.nut, *of.wrist, aside);
                orbit.distance = further * of_nut.distance;
                if (holds(orbit, of.nut, of.aspect, middle) && holds(orbit, *of.wrist, of.aspect))
                    return orbit;
            }
    return orbit;
}

Vec3 eye_of(const view::Orbit& orbit) { return Vec3(view::viewpoint_of(orbit).eye); }

}  // namespace

double seen_from(const ViewOf& of, motion::Sight& sight, const Vec3& eye) {
    if (of.touch == nullptr) return 1.0;
    return of.wrench ? motion::place_seen(sight, of.setup, *of.touch, of.joint, *of.wrench, eye)
                     : motion::nut_seen(sight, *of.touch, of.joint, eye);
}

bool holds(const view::Orbit& orbit, const Vec3& point, double aspect, const glm::dvec2& part) {
    const view::Viewpoint from = view::viewpoint_of(orbit);
    render::Perspective lens;
    lens.fov = static_cast<float>(orbit.fov);
    lens.aspect = static_cast<float>(aspect);
    const render::Eye eye = render::make_eye(from.eye, from.target, lens);
    const glm::dvec4 clip = glm::dmat4(eye.clip_from_world) * glm::dvec4(point, 1.0);
    return clip.w > 0.0 && std::abs(clip.x) < part.x * clip.w && std::abs(clip.y) < part.y * clip.w;
}

view::Orbit find_view(const ViewOf& of, motion::Sight& sight, const view::Orbit& from) {
    view::Orbit near = from;
    near.target = of.nut;
    near.distance = std::min(from.distance, reach * of.setup.wrench.handle_length);
    near.pitch = std::clamp(from.pitch, to_radians(20.0), to_radians(80.0));
    view::Orbit best = with_wrist(near, of);
    double most = seen_from(of, sight, eye_of(best)), least_turn = 0.0;
    if (most >= well_seen) return best;
    for (int side = 0; side < sides; ++side)
        for (const double pitch : pitches) {
            view::Orbit orbit = near;
            orbit.yaw = from.yaw + wrap(2.0 * pi * side / sides, 2.0 * pi);
            orbit.pitch = to_radians(pitch);
            const double turn =
                std::abs(orbit.yaw - from.yaw) + dearer_pitch * std::abs(orbit.pitch - near.pitch);
            const view::Orbit whole = with_wrist(orbit, of);
            const bool enough = most >= well_seen;
            if (enough && turn >= least_turn) continue;
            const double seen = std::min(seen_from(of, sight, eye_of(whole)), well_seen);
            if (seen < most || (seen == most && turn >= least_turn)) continue;
            most = seen;
            least_turn = turn;
            best = whole;
        }
    return best;
}

}  // namespace bolt::view
