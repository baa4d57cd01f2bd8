// The metric size of a bolt from its measured dimensions, in metres.
#pragma once

#include <optional>
#include <string>

#include "engine/base/math.hpp"
#include "haptics/joint/fastener.hpp"

namespace bolt::step_import {

inline constexpr double width_tolerance = 0.5 * mm;  // of the width across flats

// The cylindrical head of a screw with a hexagonal socket, m.
struct CapHead {
    double width = 0.0;   // diameter
    double height = 0.0;  // above the bearing face
    double depth = 0.0;   // from the top of the head to the end of the socket's walls
};

// Returns the metric size that has this diameter over the crests and this width across flats, by ISO 272 or
// by DIN 931; null if there is none.
const joint::FastenerSize* size_of(double diameter, double across_flats);

// Returns the metric size of a thread with this diameter over the crests; null if there is none.
const joint::FastenerSize* size_of_thread(double diameter);

// As size_of() above, for a cap screw of ISO 4762. `across_flats`: of its socket. The socket may be deeper
// than the standard demands.
const joint::FastenerSize* size_of(double diameter, double across_flats, const CapHead& head);

// Explains why size_of() returns null for a bolt of this diameter: states the expected dimensions and, if
// this is the diameter of an inch thread, names the thread.
std::string explain_size(double diameter);

// The same for a cap screw. If its head is a low one, names the standard of such heads.
std::string explain_size(double diameter, double across_flats, const CapHead& head);

// Returns the name of the thread. `hole`: diameter of the hole of the nut or tapped part, m, which reveals a
// fine pitch by D1 = d − 1.0825 P (ISO 68-1). Without a match the pitch is coarse.
std::string thread_name(const joint::FastenerSize& size, double hole);

}  // namespace bolt::step_import
