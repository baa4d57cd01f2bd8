// A camera that circles around a point, as a hand with a mouse moves it. Places on the picture are in heights
// of the picture from its middle, x to the right and y up, so that nothing depends on its size.
#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "engine/base/math.hpp"
#include "game/motion/visibility_model.hpp"
#include "game/view/stage.hpp"

namespace bolt::view {

struct Orbit {
    Vec3 target{0.0};       // m
    double yaw = 0.0;       // rad about Y; 0: the eye is on the side of +Z
    double pitch = 0.0;     // rad, from −90° (from below) to 90° (from above)
    double distance = 1.0;  // m, from the target to the eye
    double fov = 0.61;      // rad, vertical
};

Orbit orbit_of(const Viewpoint& view);
Viewpoint viewpoint_of(const Orbit& orbit);

// What the renderer needs; right from straight above and below too. `aside`: m to the right of the orbit, as
// one of two eyes is, which meet at the target (stereo.hpp).
render::Eye eye_of(const Orbit& orbit, const render::BoundingBox& box, float aspect, float aside = 0.0F);

// The cursor went this far: half a turn a height. The model follows it.
void turn(Orbit& orbit, glm::dvec2 by);

// The cursor went this far, and what is at the target's distance goes with it.
void pan(Orbit& orbit, glm::dvec2 by);

// Nearer by notches of a wheel (further if negative), while the point under `at` (at the target's distance)
// stays there. Distances stay between a thousandth and thirty times the box's size.
void zoom(Orbit& orbit, double notches, glm::dvec2 at, const render::BoundingBox& box);

// From no higher than `eye` (m), as far away as before, and never from less than 5° above the target.
Orbit from_at_most(const Orbit& orbit, double eye);

// All of the box, from the side that it is seen from now.
Orbit framing(const Orbit& orbit, const render::BoundingBox& box, float aspect);

// The camera glides to where the hand wants it: what is left of the way shrinks by e in 70 ms, whatever the
// frames' times are. In a straight line in all values, so that a zoom keeps its point in between too.
struct Glide {
    Orbit shown, goal;

    void jump(const Orbit& to) { shown = goal = to; }
    // To another view, the short way around.
    void go(const Orbit& to);
    // True: it moved; false: it has been there already.
    bool advance(double seconds);
};

// A view in which the eye truly sees a nut and the jaw that goes on it, asked of the same obstacles that hold
// the wrench.

struct ViewOf {
    const servo::Setup& setup;
    const servo::ToolContact* touch = nullptr;  // null: nothing can hide anything
    std::size_t joint = 0;
    Vec3 nut{0.0};               // m, its middle
    std::optional<Pose> wrench;  // where the jaw is or will be; none: only the nut counts
    // m, the wrist of the hand that works there: the picture, of that shape, is to hold it too.
    std::optional<Vec3> wrist = std::nullopt;
    double aspect = 16.0 / 9.0;
};

// 0 … 1: of nut and jaw the lesser.
double seen_from(const ViewOf& of, motion::Sight& sight, const Vec3& eye);

// Enough of it, and nobody wants more.
inline constexpr double well_seen = 0.6;

// Of half the picture's width and height: all but its very edge; and the middle, over which nothing is laid
// that is written at the edges.
inline constexpr glm::dvec2 whole_picture(0.88, 0.88), open_middle(0.36, 0.6);

// Whether a point is in that part of the picture.
bool holds(const view::Orbit& orbit, const Vec3& point, double aspect,
           const glm::dvec2& part = whole_picture);

// The view nearest to `from` in which it is well seen, or the one in which most is; near enough to work by.
// The nut is in the open middle unless only so the wrist is in the picture.
view::Orbit find_view(const ViewOf& of, motion::Sight& sight, const view::Orbit& from);

// An eye on the head of the wrench, or beside the fingers: near enough to see how the jaw lies on the nut.

// m, in the frame of the tool at work (`of.wrench`, or `fingers` where there is none): from over the handle
// if nut and jaw are well seen from there, through `swing` (rad about the bolt, signed) of the wrench; else
// from where they are, as near to the handle as may be; else from where most is seen. Fingers come along x,
// so their eye looks from the other side.
struct CloseUpEye {
    Vec3 at{0.0};
    double seen = 0.0;  // 0 … 1, the least in the swing
};
CloseUpEye close_up_eye(const ViewOf& of, const Pose& tool, double swing, motion::Sight& sight);

// How far off it is, of the nut's width, and its field of view, rad.
inline constexpr double close_up_distance = 4.5, close_up_fov = to_radians(42.0);

// What V does in the window (find_view.hpp), for simulated trainees.

// Keeps what it has learnt of the shapes: one for each lesson.
motion::ViewHelp view_help();

}  // namespace bolt::view
