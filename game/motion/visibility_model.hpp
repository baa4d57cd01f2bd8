// The visible fraction of the nut that a simulated trainee reaches for, and the head movement that increases
// it. A trainee that does not see the nut places the wrench by touch and memory, less accurately.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "engine/base/random.hpp"
#include "haptics/collision/world.hpp"
#include "haptics/servo/setup.hpp"
#include "haptics/servo/tool_contact.hpp"

namespace bolt::motion {

// The eye of a simulated trainee, and cached surface samples for visibility queries.
struct VisibilityModel {
    Vec3 eye{0.0};                                           // m
    std::vector<std::vector<collision::SurfacePoint>> nuts;  // by joint; empty: not sampled yet
    std::vector<collision::SurfacePoint> wrench_head;
};

// The fraction 0…1 of a nut that the obstacles do not hide. The wrench does not count as an obstacle, because
// it must be at the nut. 1 if the nut has no model.
double nut_visibility(VisibilityModel& model, const servo::ToolContact& contact, std::size_t joint,
                      const Vec3& eye);

// The smaller visible fraction of nut and wrench head, for a wrench at `wrench`.
double target_visibility(VisibilityModel& model, const servo::Setup& setup, const servo::ToolContact& contact,
                         std::size_t joint, const Pose& wrench, const Vec3& eye);

struct HeadMovement {
    Vec3 eye{0.0};
    double turn = 0.0;  // rad, total movement about the nut, including unsuccessful attempts
    int glances = 0;    // directions tried
};

// Searches for an eye with a target visibility of at least `sufficient` by moving the head, since a trainee
// sees only from the present position. The head moves about the nut in one direction while the visibility
// increases, then returns and tries another direction, and stops at the best position if no direction is
// better. None: the present visibility suffices.
std::optional<HeadMovement> improve_view(VisibilityModel& model, const servo::Setup& setup,
                                         const servo::ToolContact& contact, std::size_t joint,
                                         const Pose& wrench, double sufficient, Random& random);

// Standard deviation, m, of the placement of a tool at a target whose visible fraction is `share`. Vision and
// touch are weighted by their precision (van Beers, Sittig and Denier van der Gon, J. Neurophysiol. 81 (1999)
// 1355). `full_view_noise`: standard deviation at full visibility, m; `tries`: earlier attempts by touch.
double placement_noise(double full_view_noise, double share, int tries);

// A request for the program's help with the view for a simulated trainee.
struct ViewRequest {
    const servo::Setup& setup;
    const servo::ToolContact& contact;
    std::size_t joint = 0;
    Vec3 nut{0.0};  // m, centre
    Pose wrench;    // its pose above the nut, from which it is lowered
    Vec3 eye{0.0};  // m, present position
};

// Returns an eye, m, from which the nut is visible.
using ViewHelper = std::function<Vec3(const ViewRequest&)>;

}  // namespace bolt::motion
