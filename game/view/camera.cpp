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

constexpr double notch = 0.88;        // distance ratio of one notch of the wheel
constexpr double glide_time = 0.070;  // s, time constant

// Length in m at the target's distance that spans the height of the picture.
double span(const Orbit& o) { return 2.0 * o.distance * std::tan(0.5 * o.fov); }

double extent(const render::BoundingBox& box) {
    return std::max(static_cast<double>(glm::distance(box.low, box.high)), 1e-6);
}

}  // namespace

OrbitAxes axes_of(const Orbit& o) {
    const Vec3 right(std::cos(o.yaw), 0.0, -std::sin(o.yaw));
    const Vec3 back(std::sin(o.yaw) * std::cos(o.pitch), std::sin(o.pitch),
                    std::cos(o.yaw) * std::cos(o.pitch));
    return {right, glm::cross(back, right), back};
}

Orbit orbit_of(const Viewpoint& view) {
    const Vec3 offset = Vec3(view.eye) - Vec3(view.target);
    const double across = std::hypot(offset.x, offset.z);
    Orbit orbit;
    orbit.target = Vec3(view.target);
    orbit.distance = std::max(glm::length(offset), 1e-9);
    // A vertical view has no yaw; 0 matches render::look_at.
    orbit.yaw = across < 1e-4 * std::abs(offset.y) ? 0.0 : std::atan2(offset.x, offset.z);
    orbit.pitch =
        across < 1e-4 * std::abs(offset.y) ? std::copysign(0.5 * pi, offset.y) : std::atan2(offset.y, across);
    orbit.fov = static_cast<double>(view.fov > 0.0F ? view.fov : default_fov);
    return orbit;
}

Viewpoint viewpoint_of(const Orbit& o) {
    return {"", glm::vec3(o.target + o.distance * axes_of(o).back), glm::vec3(o.target),
            static_cast<float>(o.fov)};
}

render::Eye eye_of(const Orbit& o, const render::BoundingBox& box, float aspect, float offset) {
    const OrbitAxes a = axes_of(o);
    const Vec3 shift = static_cast<double>(offset) * a.right;
    const Vec3 eye = o.target + o.distance * a.back + shift;
    // The arguments are columns; the rows are the axes.
    const glm::dmat4 turn(glm::dvec4(a.right.x, a.up.x, a.back.x, 0.0),
                          glm::dvec4(a.right.y, a.up.y, a.back.y, 0.0),
                          glm::dvec4(a.right.z, a.up.z, a.back.z, 0.0), glm::dvec4(0.0, 0.0, 0.0, 1.0));
    const glm::mat4 view(glm::translate(turn, -eye));
    const render::Perspective perspective =
        perspective_for(box, glm::vec3(eye), glm::vec3(o.target + shift), static_cast<float>(o.fov), aspect);
    return {glm::vec3(eye), convergence_shear(offset, static_cast<float>(o.distance), perspective) *
                                render::perspective(perspective) * view};
}

void turn(Orbit& o, glm::dvec2 by) {
    o.yaw -= pi * by.x;
    o.pitch = std::clamp(o.pitch - pi * by.y, -0.5 * pi, 0.5 * pi);
}

void pan(Orbit& o, glm::dvec2 by) {
    const OrbitAxes a = axes_of(o);
    o.target -= span(o) * (by.x * a.right + by.y * a.up);
}

void zoom(Orbit& o, double notches, glm::dvec2 at, const render::BoundingBox& box) {
    const double size = extent(box);
    const double to = std::clamp(o.distance * std::pow(notch, notches), 1e-3 * size, 30.0 * size);
    const OrbitAxes a = axes_of(o);
    const Vec3 point = o.target + span(o) * (at.x * a.right + at.y * a.up);
    o.target = point + (o.target - point) * (to / o.distance);
    o.distance = to;
}

Orbit limit_eye_height(const Orbit& orbit, double eye) {
    const double sine = std::clamp((eye - orbit.target.y) / orbit.distance, std::sin(to_radians(5.0)), 1.0);
    Orbit lower = orbit;
    lower.pitch = std::min(orbit.pitch, std::asin(sine));
    return lower;
}

Orbit fit_to_box(const Orbit& o, const render::BoundingBox& box, float aspect) {
    render::Perspective perspective;
    perspective.fov = static_cast<float>(o.fov);
    perspective.aspect = aspect;
    const glm::vec3 middle = 0.5F * (box.low + box.high);
    const glm::vec3 eye = render::framing_eye(box, glm::vec3(axes_of(o).back), perspective);
    Orbit framed = o;
    framed.target = Vec3(middle);
    framed.distance = static_cast<double>(glm::distance(eye, middle));
    return framed;
}

void CameraGlide::glide_to(const Orbit& to) {
    goal = to;
    goal.yaw = shown.yaw + wrap(to.yaw - shown.yaw, 2.0 * pi);
}

bool CameraGlide::advance(double seconds) {
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
    const double part = 1.0 - std::exp(-std::max(seconds, 0.0) / glide_time);
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
constexpr double max_distance = 1.8;                         // in handle lengths
constexpr double pitch_weight = 0.7;  // of pitch against yaw: raising the head takes less effort

// Adds the wrist to a view of the nut: keeps the direction, and increases the distance and shifts the target
// by no more than needed. Returns the widest attempt if the wrist does not fit.
Orbit with_wrist(const Orbit& nut_only, const ViewTarget& target) {
    Orbit orbit = nut_only;
    if (!target.wrist) return orbit;
    for (const glm::dvec2& area : {open_middle, picture_area})
        for (const double scale : {1.0, 1.15, 1.3, 1.5, 1.75})
            for (const double share : {0.0, 0.2, 0.35, 0.5}) {
                orbit.target = glm::mix(target.nut, *target.wrist, share);
                orbit.distance = scale * nut_only.distance;
                if (is_in_picture(orbit, target.nut, target.aspect, area) &&
                    is_in_picture(orbit, *target.wrist, target.aspect))
                    return orbit;
            }
    return orbit;
}

Vec3 eye_of(const Orbit& orbit) { return Vec3(viewpoint_of(orbit).eye); }

}  // namespace

