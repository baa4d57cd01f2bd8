// The jaw of an open-end wrench and the hexagon of a nut, both as exact convex solids, so that a clearance of
// a tenth of a millimetre is represented exactly; the fit of the jaw on the hexagon, and their contacts.
//
// Frame of the wrench: origin in the middle of the jaw at mid thickness, which is on the bolt's axis when the
// jaw sits square; Z normal to the wrench. The throat points along X rotated by the head angle about Z, the
// mouth the opposite way. Frame of the nut: origin on its bearing face, +Z along the bolt, a corner along +X
// (nut_pose in servo/setup.hpp).
#pragma once

#include <array>
#include <span>

#include "haptics/collision/convex.hpp"

namespace bolt::collision {

struct Jaw {
    double opening = 0.0;     // m, between the flats
    double head_angle = 0.0;  // rad
    double depth = 0.0;       // m, from the middle to the throat, the bottom of the slot
    double tip = 0.0;         // m, from the middle to the end of the jaws
    double thickness = 0.0;   // m
    // m, legs of the 45° chamfers:
    double bevel = 0.0;        // along the long edges of the flats
    double lead_in = 0.0;      // inside at the tips
    double tip_chamfer = 0.0;  // outside at the tips, in place of a radius

    // m, half the height of the flats without their bevels.
    [[nodiscard]] double half_flat() const { return 0.5 * thickness - bevel; }
};

// A jaw with the proportions of our models (tools/assets/models/wrench.cpp). A `thickness`, `depth` or `tip`
// of 0 takes the models' proportion.
Jaw make_jaw(double opening, double head_angle, double thickness = 0.0, double depth = 0.0, double tip = 0.0);

struct HexagonPrism {
    double across_flats = 0.0;  // s, m
    double height = 0.0;        // m
    double bearing = 0.0;  // m, diameter of the plane part of both faces; outside it the chamfers fall by 30°

    // m, from the middle of a flat to a corner.
    [[nodiscard]] double half_side() const;
    // m by which a corner is lower than the face.
    [[nodiscard]] double corner_drop() const;
};

// The two jaws and the bottom between them, in the wrench's frame. They extend beyond the slot by
// `jaw_cover` times its opening.
using JawParts = std::array<Convex, 3>;
inline constexpr double jaw_cover = 0.3;
Result<JawParts> jaw_parts(const Jaw& jaw);

// A hexagon with its chamfers; each chamfer cone is represented by twelve tangent planes.
Result<Convex> hexagon(const HexagonPrism& prism);

// The position of the head of a tool on a hexagon (tool_head.hpp), described for a jaw.
struct HeadFit {
    // rad, −30° … 30°, by which the jaw is turned off the hexagon. Clockwise, seen from +Z, is positive: the
    // direction that tightens a right-hand thread.
    double misalignment = 0.0;
    double overlap = 0.0;  // m, height over which the flats bear at each loaded corner
    // m along the flats from the axis to the two ends of the contact; with a ring, socket or key half a side
    // of the hexagon.
    double toward_throat = 0.0, toward_mouth = 0.0;
    double lateral_offset = 0.0;  // m, from the middle of the slot, ring or key to the bolt's axis
    // rad, rotation of the jaw about the direction along its flats; with a ring, socket or key the angle
    // between the axes of tool and turned part.
    double tilt = 0.0;

    // Returns true if the hexagon is between the flats of the head. The misalignment may have any value.
    [[nodiscard]] bool surrounds(double opening) const {
        return overlap > 0.0 && toward_throat + toward_mouth > 0.0 &&
               std::abs(lateral_offset) < 0.25 * opening;
    }
};

// `wrench`: pose of the wrench in the nut's frame.
HeadFit jaw_fit(const Jaw& jaw, const HexagonPrism& prism, const Pose& wrench);

inline constexpr std::size_t max_grip_contacts = 18;

// The solids of a tool's head and of the part that it turns, each in its own frame.
struct GripSolids {
    std::span<const Convex> head, turned_part;
};

// m between the origins of tool and turned part. If they are further apart than this and the band together,
// there are no contacts.
double grip_reach(const GripSolids& solids);

// Writes contacts of the solids up to `band` (m) and returns their number; each pair of solids gets an equal
// share of `out`, for its nearest ones. Poses are to the assembly; `obstacle` is copied to the contacts.
// Distances are separations as in convex.hpp: exact if a face or two edges are nearest.
std::size_t solid_contacts(const GripSolids& solids, const Pose& tool, const Pose& turned_part, double band,
                           ObstacleId obstacle, std::span<Contact, max_grip_contacts> out);

// Shifts each contact, perpendicular to the axis, until its normal has no moment about the axis. The contacts
// then constrain a body except for its rotation about the axis.
void remove_axial_moment(const Vec3& on_axis, const Vec3& axis, std::span<Contact> contacts);

}  // namespace bolt::collision
