// A camera that circles around a point, as a hand with a mouse moves it. Places on the picture are in heights
// of the picture from its middle, x to the right and y up, so that nothing depends on its size.
#pragma once

#include <glm/vec2.hpp>

#include "engine/base/math.hpp"
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

}  // namespace bolt::view
