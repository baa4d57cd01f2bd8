// The jaw of an open-end wrench and the hexagon that it goes onto: both in closed form, so that a clearance
// of a tenth of a millimetre is just that, and how the one sits on the other.
//
// Frame of the wrench: origin in the middle of the jaw, at mid thickness and on the bolt's axis when it sits
// square; Z its normal. The throat lies along X turned by the head's angle about Z, the mouth opposite.
// Frame of the nut: origin on its bearing face, +Z along the bolt, a corner along +X (servo/touch.hpp).
#pragma once

#include <array>

#include "haptics/collision/convex.hpp"

namespace bolt::collision {

struct Jaw {
    double opening = 0.0;     // m, between the flats
    double head_angle = 0.0;  // rad
    double throat = 0.0;      // m, from the middle to the bottom
    double tip = 0.0;         // m, from the middle to the end of the jaws
    double thickness = 0.0;   // m
    double bevel = 0.0;       // m, 45° along the edges of the flats
    double lead_in = 0.0;     // m, 45° at the tips
    double round = 0.0;       // m, 45° outside at the tips

    // Half the height over which its flats are flat.
    [[nodiscard]] double half_flat() const { return 0.5 * thickness - bevel; }
};

// A jaw of the proportions of our models (tools/models/wrench); `thickness`, `throat`, `tip` of 0 m: as those
// have them.
Jaw make_jaw(double opening, double head_angle, double thickness = 0.0, double throat = 0.0,
             double tip = 0.0);

struct HexagonPrism {
    double across_flats = 0.0;  // s, m
    double height = 0.0;        // m
    double bearing = 0.0;  // m, diameter of the flat ring on both faces: from there chamfers fall by 30°

    // From the middle of a flat to a corner.
    [[nodiscard]] double half_side() const;
    // That a corner is lower than the face, m.
    [[nodiscard]] double fall() const;
};

// Two jaws and the bottom between them, in the wrench's frame. What is further than `jaw_cover` openings from
// the slot is not part of it.
using JawParts = std::array<Convex, 3>;
inline constexpr double jaw_cover = 0.3;
JawParts jaw_parts(const Jaw& jaw);

// Whether a point of a wrench, in its frame, is of what those parts stand for: a head may be broader outside
// at its tips, and has fillets in its throat.
bool covered_by_jaw(const JawParts& parts, const Vec3& point);

// The cone of the chamfers as twelve tangent planes.
Convex hexagon(const HexagonPrism& prism);

// How a jaw sits.
struct JawSeat {
    double misalignment = 0.0;  // rad, −30° … 30°, of jaw against hexagon, tightening positive
    double overlap = 0.0;       // m of height in which flat lies on flat at every corner that can bear
    double toward_throat = 0.0, toward_mouth = 0.0;  // m from the axis along the flats to where they bear
    double aside = 0.0;                              // m, from the middle of the slot to the bolt's axis
    double tilt = 0.0;                               // rad, about the flats' length

    // Whether the hexagon is between the flats, wherever it points.
    [[nodiscard]] bool around(double opening) const {
        return overlap > 0.0 && toward_throat + toward_mouth > 0.0 && std::abs(aside) < 0.25 * opening;
    }
};

// `wrench`: its frame to the nut's.
JawSeat seat_of(const Jaw& jaw, const HexagonPrism& prism, const Pose& wrench);

inline constexpr std::size_t most_jaw_contacts = 18;

// Contacts of the jaw with one hexagon, poses to the assembly; `obstacle` names it. Distances are as
// convex.hpp has them: exact wherever face meets something, or edge meets edge.
std::size_t jaw_contacts(const JawParts& jaw, const Convex& hexagon, const Pose& wrench, const Pose& nut,
                         double band, ObstacleId obstacle, std::span<Contact, most_jaw_contacts> out);

// Lines of action moved, square to the axis, to where they meet it: such contacts hold a body in all but its
// turn about the axis.
void remove_axial_moment(const Vec3& on_axis, const Vec3& axis, std::span<Contact> contacts);

}  // namespace bolt::collision
