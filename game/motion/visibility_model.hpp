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

struct Sight {
    Vec3 eye{0.0};                                           // m, where the head is
    std::vector<std::vector<collision::SurfacePoint>> nuts;  // by joint; empty: not looked at yet
    std::vector<collision::SurfacePoint> head;               // of the wrench
};

// 0…1 of a nut, past all obstacles; the wrench is none, it has to be there. 1 where the nut has no model.
double nut_seen(Sight& sight, const servo::ToolContact& touch, std::size_t joint, const Vec3& eye);

// The lesser of nut and wrench head, with the wrench at `wrench`.
double place_seen(Sight& sight, const servo::Setup& setup, const servo::ToolContact& touch, std::size_t joint,
                  const Pose& wrench, const Vec3& eye);

struct HeadMove {
    Vec3 eye{0.0};
    double turn = 0.0;  // rad about the place that is looked at, with all ways that were gone in vain
    int glances = 0;
};

// Looks for a place for the head from where as much as `content` of the place is seen, by going there: nobody
// knows what is seen from where they are not. It goes on one way about the place while more is seen, else
// back and another way, and is content with the best if it is worse wherever it goes. None: it is well where
// it is.
std::optional<HeadMove> look_round(Sight& sight, const servo::Setup& setup, const servo::ToolContact& touch,
                                   std::size_t joint, const Pose& wrench, double content, Random& random);

// Standard deviation, m, of where a tool is placed by who sees that share of the place: sight and touch each
// count by their precision (van Beers, Sittig and Denier van der Gon, J. Neurophysiol. 81 (1999) 1355).
// `sharp`: with all of it seen; `tries`: times that it has felt for the place.
double placing_noise(double sharp, double share, int tries);

// The program's help with the view for a simulated trainee: returns an eye from which the nut is visible.

struct ViewAsk {
    const servo::Setup& setup;
    const servo::ToolContact& touch;
    std::size_t joint = 0;
    Vec3 nut{0.0};  // m, its middle
    Pose wrench;    // where it is going to be
    Vec3 eye{0.0};  // m, where it is now
};

using ViewHelp = std::function<Vec3(const ViewAsk&)>;  // m, the eye in the new view

}  // namespace bolt::motion
