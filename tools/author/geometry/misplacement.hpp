// One slip behind many wrong positions: wrong units, axes that are exchanged, another origin.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "engine/base/math.hpp"

namespace bolt::geometry {

// A joint as the file and as the model have it, metres.
struct Placement {
    Vec3 file, file_axis, model, model_axis;
};

inline constexpr double position_tolerance = 0.01e-3;      // m
inline constexpr double axis_tolerance = to_radians(0.1);  // rad

bool agrees(const Placement& placement);

struct Slip {
    std::string what;      // "the model is in millimetres"
    std::string expected;  // what to do
};

// The slip that explains all of them; none if they agree, or if no single slip does.
std::optional<Slip> common_slip(std::span<const Placement> placements);

}  // namespace bolt::geometry