double visibility_from(const ViewTarget& target, motion::VisibilityModel& model, const Vec3& eye) {
    if (target.contact == nullptr) return 1.0;
    return target.wrench ? motion::target_visibility(model, target.setup, *target.contact, target.joint,
                                                     *target.wrench, eye)
                         : motion::nut_visibility(model, *target.contact, target.joint, eye);
}

bool is_in_picture(const Orbit& orbit, const Vec3& point, double aspect, const glm::dvec2& area) {
    const Viewpoint view = viewpoint_of(orbit);
    render::Perspective lens;
    lens.fov = static_cast<float>(orbit.fov);
    lens.aspect = static_cast<float>(aspect);
    const render::Eye eye = render::make_eye(view.eye, view.target, lens);
    const glm::dvec4 clip = glm::dmat4(eye.clip_from_world) * glm::dvec4(point, 1.0);
    return clip.w > 0.0 && std::abs(clip.x) < area.x * clip.w && std::abs(clip.y) < area.y * clip.w;
}

Orbit find_view(const ViewTarget& target, motion::VisibilityModel& model, const Orbit& from) {
    Orbit near = from;
    near.target = target.nut;
    near.distance = std::min(from.distance, max_distance * target.setup.wrench.handle_length);
    near.pitch = std::clamp(from.pitch, to_radians(20.0), to_radians(80.0));
    Orbit best = with_wrist(near, target);
    double most = visibility_from(target, model, eye_of(best)), min_turn = 0.0;
    if (most >= sufficient_visibility) return best;
    for (int side = 0; side < sides; ++side)
        for (const double pitch : pitches) {
            Orbit orbit = near;
            orbit.yaw = from.yaw + wrap(2.0 * pi * side / sides, 2.0 * pi);
            orbit.pitch = to_radians(pitch);
            const double turn =
                std::abs(orbit.yaw - from.yaw) + pitch_weight * std::abs(orbit.pitch - near.pitch);
            const Orbit candidate = with_wrist(orbit, target);
            const bool enough = most >= sufficient_visibility;
            if (enough && turn >= min_turn) continue;
            const double visibility =
                std::min(visibility_from(target, model, eye_of(candidate)), sufficient_visibility);
            if (visibility < most || (visibility == most && turn >= min_turn)) continue;
            most = visibility;
            min_turn = turn;
            best = candidate;
        }
    return best;
}

namespace {

// Degrees from the handle about the nut, and above the plane of the jaw; in the order of preference.
constexpr std::array azimuths{0.0, 30.0, -30.0, 60.0, -60.0, 90.0, -90.0, 135.0, -135.0, 180.0};
constexpr std::array elevations{50.0, 65.0, 35.0, 80.0};
constexpr std::array swing_samples{0.0, 0.5, 1.0};  // fractions of the swing

// The least visible fraction during the swing. `eye`: m, in the frame of the tool.
double visibility_during_swing(const ViewTarget& target, const Pose& tool, double swing, const Vec3& eye,
                               motion::VisibilityModel& model) {
    const Vec3& axis = target.setup.nuts[target.joint].axis;
    double least = 1.0;
    for (const double share : swing_samples) {
        const Quat turn = glm::angleAxis(share * swing, axis);
        const Pose swung{tool.position, turn * tool.orientation};
        ViewTarget then = target;
        if (target.wrench) then.wrench = swung;
        least = std::min(least, visibility_from(then, model, swung * eye));
        if (swing == 0.0) break;
    }
    return least;
}

}  // namespace

CloseUpEye close_up_eye(const ViewTarget& target, const Pose& tool, double swing,
                        motion::VisibilityModel& model) {
    const servo::NutGeometry& nut = target.setup.nuts[target.joint];
    // Either face of the wrench may be up.
    const double up = glm::dot(tool.orientation * Vec3(0, 0, 1), nut.axis) < 0.0 ? -1.0 : 1.0;
    const double behind = target.wrench ? 0.0 : 180.0;
    CloseUpEye best;
    for (const double azimuth : azimuths)
        for (const double elevation : elevations) {
            const double a = to_radians(azimuth + behind), h = to_radians(elevation);
            const Vec3 eye = close_up_distance * nut.across_flats *
                             Vec3(std::cos(h) * std::cos(a), std::cos(h) * std::sin(a), up * std::sin(h));
            const double visibility = visibility_during_swing(target, tool, swing, eye, model);
            if (visibility <= best.visibility) continue;
            best = {eye, visibility};
            if (visibility >= sufficient_visibility) return best;
        }
    return best;
}

motion::ViewHelper make_view_helper() {
    return [model = std::make_shared<motion::VisibilityModel>()](const motion::ViewRequest& request) {
        Viewpoint now;
        now.eye = glm::vec3(request.eye);
        now.target = glm::vec3(request.nut);
        const ViewTarget target{request.setup, &request.contact, request.joint, request.nut, request.wrench};
        const Orbit orbit = find_view(target, *model, orbit_of(now));
        return Vec3(viewpoint_of(orbit).eye);
    };
}

}  // namespace bolt::view
