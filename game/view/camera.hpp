// The camera: an orbit around a target that the mouse moves, a smooth glide between orbits, and the search
// for a view of a nut and of the wrench's jaw that obstacles do not hide.
#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "engine/base/math.hpp"
#include "game/motion/visibility_model.hpp"
#include "game/view/shown_model.hpp"

namespace bolt::view {

struct Orbit {
    Vec3 target{0.0};       // m
    double yaw = 0.0;       // rad about Y; 0: the eye is on the side of +Z
    double pitch = 0.0;     // rad, from −90° (from below) to 90° (from above)
    double distance = 1.0;  // m, from the target to the eye
    double fov = 0.61;      // rad, vertical
};

// The directions of the camera, unit vectors.
struct OrbitAxes {
    Vec3 right, up, back;  // back: from the target to the eye
};
OrbitAxes axes_of(const Orbit& orbit);

Orbit orbit_of(const Viewpoint& view);
Viewpoint viewpoint_of(const Orbit& orbit);

// The eye for the renderer; well defined at pitch ±90° too. Its depth range contains the whole box. `offset`:
// m to the right of the orbit, for one of the two eyes of a stereo view, whose axes meet at the target
// (pictures.hpp).
render::Eye eye_of(const Orbit& orbit, const render::BoundingBox& box, float aspect, float offset = 0.0F);

// The following functions take positions and movements of the cursor in units of the picture's height, from
// its middle, x to the right, y up. So they do not depend on the picture's size.

// Rotates by the cursor's movement, half a turn per picture height; the model follows the cursor.
void turn(Orbit& orbit, glm::dvec2 by);

// Moves the target by the cursor's movement: a point at the target's distance follows the cursor.
void pan(Orbit& orbit, glm::dvec2 by);

// Approaches by notches of the mouse wheel (recedes if negative). The point under the cursor `at`, at the
// target's distance, stays there. Clamps the distance to 0.001 … 30 times the box's diagonal.
void zoom(Orbit& orbit, double notches, glm::dvec2 at, const render::BoundingBox& box);

// Lowers the eye to a height of at most `eye` m at the same distance, but not below a pitch of 5°.
Orbit limit_eye_height(const Orbit& orbit, double eye);

// Shows the whole box from the direction of the orbit.
Orbit fit_to_box(const Orbit& orbit, const render::BoundingBox& box, float aspect);

// A camera that approaches its goal exponentially with a time constant of 70 ms, independent of the frame
// rate. All values are interpolated with the same fraction, so that the point under the cursor stays fixed
// during a zoom.
struct CameraGlide {
    Orbit shown, goal;

    void jump(const Orbit& to) { shown = goal = to; }
    // Sets the goal; the yaw takes the shorter way.
    void glide_to(const Orbit& to);
    // Returns false if the goal had been reached before.
    bool advance(double seconds);
};

// The nut that a view should show, and the wrench. The obstacles are those that also stop the wrench.
struct ViewTarget {
    const servo::Setup& setup;
    const servo::ToolContact* contact = nullptr;  // null: there are no obstacles
    std::size_t joint = 0;
    Vec3 nut{0.0};               // m, centre of the nut
    std::optional<Pose> wrench;  // present or future pose of the wrench; none: only the nut must be visible
    // m, the wrist of the working hand, which the picture should contain.
    std::optional<Vec3> wrist = std::nullopt;
    double aspect = 16.0 / 9.0;
};

// The smaller visible fraction, 0 … 1, of the nut and the wrench's jaw from the eye.
double visibility_from(const ViewTarget& target, motion::VisibilityModel& model, const Vec3& eye);

// Visible fraction at which a search stops.
inline constexpr double sufficient_visibility = 0.6;

// Areas about the middle of the picture, as fractions of half its width and height. `picture_area`: all but a
// narrow border. `open_middle`: the part that texts at the borders never cover.
inline constexpr glm::dvec2 picture_area(0.88, 0.88), open_middle(0.36, 0.6);

// True if the point lies in the area of the picture.
bool is_in_picture(const Orbit& orbit, const Vec3& point, double aspect,
                   const glm::dvec2& area = picture_area);

// The view nearest to `from` with sufficient visibility, or else the one with the greatest visibility, at
// working distance. Places the nut in the open middle, or anywhere in the picture if the wrist requires it.
Orbit find_view(const ViewTarget& target, motion::VisibilityModel& model, const Orbit& from);

// An eye near the jaw for the close-up, fixed to the head of the wrench or, without a wrench, to the fingers.
struct CloseUpEye {
    Vec3 position{0.0};       // m, in the frame of the tool
    double visibility = 0.0;  // 0 … 1, the least during the swing
};

// Searches the directions from above the handle outwards and stops at the first with sufficient visibility
// during a swing of the wrench by `swing` rad (signed, about the bolt), or else returns the best direction.
// `tool`: target.wrench, or the fingers' frame if there is no wrench. Fingers come from +x, so their search
// begins on the opposite side.
CloseUpEye close_up_eye(const ViewTarget& target, const Pose& tool, double swing,
                        motion::VisibilityModel& model);

// Distance of the close-up's eye from the nut in nut widths, and its field of view in rad.
inline constexpr double close_up_distance = 4.5, close_up_fov = to_radians(42.0);

// Makes a function that calls find_view() for a simulated trainee. It caches surface samples: use one per
// lesson.
motion::ViewHelper make_view_helper();

}  // namespace bolt::view
