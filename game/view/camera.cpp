#include "game/view/camera.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <memory>

#include "engine/render/camera.hpp"
#include "game/view/pictures.hpp"

namespace bolt::view {

namespace {

constexpr double notch = 0.88;   // of the distance is left after one
constexpr double glide = 0.070;  // s

struct Axes {
    Vec3 right, up, back;  // back: from the target to the eye
};

Axes axes(const Orbit& o) {
    const Vec3 right(std::cos(o.yaw), 0.0, -std::sin(o.yaw));
    const Vec3 back(std::sin(o.yaw) * std::cos(o.pitch), std::sin(o.pitch),
                    std::cos(o.yaw) * std::cos(o.pitch));
    return {right, glm::cross(back, right), back};
}

// Metres at the target's distance that a height of the picture spans.
double span(const Orbit& o) { return 2.0 * o.distance * std::tan(0.5 * o.fov); }

double extent(const render::BoundingBox& box) {
    return std::max(static_cast<double>(glm::distance(box.low, box.high)), 1e-6);
}

}  // namespace

Orbit orbit_of(const Viewpoint& view) {
    const Vec3 way = Vec3(view.eye) - Vec3(view.target);
    const double across = std::hypot(way.x, way.z);
    Orbit orbit;
    orbit.target = Vec3(view.target);
    orbit.distance = std::max(glm::length(way), 1e-9);
    // Straight from above there is no side that it is seen from: it is the one that render::look_at takes.
    orbit.yaw = across < 1e-4 * std::abs(way.y) ? 0.0 : std::atan2(way.x, way.z);
    orbit.pitch =
        across < 1e-4 * std::abs(way.y) ? std::copysign(0.5 * pi, way.y) : std::atan2(way.y, across);
    orbit.fov = static_cast<double>(view.fov > 0.0F ? view.fov : usual_fov);
    return orbit;
}

Viewpoint viewpoint_of(const Orbit& o) {
    return {"", glm::vec3(o.target + o.distance * axes(o).back), glm::vec3(o.target),
            static_cast<float>(o.fov)};
}

render::Eye eye_of(const Orbit& o, const render::BoundingBox& box, float aspect, float aside) {
    const Axes a = axes(o);
    const Vec3 beside = static_cast<double>(aside) * a.right;
    const Vec3 eye = o.target + o.distance * a.back + beside;
    // Columns; the rows are the axes.
    const glm::dmat4 turn(glm::dvec4(a.right.x, a.up.x, a.back.x, 0.0),
                          glm::dvec4(a.right.y, a.up.y, a.back.y, 0.0),
                          glm::dvec4(a.right.z, a.up.z, a.back.z, 0.0), glm::dvec4(0.0, 0.0, 0.0, 1.0));
    const glm::mat4 view(glm::translate(turn, -eye));
    const render::Perspective through =
        lens(box, glm::vec3(eye), glm::vec3(o.target + beside), static_cast<float>(o.fov), aspect);
    return {glm::vec3(eye),
            converging(aside, static_cast<float>(o.distance), through) * render::perspective(through) * view};
}

void turn(Orbit& o, glm::dvec2 by) {
    o.yaw -= pi * by.x;
    o.pitch = std::clamp(o.pitch - pi * by.y, -0.5 * pi, 0.5 * pi);
}

void pan(Orbit& o, glm::dvec2 by) {
    const Axes a = axes(o);
    o.target -= span(o) * (by.x * a.right + by.y * a.up);
}

void zoom(Orbit& o, double notches, glm::dvec2 at, const render::BoundingBox& box) {
    const double size = extent(box);
    const double to = std::clamp(o.distance * std::pow(notch, notches), 1e-3 * size, 30.0 * size);
    const Axes a = axes(o);
    const Vec3 point = o.target + span(o) * (at.x * a.right + at.y * a.up);
    o.target = point + (o.target - point) * (to / o.distance);
    o.distance = to;
}

Orbit from_at_most(const Orbit& orbit, double eye) {
    const double sine = std::clamp((eye - orbit.target.y) / orbit.distance, std::sin(to_radians(5.0)), 1.0);
    Orbit lower = orbit;
    lower.pitch = std::min(orbit.pitch, std::asin(sine));
    return lower;
}

Orbit framing(const Orbit& o, const render::BoundingBox& box, float aspect) {
    render::Perspective through;
    through.fov = static_cast<float>(o.fov);
    through.aspect = aspect;
    const glm::vec3 middle = 0.5F * (box.low + box.high);
    const glm::vec3 eye = render::framing_eye(box, glm::vec3(axes(o).back), through);
    Orbit all = o;
    all.target = Vec3(middle);
    all.distance = static_cast<double>(glm::distance(eye, middle));
    return all;
}

void Glide::go(const Orbit& to) {
    goal = to;
    goal.yaw = shown.yaw + wrap(to.yaw - shown.yaw, 2.0 * pi);
}

bool Glide::advance(double seconds) {
    const double size = std::max(shown.distance, goal.distance);
    const double left =
        std::max({glm::distance(shown.target, goal.target) / size, std::abs(shown.yaw - goal.yaw),
                  std::abs(shown.pitch - goal.pitch), std::abs(shown.distance - goal.distance) / size,
                  std::abs(shown.fov - goal.fov)});
    if (left == 0.0) return false;
    if (left < 2e-4) {  // less than a pixel
        shown = goal;
        return true;
    }
    const double part = 1.0 - std::exp(-std::max(seconds, 0.0) / glide);
    shown.target += part * (goal.target - shown.target);
    shown.yaw += part * (goal.yaw - shown.yaw);
    shown.pitch += part * (goal.pitch - shown.pitch);
    shown.distance += part * (goal.distance - shown.distance);
    shown.fov += part * (goal.fov - shown.fov);
    return true;
}

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

namespace {

// Degrees: from the handle's side, and above the plane of the jaw. In the order of preference.
constexpr std::array sides_deg{0.0, 30.0, -30.0, 60.0, -60.0, 90.0, -90.0, 135.0, -135.0, 180.0};
constexpr std::array heights{50.0, 65.0, 35.0, 80.0};
constexpr std::array swung{0.0, 0.5, 1.0};  // of the swing

double seen_through_swing(const ViewOf& of, const Pose& tool, double swing, const Vec3& eye,
                          motion::Sight& sight) {
    const Vec3& axis = of.setup.nuts[of.joint].axis;
    double least = 1.0;
    for (const double share : swung) {
        const Quat turn = glm::angleAxis(share * swing, axis);
        const Pose there{tool.position, turn * tool.orientation};
        ViewOf then = of;
        if (of.wrench) then.wrench = there;
        least = std::min(least, seen_from(then, sight, there * eye));
        if (swing == 0.0) break;
    }
    return least;
}

}  // namespace

CloseUpEye close_up_eye(const ViewOf& of, const Pose& tool, double swing, motion::Sight& sight) {
    const servo::NutGeometry& nut = of.setup.nuts[of.joint];
    // The wrench may lie on either face.
    const double up = glm::dot(tool.orientation * Vec3(0, 0, 1), nut.axis) < 0.0 ? -1.0 : 1.0;
    const double behind = of.wrench ? 0.0 : 180.0;
    CloseUpEye best;
    for (const double side : sides_deg)
        for (const double height : heights) {
            const double a = to_radians(side + behind), h = to_radians(height);
            const Vec3 eye = close_up_distance * nut.across_flats *
                             Vec3(std::cos(h) * std::cos(a), std::cos(h) * std::sin(a), up * std::sin(h));
            const double seen = seen_through_swing(of, tool, swing, eye, sight);
            if (seen <= best.seen) continue;
            best = {eye, seen};
            if (seen >= well_seen) return best;
        }
    return best;
}

motion::ViewHelp view_help() {
    return [sight = std::make_shared<motion::Sight>()](const motion::ViewAsk& ask) {
        view::Viewpoint now;
        now.eye = glm::vec3(ask.eye);
        now.target = glm::vec3(ask.nut);
        const ViewOf of{ask.setup, &ask.touch, ask.joint, ask.nut, ask.wrench};
        const view::Orbit orbit = find_view(of, *sight, view::orbit_of(now));
        return Vec3(view::viewpoint_of(orbit).eye);
    };
}

}  // namespace bolt::view
