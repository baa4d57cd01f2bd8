// From everything that is near to the few contacts that hold the tool.
#pragma once

#include <span>

#include "haptics/contact/contact.hpp"

namespace bolt::contact {

// Contacts of one obstacle count as one when their normals are within this angle and their points on the tool
// within a distance that is `merge_distance` at first and doubles, up to `furthest_merge`, until those left
// find room. The nearest of them is kept. So a motion by v that turns by w and that the contacts written
// allow comes closer to one that was merged by at most merge_angle × |v| + distance × w.
inline constexpr double merge_angle = 4.0 * pi / 180.0;
inline constexpr double merge_distance = 2e-3;
inline constexpr double furthest_merge = 32e-3;

// An order of all contacts, by distance first.
bool nearer(const Contact& a, const Contact& b);

// Sorts `near` and writes what is kept. `clearance`: up to where `near` is all
// there is.
Found reduce(std::span<Contact> near, double clearance, std::span<Contact> out);

}  // namespace bolt::contact
