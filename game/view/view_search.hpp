// A view in which the eye truly sees a nut and the jaw that goes on it, asked of the same obstacles that hold
// the wrench.
#pragma once

#include <optional>

#include "game/motion/visibility_model.hpp"
#include "game/view/orbit.hpp"

namespace bolt::view {

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

}  // namespace bolt::view
